/* Vitrail: exact order-independent transparency with per-pixel linked lists, for Vulkan 1.2 and later.
 *
 * A frame has two passes. In the collect pass the host draws its transparent geometry once, in any order; its fragment
 * shader ends in vitrailCollect() (shaders/vitrail/collect.glsl), which pushes the fragment on the list of its pixel.
 * In the resolve pass the library sorts every list by depth and blends it over the opaque colour. The source of the
 * method is Yang, Hensley, Gruen, Thibieroz: "Real-Time Concurrent Linked List Construction on the GPU" (2010), after
 * Carpenter's A-buffer (1984).
 *
 *   vitrailCreateContext   once per VkDevice
 *   vitrailCreateTarget    once per view: extent, samples, node format, memory, images
 *   per frame, in one command buffer:
 *     vitrailUpdateTarget   before recording: lets the pool follow the frame's needs (only with a memory budget)
 *     (host)  opaque geometry into colour and depth
 *     vitrailCmdBegin       outside a rendering scope: empties the lists
 *     (host)  binds vitrailTargetDescriptorSet() to its own pipelines and draws the transparent geometry with depth
 *             test on, depth writes off, no culling, no sample shading
 *     vitrailCmdCollected   outside a rendering scope: makes the lists visible to the resolve
 *     vitrailCmdResolve     sorts, blends. VITRAIL_RESOLVE_COMPUTE: outside a rendering scope;
 *                           VITRAIL_RESOLVE_FRAGMENT: inside the host's scope
 *     vitrailCmdEnd         outside a rendering scope: leaves the statistics for vitrailReadStats
 *   vitrailReadStats       later, whenever the frame has finished: what the frame held, and whether it was exact
 *
 * Threads: a context may be used from several threads at once; a target from one at a time. Recording calls
 * (vitrailCmd*) allocate nothing, wait for nothing and cannot fail. The library never submits, never waits, and keeps
 * no global state.
 *
 * In every descriptor a field that is zero means its documented default. This header needs <vulkan/vulkan_core.h> and
 * no prototypes: define VK_NO_PROTOTYPES freely. */
#ifndef VITRAIL_VITRAIL_H
#define VITRAIL_VITRAIL_H

#include <stdint.h>
#include <vulkan/vulkan_core.h>

/* Marks the functions of a shared library (VITRAIL_SHARED). A static one needs nothing. */
#if defined(VITRAIL_SHARED) && defined(__GNUC__)
#define VITRAIL_API __attribute__((visibility("default")))
#else
#define VITRAIL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define VITRAIL_VERSION_MAJOR 0
#define VITRAIL_VERSION_MINOR 3
#define VITRAIL_VERSION_PATCH 0

typedef struct VitrailContext_T* VitrailContext;
typedef struct VitrailTarget_T* VitrailTarget;
typedef struct VitrailTilePlan_T* VitrailTilePlan;

/* ---- Context ---------------------------------------------------------------------------------------------------- */

typedef enum VitrailLogSeverity {
  VITRAIL_LOG_ERROR = 1, /* the call that logs this returns an error; a recording call has gone on as the text says */
  VITRAIL_LOG_SEVERITY_MAX_ENUM = 0x7fffffff
} VitrailLogSeverity;

/* Receives one line, without a newline, that says what is wrong and what to do. Called on the thread of the call that
 * fails or is misused, before that call returns. The text is valid during the call only. */
typedef void (*VitrailLog)(VitrailLogSeverity severity, const char* message, void* user);

/* The device is created for Vulkan 1.2 or later with VkPhysicalDeviceFeatures::fragmentStoresAndAtomics. That is all
 * that the library needs. What the host has enabled beyond it is used where it helps; a device cannot be asked, so the
 * host says it: */
typedef enum VitrailFeatureBits {
  /* VkPhysicalDeviceVulkan12Features::bufferDeviceAddress: node pools larger than maxStorageBufferRange. The host's
   * collecting shaders then define VITRAIL_BUFFER_REFERENCE before they include vitrail/collect.glsl. */
  VITRAIL_FEATURE_BUFFER_DEVICE_ADDRESS = 1 << 0,
  /* VkPhysicalDeviceFeatures::dualSrcBlend: the fragment resolve is exact where surfaces multiply (see
   * VITRAIL_RESOLVE_FRAGMENT). */
  VITRAIL_FEATURE_DUAL_SRC_BLEND = 1 << 1,
  /* VkPhysicalDeviceFeatures::sampleRateShading: VITRAIL_MSAA_RESOLVE_PER_SAMPLE, which requires it. */
  VITRAIL_FEATURE_SAMPLE_RATE_SHADING = 1 << 2,
  VITRAIL_FEATURE_MAX_ENUM = 0x7fffffff
} VitrailFeatureBits;

typedef struct VitrailContextDesc {
  VkInstance instance;                           /* required */
  VkPhysicalDevice physicalDevice;               /* required */
  VkDevice device;                               /* required; outlives the context */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr; /* required: the library has no loader of its own */
  uint32_t features;                             /* VitrailFeatureBits that the device was created with */
  VkPipelineCache cache;                         /* optional; must outlive the context */
  const VkAllocationCallbacks* allocator;        /* optional; must outlive the context */
  VitrailLog log;                                /* optional; default: silence */
  void* logUser;
} VitrailContextDesc;

/* Builds what the targets of a device share. Errors: VK_ERROR_INITIALIZATION_FAILED for a missing required field,
 * VK_ERROR_FEATURE_NOT_PRESENT where the physical device lacks fragmentStoresAndAtomics, Vulkan 1.2 or a feature that
 * `features` names, or what Vulkan returned. On error *context is null. */
VITRAIL_API VkResult vitrailCreateContext(const VitrailContextDesc* desc, VitrailContext* context);

/* Destroys the context. Its targets must have been destroyed. Null is ignored. */
VITRAIL_API void vitrailDestroyContext(VitrailContext context);

/* ---- What is stored --------------------------------------------------------------------------------------------- */

/* How a fragment is stored. The stored value of a fragment is what is blended: "exact" means equal to blending all the
 * stored fragments of a pixel in depth order. In every format:
 *   - A NaN in colour or alpha is stored as 0, in depth as the value farthest from the viewer. Negative colours are
 *     stored as 0, infinite ones as the largest value of the format.
 *   - Equal depths are ordered by the rest of the node's bits, never by arrival.
 *   - A fragment that would change nothing is neither stored nor counted: with a stored alpha of 0 (premultiplied: and
 *     a stored colour of 0), or with empty coverage.
 *   - With multisampling the index of the next node shares its word with the coverage, which bounds the pool. */
typedef enum VitrailNodeFormat {
  /* 12 bytes a node.
   *   colour    8 bits a channel on the sRGB curve (IEC 61966-2-1), decoded to linear light before it is blended,
   *             clamped to [0, 1]; the error is at most 0.5/255 on the curve. At 1 sample with
   *             VITRAIL_LINKING_COMPUTE it is rounded twice: at most 0.7/255 for red and green, 0.9/255 for blue, and
   *             none for colours that are whole steps of the curve.
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
   *   alpha     16 bits, linear, clamped to [0, 1]; the error is at most 0.5/65535.
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

/* ---- Target ----------------------------------------------------------------------------------------------------- */

/* Where the resolve runs. */
typedef enum VitrailResolve {
  /* What vitrailDefaultResolve() says for the target's fields. */
  VITRAIL_RESOLVE_DEFAULT = 0,
  /* Compute shaders write the target's colour views, storage images. With samples > 1 they read the multisampled
   * opaque views and write the box-filtered picture (per pixel). */
  VITRAIL_RESOLVE_COMPUTE = 1,
  /* A full-screen triangle in the host's own rendering scope, blended by fixed function (premultiplied) over what is
   * there. Exact for lists with VITRAIL_BLEND_MULTIPLY only with VITRAIL_FEATURE_DUAL_SRC_BLEND; without it, pixels
   * whose transmittance differs between channels are blended with its mean and counted in approximatePixels. */
  VITRAIL_RESOLVE_FRAGMENT = 2,
  VITRAIL_RESOLVE_MAX_ENUM = 0x7fffffff
} VitrailResolve;

/* Who puts a fragment on the list of its pixel. Lists, memory and everything above hold for both; so does the picture,
 * but for the colours of VITRAIL_NODE_STANDARD at 1 sample, see there. Fixed when a target is made. */
typedef enum VitrailLinking {
  /* What vitrailDefaultLinking() says for the target's fields when it is made: vitrailTargetLinking(). */
  VITRAIL_LINKING_DEFAULT = 0,
  /* The fragment shader, as it collects (Yang et al.). */
  VITRAIL_LINKING_FRAGMENT = 1,
  /* A compute pass, which vitrailCmdCollected() records: the fragment shader notes the pixel in the node, and in
   * VITRAIL_NODE_STANDARD at 1 sample also leaves it to that pass to encode the colour. It takes less of fragment
   * shaders, and each node is read and written once more. For GPUs that run fragment shaders on few of their cores
   * (docs/performance.md). Areas (areaPixels) of up to VITRAIL_MAX_PIXELS_LINKED_BY_COMPUTE. */
  VITRAIL_LINKING_COMPUTE = 2,
  VITRAIL_LINKING_MAX_ENUM = 0x7fffffff
} VitrailLinking;

/* The most pixels of an area with VITRAIL_LINKING_COMPUTE: 4096 x 4096. Tile plans make no larger tiles. */
#define VITRAIL_MAX_PIXELS_LINKED_BY_COMPUTE 0x1000000

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
#define VITRAIL_MAX_COLOR_VIEWS 8
/* The most frames that may be in flight. */
#define VITRAIL_MAX_FRAMES_IN_FLIGHT 8

/* The images that a resolve reads and writes. The views are the host's, at least as large as the target's extent, and
 * outlive the target or the frames that use them (see vitrailResizeTarget). */
typedef struct VitrailViews {
  uint32_t count; /* of each array below that is not null, at most VITRAIL_MAX_COLOR_VIEWS */
  /* VITRAIL_RESOLVE_COMPUTE: what it writes; required. Single-sample 2D views of images with
   * VK_IMAGE_USAGE_STORAGE_BIT, in VK_IMAGE_LAYOUT_GENERAL. With samples == 1 they hold the opaque colour. */
  const VkImageView* color;
  /* samples > 1, per pixel: the multisampled opaque colour, with VK_IMAGE_USAGE_SAMPLED_BIT, in
   * VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL; required. */
  const VkImageView* opaque;
  /* samples > 1 without postDepthCoverage: the multisampled opaque depth (depth aspect), with
   * VK_IMAGE_USAGE_SAMPLED_BIT, in VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL; required. */
  const VkImageView* depth;
} VitrailViews;

/* The rendering scope of VITRAIL_RESOLVE_FRAGMENT: one colour attachment. */
typedef struct VitrailScope {
  VkFormat depthFormat; /* of the scope's attachments, VK_FORMAT_UNDEFINED where it has none */
  VkFormat stencilFormat;
  VkRenderPass renderPass; /* default: dynamic rendering, which the host has enabled */
  uint32_t subpass;
  /* Early rejection by stencil: the scope's stencil holds 0 where no transparent fragment was drawn, because the host's
   * collecting pipelines increment it (vitrailStencilMark), and pixels or samples whose stencil & stencilMask is 0 are
   * rejected before the resolve's shader. Default mask: 0xff. Not for per-pixel resolves of several samples. */
  VkBool32 stencilMark;
  uint32_t stencilMask;
} VitrailScope;

typedef struct VitrailTargetDesc {
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
  VitrailLinking linking;

  /* Memory: either a fixed nodeCapacity, or a budget that the pool grows towards. */
  /* Nodes of the pool, at most vitrailMaxNodeCapacity(), less where the rest of the target needs the room. With a
   * budget: at the start. */
  uint32_t nodeCapacity;
  /* Bytes of device memory for all that the target keeps; a pool that was replaced and that frames in flight still use
   * comes on top for those frames. Default 0: nodeCapacity is fixed. */
  VkDeviceSize memoryBudget;
  /* Pixels that can be collected at once: VitrailBeginInfo::area may cover that many. Default: the whole extent. A
   * target that is drawn in tiles needs head pointers for one tile only. */
  uint32_t areaPixels;
  /* Optional: the host's own memory, as vitrailTargetRequirements() asks for. It outlives the target, and nobody else
   * writes to it, between frames neither. Excludes memoryBudget and vitrailResizeTarget(). Default: the target
   * allocates and frees device-local memory. */
  VkBuffer buffer;
  VkDeviceSize bufferOffset;

  /* The colour that the resolve writes: of views.color (VITRAIL_RESOLVE_COMPUTE: VK_FORMAT_R16G16B16A16_SFLOAT, the
   * default, or VK_FORMAT_R32G32B32A32_SFLOAT) or of the scope's attachment (any format that can be blended). */
  VkFormat colorFormat;
  VitrailViews views;
  VitrailScope scope;

  uint32_t framesInFlight; /* at most VITRAIL_MAX_FRAMES_IN_FLIGHT; default 2 */
  const char* debugName;   /* prefix of the objects' debug names; default "vitrail" */
} VitrailTargetDesc;

/* The resolve that VITRAIL_RESOLVE_DEFAULT stands for: VITRAIL_RESOLVE_COMPUTE where the fields allow it (views.color
 * is given, the device stores to colorFormat, and the resolve is not per sample), else VITRAIL_RESOLVE_FRAGMENT.
 * docs/performance.md has the measurements behind it. */
VITRAIL_API VitrailResolve vitrailDefaultResolve(VitrailContext context, const VitrailTargetDesc* desc);

/* The linking that VITRAIL_LINKING_DEFAULT stands for: VITRAIL_LINKING_COMPUTE on devices where it was measured to be
 * faster, and where extent and areaPixels allow it, else VITRAIL_LINKING_FRAGMENT. docs/performance.md says which those
 * are, and how to measure another device. */
VITRAIL_API VitrailLinking vitrailDefaultLinking(VitrailContext context, const VitrailTargetDesc* desc);

/* What a buffer of the host's must be to serve as a target's memory. Its memory is device-local: shaders do atomics in
 * it, which not every machine carries to system memory. */
typedef struct VitrailRequirements {
  VkDeviceSize size;        /* bytes from bufferOffset on */
  VkDeviceSize alignment;   /* of bufferOffset */
  VkBufferUsageFlags usage; /* with SHADER_DEVICE_ADDRESS the allocation needs VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT */
} VitrailRequirements;

/* Errors: those of vitrailCreateTarget for the fields that matter here (extent, samples, nodeFormat, overflow,
 * linking, nodeCapacity, areaPixels). */
VITRAIL_API VkResult vitrailTargetRequirements(VitrailContext context, const VitrailTargetDesc* desc,
                                               VitrailRequirements* requirements);

/* Makes the memory and the descriptor sets of one view; the first target of its kind also compiles its resolve
 * pipelines. Errors: VK_ERROR_INITIALIZATION_FAILED for a field that is not as described,
 * VK_ERROR_FORMAT_NOT_SUPPORTED, VK_ERROR_FEATURE_NOT_PRESENT for a resolve or sample count that the device or the
 * context's features do not offer, VK_ERROR_OUT_OF_DEVICE_MEMORY where the pool exceeds a device limit, the budget is
 * too small, or memory is short, or what Vulkan returned; the log says which and by how much. On error *target is
 * null. */
VITRAIL_API VkResult vitrailCreateTarget(VitrailContext context, const VitrailTargetDesc* desc, VitrailTarget* target);

/* Destroys the target. No command buffer that was recorded with it may still be pending. Null is ignored. */
VITRAIL_API void vitrailDestroyTarget(VitrailTarget target);

/* The linking that a target was made with, never VITRAIL_LINKING_DEFAULT. */
VITRAIL_API VitrailLinking vitrailTargetLinking(VitrailTarget target);

/* Bytes that a pool of nodeCapacity nodes takes in a format. */
VITRAIL_API VkDeviceSize vitrailNodePoolSize(VitrailNodeFormat format, uint32_t nodeCapacity);

/* The most nodes that one pool can have on this device at that sample count (the node's next index, the largest
 * allocation and heap, and maxStorageBufferRange: of the lists of deep pixels and, without
 * VITRAIL_FEATURE_BUFFER_DEVICE_ADDRESS, of the pool). An upper bound: head pointers, sums and lists lie in the same
 * allocation, so a target of many pixels holds fewer. A memoryBudget of the device's size finds how many. */
VITRAIL_API uint32_t vitrailMaxNodeCapacity(VitrailContext context, VitrailNodeFormat format,
                                            VkSampleCountFlagBits samples);

typedef struct VitrailMemory {
  uint32_t nodeCapacity;
  VkDeviceSize nodeBytes;  /* the node pool */
  VkDeviceSize headBytes;  /* 4 bytes a pixel of the area */
  VkDeviceSize otherBytes; /* lists of deep pixels, sums for overflow, counters, parameters, statistics */
  VkDeviceSize totalBytes; /* all of these, the host's own buffer included, and pools that frames in flight still use */
} VitrailMemory;

VITRAIL_API void vitrailTargetMemory(VitrailTarget target, VitrailMemory* memory);

/* Prepares a target with a memory budget for recording `frame`: reads the statistics of the newest frame that has
 * finished, and where frames need more nodes than there are makes a larger pool, up to the budget; where the need has
 * stayed below a quarter for 120 frames, a smaller one. The old pool is freed when the frames that use it have
 * finished, `framesInFlight` frames later. Never waits. The descriptor set may change: ask for it again. Without a
 * budget, or where nothing changes, it only frees what frames no longer use.
 *
 * The frame numbers are those of VitrailBeginInfo. Errors: VK_ERROR_OUT_OF_DEVICE_MEMORY or what Vulkan returned; the
 * target stays as it was and can be used. */
VITRAIL_API VkResult vitrailUpdateTarget(VitrailTarget target, uint64_t frame);

/* Gives the target another extent and other images from `frame` on. Frames in flight keep the old ones: the old views
 * must stay until those frames have finished; the library waits for nothing. The descriptor set changes. areaPixels is
 * as in VitrailTargetDesc (0: the whole extent). Errors: as vitrailCreateTarget, of the linking that the target was
 * made with; the target stays as it was. */
typedef struct VitrailResizeInfo {
  uint64_t frame;
  VkExtent2D extent;
  uint32_t areaPixels;
  VitrailViews views;
} VitrailResizeInfo;

VITRAIL_API VkResult vitrailResizeTarget(VitrailTarget target, const VitrailResizeInfo* info);

/* ---- What the host's pipelines need ----------------------------------------------------------------------------- */

/* The layout of the one descriptor set that vitrailCollect() needs, the same for every target of the context: put it
 * into the host's pipeline layouts at the set number that its shaders define as VITRAIL_SET. The fragment stage sees
 * one uniform buffer and four storage buffers. Owned by the context. */
VITRAIL_API VkDescriptorSetLayout vitrailDescriptorSetLayout(VitrailContext context);

/* The set to bind at VITRAIL_SET while the transparent geometry is drawn into this target. Owned by the target, valid
 * until it is destroyed, or changed by vitrailUpdateTarget() or vitrailResizeTarget(). */
VITRAIL_API VkDescriptorSet vitrailTargetDescriptorSet(VitrailTarget target);

/* Optional: specialization constants for the host's collecting fragment shaders, which fix the node format, the sample
 * count, whether fragments without a node are summed (VitrailOverflow) and who links (VitrailLinking). With
 * VITRAIL_LINKING_DEFAULT the extent and areaPixels must be those that the target is made with; for a target that was
 * resized set what vitrailTargetLinking() says. Without the constants the shader reads all of it from the target and
 * has code for everything; with them it is smaller, which drivers that execute both sides of every branch repay most.
 * A shader that was specialized for another target stores nothing, and its fragments count as missing. */
typedef struct VitrailSpecialization {
  VkSpecializationMapEntry entries[5]; /* ids VITRAIL_CONSTANT_ID (default 1700) and the next four */
  uint32_t data[5];
} VitrailSpecialization;

VITRAIL_API void vitrailCollectSpecialization(VitrailContext context, const VitrailTargetDesc* desc,
                                              VitrailSpecialization* specialization);

/* Fills in the stencil state of collecting pipelines for VitrailScope::stencilMark: increments where the depth test
 * passes, never fails. stencilTestEnable is the host's to set, for both faces. */
VITRAIL_API void vitrailStencilMark(VkStencilOpState* state);

/* ---- Recording -------------------------------------------------------------------------------------------------- */

typedef struct VitrailBeginInfo {
  /* The host's number of this frame, which vitrailReadStats() takes. Frame numbers rise by 1; frames framesInFlight
   * apart share a slot, so the host begins frame n only when frame n - framesInFlight has finished on the GPU. */
  uint64_t frame;
  /* The pixels that are collected and resolved; fragments outside are ignored. At most areaPixels of them, inside the
   * extent. Default (an extent of 0): the whole target. */
  VkRect2D area;
} VitrailBeginInfo;

/* Starts a frame: empties the lists and the counters. Outside a rendering scope, on a queue with graphics and compute.
 * Waits (on the GPU) for the collect and resolve of the target's previous frame; makes the empty lists visible to
 * fragment shaders of later commands. `info` may be null (frame 0, everything).
 *
 * Frames are submitted in the order of recording. One that is not submitted after all (a swapchain out of date) is
 * dropped whole, from here to vitrailCmdEnd(): it leaves nothing behind, has no statistics, and the next one may have
 * its number or go on. */
VITRAIL_API void vitrailCmdBegin(VkCommandBuffer commandBuffer, VitrailTarget target, const VitrailBeginInfo* info);

/* Ends the collect pass. Once a frame, outside a rendering scope, after all draws that collect. Makes the lists that
 * fragment shaders wrote visible to the resolve. With VITRAIL_LINKING_COMPUTE it links the fragments, and for
 * VITRAIL_RESOLVE_FRAGMENT it sorts the lists that are longer than 16 fragments, in place; for both it binds compute
 * pipelines and a set. */
VITRAIL_API void vitrailCmdCollected(VkCommandBuffer commandBuffer, VitrailTarget target);

typedef struct VitrailResolveInfo {
  uint32_t view; /* which of the target's views to use */
} VitrailResolveInfo;

/* Sorts every list and blends it over the opaque scene, in linear light with premultiplied alpha: a pixel or sample d
 * becomes C + T * d, where (C, T) composes its fragments front to back. Once a frame. `info` may be null (view 0).
 *
 * VITRAIL_RESOLVE_COMPUTE: outside a rendering scope, after vitrailCmdCollected(). Binds compute pipelines and
 * descriptor sets; the host's compute bindings are lost, the graphics ones are not. Earlier writes to the views are
 * visible to (COMPUTE_SHADER, SHADER_READ | SHADER_WRITE). Afterwards views.color was written by (COMPUTE_SHADER,
 * SHADER_WRITE): the host's next barrier names that as its source.
 *
 * VITRAIL_RESOLVE_FRAGMENT: inside the host's rendering scope, which has the target's formats and sample count. Binds a
 * graphics pipeline and descriptor sets, and sets viewport and scissor; the host binds and sets its own again. Earlier
 * writes to views.opaque and views.depth are visible to (FRAGMENT_SHADER, SHADER_READ). */
VITRAIL_API void vitrailCmdResolve(VkCommandBuffer commandBuffer, VitrailTarget target, const VitrailResolveInfo* info);

/* Ends the frame: copies its counters to where vitrailReadStats() finds them. Outside a rendering scope, after
 * vitrailCmdResolve(), once a frame. With VITRAIL_RESOLVE_FRAGMENT and VITRAIL_OVERFLOW_APPROXIMATE it also binds a
 * compute pipeline and a set, to clean up the sums. */
VITRAIL_API void vitrailCmdEnd(VkCommandBuffer commandBuffer, VitrailTarget target);

/* ---- Barriers as data ------------------------------------------------------------------------------------------- */

/* Where the recording calls place their barriers. A host with a render graph can ask what they are:
 * vitrailBarriers(). */
typedef enum VitrailBarrierPoint {
  VITRAIL_BARRIER_BEFORE_CLEAR = 0,   /* first in vitrailCmdBegin: the previous frame -> the clears */
  VITRAIL_BARRIER_BEFORE_COLLECT = 1, /* last in vitrailCmdBegin: the clears -> vitrailCollect() */
  /* first in vitrailCmdCollected: vitrailCollect() -> linking, sorting and the resolve */
  VITRAIL_BARRIER_COLLECTED = 2,
  VITRAIL_BARRIER_POINT_MAX_ENUM = 0x7fffffff
} VitrailBarrierPoint;

#define VITRAIL_MAX_BARRIERS 4
typedef struct VitrailBarriers {
  VkPipelineStageFlags source;
  VkPipelineStageFlags destination;
  uint32_t count;
  VkBufferMemoryBarrier buffers[VITRAIL_MAX_BARRIERS];
} VitrailBarriers;

/* The barriers that a recording call makes at a point, for the target's present memory: what a render graph needs to
 * know of the library's buffers. The calls make them all the same. */
VITRAIL_API void vitrailBarriers(VitrailTarget target, VitrailBarrierPoint point, VitrailBarriers* barriers);

/* ---- Statistics ------------------------------------------------------------------------------------------------- */

typedef struct VitrailStats {
  uint64_t frame;
  uint32_t exact;              /* 1: every fragment of the frame was blended, in order; 0: see the counts below */
  uint64_t fragmentsRequested; /* fragments that reached vitrailCollect() and would change the picture */
  uint64_t fragmentsStored;    /* of those, the ones that had a node */
  uint64_t fragmentsMissing;   /* requested - stored: the pool was full */
  uint32_t nodeCapacity;       /* of the pool that the frame used */
  /* Of an overflowed frame the next three are counted only where a compute resolve blends it; else they are 0. */
  uint32_t layersMax;     /* stored fragments of the deepest pixel: the depth complexity if the frame is exact */
  uint32_t coveredPixels; /* pixels with at least one stored fragment; stored / covered is the mean depth */
  /* Pixels that were blended approximately: more than maxLayers fragments, or VITRAIL_BLEND_MULTIPLY in a fragment
   * resolve without dual-source blending (a resolve per sample counts samples). */
  uint32_t approximatePixels;
  /* Pixels (a resolve per sample counts samples) that the driver did not let the resolve finish. Always 0 on a GPU.
   * Mesa's CPU driver ends a shader's loops after 65,535 turns in total, which is enough for lists of 15,000
   * fragments. */
  uint32_t cutPixels;
} VitrailStats;

/* Reads what the GPU reported about a frame. Never blocks: VK_NOT_READY until the frame's vitrailCmdEnd() has executed,
 * and when the slot of that frame has been taken by a later one. The values are complete once the host has seen the
 * frame's fence or semaphore; a host that polls earlier gets VK_NOT_READY or the complete values. */
VITRAIL_API VkResult vitrailReadStats(VitrailTarget target, uint64_t frame, VitrailStats* stats);

/* ---- Tiles ------------------------------------------------------------------------------------------------------ */

/* A picture that does not fit into a memory budget is drawn in tiles: rectangles that are collected and resolved one
 * after the other through the same small pool, each by recording the frame with VitrailBeginInfo::area. The plan says
 * which, and splits the ones that overflow. The picture is the same, bit for bit, as without tiles. A plan makes no
 * Vulkan calls. One thread at a time. */

/* An axis-aligned box around transparent geometry, and the matrix (column-major, as GLSL's mat4) from its space to clip
 * space (x and y in [-w, w], depth in [0, w]). */
typedef struct VitrailBounds {
  float min[3];
  float max[3];
  float clipFromBox[16];
} VitrailBounds;

typedef struct VitrailTilePlanDesc {
  VkExtent2D extent; /* of the picture */
  VkSampleCountFlagBits samples;
  VitrailNodeFormat nodeFormat;
  /* Bytes for one tile's nodes, head pointers and lists; at least 64 KiB. It is clamped to what the device can hold. */
  VkDeviceSize memoryBudget;
  /* Only the smallest rectangle that these cover is drawn. Boxes that reach behind the eye cover everything. Default
   * (0): the whole picture, and always with samples > 1 resolved per pixel, which writes every pixel. */
  uint32_t boundsCount;
  const VitrailBounds* bounds;
  /* The fragments that the picture is expected to have, where that is known (from a frame that overflowed). Default 0:
   * the first tile is as large as its head pointers allow. */
  uint64_t expectedFragments;
} VitrailTilePlanDesc;

/* Errors: VK_ERROR_INITIALIZATION_FAILED for an empty extent, VK_ERROR_OUT_OF_DEVICE_MEMORY for a budget below 64 KiB,
 * VK_ERROR_FORMAT_NOT_SUPPORTED for a node format without nodes at that sample count. */
VITRAIL_API VkResult vitrailCreateTilePlan(VitrailContext context, const VitrailTilePlanDesc* desc,
                                           VitrailTilePlan* plan);
VITRAIL_API void vitrailDestroyTilePlan(VitrailTilePlan plan);

/* Sets nodeCapacity, areaPixels and overflow (VITRAIL_OVERFLOW_SKIP) of a target for this plan. */
VITRAIL_API void vitrailTilePlanTarget(VitrailTilePlan plan, VitrailTargetDesc* desc);

/* The next tile to draw. VK_FALSE: all are done. */
VITRAIL_API VkBool32 vitrailNextTile(VitrailTilePlan plan, VkRect2D* tile);

/* Tells what became of the tile that vitrailNextTile() gave last. One that overflowed (fragmentsMissing > 0) is
 * split, and its parts are drawn next. VK_ERROR_OUT_OF_DEVICE_MEMORY: it was a single pixel; the log has the bytes that
 * it needs. */
VITRAIL_API VkResult vitrailFinishTile(VitrailTilePlan plan, const VitrailStats* stats);

/* The smallest rectangle of whole pixels that contains the projections of the boxes, clipped to the extent; an extent
 * of 0 where nothing is visible. */
VITRAIL_API void vitrailProjectBounds(uint32_t count, const VitrailBounds* bounds, VkExtent2D extent, VkRect2D* area);

#ifdef __cplusplus
}
#endif

#endif
