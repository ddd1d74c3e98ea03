/* Vitrail for Direct3D 12 (feature level 11_0, shader model 5.1 and later): exact order-independent transparency with
 * per-pixel linked lists.
 *
 * The same method, calls and results as vitrail/vulkan.h, which says more about each: a frame has a collect pass, in
 * which the host draws its transparent geometry once, in any order, with pixel shaders that end in vitrailCollect(),
 * and a resolve pass, in which the library sorts every list by depth and blends it over the opaque colour.
 *
 *   vitrailD3d12CreateContext   once per device
 *   vitrailD3d12CreateTarget    once per view: size, samples, node format, memory, textures
 *   per frame, in command lists of type DIRECT:
 *     vitrailD3d12UpdateTarget    lets the pool follow the frame's needs (only with a memory budget)
 *     (host)  opaque geometry into colour and depth
 *     vitrailD3d12Begin           empties the lists
 *     (host)  sets render targets, its root signature and pipeline
 *     vitrailD3d12Bind            sets the root parameters by which the host's pixel shaders reach the lists
 *     (host)  draws the transparent geometry with depth test on, depth writes off, no culling
 *     vitrailD3d12Collected       makes the lists ready for the resolve
 *     vitrailD3d12Resolve         sorts, blends. VITRAIL_RESOLVE_FRAGMENT: into the render target that is set
 *     vitrailD3d12End             leaves the statistics for vitrailD3d12ReadStats
 *   vitrailD3d12ReadStats       later: what the frame held, and whether it was exact
 *
 * Shaders include shaders/vitrail/collect.hlsl, or list.hlsl to walk lists.
 *
 * Threads: a context may be used from several threads at once; a target from one at a time. The library never submits,
 * never waits, and calls of a frame allocate nothing. It asks the host for no library: no function of d3d12.dll is
 * called but through the interfaces that are given.
 *
 * Frames are executed on one queue, in the order of recording. A frame may lie in several command lists, and one
 * command list may hold several frames, of several targets. Bundles, and lists of other types than DIRECT, are refused.
 *
 * State of a command list: cannot be asked for, so it cannot be put back. Calls leave all of it as it is, but for what
 * follows; the host sets its own again before it draws or dispatches.
 *
 *   Begin, Collected, CopyLists, End   the pipeline, the compute root signature and its arguments; and, but for Begin,
 *                                      the descriptor heaps, where the target has its own (descriptorHeap is null)
 *   Resolve by compute                 the same
 *   Resolve by fragment                the pipeline, the graphics root signature and its arguments, the descriptor
 *                                      heaps likewise, primitive topology, viewports, scissor rectangles; and the
 *                                      stencil reference with stencilMark. Render targets stay.
 *   Bind, BindLists                    arguments of the root parameters that are named
 *
 * Predication is off, and no render pass (BeginRenderPass) is open, during calls; but a resolve by fragment may stand
 * in one, as it records no barrier.
 *
 * Resource states. The library makes the transitions of its own buffers, and leaves them so that between
 * vitrailD3d12Begin() and vitrailD3d12Collected() the host's draws collect without a barrier, and shaders of the host
 * walk lists after vitrailD3d12BindLists(). It makes none of the host's textures, but for those said at
 * VitrailD3d12Views. Buffers decay and are promoted between calls of ExecuteCommandLists() as Direct3D 12 has it.
 *
 * Rows: pixels count from the upper left corner, as SV_Position does.
 *
 * Removed devices: calls do nothing that can be seen; objects are released as ever.
 *
 * Out of order, null: as in vulkan.h. Calls that return a VitrailResult return VITRAIL_ERROR_INVALID where a required
 * pointer is null. A null `commands` is out of order, too.
 *
 * This header needs no other: interfaces are declared only. Formats are numbers of DXGI_FORMAT. */
#ifndef VITRAIL_D3D12_H
#define VITRAIL_D3D12_H

#include <vitrail/tiles.h>
#include <vitrail/types.h>

#ifdef __cplusplus
struct ID3D12DescriptorHeap;
struct ID3D12Device;
struct ID3D12GraphicsCommandList;
struct ID3D12Heap;
struct ID3D12Resource;
extern "C" {
#else
typedef struct ID3D12DescriptorHeap ID3D12DescriptorHeap;
typedef struct ID3D12Device ID3D12Device;
typedef struct ID3D12GraphicsCommandList ID3D12GraphicsCommandList;
typedef struct ID3D12Heap ID3D12Heap;
typedef struct ID3D12Resource ID3D12Resource;
#endif

typedef struct VitrailD3d12Context_T* VitrailD3d12Context;
typedef struct VitrailD3d12Target_T* VitrailD3d12Target;

/* ---- Context ---------------------------------------------------------------------------------------------------- */

typedef struct VitrailD3d12ContextDesc {
  const void* next;     /* null */
  ID3D12Device* device; /* required; the context holds a reference */
  /* Bytes that one target may take at most: what DXGI says of the adapter's memory, which a device does not tell.
   * Default (0): as much as the device can address of one buffer; what there is not is refused when it is asked for. */
  uint64_t memoryBytes;
  VitrailLog log; /* optional; default: silence; outlives the context and its targets */
  void* logUser;
} VitrailD3d12ContextDesc;

/* Errors: VITRAIL_ERROR_INVALID for a missing field, VITRAIL_ERROR_UNSUPPORTED where the device refuses a root
 * signature. On error *context is null. */
VITRAIL_API VitrailResult vitrailD3d12CreateContext(const VitrailD3d12ContextDesc* desc, VitrailD3d12Context* context);

/* Destroys the context. Its targets are destroyed before; where some are left the log says so, and the context is freed
 * with the last of them. Null is ignored. */
VITRAIL_API void vitrailD3d12DestroyContext(VitrailD3d12Context context);

/* ---- Target ----------------------------------------------------------------------------------------------------- */

/* The textures that a resolve reads and writes: the host's, at least as large as the target, and there as long as the
 * target and frames in flight use them. Level 0 of 2D textures. */
typedef struct VitrailD3d12Views {
  uint32_t count; /* of each array below that is not null, 1 to VITRAIL_MAX_VIEWS; 0 where all are null */
  /* VITRAIL_RESOLVE_COMPUTE: what is written; required. In colorFormat, with
   * D3D12_RESOURCE_FLAG_ALLOW_UNORDERED_ACCESS. In D3D12_RESOURCE_STATE_UNORDERED_ACCESS before
   * vitrailD3d12Resolve() and after it; the host's next barrier is a transition from there, or one of type UAV. With
   * samples == 1 it holds the opaque colour, which a resolve copies to a texture of the library's first (few devices
   * read what they write), for which it makes transitions to D3D12_RESOURCE_STATE_COPY_SOURCE and back. */
  ID3D12Resource* const* color;
  /* samples > 1, per pixel: the multisampled opaque colour; required. In
   * D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE for a resolve by compute, D3D12_RESOURCE_STATE_PIXEL_SHADER_RESOURCE
   * for one by fragment, as is: */
  ID3D12Resource* const* opaque;
  /* samples > 1: the multisampled opaque depth; required. Where it is set as depth-stencil view during a resolve by
   * VITRAIL_RESOLVE_FRAGMENT, in D3D12_RESOURCE_STATE_DEPTH_READ as well, by a read-only view. */
  ID3D12Resource* const* depth;
} VitrailD3d12Views;

/* Fields as in VitrailVkTargetDesc where nothing else is said. */
typedef struct VitrailD3d12TargetDesc {
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
  /* Optional: a heap of the host's (D3D12_HEAP_TYPE_DEFAULT, buffers allowed) from which the buffers are placed, as
   * vitrailD3d12TargetRequirements() asks for. It outlives the target, and nobody else writes there. Excludes
   * memoryBudget and vitrailD3d12ResizeTarget(). Default: committed resources. */
  ID3D12Heap* heap;
  uint64_t heapOffset; /* a multiple of 65536 */
  uint64_t heapSize;   /* bytes from heapOffset on; required with `heap` */
  /* Optional: descriptors of the host's shader-visible heap of type CBV_SRV_UAV, which is set whenever
   * vitrailD3d12Collected(), CopyLists, Resolve and End are called: they leave the heaps as they are. As many as
   * VitrailD3d12Requirements::descriptors. Default: the target has heaps of its own, and sets them. */
  ID3D12DescriptorHeap* descriptorHeap;
  uint32_t firstDescriptor;
  uint32_t descriptorCount; /* from there on; required with `descriptorHeap` */

  /* Of views.color (VITRAIL_RESOLVE_COMPUTE: DXGI_FORMAT_R16G16B16A16_FLOAT, the default, or R32G32B32A32_FLOAT), or of
   * the first render target (any format that can be blended). */
  uint32_t colorFormat;
  VitrailD3d12Views views;
  /* VITRAIL_RESOLVE_FRAGMENT: the depth-stencil view that is set in vitrailD3d12Resolve(); default (0): none. */
  uint32_t depthStencilFormat;
  /* VITRAIL_RESOLVE_FRAGMENT: the first render target that is set in vitrailD3d12Resolve() has the target's samples
   * (per pixel: one). 1: there are others behind it, in these formats, which are not written; then pixels whose
   * surfaces multiply are approximate, as where Vulkan lacks dualSrcBlend. */
  uint32_t severalRenderTargets;
  uint32_t otherFormats[7]; /* 0: none from there on */
  /* VITRAIL_RESOLVE_FRAGMENT: as VitrailVkScope::stencilMark. The host's collecting pipelines have
   * D3D12_STENCIL_OP_INCR_SAT and D3D12_COMPARISON_FUNC_ALWAYS for both faces. */
  uint32_t stencilMark;
  uint32_t stencilMask; /* default 0xff */

  uint32_t framesInFlight; /* at most VITRAIL_MAX_FRAMES_IN_FLIGHT; default 2 */
  const char* debugName;   /* prefix of the objects' names (ID3D12Object::SetName); default "vitrail" */
} VitrailD3d12TargetDesc;

VITRAIL_API VitrailResolve vitrailD3d12DefaultResolve(VitrailD3d12Context context, const VitrailD3d12TargetDesc* desc);
VITRAIL_API VitrailListBuild vitrailD3d12DefaultListBuild(VitrailD3d12Context context,
                                                          const VitrailD3d12TargetDesc* desc);

/* What a heap, and a range of descriptors, of the host's must have to serve a target. */
typedef struct VitrailD3d12Requirements {
  void* next;           /* null */
  uint64_t size;        /* bytes from heapOffset on */
  uint64_t alignment;   /* of heapOffset: 65536 */
  uint32_t descriptors; /* for the target, and for memory of before that frames in flight still use */
} VitrailD3d12Requirements;

VITRAIL_API VitrailResult vitrailD3d12TargetRequirements(VitrailD3d12Context context,
                                                         const VitrailD3d12TargetDesc* desc,
                                                         VitrailD3d12Requirements* requirements);

/* Makes the memory and descriptors of one view; the first target of its kind also makes its pipelines. Errors:
 * VITRAIL_ERROR_INVALID for a field that is not as described, VITRAIL_ERROR_FORMAT, VITRAIL_ERROR_UNSUPPORTED for
 * samples, or a pipeline that the device refuses, VITRAIL_ERROR_OUT_OF_MEMORY; the log says which and by how much. On
 * error *target is null. */
VITRAIL_API VitrailResult vitrailD3d12CreateTarget(VitrailD3d12Context context, const VitrailD3d12TargetDesc* desc,
                                                   VitrailD3d12Target* target);

/* Destroys the target. No command list that was recorded with it may still be executing. Null is ignored. */
VITRAIL_API void vitrailD3d12DestroyTarget(VitrailD3d12Target target);

VITRAIL_API VitrailResolve vitrailD3d12TargetResolve(VitrailD3d12Target target);
VITRAIL_API VitrailListBuild vitrailD3d12TargetListBuild(VitrailD3d12Target target);

/* The most nodes that one pool can have at that sample count; see vitrailVkMaxNodeCapacity(). */
VITRAIL_API uint32_t vitrailD3d12MaxNodeCapacity(VitrailD3d12Context context, VitrailNodeFormat format,
                                                 uint32_t samples);

VITRAIL_API void vitrailD3d12TargetMemory(VitrailD3d12Target target, VitrailMemory* memory);

/* Prepares a target with a memory budget for recording `frame` (0: the next one), as vitrailVkUpdateTarget(): reads the
 * statistics of the newest frame that has finished, and makes a larger or smaller pool where the need has changed. The
 * old one is freed when the frames that use it have finished, framesInFlight frames later. Never waits. Addresses and
 * descriptors may change: call vitrailD3d12Bind(), or vitrailD3d12WriteDescriptors(), again. Errors:
 * VITRAIL_ERROR_OUT_OF_MEMORY; the target stays as it was and can be used. */
VITRAIL_API VitrailResult vitrailD3d12UpdateTarget(VitrailD3d12Target target, uint64_t frame);

typedef struct VitrailD3d12ResizeInfo {
  const void* next; /* null */
  uint32_t width;   /* required */
  uint32_t height;
  uint32_t nodeCapacity; /* as in VitrailVkResizeInfo */
  uint32_t areaPixels;
  VitrailD3d12Views views;
} VitrailD3d12ResizeInfo;

/* Gives the target another size and other textures from the next frame on. Frames in flight keep the old ones, which
 * must stay until those frames have finished. Errors: as vitrailD3d12CreateTarget; the target stays as it was. */
VITRAIL_API VitrailResult vitrailD3d12ResizeTarget(VitrailD3d12Target target, const VitrailD3d12ResizeInfo* info);

/* ---- What the host's pipelines need ----------------------------------------------------------------------------- */

/* vitrailCollect() reaches the lists by five root parameters in a row of the host's root signature, which
 * vitrailD3d12Bind() sets:
 *
 *   first       D3D12_ROOT_PARAMETER_TYPE_CBV   b13   VITRAIL_REGISTER_PARAMETERS
 *   first + 1   D3D12_ROOT_PARAMETER_TYPE_UAV   u1    VITRAIL_REGISTER_CONTROL
 *   first + 2   D3D12_ROOT_PARAMETER_TYPE_UAV   u2    VITRAIL_REGISTER_HEADS
 *   first + 3   D3D12_ROOT_PARAMETER_TYPE_UAV   u3    VITRAIL_REGISTER_NODES
 *   first + 4   D3D12_ROOT_PARAMETER_TYPE_UAV   u4    VITRAIL_REGISTER_SUMS
 *
 * visible to pixel shaders. The registers are those of collect.hlsl where the host's shaders define no others, in the
 * space that they define as VITRAIL_SPACE. In an HLSL root signature:
 *
 *   "CBV(b13), UAV(u1), UAV(u2), UAV(u3), UAV(u4)"
 *
 * Shaders that walk lists (list.hlsl) have four, which vitrailD3d12BindLists() sets: CBV b13, and SRV t120, t121, t122.
 *
 * Tables of descriptors, and heaps for VITRAIL_BINDLESS, get the same views by vitrailD3d12WriteDescriptors(): */
#define VITRAIL_D3D12_COLLECT_DESCRIPTORS 5 /* CBV, then four UAVs, in the order above */
#define VITRAIL_D3D12_LIST_DESCRIPTORS 3    /* SRVs of t120 to t122, behind those */
#define VITRAIL_D3D12_DESCRIPTORS 8         /* all of them */

/* Writes VITRAIL_D3D12_DESCRIPTORS descriptors, from that D3D12_CPU_DESCRIPTOR_HANDLE::ptr on, of a heap of type
 * CBV_SRV_UAV. They hold until vitrailD3d12UpdateTarget() or vitrailD3d12ResizeTarget(). */
VITRAIL_API void vitrailD3d12WriteDescriptors(VitrailD3d12Target target, uint64_t handle);

/* ---- Frame ------------------------------------------------------------------------------------------------------ */

typedef struct VitrailD3d12BeginInfo {
  const void* next; /* null */
  uint64_t frame;   /* as in VitrailVkBeginInfo: the host begins frame n when frame n - framesInFlight has finished */
  VitrailRect area; /* the pixels that are collected and resolved; an extent of 0: all */
} VitrailD3d12BeginInfo;

/* Starts a frame: empties the lists and the counters, as vitrailVkCmdBegin(). `info` may be null (the next frame,
 * everything). */
VITRAIL_API void vitrailD3d12Begin(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                   const VitrailD3d12BeginInfo* info);

/* Sets the graphics root parameters for vitrailCollect(), from number `firstParameter` on, of the root signature that
 * is set. Any number of times between vitrailD3d12Begin() and vitrailD3d12Collected(), and in any command lists that
 * are executed between those. */
VITRAIL_API void vitrailD3d12Bind(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                  uint32_t firstParameter);

/* The number of the frame that was begun last; 0 before the first. */
VITRAIL_API uint64_t vitrailD3d12TargetFrame(VitrailD3d12Target target);

/* Ends the collect pass: makes the lists that pixel shaders wrote visible to the resolve; builds or sorts lists where
 * the target's choices ask for it. */
VITRAIL_API void vitrailD3d12Collected(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands);

typedef struct VitrailD3d12ResolveInfo {
  const void* next; /* null */
  uint32_t view;    /* which of the target's textures to use */
} VitrailD3d12ResolveInfo;

/* Sorts every list and blends it over the opaque scene, as vitrailVkCmdResolve(). VITRAIL_RESOLVE_FRAGMENT draws into
 * the first render target that is set, in the area of the frame; values are linear light. */
VITRAIL_API void vitrailD3d12Resolve(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                     const VitrailD3d12ResolveInfo* info);

/* Ends the frame: its counters go to where vitrailD3d12ReadStats() finds them. */
VITRAIL_API void vitrailD3d12End(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands);

/* ---- Reading lists ---------------------------------------------------------------------------------------------- */

/* Shaders of the host's walk lists where they lie, after vitrailD3d12Collected() and before vitrailD3d12End():
 * list.hlsl. This call makes the lists readable (D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE and
 * PIXEL_SHADER_RESOURCE), and sets four root parameters from `firstParameter` on, of the
 * graphics root signature, or with `compute` of the compute one; VITRAIL_D3D12_NO_PARAMETER sets none. The host ends
 * with vitrailD3d12UnbindLists(), which makes them writable again, before the target's next call. */
#define VITRAIL_D3D12_NO_PARAMETER 0xffffffffU
VITRAIL_API void vitrailD3d12BindLists(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                       uint32_t firstParameter, uint32_t compute);
VITRAIL_API void vitrailD3d12UnbindLists(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands);

/* The host's memory gets the lists, sorted, by a call: */
typedef struct VitrailD3d12CopyInfo {
  const void* next;       /* null */
  VitrailRect area;       /* inside the frame's area, at least one pixel */
  ID3D12Resource* buffer; /* required; in D3D12_RESOURCE_STATE_COPY_DEST, which it stays in */
  uint64_t offset;        /* a multiple of 4 */
  uint64_t size;          /* bytes of the buffer from offset on; required, at least vitrailD3d12CopySize() */
} VitrailD3d12CopyInfo;

/* What such a copy begins with. Behind it are one VitrailD3d12CopiedList a pixel, row by row, and then the layers of
 * all pixels, VitrailLayer each, of one pixel front to back; pixels lie in any order. */
typedef struct VitrailD3d12CopyHeader {
  uint32_t layers;   /* that the pixels have; where that is more than `capacity` some lists are missing */
  uint32_t capacity; /* VitrailD3d12TargetDesc::copyLayers */
  VitrailRect area;
  uint32_t reserved[2];
} VitrailD3d12CopyHeader;

typedef struct VitrailD3d12CopiedList {
  uint32_t first; /* of the layers; 0xffffffff where the list was left out, as in VitrailVkCopiedList */
  uint32_t count; /* of the layers that the pixel has */
} VitrailD3d12CopiedList;

/* Bytes from VitrailD3d12CopyInfo::offset on that a copy of so many pixels writes; 0 for a null target. */
VITRAIL_API uint64_t vitrailD3d12CopySize(VitrailD3d12Target target, uint32_t width, uint32_t height);
VITRAIL_API void vitrailD3d12CopyLists(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                       const VitrailD3d12CopyInfo* info);

/* ---- Statistics and tiles --------------------------------------------------------------------------------------- */

/* Reads what the GPU reported about a frame, as vitrailVkReadStats(): VITRAIL_INCOMPLETE until its vitrailD3d12End()
 * has executed, and once it is more than framesInFlight frames old. The values are complete once the host has seen the
 * frame's fence. Never waits. */
VITRAIL_API VitrailResult vitrailD3d12ReadStats(VitrailD3d12Target target, uint64_t frame, VitrailStats* stats);

/* What the device can hold, for VitrailTilePlanDesc::limits (tiles.h). */
VITRAIL_API VitrailResult vitrailD3d12TileLimits(VitrailD3d12Context context, VitrailNodeFormat format,
                                                 uint32_t samples, VitrailTileLimits* limits);

/* As vitrailVkTilePlanTarget(). */
VITRAIL_API void vitrailD3d12TilePlanTarget(VitrailTilePlan plan, VitrailD3d12TargetDesc* desc);

#ifdef __cplusplus
}
#endif

#endif
