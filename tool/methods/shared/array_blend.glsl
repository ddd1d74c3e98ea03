// Blends the fragments of an array in order, nearest first, whatever order they lie in: sixteen at a time in registers,
// the next sixteen beyond them by going through the array again. No bindings: the including shader defines
//
//   uvec4 arrayKey(uint i)           of the i-th fragment: grows away from the viewer, no two the same
//   VitrailPair arrayPair(uvec4 key) what that fragment does to the light behind it
#ifndef VITRAIL_TOOL_ARRAY_BLEND_GLSL
#define VITRAIL_TOOL_ARRAY_BLEND_GLSL

#include "vitrail/sort.glsl"

// Whether all fragments were blended: a driver may end loops that it takes for endless ones.
bool blendArray(uint count, inout VitrailPair front) {
  uvec4 last = uvec4(0u);
  for (uint blended = 0u; blended < count;) {
    VitrailEntry e[16] = VitrailEntry[](VITRAIL_LAST_16);
    uint i = 0u;
    for (; i < count; ++i) {
      uvec4 key = arrayKey(i);
      if (blended == 0u || vitrailBefore(last, key)) vitrailInsert(e, VitrailEntry(key, 0u));
    }
    if (i < count) return false;
    uint more = min(count - blended, 16u);
#define ARRAY_BLEND(n) \
  if (n < more) { \
    VitrailPair pair = arrayPair(e[n].key); \
    front.color += front.transmittance.rgb * pair.color; \
    front.transmittance *= pair.transmittance; \
  }
    ARRAY_BLEND(0u) ARRAY_BLEND(1u) ARRAY_BLEND(2u) ARRAY_BLEND(3u) ARRAY_BLEND(4u) ARRAY_BLEND(5u) ARRAY_BLEND(6u)
    ARRAY_BLEND(7u) ARRAY_BLEND(8u) ARRAY_BLEND(9u) ARRAY_BLEND(10u) ARRAY_BLEND(11u) ARRAY_BLEND(12u)
    ARRAY_BLEND(13u) ARRAY_BLEND(14u) ARRAY_BLEND(15u)
    last = e[15].key;
    blended += more;
    if (blended < count && last == VITRAIL_LAST.key) return false;
  }
  return true;
}

#endif
