// The surfaces of the figures, shaded as docs/shading.md states materials without extensions, for every way to draw
// them.
#ifdef FIGURES_COLLECT
#include "vitrail/collect.hlsl"
#endif
#ifdef FIGURES_STORE
#define FIGURES_BUFFER RWStructuredBuffer<StoredFragment>
#include "stored.hlsl"
#endif

#include "frame.hlsl"

struct Corner {
  float4 clip : SV_Position;
  float3 position : POSITION;
  float3 normal : NORMAL;
  nointerpolation float4 color : COLOR;
  nointerpolation float roughness : ROUGHNESS; // below 0: unlit
};

// The rows of an instance's transform turn normals by their cofactors.
Corner place(float3 position : POSITION, float3 normal : NORMAL, float4 row0 : ROW0, float4 row1 : ROW1,
             float4 row2 : ROW2, float4 color : COLOR, float roughness : ROUGHNESS) {
  float4 local = float4(position, 1.0);
  Corner c;
  c.position = float3(dot(row0, local), dot(row1, local), dot(row2, local));
  c.clip = mul(viewProjection, float4(c.position, 1.0));
  c.clip.y = -c.clip.y; // the matrix is for Vulkan, whose pictures begin below
  c.normal = float3(dot(normal, cross(row1.xyz, row2.xyz)), dot(normal, cross(row2.xyz, row0.xyz)),
                    dot(normal, cross(row0.xyz, row1.xyz)));
  c.color = color;
  c.roughness = roughness;
  return c;
}

float3 hemisphere(float3 d) { return lerp(float3(0.18, 0.17, 0.16), float3(0.36, 0.38, 0.42), 0.5 + 0.5 * d.y); }

float4 shade(Corner c, bool front) {
  if (c.roughness < 0.0) return c.color;
  static const float kPi = 3.14159265;
  float3 v = normalize(eye.xyz - c.position);
  float3 n = normalize(c.normal) * (front ? 1.0 : -1.0);
  float nv = max(dot(n, v), 0.0001);
  float nl = max(dot(n, toLight.xyz), 0.0);
  float3 h = normalize(toLight.xyz + v);
  float nh = dot(n, h);
  float3 side = cross(n, h); // 1 - nh^2, without cancellation
  float r = clamp(c.roughness, 0.045, 1.0);
  float a2 = r * r * r * r;
  float fresnel = 0.04 + 0.96 * pow(max(1.0 - dot(v, h), 0.0), 5.0);
  float f = nh > 0.0 ? nh * nh * a2 + dot(side, side) : 1.0;
  float distribution = a2 / (kPi * f * f);
  float visibility = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
  float3 direct = 2.0 * nl * ((1.0 - fresnel) * c.color.rgb / kPi + fresnel * distribution * visibility);
  float3 mirrored = 2.0 * dot(n, v) * n - v;
  float reflected = 0.04 + (max(1.0 - r, 0.04) - 0.04) * pow(max(1.0 - nv, 0.0), 5.0);
  return float4(direct + hemisphere(n) * c.color.rgb + hemisphere(mirrored) * reflected, c.color.a);
}

// Opaque, and blended in the order of drawing.
float4 draw(Corner c, bool front : SV_IsFrontFace) : SV_Target { return shade(c, front); }

#ifdef FIGURES_COLLECT
[earlydepthstencil] void collect(Corner c, uint coverage : SV_Coverage, bool front : SV_IsFrontFace) {
#ifdef FIGURES_WHOLE_PIXELS // as where nobody looks at which samples a fragment covers
  coverage = 0xffu;
#endif
  vitrailCollect(c.clip, coverage, shade(c, front));
}
#endif

#ifdef FIGURES_STORE
[earlydepthstencil] void store(Corner c, uint coverage : SV_Coverage, bool front : SV_IsFrontFace) {
  float4 color = shade(c, front);
  uint index = storedFragments.IncrementCounter();
  uint count, stride;
  storedFragments.GetDimensions(count, stride);
  if (index >= count) return;
  StoredFragment fragment;
  InterlockedExchange(storedHeads[uint2(c.clip.xy)], index, fragment.next);
  fragment.color = uint2(f32tof16(color.r) | f32tof16(color.g) << 16, f32tof16(color.b) | f32tof16(color.a) << 16);
  fragment.depth = c.clip.z;
  fragment.coverage = coverage;
  storedFragments[index] = fragment;
}
#endif
