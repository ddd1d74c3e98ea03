/* Vitrail on the CPU: exact order-independent transparency by a rasteriser of its own, for machines without a GPU and
 * for hosts that have no graphics API. It needs no Vulkan, and no driver.
 *
 * A frame is one call. The host hands over triangles in clip space, in any order, each draw with a colour or with a
 * function that shades it, and arrays for colour and depth. Triangles are binned to tiles of 32 x 32 pixels; all
 * transparent fragments of a tile are kept in cache, sorted by depth for each pixel and blended front to back. Nothing
 * is stored for the whole picture: there is no pool that could overflow, and any number of layers is exact. The sources
 * are Carpenter's A-buffer (1984), Pineda's "A Parallel Algorithm for Polygon Rasterization" (1988) and Batcher's
 * sorting networks (1968).
 *
 *   vitrailCpuCreateContext    once: how many threads, which instructions
 *   vitrailCpuRender           once a frame: opaque and transparent draws into the host's arrays
 *   vitrailCpuDestroyContext
 *
 * Coverage is that of graphics hardware, bit for bit: corners are rounded to 1/256 pixel, edges are exact, pixels (or
 * samples, at Vulkan's standard places) on an edge belong to the triangle of which it is a top or left edge. A triangle
 * that reaches over the near plane or far out of the picture is clipped, in doubles: corners may be 10^10 times as far
 * away as the picture is wide. Where one has a coordinate that is no finite number nothing of it is drawn.
 *
 * Depth and the position within a triangle are interpolated in 32-bit floats from exact edge functions: depth is off by
 * at most 2^-22 of the largest depth of the triangle's corners, barycentric coordinates by at most 2^-20, times how
 * many times as large the w of one corner is as that of another, whatever the triangle's shape.
 *
 * The same frame gives the same bits for any number of threads and any order of transparent draws, as far as what is
 * shaded is the same; of opaque surfaces at one depth the one that is drawn last shows. Between instruction sets
 * pictures differ by at most 1/255: some fuse a multiplication and an addition, which rounds once, others round twice.
 * (By more where slanted surfaces lie in one plane: rounding then tells which is in front.) Coverage never differs.
 *
 * Threads: a context is used from one thread at a time; different contexts may be used at once. Nothing global is kept.
 * A call returns when the frame is done; shade functions and hooks run on the context's threads, several at once. */
#ifndef VITRAIL_CPU_H
#define VITRAIL_CPU_H

#include <vitrail/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Context ---------------------------------------------------------------------------------------------------- */

typedef struct VitrailCpuContext_T* VitrailCpuContext;

/* Calls task(data, i) for each i below count, on whatever threads, and returns when all are done. May be called again
 * while a call is under way only by different contexts. */
typedef void (*VitrailCpuParallel)(void* user, uint32_t count, void (*task)(void* data, uint32_t i), void* data);

/* The vector instructions that a context uses. Which there are depends on the processor and on how the library was
 * built. */
typedef enum VitrailCpuInstructions {
  VITRAIL_CPU_BEST = 0,     /* the widest that the processor has */
  VITRAIL_CPU_SSE4 = 1,     /* 4 lanes, x86 */
  VITRAIL_CPU_AVX2 = 2,     /* 8 lanes, x86, with fused multiply-add */
  VITRAIL_CPU_AVX512 = 3,   /* 16 lanes, x86 */
  VITRAIL_CPU_NEON = 4,     /* 4 lanes, 64-bit Arm */
  VITRAIL_CPU_BASELINE = 5, /* processors of other kinds, with what all of the kind have */
  VITRAIL_CPU_INSTRUCTIONS_MAX_ENUM = 0x7fffffff
} VitrailCpuInstructions;

typedef struct VitrailCpuContextDesc {
  const void* next; /* null */
  /* How many threads work on a frame, the caller's among them. Default: as many as the process may run on. 1: only the
   * caller's, and none is ever started. The others are started with the context and sleep between
   * frames. */
  uint32_t threads;
  VitrailCpuParallel parallel; /* optional: the host's own threads, in place of the context's; `threads` is how many */
  void* parallelUser;
  VitrailCpuInstructions instructions;
  VitrailLog log; /* optional; default: silence; outlives the context */
  void* logUser;
} VitrailCpuContextDesc;

/* A null `desc` stands for all defaults. Errors: VITRAIL_ERROR_INVALID for a field that is not as described,
 * VITRAIL_ERROR_UNSUPPORTED for instructions that are not there, VITRAIL_ERROR_OUT_OF_MEMORY. On error *context is
 * null. */
VITRAIL_API VitrailResult vitrailCpuCreateContext(const VitrailCpuContextDesc* desc, VitrailCpuContext* context);

/* Null is ignored. */
VITRAIL_API void vitrailCpuDestroyContext(VitrailCpuContext context);

/* The instructions that a context uses, never VITRAIL_CPU_BEST, and how many threads. */
VITRAIL_API VitrailCpuInstructions vitrailCpuContextInstructions(VitrailCpuContext context);
VITRAIL_API uint32_t vitrailCpuContextThreads(VitrailCpuContext context);

/* Their name: "AVX-512". "best" for VITRAIL_CPU_BEST, "unknown" for what is none of them. */
VITRAIL_API const char* vitrailCpuInstructionsName(VitrailCpuInstructions instructions);

/* ---- Shading ---------------------------------------------------------------------------------------------------- */

/* Fragments are shaded up to sixteen at a time: pixels of one block of 4 x 4 and of one draw, of several triangles
 * where those are small. Entry i of each array is one fragment; those whose bit of `mask` is not set are not wanted:
 * what is in them is of no meaning (but finite, and their `triangle` is one of the draw's), and they may be shaded or
 * not. */
#define VITRAIL_CPU_LANES 16

typedef struct VitrailCpuFragments {
  /* What to shade. Arrays are aligned to 64 bytes. */
  uint32_t triangle[VITRAIL_CPU_LANES]; /* which triangle (line, point) of the draw, from 0 */
  float depth[VITRAIL_CPU_LANES];       /* at the pixel centre, in [0, 1] */
  /* Where in its triangle the pixel's centre is, perspective-correct: the weight of the second corner and that of the
   * third. The first has 1 - second - third. On a line the second is that of its end. Where several samples are taken
   * the centre may lie outside, and weights below 0 or above 1. */
  float second[VITRAIL_CPU_LANES];
  float third[VITRAIL_CPU_LANES];
  /* VITRAIL_CPU_SHADE_DERIVATIVES: how the two change from this pixel to the next, to the right and down. */
  float secondDx[VITRAIL_CPU_LANES];
  float secondDy[VITRAIL_CPU_LANES];
  float thirdDx[VITRAIL_CPU_LANES];
  float thirdDy[VITRAIL_CPU_LANES];

  /* What the function fills in. */
  float color[4][VITRAIL_CPU_LANES]; /* linear r, g, b, and alpha, as the draw's blend mode takes them */
  /* VITRAIL_CPU_SHADE_FILTER: what passes through the fragment is multiplied by this, per channel; 0 to 1, larger ones
   * are clamped. (What makes the light behind it brighter is a draw of VITRAIL_BLEND_MULTIPLY.) */
  float filter[3][VITRAIL_CPU_LANES];
  /* VITRAIL_CPU_SHADE_DISCARD: bits of those that are not there. 0 when the function is called. */
  uint32_t discarded;

  uint32_t mask;  /* bit i: entry i is a fragment; at least one is */
  uint32_t draw;  /* index of the draw */
  uint32_t front; /* bit i: the triangle shows its front */
  uint32_t x;     /* in the picture, the block's first pixel: entry i is at x + i % 4, y + i / 4 */
  uint32_t y;
} VitrailCpuFragments;

/* Shades fragments of a draw. Called on several threads at once. Colours are as those of VitrailNodeFormat: a NaN is 0,
 * negative colours are 0, infinite ones 65504, alpha is clamped to [0, 1]. */
typedef void (*VitrailCpuShade)(void* user, VitrailCpuFragments* fragments);

typedef enum VitrailCpuShadeBits {
  VITRAIL_CPU_SHADE_DERIVATIVES = 1 << 0, /* it reads secondDx and the like */
  VITRAIL_CPU_SHADE_DISCARD = 1 << 1,     /* it may discard fragments */
  /* Transparent draws of VITRAIL_BLEND_PREMULTIPLIED: it fills in `filter`. The fragment does to the light d behind it
   * rgb + (1 - a) * filter * d: a reflection in front of a colour filter, in one fragment. */
  VITRAIL_CPU_SHADE_FILTER = 1 << 2,
  VITRAIL_CPU_SHADE_MAX_ENUM = 0x7fffffff
} VitrailCpuShadeBits;

/* ---- Draws ------------------------------------------------------------------------------------------------------ */

typedef enum VitrailCpuSurface {
  VITRAIL_CPU_TRANSPARENT = 0, /* every fragment in front of the opaque surfaces is blended */
  VITRAIL_CPU_OPAQUE = 1,      /* hides what is behind it; its alpha is not looked at */
  VITRAIL_CPU_SURFACE_MAX_ENUM = 0x7fffffff
} VitrailCpuSurface;

typedef enum VitrailCpuTopology {
  VITRAIL_CPU_TRIANGLES = 0, /* three vertices each */
  VITRAIL_CPU_LINES = 1,     /* two vertices each, a pixel wide: parallelograms, as Vulkan's non-strict lines */
  VITRAIL_CPU_POINTS = 2,    /* one vertex each: squares of pointSize pixels */
  VITRAIL_CPU_TOPOLOGY_MAX_ENUM = 0x7fffffff
} VitrailCpuTopology;

/* Which triangles are left out. The front is the side from which the corners run counter-clockwise in the picture. */
typedef enum VitrailCpuCull {
  VITRAIL_CPU_CULL_NONE = 0,
  VITRAIL_CPU_CULL_BACK = 1,
  VITRAIL_CPU_CULL_FRONT = 2,
  VITRAIL_CPU_CULL_MAX_ENUM = 0x7fffffff
} VitrailCpuCull;

/* The most clip planes of a draw, and pixels of a point's side. */
#define VITRAIL_CPU_MAX_CLIP_PLANES 8
#define VITRAIL_CPU_MAX_POINT_SIZE 2048

typedef struct VitrailCpuDraw {
  const void* next; /* null */
  VitrailCpuSurface surface;
  VitrailCpuTopology topology;
  VitrailCpuCull cull;
  VitrailBlend blend; /* of transparent draws */
  /* Vertices: `vertexCount` times `components` floats, 3 (w is 1) or 4 (default), `vertexStride` bytes apart (default:
   * without gaps). With `model`, three rows of four floats, (x, y, z) becomes those rows times (x, y, z, w). With
   * `transform`, a 4 x 4 matrix in columns, clip space is transform * (x, y, z, w); without it they are in clip space.
   * Products are added from w to x, each sum rounded: in the order of Mesa's drivers. */
  const float* positions; /* required */
  uint32_t components;
  uint32_t vertexStride;
  uint32_t vertexCount;
  const float* model;     /* optional */
  const float* transform; /* optional */
  /* Optional: `indexCount` numbers of vertices, each below vertexCount. Without them vertices are taken in order. */
  const uint32_t* indices;
  uint32_t indexCount;
  /* Optional: what is on the negative side of a plane is cut away: four floats each, times (x, y, z, w) before
   * `transform` and after `model`. At most VITRAIL_CPU_MAX_CLIP_PLANES. */
  const float* clipPlanes;
  uint32_t clipPlaneCount;
  float pointSize; /* of points, at most VITRAIL_CPU_MAX_POINT_SIZE; default 1 */
  float color[4];  /* where `shade` is null: linear r, g, b, alpha, as `blend` takes them */
  VitrailCpuShade shade;
  void* shadeUser;
  uint32_t shadeFlags; /* VitrailCpuShadeBits */
  /* The largest r, g or b, of VITRAIL_BLEND_ADDITIVE times alpha, that `shade` gives: larger ones are clamped to it. It
   * decides how far behind nearly opaque surfaces fragments still count (VitrailStats of vitrailCpuRender). Default:
   * 65504. Not needed where `shade` is null. */
  float brightest;
  /* A promise: the alpha that `shade` gives is never below this, from 0 (default: nothing is known) to 1. By it, what
   * is hidden is known before it is shaded, and most of it is left alone; where it is not kept, surfaces vanish behind
   * others. 0 with VITRAIL_CPU_SHADE_DISCARD. Not needed where `shade` is null. */
  float leastAlpha;
  uint32_t word; /* the host's, for the list hook: object, material */
} VitrailCpuDraw;

/* ---- Frames ----------------------------------------------------------------------------------------------------- */

/* How clip space looks: where y points, and which z are within the view. */
typedef enum VitrailCpuClipSpace {
  VITRAIL_CPU_CLIP_VULKAN = 0,   /* y down, 0 <= z <= w */
  VITRAIL_CPU_CLIP_DIRECT3D = 1, /* y up, 0 <= z <= w */
  VITRAIL_CPU_CLIP_OPENGL = 2,   /* y up, -w <= z <= w: depth is (z / w + 1) / 2 */
  VITRAIL_CPU_CLIP_SPACE_MAX_ENUM = 0x7fffffff
} VitrailCpuClipSpace;

typedef enum VitrailCpuColorFormat {
  VITRAIL_CPU_RGBA32F = 0,    /* linear, premultiplied */
  VITRAIL_CPU_RGBA8_SRGB = 1, /* r, g, b on the sRGB curve, opaque: alpha is written as 255 */
  VITRAIL_CPU_COLOR_FORMAT_MAX_ENUM = 0x7fffffff
} VitrailCpuColorFormat;

/* Takes the sorted fragments of a pixel, nearest first, those behind opaque surfaces left out; those of one depth in an
 * order that does not depend on that of the draws: by what they do to light, then by blend mode and word. Those of
 * VITRAIL_BLEND_ADDITIVE and _MULTIPLY come with what they amount to at an alpha of 1. A fragment with a filter
 * (VITRAIL_CPU_SHADE_FILTER) is two layers at one depth, the first VITRAIL_BLEND_PREMULTIPLIED, the second
 * VITRAIL_BLEND_MULTIPLY. Called on several threads at once, for each pixel that has layers. x and y are in the
 * picture, also where the frame is a part of it. Return 0 for the pixel to be blended as ever, or 1 to have blended it:
 * `color` holds the opaque colour of each sample, 4 floats (linear, premultiplied) times `samples`, and takes what
 * becomes of them. No fragment is left out for what is in front of it. */
typedef int (*VitrailCpuList)(void* user, uint32_t x, uint32_t y, const VitrailLayer* layers, uint32_t count,
                              float* color);

/* Told how many of the tiles are done, on one of the context's threads, not on several at once. Return 0 to go on,
 * anything else to give up: the call returns VITRAIL_INCOMPLETE, and part of the picture is there. */
typedef int (*VitrailCpuProgress)(void* user, uint32_t tilesDone, uint32_t tiles);

/* The most pixels of a picture's side. */
#define VITRAIL_CPU_MAX_SIDE 32768

typedef struct VitrailCpuFrame {
  const void* next; /* null */
  uint32_t width;   /* pixels; required; at most VITRAIL_CPU_MAX_SIDE */
  uint32_t height;
  /* Where the frame is a part of a larger picture: the size of that, and where in it the frame begins. What is drawn is
   * bit for bit what it is in the whole picture. Default: the frame is the picture. */
  uint32_t pictureWidth;
  uint32_t pictureHeight;
  uint32_t originX;
  uint32_t originY;
  uint32_t samples; /* 1 (default), 2, 4 or 8: each sample blends its own fragments, and a pixel is their mean */
  VitrailCpuClipSpace clipSpace;
  VitrailDepthOrder depthOrder;
  VitrailCpuColorFormat colorFormat;
  /* In: what is behind all draws. Out: the picture. Rows top to bottom. */
  void* color;          /* required */
  uint32_t colorStride; /* bytes from row to row; default: without gaps */
  /* Optional: one colour behind all draws, 4 floats, linear, premultiplied with alpha (pictures of 8 bits take no
   * alpha). `color` is then not read, and every pixel of it is written: faster than to fill it first. */
  const float* clear;
  /* Optional: the opaque depth in [0, 1], which draws are tested against and opaque ones change: `samples` floats a
   * pixel. Without it there is nothing opaque but this frame's draws. */
  float* depth;
  uint32_t depthStride; /* bytes from row to row; default: without gaps */
  /* Optional, samples > 1: what is behind each sample, in place of `color`: 4 floats times `samples` a pixel, without
   * gaps. It is not written. */
  const float* sampleColors;
  float brightest;     /* the largest r, g or b of `color`, `clear` and `sampleColors`; default 1 */
  VitrailCpuList list; /* optional */
  void* listUser;
  VitrailCpuProgress progress; /* optional */
  void* progressUser;
  /* Bytes that the fragments of all tiles in work may take, at least 65536: where they need more, a tile is drawn in
   * parts and layers, for the same picture, and where it is less than 22 KiB a thread, on fewer threads. Default: 256
   * MiB, or 4 MiB a thread where that is more; tiles that need little touch little of it. Beside it a frame takes about
   * 20 bytes a vertex, 80 bytes a thread for each tile of 32 x 32 pixels, 4 to 8 bytes for each tile that a triangle
   * may touch, and 4 a triangle where what is near may hide what is behind it. */
  uint64_t memoryBudget;
} VitrailCpuFrame;

/* Draws a frame. `stats` is optional: a frame without it is faster where much is hidden, which need not be counted
 * then; the picture is the same. `exact` and `complete` are 1 for every frame that was not given up (`exact` is 0 where
 * more than 98,000 surfaces of a pixel may add light without hiding any, see below), fragmentsRequested counts the
 * transparent fragments in front of opaque surfaces (as far as they are known: those behind what is nearly opaque may
 * be left out before they are counted; layersMax and coveredPixels likewise), fragmentsMissing is 0.
 *
 * A fragment is not blended, and where that saves time not shaded, where so little light comes through what is in front
 * of it, at most 0.000106 divided by the brightest colour of the frame (see VitrailCpuDraw::brightest; at least 1),
 * that all that is left out changes the sRGB picture by at most 0.35 of 1/255, as on a GPU (vulkan_raster.h). A host
 * that shows colours with a higher exposure, or wants more of them, says a larger `brightest`: with 1000, 0.00035 of
 * 1/255 may be left out. Where surfaces send light that they need not hide for (VITRAIL_BLEND_ADDITIVE, or
 * VITRAIL_BLEND_PREMULTIPLIED with a shade function), any number of them may add up, and nothing is left out unless
 * less than 1e-30 of its light comes through. Together with rounding, errorBound tells how far a pixel may be from the
 * real-number answer.
 *
 * Errors, with the reason in the context's log: VITRAIL_ERROR_INVALID for a field that is not as described,
 * VITRAIL_ERROR_OUT_OF_MEMORY, VITRAIL_ERROR_UNSUPPORTED where a thread cannot be started, one of the host's functions
 * throws, or the draws are too many: cut into parts of up to 4,096 triangles of one draw, a frame takes 524,287. Then
 * the arrays may hold a part of the picture. */
VITRAIL_API VitrailResult vitrailCpuRender(VitrailCpuContext context, const VitrailCpuFrame* frame,
                                           const VitrailCpuDraw* draws, uint32_t drawCount, VitrailStats* stats);

/* The most bytes that fragments took in the context's last frame, of all threads together. */
VITRAIL_API uint64_t vitrailCpuFragmentBytes(VitrailCpuContext context);

#ifdef __cplusplus
}
#endif

#endif
