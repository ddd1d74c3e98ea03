// A triangle over the whole picture, and the sky of docs/shading.md on it.
#include "frame.hlsl"

float4 place(uint vertex : SV_VertexID) : SV_Position {
  return float4(vertex == 1u ? 3.0 : -1.0, vertex == 2u ? 3.0 : -1.0, 0.0, 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target {
  float3 inCamera = float3(position.x * ray.x - ray.z, ray.w - position.y * ray.y, -1.0);
  float y = normalize(mul((float3x3)cameraToWorld, inCamera)).y;
  float3 far = y >= 0.0 ? float3(0.18, 0.36, 0.70) : float3(0.30, 0.28, 0.26);
  return float4(lerp(float3(0.70, 0.78, 0.88), far, sqrt(abs(y))), 1.0);
}
