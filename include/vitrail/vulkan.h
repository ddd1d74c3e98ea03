/* Vitrail for Vulkan 1.2 and later: exact order-independent transparency with per-pixel linked lists.
 *
 * A frame has two passes. In the collect pass the host draws its transparent geometry once, in any order; its fragment
 * shader ends in vitrailCollect() (shaders/vitrail/collect.glsl), which pushes the fragment on the list of its pixel.
 * In the resolve pass the library sorts every list by depth and blends it over the opaque colour. The source of the
 * method is Yang, Hensley, Gruen, Thibieroz: "Real-Time Concurrent Linked List Construction on the GPU" (2010), after
 * Carpenter's A-buffer (1984).
 *
 *   vitrailVkCreateContext   once per VkDevice
 *   vitrailVkCreateTarget    once per view: extent, samples, node format, memory, images
 *   per frame, in one command buffer:
 *     vitrailVkUpdateTarget   before recording: lets the pool follow the frame's needs (only with a memory budget)
 *     (host)  opaque geometry into colour and depth
 *     vitrailVkCmdBegin       outside a rendering scope: empties the lists
 *     (host)  binds vitrailVkTargetDescriptorSet() to its own pipelines and draws the transparent geometry with depth
 *             test on, depth writes off, no culling, no sample shading
 *     vitrailVkCmdCollected   outside a rendering scope: makes the lists visible to the resolve
 *     vitrailVkCmdResolve     sorts, blends. VITRAIL_RESOLVE_COMPUTE: outside a rendering scope;
 *                             VITRAIL_RESOLVE_FRAGMENT: inside the host's scope
 *     vitrailVkCmdEnd         outside a rendering scope: leaves the statistics for vitrailVkReadStats
 *   vitrailVkReadStats       later, whenever the frame has finished: what the frame held, and whether it was exact
 *
 * Threads: a context may be used from several threads at once; a target from one at a time. Recording calls
 * (vitrailVkCmd*) allocate nothing, wait for nothing and cannot fail. The library never submits, never waits, and keeps
 * no global state.
 *
 * Out of order: a recording call that may not come at its place in the frame (before vitrailVkCmdBegin, twice, a
 * resolve of lists that were not collected) records nothing and logs one error, and the frame's statistics are never
 * exact.
 *
 * Null: a pointer or handle that is not said to be optional is required. Where one is null, calls that return a
 * VkResult return VK_ERROR_INITIALIZATION_FAILED, calls that return something else return zero, and the others do
 * nothing; what is to be filled in is zeroed where it is there, and the context's log, where there is one, gets a line.
 *
 * This header needs <vulkan/vulkan_core.h> and no prototypes: define VK_NO_PROTOTYPES freely. */
#ifndef VITRAIL_VULKAN_H
#define VITRAIL_VULKAN_H

#include <vulkan/vulkan_core.h>

#include <vitrail/tiles.h>
#include <vitrail/types.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct VitrailVkContext_T* VitrailVkContext;
typedef struct VitrailVkTarget_T* VitrailVkTarget;

/* ---- Context ---------------------------------------------------------------------------------------------------- */

/* The device is created for Vulkan 1.2 or later with VkPhysicalDeviceFeatures::fragmentStoresAndAtomics. That is all
 * that the library needs. What the host has enabled beyond it is used where it helps; a device cannot be asked, so the
 * host says it: */
typedef enum VitrailVkFeatureBits {
  /* VkPhysicalDeviceVulkan12Features::bufferDeviceAddress: node pools larger than maxStorageBufferRange. The host's
   * collecting shaders then define VITRAIL_BUFFER_REFERENCE before they include vitrail/collect.glsl. Fragments of a
   * shader that does not, and that cannot reach all of the pool, count as missing. */
  VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS = 1 << 0,
  /* VkPhysicalDeviceFeatures::dualSrcBlend: the fragment resolve is exact where surfaces multiply (see
   * VITRAIL_RESOLVE_FRAGMENT). */
  VITRAIL_VK_FEATURE_DUAL_SRC_BLEND = 1 << 1,
  /* VkPhysicalDeviceFeatures::sampleRateShading: VITRAIL_MSAA_RESOLVE_PER_SAMPLE, which requires it. */
  VITRAIL_VK_FEATURE_SAMPLE_RATE_SHADING = 1 << 2,
  VITRAIL_VK_FEATURE_MAX_ENUM = 0x7fffffff
} VitrailVkFeatureBits;

typedef struct VitrailVkContextDesc {
  const void* next;                              /* null */
  VkInstance instance;                           /* required */
  VkPhysicalDevice physicalDevice;               /* required */
  VkDevice device;                               /* required; outlives the context and its targets */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr; /* required: the library has no loader of its own */
  uint32_t features;                             /* VitrailVkFeatureBits that the device was created with */
  VkPipelineCache cache;                         /* optional; outlives the context */
  const VkAllocationCallbacks* allocator;        /* optional; outlives the context and its targets */
  VitrailLog log;                                /* optional; default: silence; outlives the context and its targets */
  void* logUser;
} VitrailVkContextDesc;

/* Builds what the targets of a device share. Errors: VK_ERROR_INITIALIZATION_FAILED for a missing required field or an
 * unknown feature bit, VK_ERROR_FEATURE_NOT_PRESENT where the physical device lacks fragmentStoresAndAtomics,
 * Vulkan 1.2 or a feature that `features` names, or what Vulkan returned. On error *context is null. */
VITRAIL_API VkResult vitrailVkCreateContext(const VitrailVkContextDesc* desc, VitrailVkContext* context);

/* Destroys the context. Its targets are destroyed before; where some are left the log says so, no new ones can be made,
 * and the context's objects are freed with the last of them. Null is ignored. */
VITRAIL_API void vitrailVkDestroyContext(VitrailVkContext context);

/* ---- Target ----------------------------------------------------------------------------------------------------- */

/* The images that a resolve reads and writes. The views are the host's, at least as large as the target's extent, and
 * outlive the target or the frames that use them (see vitrailVkResizeTarget). */
typedef struct VitrailVkViews {
  uint32_t count; /* of each array below that is not null, 1 to VITRAIL_MAX_VIEWS; 0 where all are null */
  /* VITRAIL_RESOLVE_COMPUTE: what it writes; required. Single-sample 2D views of images with
   * VK_IMAGE_USAGE_STORAGE_BIT, in VK_IMAGE_LAYOUT_GENERAL. With samples == 1 they hold the opaque colour. */
  const VkImageView* color;
  /* samples > 1, per pixel: the multisampled opaque colour, with VK_IMAGE_USAGE_SAMPLED_BIT, in
   * VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL; required. */
  const VkImageView* opaque;
  /* samples > 1 without postDepthCoverage: the multisampled opaque depth (depth aspect), with
   * VK_IMAGE_USAGE_SAMPLED_BIT, in VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL; required. */
  const VkImageView* depth;
} VitrailVkViews;

/* The rendering scope of VITRAIL_RESOLVE_FRAGMENT: one colour attachment. */
typedef struct VitrailVkScope {
  VkFormat depthFormat; /* of the scope's attachments, VK_FORMAT_UNDEFINED where it has none */
  VkFormat stencilFormat;
  VkRenderPass renderPass; /* default: dynamic rendering, which the host has enabled */
  uint32_t subpass;
  /* Early rejection by stencil: the scope's stencil holds 0 where no transparent fragment was drawn, because the host's
   * collecting pipelines increment it (vitrailVkStencilMark), and pixels or samples whose stencil & stencilMask is 0
   * are rejected before the resolve's shader. Default mask: 0xff. Not for per-pixel resolves of several samples. */
  VkBool32 stencilMark;
  uint32_t stencilMask;
} VitrailVkScope;

typedef struct VitrailVkTargetDesc {
  const void* next;              /* null */
  VkExtent2D extent;             /* pixels; required, each side at least 1 */
  VkSampleCountFlagBits samples; /* of the collect pass: 1, 2, 4 or 8; default 1 */
  VitrailNodeFormat nodeFormat;  /* default: VITRAIL_NODE_STANDARD */
  VitrailDepthOrder depthOrder;  /* default: VITRAIL_DEPTH_NEAREST_IS_ZERO */
  VitrailResolve resolve;
  VitrailMsaaResolve msaaResolve;
  /* The collecting shaders define VITRAIL_POST_DEPTH_COVERAGE (VK_EXT_post_depth_coverage): stored coverage has passed
   * the depth test. Without it, and with samples > 1, the resolve tests each sample's opaque depth (views.depth)
   * against the fragment's depth at the pixel centre: where a transparent surface cuts an opaque one within a pixel,
   * samples may differ from the depth test's. A fragment as deep as the sample passes. */
  VkBool32 postDepthCoverage;
  /* Bounds the cost of a pixel: the nearest maxLayers fragments are blended exactly, the others approximately under
   * them, whatever order they arrive in (weighted average, samples apart). Pixels with more are counted in
   * approximatePixels. Default 0: no bound. */
  uint32_t maxLayers;
  VitrailOverflow overflow;
  VitrailListBuild listBuild;
  /* Nodes carry a 32-bit word of the host's (object, material), as vitrailCollect(color, blend, depth, word) takes it:
   * 4 bytes a node. vitrail/list.glsl and vitrailVkCmdCopyLists() give it back. */
  VkBool32 userWords;

  /* Memory: either a fixed nodeCapacity, or a budget that the pool grows towards; one of them is required. */
  /* Nodes of the pool, at most vitrailVkMaxNodeCapacity(), less where the rest of the target needs the room. With a
   * budget: at the start; default: 2 a pixel. */
  uint32_t nodeCapacity;
  /* Bytes of device memory for all that the target keeps; a pool that was replaced and that frames in flight still use
   * comes on top for those frames. Default 0: nodeCapacity is fixed. */
  VkDeviceSize memoryBudget;
  /* Pixels that can be collected at once: VitrailVkBeginInfo::area may cover that many. Default: the whole extent. A
   * target that is drawn in tiles needs head pointers for one tile only. */
  uint32_t areaPixels;
  /* Layers, and pixels, that one vitrailVkCmdCopyLists() can copy, 40 bytes each; default 0: it is not used. */
  uint32_t copyLayers;
  /* Optional: the host's own memory, as vitrailVkTargetRequirements() asks for. It outlives the target, and nobody else
   * writes to it, between frames neither. Excludes memoryBudget and vitrailVkResizeTarget(). Default: the target
   * allocates and frees device-local memory. */
  VkBuffer buffer;
  VkDeviceSize bufferOffset;
  VkDeviceSize bufferSize; /* bytes from bufferOffset on; required with `buffer` */

  /* The colour that the resolve writes: of views.color (VITRAIL_RESOLVE_COMPUTE: VK_FORMAT_R16G16B16A16_SFLOAT, the
   * default, or VK_FORMAT_R32G32B32A32_SFLOAT) or of the scope's attachment (any format that can be blended). */
  VkFormat colorFormat;
  VitrailVkViews views;
  VitrailVkScope scope;

  /* The barriers between the recording calls are the host's, by its render graph: it asks vitrailVkBarriers() which
   * those are. Default: the calls record them. */
  VkBool32 hostBarriers;
  uint32_t framesInFlight; /* at most VITRAIL_MAX_FRAMES_IN_FLIGHT; default 2 */
  const char* debugName;   /* prefix of the objects' debug names; default "vitrail" */
} VitrailVkTargetDesc;

/* The resolve that VITRAIL_RESOLVE_DEFAULT stands for: VITRAIL_RESOLVE_COMPUTE where the fields allow it (views.color
 * is given, the device stores to colorFormat, and the resolve is not per sample), else VITRAIL_RESOLVE_FRAGMENT.
 * docs/performance.md has the measurements behind it. */
VITRAIL_API VitrailResolve vitrailVkDefaultResolve(VitrailVkContext context, const VitrailVkTargetDesc* desc);

/* Who builds the lists by VITRAIL_LIST_BUILD_DEFAULT: VITRAIL_LIST_BUILD_COMPUTE on devices where it was measured to be
 * faster, and where extent and areaPixels allow it, else VITRAIL_LIST_BUILD_FRAGMENT. docs/performance.md says which
 * those are, and how to measure another device. */
VITRAIL_API VitrailListBuild vitrailVkDefaultListBuild(VitrailVkContext context, const VitrailVkTargetDesc* desc);

/* What a buffer of the host's must be to serve as a target's memory. Its memory is device-local: shaders do atomics in
 * it, which not every machine carries to system memory. */
typedef struct VitrailVkRequirements {
  void* next;               /* null */
  VkDeviceSize size;        /* bytes from bufferOffset on */
  VkDeviceSize alignment;   /* of bufferOffset */
  VkBufferUsageFlags usage; /* with SHADER_DEVICE_ADDRESS the allocation needs VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT */
} VitrailVkRequirements;

/* Errors: those of vitrailVkCreateTarget for the fields that matter here (extent, samples, nodeFormat, overflow,
 * listBuild, userWords, nodeCapacity, areaPixels, copyLayers). */
VITRAIL_API VkResult vitrailVkTargetRequirements(VitrailVkContext context, const VitrailVkTargetDesc* desc,
                                                 VitrailVkRequirements* requirements);

/* Makes the memory and the descriptor sets of one view; the first target of its kind also compiles its resolve
 * pipelines. Errors: VK_ERROR_INITIALIZATION_FAILED for a field that is not as described,
 * VK_ERROR_FORMAT_NOT_SUPPORTED, VK_ERROR_FEATURE_NOT_PRESENT for a resolve or sample count that the device or the
 * context's features do not offer, VK_ERROR_OUT_OF_DEVICE_MEMORY where the pool exceeds a device limit, the budget is
 * too small, or memory is short, or what Vulkan returned; the log says which and by how much. On error *target is
 * null. */
VITRAIL_API VkResult vitrailVkCreateTarget(VitrailVkContext context, const VitrailVkTargetDesc* desc,
                                           VitrailVkTarget* target);

/* Destroys the target. No command buffer that was recorded with it may still be pending. Null is ignored. */
VITRAIL_API void vitrailVkDestroyTarget(VitrailVkTarget target);

/* What a target was made with, never VITRAIL_RESOLVE_DEFAULT or VITRAIL_LIST_BUILD_DEFAULT. With
 * VITRAIL_RESOLVE_FRAGMENT vitrailVkCmdResolve() is recorded inside a rendering scope. A null target: the default. */
VITRAIL_API VitrailResolve vitrailVkTargetResolve(VitrailVkTarget target);
VITRAIL_API VitrailListBuild vitrailVkTargetListBuild(VitrailVkTarget target);

/* The most nodes that one pool can have on this device at that sample count (the node's next index, the largest
 * allocation and heap, and maxStorageBufferRange: of the lists of deep pixels and, without
 * VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS, of the pool). An upper bound: head pointers, sums and lists lie in the same
 * allocation, so a target of many pixels holds fewer, and so does one whose nodes carry words. A memoryBudget of the
 * device's size finds how many. */
VITRAIL_API uint32_t vitrailVkMaxNodeCapacity(VitrailVkContext context, VitrailNodeFormat format,
                                              VkSampleCountFlagBits samples);

VITRAIL_API void vitrailVkTargetMemory(VitrailVkTarget target, VitrailMemory* memory);

/* Prepares a target with a memory budget for recording `frame`: reads the statistics of the newest frame that has
 * finished, and where frames need more nodes than there are makes a larger pool, up to the budget; where the need has
 * stayed below a quarter for 120 frames, a smaller one. The old pool is freed when the frames that use it have
 * finished, `framesInFlight` frames later. Never waits. The descriptor set may change: ask for it again. Without a
 * budget, or where nothing changes, it only frees what frames no longer use.
 *
 * The frame numbers are those of VitrailVkBeginInfo; 0 is the next frame here, too. Errors:
 * VK_ERROR_OUT_OF_DEVICE_MEMORY or what Vulkan returned; the target stays as it was and can be used. */
VITRAIL_API VkResult vitrailVkUpdateTarget(VitrailVkTarget target, uint64_t frame);

typedef struct VitrailVkResizeInfo {
  const void* next;  /* null */
  VkExtent2D extent; /* required */
  /* Nodes of the pool from now on. Default (0): as many as before; with a memory budget, as many as before for each
   * pixel of the area, within the budget. */
  uint32_t nodeCapacity;
  uint32_t areaPixels; /* as in VitrailVkTargetDesc; 0: the whole extent */
  VitrailVkViews views;
} VitrailVkResizeInfo;

/* Gives the target another extent and other images from the next frame on. Frames in flight keep the old ones: the old
 * views must stay until those frames have finished; the library waits for nothing, and frees the old memory when the
 * host begins a frame that says they have finished, or at once where no frame was begun with it. The descriptor set
 * changes. Errors: as vitrailVkCreateTarget, of the list build and the resolve that the target was made with; the
 * target stays as it was. */
VITRAIL_API VkResult vitrailVkResizeTarget(VitrailVkTarget target, const VitrailVkResizeInfo* info);

/* ---- What the host's pipelines need ----------------------------------------------------------------------------- */

/* The layout of the one descriptor set that vitrailCollect() needs, the same for every target of the context: put it
 * into the host's pipeline layouts at the set number that its shaders define as VITRAIL_SET. The fragment stage sees
 * one uniform buffer and four storage buffers. Owned by the context. */
VITRAIL_API VkDescriptorSetLayout vitrailVkDescriptorSetLayout(VitrailVkContext context);

/* The set to bind at VITRAIL_SET while the transparent geometry is drawn into this target. Owned by the target, valid
 * until it is destroyed, or changed by vitrailVkUpdateTarget() or vitrailVkResizeTarget(). */
VITRAIL_API VkDescriptorSet vitrailVkTargetDescriptorSet(VitrailVkTarget target);

/* Optional: specialization constants for the host's collecting fragment shaders, which fix the node format, the sample
 * count, whether fragments without a node are summed (VitrailOverflow), who builds the lists (VitrailListBuild) and
 * whether nodes carry words. With VITRAIL_LIST_BUILD_DEFAULT the extent and areaPixels must be those that the target is
 * made with; for a target that was resized set what vitrailVkTargetListBuild() says. Without the constants the shader
 * reads all of it from the target and has code for everything; with them it is smaller, which drivers that execute both
 * sides of every branch repay most. A shader that was specialized for another target stores nothing, and its fragments
 * count as missing. */
typedef struct VitrailVkSpecialization {
  uint32_t count;                      /* of those below that are in use */
  VkSpecializationMapEntry entries[8]; /* ids VITRAIL_CONSTANT_ID (default 1700) and the next ones */
  uint32_t data[8];
} VitrailVkSpecialization;

VITRAIL_API void vitrailVkCollectSpecialization(VitrailVkContext context, const VitrailVkTargetDesc* desc,
                                                VitrailVkSpecialization* specialization);

/* Fills in the stencil state of collecting pipelines for VitrailVkScope::stencilMark: increments where the depth test
 * passes, never fails. stencilTestEnable is the host's to set, for both faces. */
VITRAIL_API void vitrailVkStencilMark(VkStencilOpState* state);

/* ---- Recording -------------------------------------------------------------------------------------------------- */

typedef struct VitrailVkBeginInfo {
  const void* next; /* null */
  /* The host's number of this frame, which vitrailVkReadStats() takes. Frame numbers rise by 1, and the host begins
   * frame n only when frame n - framesInFlight has finished on the GPU. Default (0): the number after the last frame's;
   * the first frame is 0 then. vitrailVkTargetFrame() tells. */
  uint64_t frame;
  /* The pixels that are collected and resolved; fragments outside are ignored. At most areaPixels of them. What lies
   * outside the extent is left out, with a warning. Default (an extent of 0): the whole target. */
  VkRect2D area;
} VitrailVkBeginInfo;

/* Starts a frame: empties the lists and the counters. Outside a rendering scope, on a queue with graphics and compute.
 * Waits (on the GPU) for the collect and resolve of the target's previous frame; makes the empty lists visible to
 * fragment shaders of later commands. `info` may be null (the next frame, everything). Frees memory that only frames
 * used that have finished.
 *
 * Frames are submitted in the order of recording. One that is not submitted after all (a swapchain out of date) is
 * dropped whole, from here to vitrailVkCmdEnd(): it leaves nothing behind, has no statistics, and the next one may have
 * its number or go on; a host that goes on has waited for frame n - framesInFlight all the same. A target that is
 * resized, or given another pool, before the frame was ended drops it, and logs a warning. */
VITRAIL_API void vitrailVkCmdBegin(VkCommandBuffer commandBuffer, VitrailVkTarget target,
                                   const VitrailVkBeginInfo* info);

/* The number of the frame that was begun last; 0 before the first. */
VITRAIL_API uint64_t vitrailVkTargetFrame(VitrailVkTarget target);

/* Ends the collect pass. Once a frame, outside a rendering scope, after all draws that collect. Makes the lists that
 * fragment shaders wrote visible to the resolve. With VITRAIL_LIST_BUILD_COMPUTE it builds the lists, and for
 * VITRAIL_RESOLVE_FRAGMENT and VITRAIL_RESOLVE_HOST it sorts the lists that are longer than 16 fragments, in place: for
 * the latter fragments that are alike by their words. Binds compute pipelines and a set. */
VITRAIL_API void vitrailVkCmdCollected(VkCommandBuffer commandBuffer, VitrailVkTarget target);

typedef struct VitrailVkResolveInfo {
  const void* next; /* null */
  uint32_t view;    /* which of the target's views to use */
} VitrailVkResolveInfo;

/* Sorts every list and blends it over the opaque scene, in linear light with premultiplied alpha: a pixel or sample d
 * becomes C + T * d, where (C, T) composes its fragments front to back. Once a frame. `info` may be null (view 0). A
 * frame without fragments costs next to nothing, but for the mean of several samples that a resolve per pixel writes.
 *
 * VITRAIL_RESOLVE_COMPUTE: outside a rendering scope, after vitrailVkCmdCollected(). Binds compute pipelines and
 * descriptor sets; the host's compute bindings are lost, the graphics ones are not. Earlier writes to the views are
 * visible to (COMPUTE_SHADER, SHADER_READ | SHADER_WRITE). Afterwards views.color was written by (COMPUTE_SHADER,
 * SHADER_WRITE): the host's next barrier names that as its source.
 *
 * VITRAIL_RESOLVE_FRAGMENT: inside the host's rendering scope, which has the target's formats and sample count. Binds a
 * graphics pipeline and descriptor sets, and sets viewport and scissor; the host binds and sets its own again. Earlier
 * writes to views.opaque and views.depth are visible to (FRAGMENT_SHADER, SHADER_READ).
 *
 * VITRAIL_RESOLVE_HOST: records nothing, and says that the host's own pass over the lists is recorded, which comes
 * after vitrailVkCmdCollected() and before vitrailVkCmdEnd(). A frame without this call does not count as complete. */
VITRAIL_API void vitrailVkCmdResolve(VkCommandBuffer commandBuffer, VitrailVkTarget target,
                                     const VitrailVkResolveInfo* info);

/* Ends the frame: copies its counters to where vitrailVkReadStats() finds them. Outside a rendering scope, after
 * vitrailVkCmdResolve(), once a frame. With VITRAIL_RESOLVE_FRAGMENT and VITRAIL_OVERFLOW_APPROXIMATE it also binds a
 * compute pipeline and a set, to clean up the sums. */
VITRAIL_API void vitrailVkCmdEnd(VkCommandBuffer commandBuffer, VitrailVkTarget target);

/* ---- Reading lists ---------------------------------------------------------------------------------------------- */

/* Shaders of the host's read lists where they lie: shaders/vitrail/list.glsl, with the set of
 * vitrailVkTargetDescriptorSet(), after vitrailVkCmdCollected() and before the target's next vitrailVkCmdBegin().
 * vitrailVkCmdCollected() makes the lists visible to (FRAGMENT_SHADER | COMPUTE_SHADER, SHADER_READ); with hostBarriers
 * the barrier of VITRAIL_VK_BARRIER_RESOLVE does. A resolve by compute, and vitrailVkCmdCopyLists(), relink long lists
 * in place: a reader after them waits for (COMPUTE_SHADER, SHADER_WRITE), and they wait for a reader before them.
 *
 * The host's memory gets them, sorted, by a call: */
typedef struct VitrailVkCopyInfo {
  const void* next;    /* null */
  VkRect2D area;       /* the pixels, in the picture; inside the frame's area, at least one */
  VkBuffer buffer;     /* required; with VK_BUFFER_USAGE_TRANSFER_DST_BIT */
  VkDeviceSize offset; /* a multiple of 4 */
  VkDeviceSize size;   /* bytes of the buffer from offset on; required, at least vitrailVkCopySize() */
} VitrailVkCopyInfo;

/* What such a copy begins with. Behind it are one VitrailVkCopiedList a pixel, row by row, and then the layers of all
 * pixels, VitrailLayer each, of one pixel front to back; pixels lie in any order. */
typedef struct VitrailVkCopyHeader {
  uint32_t layers;   /* that the pixels have; where that is more than `capacity` some lists are missing */
  uint32_t capacity; /* VitrailVkTargetDesc::copyLayers */
  uint32_t x;        /* the area */
  uint32_t y;
  uint32_t width;
  uint32_t height;
  uint32_t reserved[2];
} VitrailVkCopyHeader;

typedef struct VitrailVkCopiedList {
  /* Of the layers. 0xffffffff where the list was left out: for want of room, in a frame that overflowed, or where the
   * driver did not let it be sorted. */
  uint32_t first;
  uint32_t count; /* of the layers that the pixel has */
} VitrailVkCopiedList;

/* Bytes from VitrailVkCopyInfo::offset on that a copy of so many pixels writes; 0 for a null target. */
VITRAIL_API VkDeviceSize vitrailVkCopySize(VitrailVkTarget target, uint32_t width, uint32_t height);

/* Copies the sorted lists of an area into the host's buffer. Any number of times a frame, outside a rendering scope,
 * after vitrailVkCmdCollected() and before vitrailVkCmdEnd(); of fragments as deep as each other in all their bits, the
 * one with the lower word comes first. For a target made with copyLayers. The buffer was last written by (TRANSFER,
 * TRANSFER_WRITE): the host's next barrier names that as its source. Binds a compute pipeline and sets. An area that is
 * not inside the frame's or has more pixels than copyLayers, and a buffer that is too small, record nothing, log an
 * error, and leave the frame not exact. */
VITRAIL_API void vitrailVkCmdCopyLists(VkCommandBuffer commandBuffer, VitrailVkTarget target,
                                       const VitrailVkCopyInfo* info);

/* ---- Barriers of a render graph --------------------------------------------------------------------------------- */

/* Between which of a frame's commands a target with hostBarriers leaves the barriers to the host. */
typedef enum VitrailVkBarrierPoint {
  VITRAIL_VK_BARRIER_BEGIN = 0,     /* before vitrailVkCmdBegin: the previous frame -> the clears */
  VITRAIL_VK_BARRIER_COLLECT = 1,   /* before the draws that collect: the clears -> vitrailCollect() */
  VITRAIL_VK_BARRIER_COLLECTED = 2, /* before vitrailVkCmdCollected: vitrailCollect() -> building and sorting lists */
  VITRAIL_VK_BARRIER_RESOLVE = 3,   /* before vitrailVkCmdResolve, and outside its scope: the lists -> the resolve */
  VITRAIL_VK_BARRIER_END = 4,       /* before vitrailVkCmdEnd: the resolve -> the copy of the counters */
  VITRAIL_VK_BARRIER_POINT_MAX_ENUM = 0x7fffffff
} VitrailVkBarrierPoint;

#define VITRAIL_VK_MAX_BARRIERS 4
typedef struct VitrailVkBarriers {
  void* next; /* null */
  VkPipelineStageFlags source;
  VkPipelineStageFlags destination;
  uint32_t count; /* 0: nothing is to be waited for */
  VkBufferMemoryBarrier buffers[VITRAIL_VK_MAX_BARRIERS];
} VitrailVkBarriers;

/* The barriers of a point, for the target's present memory: with hostBarriers the ones that the host has to make, else
 * the ones that the calls record. Barriers within a call are always the library's own. */
VITRAIL_API void vitrailVkBarriers(VitrailVkTarget target, VitrailVkBarrierPoint point, VitrailVkBarriers* barriers);

/* ---- Statistics ------------------------------------------------------------------------------------------------- */

/* Reads what the GPU reported about a frame. Frame 0, where the host leaves the numbers to the library (frame 0 in
 * every vitrailVkCmdBegin): the newest frame that has finished; VitrailStats::frame tells which. Never blocks:
 * VK_NOT_READY until the frame's vitrailVkCmdEnd() has executed, and once a frame has begun to execute that is more
 * than framesInFlight later: a host reads frame n - framesInFlight when it has waited for its fence, before or after it
 * records frame n. The values are complete once the host has seen the frame's fence or semaphore; a host that polls
 * earlier gets VK_NOT_READY or the complete values. */
VITRAIL_API VkResult vitrailVkReadStats(VitrailVkTarget target, uint64_t frame, VitrailStats* stats);

/* ---- Tiles ------------------------------------------------------------------------------------------------------ */

/* What the device can hold, for VitrailTilePlanDesc::limits (tiles.h). Errors: VK_ERROR_INITIALIZATION_FAILED for an
 * unknown format, VK_ERROR_FORMAT_NOT_SUPPORTED for a format without nodes at that sample count. */
VITRAIL_API VkResult vitrailVkTileLimits(VitrailVkContext context, VitrailNodeFormat format,
                                         VkSampleCountFlagBits samples, VitrailTileLimits* limits);

/* Sets nodeCapacity, areaPixels and overflow (VITRAIL_OVERFLOW_SKIP) of a target that draws a plan's tiles, and clears
 * memoryBudget. */
VITRAIL_API void vitrailVkTilePlanTarget(VitrailTilePlan plan, VitrailVkTargetDesc* desc);

#ifdef __cplusplus
}
#endif

#endif
