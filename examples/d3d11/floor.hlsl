// A chequered floor that is darker below the cube and fades into the distance.
#include "scene.hlsl"

Corner place(uint vertex : SV_VertexID) { return corner(vertex, -1); }

float4 main(Corner c) : SV_Target {
  float2 square = floor(c.position.xz * 2.0);
  bool light = frac((square.x + square.y) * 0.5) < 0.25;
  float3 color = light ? float3(0.74, 0.72, 0.68) : float3(0.28, 0.29, 0.32);
  float away = length(max(abs(c.position.xz) - 0.8, 0.0));
  color *= lerp(0.55, 1.0, smoothstep(0.0, 1.2, away));
  return float4(lerp(color, kHorizon, smoothstep(3.0, 16.0, distance(c.position, kEye) - 4.0)), 1.0);
}
