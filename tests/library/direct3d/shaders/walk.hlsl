// Writes down what lies under each pixel of an area, front to back: tests/library/vulkan/shaders/walk.comp for HLSL.
#ifdef VITRAIL_TEST_WALK_AND_COLLECT // both may stand in one shader
#include "vitrail/collect.hlsl"
#endif
#include "vitrail/list.hlsl"

cbuffer Constants : register(b0) {
  uint4 area; // x, y, width, height
  uint most;  // layers that are written down of a pixel
};
// Of each pixel: how many layers it has, whether the walk was cut, and the layers, 8 words each.
RWByteAddressBuffer walked : register(u0);

[numthreads(8, 8, 1)] void main(uint3 id : SV_DispatchThreadID) {
  if (id.x >= area.z || id.y >= area.w) return;
  uint first = 4u * (id.y * area.z + id.x) * (2u + 8u * most);
  VitrailList list = vitrailOpenList(int2(id.xy + area.xy));
  VitrailLayer layer;
  uint count = 0u;
  [loop] while (vitrailNextLayer(list, layer)) {
    if (count < most) {
      uint at = first + 8u + 32u * count;
      walked.Store4(at, asuint(layer.color));
      walked.Store4(at + 16u, uint4(asuint(layer.depth), layer.blend, layer.coverage, layer.word));
    }
    ++count;
  }
  walked.Store2(first, uint2(count, vitrailListWasCut(list) ? 1u : 0u));
}
