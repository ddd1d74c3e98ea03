// What the shaders that follow light through what surfaces enclose share with C++. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_MEDIA_SHARED_H
#define VITRAIL_TOOL_MEDIA_SHARED_H

#include "gpu/glsl.h"

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace vitrail::tool::shaders {
using glm::vec4;
} // namespace vitrail::tool::shaders
#endif

VITRAIL_SHARED_BEGIN

// The word of a fragment where light enters or leaves an object: 0 for other fragments, else the object's number plus 1
// in the upper 31 bits, and in the lowest whether the surface shows its front.
const uint MEDIA_FRONT = 1u;
const uint MEDIA_FIRST_OBJECT = 2u; // the least such word

// What an object does to light (std430).
struct MediaObject {
  vec4 absorption; // rgb, per unit of length; w: MEDIA_INWARD, MEDIA_NEAR, as a number
};
const uint MEDIA_INWARD = 1u; // its surfaces show their fronts to its inside
const uint MEDIA_NEAR = 2u;   // it may reach in front of the near plane: rays may begin inside of it

// How rays go through a picture (push constants).
struct MediaView {
  vec4 ray;   // FrameData::ray
  vec4 depth; // xy: FrameData::depth.xy; z: 1 if orthographic; w: 1 if any object has MEDIA_NEAR
};

#ifdef __cplusplus
static_assert(sizeof(MediaObject) == 16);
static_assert(sizeof(MediaView) == 32);
#endif

VITRAIL_SHARED_END

#endif
