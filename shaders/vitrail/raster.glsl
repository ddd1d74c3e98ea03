// Exact transparency by a rasteriser in compute shaders (vulkan_raster.h): what a host's shader includes. It says where
// vertices are and what surfaces look like, and is compiled once for each stage:
//
//   #version 460
//   #extension GL_GOOGLE_include_directive : require
//   #define VITRAIL_SET 1
//   #include "vitrail/raster.glsl"
//   vec4 vitrailPosition(VitrailVertex vertex) { return viewProjection * model[vertex.instance] * ...; }
//   vec4 vitrailShade(VitrailSurface surface) { return ...; }   // linear colour, straight alpha
//
//   glslc -fshader-stage=compute --target-env=vulkan1.2 -DVITRAIL_RASTER_STAGE=0 ...
//
// vitrailPosition() gives clip space as a vertex shader of Vulkan does. A negative viewport height is not known here:
// who has one turns y. vitrailShade() is called for what shows, front to back, and not for what is hidden. Both may
// read all that the host's descriptor sets have, and may be called for a pixel any number of times; in the stage
// POSITIONS vitrailPosition() is called once for each vertex of each instance and may write, too: what else it has
// worked out to vertex.place of an array of the host's, say. There are no implicit derivatives: textures are sampled by
// textureGrad() and vitrailDerivatives(), or by textureLod(). A surface of alpha 0 is not there: a mask returns that
// (premultiplied, of colour 0 too).
//
// Define before the include
//   VITRAIL_SET                  required: the number of the raster's descriptor set, which comes behind the host's own
//                                (VitrailVkRasterDesc::setLayoutCount)
//   VITRAIL_RASTER_STAGE         required: which stage this is, by the compiler's command line
//   VITRAIL_MULTISAMPLED         the raster has several samples
//   VITRAIL_COLOR_FORMAT         the colour image's, rgba16f (the default) or rgba32f
//   VITRAIL_CLIP_PLANES          how many of VitrailVkRasterInfo::clipPlanes cut triangles, at most 8; default 0
//   VITRAIL_RASTER_FRAGMENTS     1 (the default), or 2: in place of vitrailShade() the host has vitrailShadeTwice(),
//                                of which the second step counts where the raster has more than one of blendModes
//
// Specialization constants from 1710 on are the library's, which reads in the last what the stage was compiled for. The
// stages need SPIR-V 1.3 and subgroup shuffles.
#ifndef VITRAIL_RASTER_GLSL
#define VITRAIL_RASTER_GLSL

#include "layout.h" // the names of blend modes
#include "raster/layout.h"

#define VITRAIL_RASTER_STAGE_POSITIONS 0
#define VITRAIL_RASTER_STAGE_SET_UP 1
#define VITRAIL_RASTER_STAGE_SET_UP_LARGE 2
#define VITRAIL_RASTER_STAGE_BLEND 3
#define VITRAIL_RASTER_STAGE_BLEND_DEEP 4

#ifndef VITRAIL_SET
#error VITRAIL_SET is not defined: the number of the raster's descriptor set, behind those of VitrailVkRasterDesc
#endif
#ifndef VITRAIL_RASTER_STAGE
#error VITRAIL_RASTER_STAGE is not defined: 0 to 4, one module for each stage of VitrailVkRasterDesc
#endif
#if VITRAIL_RASTER_STAGE < 0 || VITRAIL_RASTER_STAGE > 4
#error VITRAIL_RASTER_STAGE is none of 0 to 4
#endif
#ifndef VITRAIL_RASTER_FRAGMENTS
#define VITRAIL_RASTER_FRAGMENTS 1
#endif
#if VITRAIL_RASTER_FRAGMENTS != 1 && VITRAIL_RASTER_FRAGMENTS != 2
#error VITRAIL_RASTER_FRAGMENTS is neither 1 nor 2
#endif
#ifndef VITRAIL_CLIP_PLANES
#define VITRAIL_CLIP_PLANES 0
#endif
#if VITRAIL_CLIP_PLANES < 0 || VITRAIL_CLIP_PLANES > 8
#error VITRAIL_CLIP_PLANES is none of 0 to 8
#endif
#ifdef VITRAIL_MULTISAMPLED
#define VITRAIL_RASTER_SEVERAL 1
#else
#define VITRAIL_RASTER_SEVERAL 0
#endif

// main() names it, below, so that nothing takes it out of the module.
layout(constant_id = 1731) const uint VITRAIL_RASTER_COMPILED =
    uint(VITRAIL_RASTER_STAGE) << VITRAIL_RASTER_COMPILED_STAGE | uint(VITRAIL_SET) << VITRAIL_RASTER_COMPILED_SET |
    uint(VITRAIL_CLIP_PLANES) << VITRAIL_RASTER_COMPILED_PLANES |
    uint(VITRAIL_RASTER_FRAGMENTS) << VITRAIL_RASTER_COMPILED_FRAGMENTS |
    uint(VITRAIL_RASTER_SEVERAL) << VITRAIL_RASTER_COMPILED_SAMPLES;

const uint VITRAIL_NOT_KEPT = 0xffffffffu;

struct VitrailVertex {
  uint draw;     // which of the frame's
  uint instance; // as gl_InstanceIndex, from firstInstance on
  uint vertex;   // as gl_VertexIndex, with vertexOffset
  uint place;    // among the vertices of all instances of all draws; VITRAIL_NOT_KEPT where positions are not kept
  uint word;     // the draw's
};

// A surface at the middle of a pixel.
struct VitrailSurface {
  ivec2 pixel;
  uint draw;
  uint instance;
  uint primitive; // of the instance: a triangle, or half of a line or point
  uint word;
  bool front;     // which side shows
  uint corners;   // 3; 2 of a line, 1 of a point, whose other corners are the first
  uvec3 vertices; // of the corners, as VitrailVertex has them
  uvec3 places;
  vec3 weights;   // of the corners, with perspective; what is interpolated is the sum of three values times these
  mat3 clip;      // each corner's x, y and w in clip space
};

// The weights at another place of the surface's plane, in pixels: the middle of the pixel is pixel + 0.5.
vec3 vitrailWeightsAt(VitrailSurface surface, vec2 place);
// How the weights change from a pixel to the next, as the four pixels of a square tell each other (dFdx, dFdy).
void vitrailDerivatives(VitrailSurface surface, out vec3 right, out vec3 down);

// What a surface does to light, in at most two steps, the first in front of the second: linear colours with alpha, and
// their blend modes (VITRAIL_OVER, VITRAIL_PREMULTIPLIED, VITRAIL_ADDITIVE, VITRAIL_MULTIPLY).
struct VitrailFragments {
  vec4 colors[2];
  uint blends[2];
  uint count;
};

// The host's.
vec4 vitrailPosition(VitrailVertex vertex);
#if VITRAIL_RASTER_FRAGMENTS == 1
vec4 vitrailShade(VitrailSurface surface); // with the draw's blend mode
#else
VitrailFragments vitrailShadeTwice(VitrailSurface surface);
#endif

#define main vitrailStage
#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_POSITIONS
#include "raster/positions.glsl"
#elif VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_SET_UP
#include "raster/set_up.glsl"
#elif VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_SET_UP_LARGE
#include "raster/set_up_large.glsl"
#elif VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND
#include "raster/blend.glsl"
#else
#include "raster/blend_deep.glsl"
#endif
#undef main

void main() {
  if (VITRAIL_RASTER_COMPILED != 0u) vitrailStage(); // it never is 0: it has VITRAIL_RASTER_FRAGMENTS
}

#endif
