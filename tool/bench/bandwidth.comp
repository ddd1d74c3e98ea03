// Copies one buffer to another, 16 bytes at a time: what the bandwidth probe times.
#version 460

layout(local_size_x = 256) in;

layout(set = 0, binding = 0, std430) readonly buffer SourceBlock { uvec4 source[]; };
layout(set = 0, binding = 1, std430) writeonly buffer DestinationBlock { uvec4 destination[]; };

void main() {
  uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  uint count = uint(source.length());
  for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) destination[i] = source[i];
}
