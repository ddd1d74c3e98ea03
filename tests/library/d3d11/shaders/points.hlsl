// The smallest host shader there is: tests/library/vulkan/shaders/points.frag for HLSL.
#include "vitrail/collect.hlsl"

struct PointOfPixel {
  float4 position : SV_Position;
  nointerpolation float4 color : COLOR;
  nointerpolation uint blend : BLEND;
  nointerpolation uint word : WORD;
};

[earlydepthstencil] void main(PointOfPixel p, uint coverage : SV_Coverage) {
  vitrailCollectWord(p.position, coverage, p.color, p.blend, p.word);
}
