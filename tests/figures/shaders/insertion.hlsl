// The resolve of such lists: a pixel shader, once a sample, copies those that cover the sample into an array, sorts it
// by insertion and blends it. What finds no room in the array is left out.
#include "stored.hlsl"

float4 main(float4 position : SV_Position
#ifdef FIGURES_SEVERAL_SAMPLES
            , uint sampleIndex : SV_SampleIndex
#endif
            ) : SV_Target {
#ifndef FIGURES_SEVERAL_SAMPLES
  static const uint sampleIndex = 0u;
#endif
  uint index = storedHeads[uint2(position.xy)];
  if (index == kEndOfList) discard;
  StoredFragment array[FIGURES_LAYERS];
  uint count = 0u;
  [loop] while (index != kEndOfList && count < FIGURES_LAYERS) {
    StoredFragment fragment = storedFragments[index];
    index = fragment.next;
    if ((fragment.coverage >> sampleIndex & 1u) != 0u) {
      array[count] = fragment;
      ++count;
    }
  }
  [loop] for (uint i = 1u; i < count; ++i) {
    StoredFragment moving = array[i];
    uint hole = i;
    [loop] while (hole > 0u && array[hole - 1u].depth > moving.depth) { // 1 is the nearest: the farthest come first
      array[hole] = array[hole - 1u];
      --hole;
    }
    array[hole] = moving;
  }
  float4 blended = 0.0; // premultiplied
  [loop] for (uint k = 0u; k < count; ++k) {
    uint2 c = array[k].color;
    float alpha = f16tof32(c.y >> 16);
    float3 color = float3(f16tof32(c.x), f16tof32(c.x >> 16), f16tof32(c.y));
    blended = float4(alpha * color, alpha) + (1.0 - alpha) * blended;
  }
  return blended;
}
