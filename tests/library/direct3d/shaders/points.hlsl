// Puts one point, a fragment of the caller's choosing, on one pixel, and collects it: the smallest shaders there are.
#include "vitrail/collect.hlsl"

struct PointOfPixel {
  float4 position : SV_Position;
  nointerpolation float4 color : COLOR;
  nointerpolation uint blend : BLEND;
  nointerpolation uint word : WORD;
};

PointOfPixel place(float3 position : POSITION, float4 color : COLOR, uint blend : BLEND, uint word : WORD) {
  PointOfPixel p;
  p.position = float4(position, 1.0); // clip space
  p.color = color;
  p.blend = blend;
  p.word = word;
  return p;
}

[earlydepthstencil] void main(PointOfPixel p, uint coverage : SV_Coverage) {
  vitrailCollectWord(p.position, coverage, p.color, p.blend, p.word);
}
