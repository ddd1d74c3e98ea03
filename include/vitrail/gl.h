/* Vitrail for OpenGL 4.3 (core profile) and later: exact order-independent transparency with per-pixel linked lists.
 *
 * The same method, calls and results as vitrail/vulkan.h, which says more about each: a frame has a collect pass, in
 * which the host draws its transparent geometry once, in any order, with fragment shaders that end in vitrailCollect(),
 * and a resolve pass, in which the library sorts every list by depth and blends it over the opaque colour.
 *
 *   vitrailGlCreateContext   once per OpenGL context, or per group of contexts that share objects
 *   vitrailGlCreateTarget    once per view: size, samples, node format, memory, textures
 *   per frame:
 *     vitrailGlUpdateTarget    lets the pool follow the frame's needs (only with a memory budget)
 *     (host)  opaque geometry into colour and depth
 *     vitrailGlBegin           empties the lists
 *     vitrailGlBind            binds the lists for the host's shaders
 *     (host)  draws the transparent geometry with depth test on, depth writes off, no culling, no sample shading
 *     vitrailGlCollected       makes the lists visible to the resolve
 *     vitrailGlResolve         sorts, blends. VITRAIL_RESOLVE_FRAGMENT: into the draw framebuffer that is bound
 *     vitrailGlEnd             leaves the statistics for vitrailGlReadStats
 *   vitrailGlReadStats       later: what the frame held, and whether it was exact
 *
 * Shaders: OpenGL has no #include. vitrailGlCollectSource() is the text of shaders/vitrail/collect.glsl with all that
 * it includes, which the host hands to glShaderSource() between its #version line and its own text.
 *
 * Current context: every call but those that only read fields of a target needs the context that the library's context
 * was made with, or one that shares objects with it, to be current on the calling thread. Between contexts OpenGL's
 * rules hold: what one has written is seen by another after glFinish() or a fence, and where the other binds it anew.
 * A target is used by one thread at a time, in one context in a frame.
 *
 * State: what a call changes of the context's state it puts back, but for vitrailGlBind(), whose purpose is a change. A
 * program that was deleted while it was current is gone when a call takes its place, as OpenGL has it: then none is.
 * docs/integration.md lists what is touched. Conditional rendering, transform feedback and queries of samples or
 * primitives are not active during calls. Error flags: creating calls read them (glGetError) and so clear what the host
 * left there, with a line in the log; other calls do not.
 *
 * Rows: pixels count from the lower left corner, as gl_FragCoord does, in areas, copies and lists alike.
 *
 * Barriers: the calls make those between the library's passes, and one behind a resolve by compute for whatever the
 * host does with the texture next. With hostBarriers those between calls, and that one,
 * are the host's.
 *
 * Lost contexts (GL_CONTEXT_LOST): calls of a frame do nothing, as OpenGL's own. Calls that return a VitrailResult say
 * VITRAIL_ERROR_DEVICE_LOST where they need OpenGL: creating, resizing, a pool that is to change, and statistics that
 * were not read before and so will never be there, so that no host waits for them for ever. A frame that was lost is
 * never `complete`. No call waits. Destroying calls free what the library has of its own, and OpenGL's objects go with
 * the context. glGetGraphicsResetStatus() stays the host's: the library does not call it.
 *
 * Out of order, null: as in vulkan.h. Calls that return a VitrailResult return VITRAIL_ERROR_INVALID where a required
 * pointer is null.
 *
 * This header needs no OpenGL header: names of objects are uint32_t as GLuint is. */
#ifndef VITRAIL_GL_H
#define VITRAIL_GL_H

#include <vitrail/tiles.h>
#include <vitrail/types.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct VitrailGlContext_T* VitrailGlContext;
typedef struct VitrailGlTarget_T* VitrailGlTarget;

/* ---- Context ---------------------------------------------------------------------------------------------------- */

/* As eglGetProcAddress(), glXGetProcAddress() and glfwGetProcAddress() are, and as `user` completes it: null for a
 * function that there is not. */
typedef void* (*VitrailGlGetProcAddress)(const char* name, void* user);

typedef struct VitrailGlContextDesc {
  const void* next;                       /* null */
  VitrailGlGetProcAddress getProcAddress; /* required: the library has no loader of its own */
  void* loaderUser;
  /* The first of the five binding points (VITRAIL_GL_BINDINGS) of vitrailGlBind(): uniform buffer bindingBase, shader
   * storage buffers bindingBase + 1 to + 4. Shaders define VITRAIL_BINDING_BASE alike, which takes GLSL 4.40 or
   * GL_ARB_enhanced_layouts where it is not 0. */
  uint32_t bindingBase;
  VitrailLog log; /* optional; default: silence; outlives the context and its targets */
  void* logUser;
} VitrailGlContextDesc;

#define VITRAIL_GL_BINDINGS 5

/* Builds what the targets share. Errors: VITRAIL_ERROR_INVALID for a missing field, VITRAIL_ERROR_UNSUPPORTED where no
 * context is current, it is older than OpenGL 4.3, or it lacks what the library needs, VITRAIL_ERROR_DEVICE_LOST where
 * it is lost. On error *context is null. */
VITRAIL_API VitrailResult vitrailGlCreateContext(const VitrailGlContextDesc* desc, VitrailGlContext* context);

/* Destroys the context. Its targets are destroyed before; where some are left the log says so, and the context is freed
 * with the last of them. Null is ignored. */
VITRAIL_API void vitrailGlDestroyContext(VitrailGlContext context);

/* ---- What the host's shaders need ------------------------------------------------------------------------------- */

/* The text of shaders/vitrail/collect.glsl, and of shaders/vitrail/list.glsl, with all that they include: GLSL 4.30. It
 * follows the host's #version line, its #extension lines and what it defines of the names that collect.glsl describes
 * (VITRAIL_POST_DEPTH_COVERAGE where GL_ARB_post_depth_coverage is there, VITRAIL_CPU_DRIVER, VITRAIL_ONLY_*), and
 * precedes everything else; VITRAIL_OPENGL it defines itself, VITRAIL_SET is not needed. The line after it is line 1 to
 * the compiler. Owned by the context. */
VITRAIL_API const char* vitrailGlCollectSource(VitrailGlContext context);
VITRAIL_API const char* vitrailGlListSource(VitrailGlContext context);

/* ---- Target ----------------------------------------------------------------------------------------------------- */

/* The textures that a resolve reads and writes: the host's, at least as large as the target, and there as long as the
 * target uses them. */
typedef struct VitrailGlTextures {
  uint32_t count; /* of each array below that is not null, 1 to VITRAIL_MAX_VIEWS; 0 where all are null */
  /* VITRAIL_RESOLVE_COMPUTE: what level 0 of it gets; required. GL_TEXTURE_2D, complete. With samples == 1 it holds the
   * opaque colour. */
  const uint32_t* color;
  /* samples > 1, per pixel: the multisampled opaque colour, GL_TEXTURE_2D_MULTISAMPLE; required. */
  const uint32_t* opaque;
  /* samples > 1 without postDepthCoverage: the multisampled opaque depth, GL_TEXTURE_2D_MULTISAMPLE of a depth format,
   * or of a depth and stencil format with GL_DEPTH_STENCIL_TEXTURE_MODE at GL_DEPTH_COMPONENT; required. */
  const uint32_t* depth;
} VitrailGlTextures;

/* Fields as in VitrailVkTargetDesc where nothing else is said. */
typedef struct VitrailGlTargetDesc {
  const void* next; /* null */
  uint32_t width;   /* pixels; required */
  uint32_t height;
  uint32_t samples; /* of the framebuffer that fragments are collected in: 1, 2, 4 or 8; default 1 */
  VitrailNodeFormat nodeFormat;
  VitrailDepthOrder depthOrder; /* of the depth in the depth buffer, which is gl_FragCoord.z */
  VitrailResolve resolve;
  VitrailMsaaResolve msaaResolve;
  uint32_t postDepthCoverage; /* 1: shaders define VITRAIL_POST_DEPTH_COVERAGE (GL_ARB_post_depth_coverage) */
  uint32_t maxLayers;         /* with VITRAIL_RESOLVE_COMPUTE on a GPU at most 16 in this version */
  VitrailOverflow overflow;
  VitrailListBuild listBuild;
  uint32_t userWords; /* 1: nodes carry a word of the host's */

  uint32_t nodeCapacity; /* or memoryBudget: one of them is required */
  uint64_t memoryBudget;
  uint32_t areaPixels;
  uint32_t copyLayers;
  /* Optional: the host's own buffer object, with immutable or other storage of at least bufferOffset + bufferSize bytes
   * (vitrailGlTargetRequirements). No flag of glBufferStorage() is needed. */
  uint32_t buffer;
  uint64_t bufferOffset;
  uint64_t bufferSize;

  uint32_t colorFormat; /* VITRAIL_RESOLVE_COMPUTE: of textures.color, GL_RGBA16F (default) or GL_RGBA32F */
  VitrailGlTextures textures;
  /* VITRAIL_RESOLVE_FRAGMENT: the draw framebuffer that is bound in vitrailGlResolve() is not layered, has the target's
   * samples (per pixel: one) and one draw buffer of a format that can be blended. 1: it has several draw buffers, of
   * which the first is written and the host masks the others; then pixels whose surfaces multiply are approximate, as
   * where Vulkan lacks dualSrcBlend. */
  uint32_t severalDrawBuffers;
  /* VITRAIL_RESOLVE_FRAGMENT: as VitrailVkScope::stencilMark. The host's collecting draws have glStencilFunc(GL_ALWAYS,
   * 0, 0xff), glStencilOp(GL_KEEP, GL_KEEP, GL_INCR), for both faces. */
  uint32_t stencilMark;
  uint32_t stencilMask; /* default 0xff */

  uint32_t hostBarriers; /* 1: the barriers between the calls are the host's, as vitrailGlBarriers() says */
  /* Frames whose statistics can be read; at most VITRAIL_MAX_FRAMES_IN_FLIGHT; default 2. OpenGL itself keeps memory
   * that frames in flight use. */
  uint32_t framesInFlight;
  const char* debugName; /* prefix of the objects' labels; default "vitrail" */
} VitrailGlTargetDesc;

VITRAIL_API VitrailResolve vitrailGlDefaultResolve(VitrailGlContext context, const VitrailGlTargetDesc* desc);
VITRAIL_API VitrailListBuild vitrailGlDefaultListBuild(VitrailGlContext context, const VitrailGlTargetDesc* desc);

/* What a buffer of the host's must be to serve as a target's memory. */
typedef struct VitrailGlRequirements {
  void* next;         /* null */
  uint64_t size;      /* bytes from bufferOffset on */
  uint64_t alignment; /* of bufferOffset */
} VitrailGlRequirements;

VITRAIL_API VitrailResult vitrailGlTargetRequirements(VitrailGlContext context, const VitrailGlTargetDesc* desc,
                                                      VitrailGlRequirements* requirements);

/* Makes the memory of one view; the first target of its kind also compiles its resolve programs. Errors:
 * VITRAIL_ERROR_INVALID for a field that is not as described, VITRAIL_ERROR_FORMAT, VITRAIL_ERROR_UNSUPPORTED for
 * samples or a program that the driver refuses, VITRAIL_ERROR_OUT_OF_MEMORY, VITRAIL_ERROR_DEVICE_LOST; the log says
 * which and by how much. On error *target is null. */
VITRAIL_API VitrailResult vitrailGlCreateTarget(VitrailGlContext context, const VitrailGlTargetDesc* desc,
                                                VitrailGlTarget* target);

/* Destroys the target. Null is ignored. */
VITRAIL_API void vitrailGlDestroyTarget(VitrailGlTarget target);

VITRAIL_API VitrailResolve vitrailGlTargetResolve(VitrailGlTarget target);
VITRAIL_API VitrailListBuild vitrailGlTargetListBuild(VitrailGlTarget target);

/* The most nodes that one pool can have at that sample count; see vitrailVkMaxNodeCapacity(). */
VITRAIL_API uint32_t vitrailGlMaxNodeCapacity(VitrailGlContext context, VitrailNodeFormat format, uint32_t samples);

VITRAIL_API void vitrailGlTargetMemory(VitrailGlTarget target, VitrailMemory* memory);

/* Prepares a target with a memory budget for `frame` (0: the next one): reads the statistics of the newest frame that
 * has finished, and makes a larger or smaller pool where the need has changed. Never waits. Errors:
 * VITRAIL_ERROR_OUT_OF_MEMORY; the target stays as it was and can be used. VITRAIL_ERROR_DEVICE_LOST. */
VITRAIL_API VitrailResult vitrailGlUpdateTarget(VitrailGlTarget target, uint64_t frame);

typedef struct VitrailGlResizeInfo {
  const void* next; /* null */
  uint32_t width;   /* required */
  uint32_t height;
  uint32_t nodeCapacity; /* as in VitrailVkResizeInfo */
  uint32_t areaPixels;
  VitrailGlTextures textures;
} VitrailGlResizeInfo;

/* Gives the target another size and other textures from the next frame on. Errors: as vitrailGlCreateTarget; the target
 * stays as it was. */
VITRAIL_API VitrailResult vitrailGlResizeTarget(VitrailGlTarget target, const VitrailGlResizeInfo* info);

/* Lines that the host's collecting shaders may have before vitrailGlCollectSource(), "#define VITRAIL_ONLY_..." each:
 * the shader is for targets like this one only, and smaller. As vitrailVkCollectSpecialization(). */
typedef struct VitrailGlSpecialization {
  char defines[256];
} VitrailGlSpecialization;

VITRAIL_API void vitrailGlCollectSpecialization(VitrailGlContext context, const VitrailGlTargetDesc* desc,
                                                VitrailGlSpecialization* specialization);

/* ---- Frame ------------------------------------------------------------------------------------------------------ */

typedef struct VitrailGlBeginInfo {
  const void* next; /* null */
  uint64_t frame;   /* as in VitrailVkBeginInfo */
  VitrailRect area; /* the pixels that are collected and resolved; an extent of 0: all */
} VitrailGlBeginInfo;

/* Starts a frame: empties the lists and the counters. `info` may be null (the next frame, everything). */
VITRAIL_API void vitrailGlBegin(VitrailGlTarget target, const VitrailGlBeginInfo* info);

/* Binds what vitrailCollect() and shaders that walk lists need, to the binding points of bindingBase on, where it
 * stays: uniform buffer bindingBase, shader storage buffers bindingBase + 1 to + 4, and with them the generic bindings
 * GL_UNIFORM_BUFFER and GL_SHADER_STORAGE_BUFFER. Any number of times between vitrailGlBegin() and vitrailGlEnd(). */
VITRAIL_API void vitrailGlBind(VitrailGlTarget target);

/* The number of the frame that was begun last; 0 before the first. */
VITRAIL_API uint64_t vitrailGlTargetFrame(VitrailGlTarget target);

/* Ends the collect pass; builds or sorts lists where the target's choices ask for it. */
VITRAIL_API void vitrailGlCollected(VitrailGlTarget target);

typedef struct VitrailGlResolveInfo {
  const void* next; /* null */
  uint32_t view;    /* which of the target's textures to use */
} VitrailGlResolveInfo;

/* Sorts every list and blends it over the opaque scene, as vitrailVkCmdResolve(). VITRAIL_RESOLVE_FRAGMENT draws into
 * the draw framebuffer, in the area of the frame; values are linear light, and GL_FRAMEBUFFER_SRGB is the host's. */
VITRAIL_API void vitrailGlResolve(VitrailGlTarget target, const VitrailGlResolveInfo* info);

/* Ends the frame: its counters go to where vitrailGlReadStats() finds them. */
VITRAIL_API void vitrailGlEnd(VitrailGlTarget target);

/* ---- Reading lists ---------------------------------------------------------------------------------------------- */

/* Shaders of the host's walk lists where they lie, after vitrailGlCollected(): vitrailGlListSource(), with
 * vitrailGlBind(). A walk after a resolve by compute or a copy needs glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT)
 * only with hostBarriers. The host's memory gets the lists, sorted, by a call: */
typedef struct VitrailGlCopyInfo {
  const void* next; /* null */
  VitrailRect area; /* inside the frame's area, at least one pixel */
  uint32_t buffer;  /* required; a buffer object */
  uint64_t offset;  /* a multiple of 4 */
  uint64_t size;    /* bytes of the buffer from offset on; required, at least vitrailGlCopySize() */
} VitrailGlCopyInfo;

/* What such a copy begins with. Behind it are one VitrailGlCopiedList a pixel, row by row, and then the layers of all
 * pixels, VitrailLayer each, of one pixel front to back; pixels lie in any order. */
typedef struct VitrailGlCopyHeader {
  uint32_t layers;   /* that the pixels have; where that is more than `capacity` some lists are missing */
  uint32_t capacity; /* VitrailGlTargetDesc::copyLayers */
  VitrailRect area;
  uint32_t reserved[2];
} VitrailGlCopyHeader;

typedef struct VitrailGlCopiedList {
  uint32_t first; /* of the layers; 0xffffffff where the list was left out, as in VitrailVkCopiedList */
  uint32_t count; /* of the layers that the pixel has */
} VitrailGlCopiedList;

/* Bytes from VitrailGlCopyInfo::offset on that a copy of so many pixels writes; 0 for a null target. */
VITRAIL_API uint64_t vitrailGlCopySize(VitrailGlTarget target, uint32_t width, uint32_t height);
VITRAIL_API void vitrailGlCopyLists(VitrailGlTarget target, const VitrailGlCopyInfo* info);

/* ---- Barriers --------------------------------------------------------------------------------------------------- */

/* Between which calls a target with hostBarriers leaves the barriers to the host. */
typedef enum VitrailGlBarrierPoint {
  VITRAIL_GL_BARRIER_BEGIN = 0,     /* before vitrailGlBegin: the previous frame -> the clears */
  VITRAIL_GL_BARRIER_COLLECT = 1,   /* before the draws that collect */
  VITRAIL_GL_BARRIER_COLLECTED = 2, /* before vitrailGlCollected: vitrailCollect() -> building and sorting lists */
  VITRAIL_GL_BARRIER_RESOLVE = 3,   /* before vitrailGlResolve: the lists -> the resolve */
  VITRAIL_GL_BARRIER_END = 4,       /* before vitrailGlEnd: the resolve -> the copy of the counters */
  VITRAIL_GL_BARRIER_POINT_MAX_ENUM = 0x7fffffff
} VitrailGlBarrierPoint;

/* The bits for glMemoryBarrier() at a point; 0 where nothing is to be waited for. */
VITRAIL_API uint32_t vitrailGlBarriers(VitrailGlTarget target, VitrailGlBarrierPoint point);

/* ---- Statistics and tiles --------------------------------------------------------------------------------------- */

/* Reads what the GPU reported about a frame, as vitrailVkReadStats(): VITRAIL_INCOMPLETE until it has executed, and
 * once it is more than framesInFlight frames old. VITRAIL_ERROR_DEVICE_LOST in place of that once the context is lost.
 * Never waits. */
VITRAIL_API VitrailResult vitrailGlReadStats(VitrailGlTarget target, uint64_t frame, VitrailStats* stats);

/* What the device can hold, for VitrailTilePlanDesc::limits (tiles.h). */
VITRAIL_API VitrailResult vitrailGlTileLimits(VitrailGlContext context, VitrailNodeFormat format, uint32_t samples,
                                              VitrailTileLimits* limits);

/* As vitrailVkTilePlanTarget(). */
VITRAIL_API void vitrailGlTilePlanTarget(VitrailTilePlan plan, VitrailGlTargetDesc* desc);

#ifdef __cplusplus
}
#endif

#endif
