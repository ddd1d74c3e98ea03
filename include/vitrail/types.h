/* What all of Vitrail's headers share: node formats, blend modes, choices of a target, statistics, the log. No graphics
 * API. What depends on one says so in its name: vulkan.h has VitrailVk* and vitrailVk*.
 *
 * In every descriptor a field that is zero means its documented default. Every descriptor begins with `next`, through
 * which later versions add fields (as Vulkan's pNext does): it is null in this version, and a descriptor with anything
 * else is refused. Structures that the library fills in begin with `next` too, which it leaves as it is: set it to
 * null, or zero the structure, before the call. */
#ifndef VITRAIL_TYPES_H
#define VITRAIL_TYPES_H

#include <stdint.h>

/* Marks the functions of a shared library (VITRAIL_SHARED). A static one needs nothing. */
#if defined(VITRAIL_SHARED) && defined(_WIN32)
#define VITRAIL_API __declspec(dllexport)
#elif defined(VITRAIL_SHARED) && defined(__GNUC__)
#define VITRAIL_API __attribute__((visibility("default")))
#else
#define VITRAIL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define VITRAIL_VERSION_MAJOR 0
#define VITRAIL_VERSION_MINOR 6
#define VITRAIL_VERSION_PATCH 0
/* Versions as numbers that grow: major << 22 | minor << 12 | patch. */
#define VITRAIL_MAKE_VERSION(major, minor, patch) \
  (((uint32_t)(major) << 22) | ((uint32_t)(minor) << 12) | (uint32_t)(patch))
#define VITRAIL_VERSION VITRAIL_MAKE_VERSION(VITRAIL_VERSION_MAJOR, VITRAIL_VERSION_MINOR, VITRAIL_VERSION_PATCH)

/* The version of the library that the program runs with: VITRAIL_VERSION is that of the header it was compiled with.
 * Before 1.0 the two must have the same major and minor version. */
VITRAIL_API uint32_t vitrailVersion(void);

/* What calls without a graphics API return; those of an API return that API's own codes. */
typedef enum VitrailResult {
  VITRAIL_SUCCESS = 0,
  VITRAIL_INCOMPLETE = 1,           /* it was given up, as the host asked */
  VITRAIL_ERROR_INVALID = -1,       /* an argument is not as described */
  VITRAIL_ERROR_UNSUPPORTED = -2,   /* the device, or a feature that was not enabled, rules it out */
  VITRAIL_ERROR_FORMAT = -3,        /* a format does not go with the rest */
  VITRAIL_ERROR_OUT_OF_MEMORY = -4, /* it exceeds the budget, a limit of the device, or what is left */
  VITRAIL_ERROR_DEVICE_LOST = -5,   /* the device or its context is lost: destroy what there is of it, and begin anew */
  VITRAIL_RESULT_MAX_ENUM = 0x7fffffff
} VitrailResult;

/* ---- Log -------------------------------------------------------------------------------------------------------- */

typedef enum VitrailLogSeverity {
  /* The call could not do what it was asked for: it returns an error, or has recorded nothing of it, or less than the
   * frame needs, and then the frame is not exact. */
  VITRAIL_LOG_ERROR = 1,
  /* The call goes on, as the text says. */
  VITRAIL_LOG_WARNING = 2,
  VITRAIL_LOG_SEVERITY_MAX_ENUM = 0x7fffffff
} VitrailLogSeverity;

/* Receives one line, without a newline, that says what is wrong and what to do. Called on the thread of the call that
 * fails or is misused, before that call returns. The text is valid during the call only. */
typedef void (*VitrailLog)(VitrailLogSeverity severity, const char* message, void* user);

/* ---- What is stored --------------------------------------------------------------------------------------------- */

/* How a fragment is stored. The stored value of a fragment is what is blended; vitrailNodeErrorBound() tells how far
 * that may be from blending, in real numbers, what was handed over. In every format:
 *   - A NaN in colour or alpha is stored as 0, in depth as the value farthest from the viewer. Negative colours are
 *     stored as 0, infinite ones as the largest value of the format.
 *   - Equal depths are ordered by the rest of the node's bits, never by arrival.
 *   - A fragment that would change nothing is neither stored nor counted: with a stored alpha of 0 (premultiplied: and
 *     a stored colour of 0), or with empty coverage.
 *   - With multisampling the index of the next node shares its word with the coverage, which bounds the pool.
 *   - A target may ask for 4 bytes more a node, for a word of the host's (userWords). */
typedef enum VitrailNodeFormat {
  /* 12 bytes a node.
   *   colour    8 bits a channel on the sRGB curve (IEC 61966-2-1), decoded to linear light before it is blended,
   *             clamped to [0, 1]; the error is at most 0.5/255 on the curve. At 1 sample with
   *             VITRAIL_LIST_BUILD_COMPUTE it is rounded twice: at most 0.7/255 for red and green, 0.9/255 for blue,
   *             and none for colours that are whole steps of the curve.
   *   alpha     8 bits, linear, clamped to [0, 1]; the error is at most 0.5/255.
   *   depth     the full 32-bit float of gl_FragCoord.z, or of the depth that the shader hands over, clamped to [0, 1];
   *             no error.
   *   coverage  up to 8 samples.
   *   pool      up to 0xe0000000 nodes at 1 sample, 2^28 - 2 at 2 and 4 samples, 2^24 - 2 at 8 samples. */
  VITRAIL_NODE_STANDARD = 0,
  /* 8 bytes a node, for devices where bandwidth is scarce. Up to 4 samples.
   *   colour    on the sRGB curve, clamped to [0, 1]; 5, 6, 5 bits at 1 sample: at most 0.5/31, 0.5/63, 0.5/31 off;
   *             5 bits a channel at 2 and 4 samples.
   *   alpha     linear, clamped to [0, 1]; 6 bits at 1 sample: at most 0.5/63 off; 5 bits at 2 and 4 samples.
   *   depth     a float without sign of the distance to the far plane, n = z or 1 - z (nearest is one or zero), with a
   *             5-bit exponent: relative error of n at most 2^-12 (11-bit fraction) at 1 sample and 2^-10 (9-bit
   *             fraction) at 2 and 4 samples; n below 2^-31 becomes 0. Surfaces closer than that count as equally
   *             deep.
   *   coverage  up to 4 samples.
   *   pool      up to 2^24 - 2 nodes. */
  VITRAIL_NODE_COMPACT = 1,
  /* 16 bytes a node.
   *   colour    a 16-bit float a channel, clamped to [0, 65504]; the error is at most 2^-10 of the value, below 2^-14
   *             at most 2^-24. Surfaces brighter than 1 keep their brightness.
   *   alpha     16 bits, its square root, clamped to [0, 1]: the error is at most sqrt(alpha) / 65535. Faint surfaces
   *             keep their share: a thousandth is at most 0.05 % off.
   *   depth, coverage, pool: as VITRAIL_NODE_STANDARD. */
  VITRAIL_NODE_HDR = 2,
  VITRAIL_NODE_FORMAT_MAX_ENUM = 0x7fffffff
} VitrailNodeFormat;

/* What a fragment does to the light d behind it (linear, premultiplied), as vitrailCollect(color, blend) takes it.
 * Modes mix freely in one list. With colour rgb and alpha a:
 *   OVER           a * rgb + (1 - a) * d   Porter and Duff's over with straight alpha; the default
 *   PREMULTIPLIED  rgb + (1 - a) * d       colour already holds its alpha; rgb may exceed a (a glint on clear glass)
 *   ADDITIVE       a * rgb + d             light without a body: flames, glows. The picture's alpha is unchanged
 *   MULTIPLY       mix(1, rgb, a) * d      a colour filter. The picture's alpha is unchanged */
typedef enum VitrailBlend {
  VITRAIL_BLEND_OVER = 0,
  VITRAIL_BLEND_PREMULTIPLIED = 1,
  VITRAIL_BLEND_ADDITIVE = 2,
  VITRAIL_BLEND_MULTIPLY = 3,
  VITRAIL_BLEND_MAX_ENUM = 0x7fffffff
} VitrailBlend;

typedef enum VitrailDepthOrder {
  VITRAIL_DEPTH_NEAREST_IS_ZERO = 0, /* conventional depth: 0 at the near plane */
  VITRAIL_DEPTH_NEAREST_IS_ONE = 1,  /* reversed depth: 1 at the near plane */
  VITRAIL_DEPTH_ORDER_MAX_ENUM = 0x7fffffff
} VitrailDepthOrder;

/* One fragment of a pixel as it was stored, as lists are copied out: 32 bytes. */
typedef struct VitrailLayer {
  float color[4];    /* linear r, g, b and alpha, straight (VITRAIL_BLEND_PREMULTIPLIED: as handed over) */
  float depth;       /* as handed over, within the format's error */
  uint32_t blend;    /* VitrailBlend */
  uint32_t coverage; /* a bit a sample; 1 at 1 sample */
  uint32_t word;     /* the host's; 0 where the target keeps none */
} VitrailLayer;

/* ---- Choices of a target ---------------------------------------------------------------------------------------- */

/* Where the resolve runs. */
typedef enum VitrailResolve {
  /* What the API's default says for the target's fields when it is made (vitrailVkDefaultResolve); the target tells
   * which was taken (vitrailVkTargetResolve). It decides whether the resolve is recorded inside a rendering scope. */
  VITRAIL_RESOLVE_DEFAULT = 0,
  /* Compute shaders write the target's colour views, storage images. With samples > 1 they read the multisampled
   * opaque views and write the box-filtered picture (per pixel). */
  VITRAIL_RESOLVE_COMPUTE = 1,
  /* A full-screen triangle in the host's own rendering scope, blended by fixed function (premultiplied) over what is
   * there. Exact for lists with VITRAIL_BLEND_MULTIPLY only with dual-source blending; without it, pixels whose
   * transmittance differs between channels are blended with its mean and counted in approximatePixels. */
  VITRAIL_RESOLVE_FRAGMENT = 2,
  /* The host's own shaders, which walk the lists (shaders/vitrail/list.glsl with VITRAIL_SORTED_LISTS) and draw what
   * they make of them: light that is absorbed between two surfaces, say. The library collects, sorts and counts, and
   * writes no picture. What the library's own resolve would do is the host's: maxLayers is 0, and of a frame that
   * overflowed nothing is summed. */
  VITRAIL_RESOLVE_HOST = 3,
  VITRAIL_RESOLVE_MAX_ENUM = 0x7fffffff
} VitrailResolve;

/* Who builds the lists: puts a fragment on the list of its pixel. Lists, memory and everything else hold for both; so
 * does the picture, but for the colours of VITRAIL_NODE_STANDARD at 1 sample, see there. Fixed when a target is made.
 * docs/resolve.md tells how both work. */
typedef enum VitrailListBuild {
  /* What the API's default says for the target's fields when it is made (vitrailVkDefaultListBuild); the target tells
   * which was taken. */
  VITRAIL_LIST_BUILD_DEFAULT = 0,
  /* The fragment shader, as it collects (Yang et al.). */
  VITRAIL_LIST_BUILD_FRAGMENT = 1,
  /* A compute pass after the draws, which vitrailVkCmdCollected() records: the fragment shader leaves loose nodes, each
   * with the number of its pixel, and in VITRAIL_NODE_STANDARD at 1 sample also leaves it to that pass to encode the
   * colour. It takes less of fragment shaders, and each node is read and written once more. For GPUs that run fragment
   * shaders on few of their cores (docs/performance.md). Areas (areaPixels) of up to
   * VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS. */
  VITRAIL_LIST_BUILD_COMPUTE = 2,
  VITRAIL_LIST_BUILD_MAX_ENUM = 0x7fffffff
} VitrailListBuild;

/* The most pixels of an area with VITRAIL_LIST_BUILD_COMPUTE: 4096 x 4096. Tile plans make no larger tiles. */
#define VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS 0x1000000

/* What the resolve writes where the collect pass has several samples. Each sample blends its own fragments, those that
 * cover it, over its own opaque colour. */
typedef enum VitrailMsaaResolve {
  /* One colour a pixel: the mean of its samples, the same as per sample followed by a box filter. Every pixel of the
   * area is written, whether or not it has fragments. The fragment resolve draws into a single-sample scope. */
  VITRAIL_MSAA_RESOLVE_PER_PIXEL = 0,
  /* A multisampled scope of the host's, blended sample by sample. VITRAIL_RESOLVE_FRAGMENT only. */
  VITRAIL_MSAA_RESOLVE_PER_SAMPLE = 1,
  VITRAIL_MSAA_RESOLVE_MAX_ENUM = 0x7fffffff
} VitrailMsaaResolve;

/* What becomes of a frame that has more fragments than the pool has nodes. */
typedef enum VitrailOverflow {
  /* The frame is blended approximately, from sums over all its fragments that do not depend on their order: identical
   * frames give identical pictures. Exact for pixels with one layer of VITRAIL_BLEND_OVER that covers all of the pixel,
   * with colour times alpha up to 16; up to 2^-13 of the colour. In sums brighter colours count as 16, and a pixel's
   * sums hold 4,095 fragments as bright as that, 43,690 that are not brighter than 1. Takes 20 bytes a pixel. The sums
   * are those of the weighted average of Bavoil and Myers (2008). */
  VITRAIL_OVERFLOW_APPROXIMATE = 0,
  /* The frame is not resolved: the images keep the opaque scene (resolved per pixel from several samples: what was in
   * them), so that it can be drawn again with a larger pool or in tiles. Takes no memory. */
  VITRAIL_OVERFLOW_SKIP = 1,
  VITRAIL_OVERFLOW_MAX_ENUM = 0x7fffffff
} VitrailOverflow;

/* The most images of a kind that one target takes (a swapchain's worth). */
#define VITRAIL_MAX_VIEWS 8
/* The most frames that may be in flight. */
#define VITRAIL_MAX_FRAMES_IN_FLIGHT 8

/* ---- Memory and statistics -------------------------------------------------------------------------------------- */

/* Bytes that a pool of nodeCapacity nodes takes in a format; 0 where that is none. With a word of the host's in each
 * node (userWords) it is 4 bytes a node more. */
VITRAIL_API uint64_t vitrailNodePoolSize(VitrailNodeFormat format, uint32_t nodeCapacity);

/* How far a pixel may be from the real-number answer, all fragments blended in depth order, in steps of an 8-bit
 * picture (1/255 on the sRGB curve, the rounding to such a picture included), with at most so many `layers` and colours
 * up to 1:
 *   - HDR: 0.56 + 0.007 * sqrt(layers), which is at most 1 up to 3,900 layers: a complete frame is exact
 * (VitrailStats).
 *   - STANDARD: 1 + 255 * srgb(min(1, layers * 0.5/255)). A surface as faint as half a step of alpha is lost, which
 * shows where it is bright before darkness. Of common pictures few pixels are off by more than 2.
 *   - COMPACT: likewise, with its coarser steps of colour and alpha.
 * Fragments that are rounded to nothing are among the `layers` here, and not among VitrailStats::layersMax: with the
 * last two formats a frame is never exact, and its bound is for fragments of at least half a step of alpha. 255 for a
 * format that there is not. Derived in docs/resolve.md. */
VITRAIL_API float vitrailNodeErrorBound(VitrailNodeFormat format, uint32_t samples, uint32_t layers);

/* What a target takes, in bytes. */
typedef struct VitrailMemory {
  void* next; /* null */
  uint32_t nodeCapacity;
  uint64_t nodeBytes; /* the node pool */
  uint64_t headBytes; /* 4 bytes a pixel of the area */
  /* Lists of deep pixels, sums for overflow, room to copy lists, counters, parameters, statistics. */
  uint64_t otherBytes;
  uint64_t retiredBytes; /* memory that was replaced and that frames in flight still use */
  uint64_t totalBytes;   /* all of these, the host's own buffer included */
} VitrailMemory;

/* What the GPU reports of a frame. */
typedef struct VitrailStats {
  void* next; /* null */
  uint64_t frame;
  uint32_t exact;              /* 1: complete, and each pixel is within 1/255 of the real-number answer (errorBound) */
  uint32_t complete;           /* 1: every fragment of the frame was blended, in order; 0: see below */
  float errorBound;            /* vitrailNodeErrorBound() of the target's format and layersMax */
  uint32_t misused;            /* 1: calls were left out, or recorded wrongly (see the log): never complete */
  uint64_t fragmentsRequested; /* fragments that reached vitrailCollect() and would change the picture */
  uint64_t fragmentsStored;    /* of those, the ones that had a node */
  uint64_t fragmentsMissing;   /* requested - stored: the pool was full, or their shader does not suit the target */
  uint32_t nodeCapacity;       /* of the pool that the frame used */
  /* Of an overflowed frame the next three are counted only where a compute resolve blends it; else they are 0. */
  uint32_t layersMax;     /* stored fragments of the deepest pixel: the depth complexity if the frame is complete */
  uint32_t coveredPixels; /* pixels with at least one stored fragment; stored / covered is the mean depth */
  /* Pixels that were blended approximately: more than maxLayers fragments, or VITRAIL_BLEND_MULTIPLY in a fragment
   * resolve without dual-source blending (a resolve per sample counts samples). */
  uint32_t approximatePixels;
  /* Pixels (a resolve per sample counts samples) that the driver did not let the resolve finish. Always 0 on a GPU.
   * Mesa's CPU driver ends a shader's loops after 65,535 turns in total, which is enough for lists of 15,000
   * fragments, through OpenGL for lists of 14,000. */
  uint32_t cutPixels;
} VitrailStats;

/* Whole pixels, from the top left corner of a picture. */
typedef struct VitrailRect {
  uint32_t x;
  uint32_t y;
  uint32_t width;
  uint32_t height;
} VitrailRect;

#ifdef __cplusplus
}
#endif

#endif
