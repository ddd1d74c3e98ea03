// What the opaque scene of the tests is at one sample. This file is both GLSL and C++.
#ifndef VITRAIL_TESTS_OPAQUE_H
#define VITRAIL_TESTS_OPAQUE_H

struct OpaqueConstants {
#ifdef __cplusplus
  float color[4];
#else
  vec4 color;
#endif
  float depth;
};

#endif
