/* Vitrail for Direct3D 11 (feature level 11_0 and later): exact order-independent transparency with per-pixel linked
 * lists.
 *
 * The same method, calls and results as vitrail/vulkan.h, which says more about each: a frame has a collect pass, in
 * which the host draws its transparent geometry once, in any order, with pixel shaders that end in vitrailCollect(),
 * and a resolve pass, in which the library sorts every list by depth and blends it over the opaque colour.
 *
 *   vitrailD3d11CreateContext   once per device
 *   vitrailD3d11CreateTarget    once per view: size, samples, node format, memory, textures
 *   per frame, on any device context:
 *     vitrailD3d11UpdateTarget    lets the pool follow the frame's needs (only with a memory budget)
 *     (host)  opaque geometry into colour and depth
 *     vitrailD3d11Begin           empties the lists
 *     (host)  sets the render targets
 *     vitrailD3d11Bind            binds the lists beside them for the host's pixel shaders
 *     (host)  draws the transparent geometry with depth test on, depth writes off, no culling
 *     vitrailD3d11Collected       unbinds them, and makes the lists ready for the resolve
 *     vitrailD3d11Resolve         sorts, blends. VITRAIL_RESOLVE_FRAGMENT: into the render target that is set
 *     vitrailD3d11End             leaves the statistics for vitrailD3d11ReadStats
 *   vitrailD3d11ReadStats       later: what the frame held, and whether it was exact
 *
 * Shaders include shaders/vitrail/collect.hlsl, or list.hlsl to walk lists.
 *
 * Contexts: `commands` is the immediate context or a deferred one. Where it is a deferred one, its command list is
 * executed before the next frame of the target is recorded elsewhere, and in the order of recording. Calls that take no
 * context use the device alone, but for vitrailD3d11UpdateTarget() and vitrailD3d11ReadStats(), which read statistics
 * through the immediate context: they are called where that may be used. A target is used by one thread at a time.
 *
 * State: what a call changes of a context it puts back, but for vitrailD3d11Bind(), vitrailD3d11BindLists() and, of the
 * unordered access views behind the render targets, vitrailD3d11Collected(), whose purpose is a change. Stream output
 * is left alone: no buffers are set for it during calls.
 *
 * Rows: pixels count from the upper left corner, as SV_Position does.
 *
 * Barriers: Direct3D 11 has none. Removed devices: calls do nothing that can be seen; objects are released as ever.
 *
 * Out of order, null: as in vulkan.h. Calls that return a VitrailResult return VITRAIL_ERROR_INVALID where a required
 * pointer is null. A null `commands` is out of order, too.
 *
 * This header needs no other: interfaces are declared only. */
#ifndef VITRAIL_D3D11_H
#define VITRAIL_D3D11_H

#include <vitrail/tiles.h>
#include <vitrail/types.h>

#ifdef __cplusplus
struct ID3D11Buffer;
struct ID3D11Device;
struct ID3D11DeviceContext;
struct ID3D11ShaderResourceView;
struct ID3D11UnorderedAccessView;
extern "C" {
#else
typedef struct ID3D11Buffer ID3D11Buffer;
typedef struct ID3D11Device ID3D11Device;
typedef struct ID3D11DeviceContext ID3D11DeviceContext;
typedef struct ID3D11ShaderResourceView ID3D11ShaderResourceView;
typedef struct ID3D11UnorderedAccessView ID3D11UnorderedAccessView;
#endif

typedef struct VitrailD3d11Context_T* VitrailD3d11Context;
typedef struct VitrailD3d11Target_T* VitrailD3d11Target;

/* ---- Context ---------------------------------------------------------------------------------------------------- */

typedef struct VitrailD3d11ContextDesc {
  const void* next;     /* null */
  ID3D11Device* device; /* required; the context holds a reference */
  /* Where vitrailD3d11Bind() binds, and shaders have their registers (collect.hlsl): the constant buffer slot; default
   * (0) 13, b13. */
  uint32_t constantSlot;
  /* The first of four slots of unordered access views in a row; default (0) 1, u1 to u4. Not less than the render
   * targets that are set beside. Feature level 11_0 has 8 slots, 11_1 has 64. */
  uint32_t uavSlot;
  /* The first of three slots of shader resource views in a row, for vitrailD3d11BindLists(); default (0) 120. */
  uint32_t listSlot;
  VitrailLog log; /* optional; default: silence; outlives the context and its targets */
  void* logUser;
} VitrailD3d11ContextDesc;

/* Errors: VITRAIL_ERROR_INVALID for a missing field or a slot that there is not, VITRAIL_ERROR_UNSUPPORTED below
 * feature level 11_0. On error *context is null. */
VITRAIL_API VitrailResult vitrailD3d11CreateContext(const VitrailD3d11ContextDesc* desc, VitrailD3d11Context* context);

/* Destroys the context. Its targets are destroyed before; where some are left the log says so, and the context is freed
 * with the last of them. Null is ignored. */
VITRAIL_API void vitrailD3d11DestroyContext(VitrailD3d11Context context);

/* ---- Target ----------------------------------------------------------------------------------------------------- */

/* The textures that a resolve reads and writes: the host's, at least as large as the target, and there as long as the
 * target uses them. During a resolve they are not bound elsewhere but as said. */
typedef struct VitrailD3d11Views {
  uint32_t count; /* of each array below that is not null, 1 to VITRAIL_MAX_VIEWS; 0 where all are null */
  /* VITRAIL_RESOLVE_COMPUTE: what is written; required. Views of level 0 of a 2D texture, in colorFormat, which is the
   * texture's format, too. With samples == 1 it holds the opaque colour, which a resolve copies to a texture of the
   * library's first: few devices read what they write. */
  ID3D11UnorderedAccessView* const* color;
  /* samples > 1, per pixel: the multisampled opaque colour; required. */
  ID3D11ShaderResourceView* const* opaque;
  /* samples > 1: the multisampled opaque depth; required. Where it is set as depth-stencil view during a resolve by
   * VITRAIL_RESOLVE_FRAGMENT, that view is read-only (D3D11_DSV_READ_ONLY_DEPTH). */
  ID3D11ShaderResourceView* const* depth;
} VitrailD3d11Views;

/* The buffers of a target, for hosts that bring the memory. */
typedef enum VitrailD3d11BufferKind {
  VITRAIL_D3D11_BUFFER_CONTROL = 0,
  VITRAIL_D3D11_BUFFER_HEADS = 1,
  VITRAIL_D3D11_BUFFER_NODES = 2,
  VITRAIL_D3D11_BUFFER_SUMS = 3,
  VITRAIL_D3D11_BUFFER_MEDIUM_LISTS = 4,
  VITRAIL_D3D11_BUFFER_LONG_LISTS = 5,
  VITRAIL_D3D11_BUFFER_COPY = 6,
  VITRAIL_D3D11_BUFFER_KIND_MAX_ENUM = 0x7fffffff
} VitrailD3d11BufferKind;
#define VITRAIL_D3D11_BUFFERS 7

/* Fields as in VitrailVkTargetDesc where nothing else is said. */
typedef struct VitrailD3d11TargetDesc {
  const void* next; /* null */
  uint32_t width;   /* pixels; required */
  uint32_t height;
  uint32_t samples; /* of the depth-stencil view, or render target, that fragments are collected with: 1, 2, 4 or 8;
                       default 1 */
  VitrailNodeFormat nodeFormat;
  VitrailDepthOrder depthOrder; /* of SV_Position.z */
  VitrailResolve resolve;
  VitrailMsaaResolve msaaResolve;
  uint32_t maxLayers;
  VitrailOverflow overflow;
  VitrailListBuild listBuild;
  uint32_t userWords; /* 1: nodes carry a word of the host's */

  uint32_t nodeCapacity; /* or memoryBudget: one of them is required */
  uint64_t memoryBudget;
  uint32_t areaPixels;
  uint32_t copyLayers;
  /* Optional: VITRAIL_D3D11_BUFFERS of the host's own, by VitrailD3d11BufferKind, as vitrailD3d11TargetRequirements()
   * says. Null: the library makes them. */
  ID3D11Buffer* const* buffers;

  uint32_t colorFormat; /* VITRAIL_RESOLVE_COMPUTE: DXGI_FORMAT_R16G16B16A16_FLOAT (default) or R32G32B32A32_FLOAT */
  VitrailD3d11Views views;
  /* VITRAIL_RESOLVE_FRAGMENT: the first render target that is set in vitrailD3d11Resolve() has the target's samples
   * (per pixel: one), is no array, and has a format that can be blended; others are not written. 1: there are others, 6
   * at most; then pixels whose surfaces multiply are approximate, as where Vulkan lacks dualSrcBlend. */
  uint32_t severalRenderTargets;
  /* VITRAIL_RESOLVE_FRAGMENT: as VitrailVkScope::stencilMark. The host's collecting draws have
   * D3D11_STENCIL_OP_INCR_SAT and D3D11_COMPARISON_ALWAYS for both faces. */
  uint32_t stencilMark;
  uint32_t stencilMask; /* default 0xff */

  uint32_t framesInFlight; /* frames whose statistics can be read; at most VITRAIL_MAX_FRAMES_IN_FLIGHT; default 2 */
  const char* debugName;   /* prefix of the objects' names (WKPDID_D3DDebugObjectName); default "vitrail" */
} VitrailD3d11TargetDesc;

VITRAIL_API VitrailResolve vitrailD3d11DefaultResolve(VitrailD3d11Context context, const VitrailD3d11TargetDesc* desc);
VITRAIL_API VitrailListBuild vitrailD3d11DefaultListBuild(VitrailD3d11Context context,
                                                          const VitrailD3d11TargetDesc* desc);

/* What buffers of the host's must be to serve as a target's memory: D3D11_USAGE_DEFAULT, with
 * D3D11_BIND_UNORDERED_ACCESS and D3D11_BIND_SHADER_RESOURCE, and D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS. */
typedef struct VitrailD3d11Requirements {
  void* next;                            /* null */
  uint64_t sizes[VITRAIL_D3D11_BUFFERS]; /* bytes of each, by VitrailD3d11BufferKind */
} VitrailD3d11Requirements;

VITRAIL_API VitrailResult vitrailD3d11TargetRequirements(VitrailD3d11Context context,
                                                         const VitrailD3d11TargetDesc* desc,
                                                         VitrailD3d11Requirements* requirements);

/* Makes the memory of one view; the first target of its kind also makes its shaders. Errors: VITRAIL_ERROR_INVALID for
 * a field that is not as described, VITRAIL_ERROR_FORMAT, VITRAIL_ERROR_UNSUPPORTED for samples, or a shader that the
 * device refuses, VITRAIL_ERROR_OUT_OF_MEMORY; the log says which and by how much. On error *target is null. */
VITRAIL_API VitrailResult vitrailD3d11CreateTarget(VitrailD3d11Context context, const VitrailD3d11TargetDesc* desc,
                                                   VitrailD3d11Target* target);

/* Destroys the target. Null is ignored. */
VITRAIL_API void vitrailD3d11DestroyTarget(VitrailD3d11Target target);

VITRAIL_API VitrailResolve vitrailD3d11TargetResolve(VitrailD3d11Target target);
VITRAIL_API VitrailListBuild vitrailD3d11TargetListBuild(VitrailD3d11Target target);

/* The most nodes that one pool can have at that sample count; see vitrailVkMaxNodeCapacity(). */
VITRAIL_API uint32_t vitrailD3d11MaxNodeCapacity(VitrailD3d11Context context, VitrailNodeFormat format,
                                                 uint32_t samples);

VITRAIL_API void vitrailD3d11TargetMemory(VitrailD3d11Target target, VitrailMemory* memory);

/* Prepares a target with a memory budget for `frame` (0: the next one): reads the statistics of the newest frame that
 * has finished, and makes a larger or smaller pool where the need has changed. Never waits. Errors:
 * VITRAIL_ERROR_OUT_OF_MEMORY; the target stays as it was and can be used. */
VITRAIL_API VitrailResult vitrailD3d11UpdateTarget(VitrailD3d11Target target, uint64_t frame);

typedef struct VitrailD3d11ResizeInfo {
  const void* next; /* null */
  uint32_t width;   /* required */
  uint32_t height;
  uint32_t nodeCapacity; /* as in VitrailVkResizeInfo */
  uint32_t areaPixels;
  VitrailD3d11Views views;
} VitrailD3d11ResizeInfo;

/* Gives the target another size and other textures from the next frame on. Errors: as vitrailD3d11CreateTarget; the
 * target stays as it was. */
VITRAIL_API VitrailResult vitrailD3d11ResizeTarget(VitrailD3d11Target target, const VitrailD3d11ResizeInfo* info);

/* ---- Frame ------------------------------------------------------------------------------------------------------ */

typedef struct VitrailD3d11BeginInfo {
  const void* next; /* null */
  uint64_t frame;   /* as in VitrailVkBeginInfo */
  VitrailRect area; /* the pixels that are collected and resolved; an extent of 0: all */
} VitrailD3d11BeginInfo;

/* Starts a frame: empties the lists and the counters. `info` may be null (the next frame, everything). */
VITRAIL_API void vitrailD3d11Begin(VitrailD3d11Target target, ID3D11DeviceContext* commands,
                                   const VitrailD3d11BeginInfo* info);

/* Binds what vitrailCollect() needs for pixel shaders: the constant buffer, and unordered access views behind the
 * render targets that are set, which it keeps. Other unordered access views of pixel shaders are unbound, as Direct3D
 * 11 does; setting render targets unbinds these: call it after that, any number of times between vitrailD3d11Begin()
 * and vitrailD3d11Collected(). */
VITRAIL_API void vitrailD3d11Bind(VitrailD3d11Target target, ID3D11DeviceContext* commands);

/* The number of the frame that was begun last; 0 before the first. */
VITRAIL_API uint64_t vitrailD3d11TargetFrame(VitrailD3d11Target target);

/* Ends the collect pass: unbinds the unordered access views of vitrailD3d11Bind(); builds or sorts lists where the
 * target's choices ask for it. */
VITRAIL_API void vitrailD3d11Collected(VitrailD3d11Target target, ID3D11DeviceContext* commands);

typedef struct VitrailD3d11ResolveInfo {
  const void* next; /* null */
  uint32_t view;    /* which of the target's textures to use */
} VitrailD3d11ResolveInfo;

/* Sorts every list and blends it over the opaque scene, as vitrailVkCmdResolve(). VITRAIL_RESOLVE_FRAGMENT draws into
 * the first render target that is set, in the area of the frame; values are linear light. */
VITRAIL_API void vitrailD3d11Resolve(VitrailD3d11Target target, ID3D11DeviceContext* commands,
                                     const VitrailD3d11ResolveInfo* info);

/* Ends the frame: its counters go to where vitrailD3d11ReadStats() finds them. */
VITRAIL_API void vitrailD3d11End(VitrailD3d11Target target, ID3D11DeviceContext* commands);

/* ---- Reading lists ---------------------------------------------------------------------------------------------- */

/* Shaders of the host's walk lists where they lie, after vitrailD3d11Collected(): list.hlsl, with this call, which
 * binds the constant buffer and the shader resource views for pixel and compute shaders. The host unbinds them
 * (vitrailD3d11UnbindLists) before the target's next call. */
VITRAIL_API void vitrailD3d11BindLists(VitrailD3d11Target target, ID3D11DeviceContext* commands);
VITRAIL_API void vitrailD3d11UnbindLists(VitrailD3d11Target target, ID3D11DeviceContext* commands);

/* The host's memory gets the lists, sorted, by a call: */
typedef struct VitrailD3d11CopyInfo {
  const void* next;     /* null */
  VitrailRect area;     /* inside the frame's area, at least one pixel */
  ID3D11Buffer* buffer; /* required; D3D11_USAGE_DEFAULT or D3D11_USAGE_STAGING */
  uint64_t offset;      /* a multiple of 4 */
  uint64_t size;        /* bytes of the buffer from offset on; required, at least vitrailD3d11CopySize() */
} VitrailD3d11CopyInfo;

/* What such a copy begins with. Behind it are one VitrailD3d11CopiedList a pixel, row by row, and then the layers of
 * all pixels, VitrailLayer each, of one pixel front to back; pixels lie in any order. */
typedef struct VitrailD3d11CopyHeader {
  uint32_t layers;   /* that the pixels have; where that is more than `capacity` some lists are missing */
  uint32_t capacity; /* VitrailD3d11TargetDesc::copyLayers */
  VitrailRect area;
  uint32_t reserved[2];
} VitrailD3d11CopyHeader;

typedef struct VitrailD3d11CopiedList {
  uint32_t first; /* of the layers; 0xffffffff where the list was left out, as in VitrailVkCopiedList */
  uint32_t count; /* of the layers that the pixel has */
} VitrailD3d11CopiedList;

/* Bytes from VitrailD3d11CopyInfo::offset on that a copy of so many pixels writes; 0 for a null target. */
VITRAIL_API uint64_t vitrailD3d11CopySize(VitrailD3d11Target target, uint32_t width, uint32_t height);
VITRAIL_API void vitrailD3d11CopyLists(VitrailD3d11Target target, ID3D11DeviceContext* commands,
                                       const VitrailD3d11CopyInfo* info);

/* ---- Statistics and tiles --------------------------------------------------------------------------------------- */

/* Reads what the GPU reported about a frame, as vitrailVkReadStats(): VITRAIL_INCOMPLETE until it has executed, and
 * once it is more than framesInFlight frames old. Never waits. */
VITRAIL_API VitrailResult vitrailD3d11ReadStats(VitrailD3d11Target target, uint64_t frame, VitrailStats* stats);

/* What the device can hold, for VitrailTilePlanDesc::limits (tiles.h). */
VITRAIL_API VitrailResult vitrailD3d11TileLimits(VitrailD3d11Context context, VitrailNodeFormat format,
                                                 uint32_t samples, VitrailTileLimits* limits);

/* As vitrailVkTilePlanTarget(). */
VITRAIL_API void vitrailD3d11TilePlanTarget(VitrailTilePlan plan, VitrailD3d11TargetDesc* desc);

#ifdef __cplusplus
}
#endif

#endif
