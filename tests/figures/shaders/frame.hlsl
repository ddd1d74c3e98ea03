// What all draws share: the first members of FrameData, tool/stage/surface_shared.h.
cbuffer FrameBlock : register(b0) {
  float4x4 viewProjection;
  float4x4 cameraToWorld;
  float4 eye;
  float4 toLight;
  float4 ray;
};
