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

// The word of a fragment of an object that encloses a volume: MEDIA_OBJECT times its number plus 1, and these bits. 0
// for other fragments.
const uint MEDIA_FRONT = 1u;   // the surface shows its front
const uint MEDIA_SURFACE = 2u; // here light enters or leaves: one fragment of each surface
const uint MEDIA_OBJECT = 4u;

// What an object does to light (std430).
struct MediaObject {
  vec4 absorption; // rgb, per unit of length; w: MEDIA_INWARD, MEDIA_NEAR, as a number
};
const uint MEDIA_INWARD = 1u; // its surfaces show their fronts to its inside
// Rays may begin inside of it. All its surfaces are on the lists, those behind opaque ones too: as many more as a ray
// leaves than it enters, so many times it has begun inside.
const uint MEDIA_NEAR = 2u;

// How rays go through a picture (push constants).
struct MediaView {
  vec4 ray;   // FrameData::ray
  vec4 depth; // xy: FrameData::depth.xy; z: 1 if orthographic
};

#ifdef __cplusplus
static_assert(sizeof(MediaObject) == 16);
static_assert(sizeof(MediaView) == 32);
#endif

VITRAIL_SHARED_END

#endif
