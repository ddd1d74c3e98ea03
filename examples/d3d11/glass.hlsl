// Tinted glass: a filter for what is behind it, and what it reflects itself.
#include "vitrail/collect.hlsl"
#include "scene.hlsl"

Corner place(uint vertex : SV_VertexID, uint pane : SV_InstanceID) { return corner(vertex, int(pane)); }

[earlydepthstencil] void main(Corner c) {
  static const float3 kTints[3] = {float3(0.60, 0.90, 0.95), float3(0.98, 0.86, 0.52), float3(0.96, 0.64, 0.76)};
  float3 ray = normalize(c.position - kEye);
  float3 axis = float3(c.axis == 0 ? 1.0 : 0.0, c.axis == 1 ? 1.0 : 0.0, c.axis == 2 ? 1.0 : 0.0);
  float3 normal = -sign(dot(ray, axis)) * axis;
  float facing = 1.0 + dot(ray, normal);
  float reflectance = 0.04 + 0.96 * facing * facing * facing * facing * facing; // Schlick's approximation
  float rim = step(0.965, max(abs(c.place.x), abs(c.place.y)));                 // the ground edge of the pane
  reflectance = lerp(reflectance, 0.55, rim);
  vitrailCollect(c.clip, 1u, float4(kTints[c.axis], 1.0), VITRAIL_MULTIPLY);
  float3 sky = skyColor(reflect(ray, normal));
  vitrailCollect(c.clip, 1u, float4(reflectance * sky, reflectance), VITRAIL_PREMULTIPLIED);
}
