/* Vitrail: exact order-independent transparency with per-pixel linked lists, for Vulkan 1.2 and later.
 *
 * A frame has two passes. In the collect pass the host draws its transparent geometry once, in any order; its fragment
 * shader ends in vitrailCollect() (shaders/vitrail/collect.glsl), which pushes the fragment on the list of its pixel.
 * In the resolve pass the library sorts every list by depth and blends it over the opaque colour. The source of the
 * method is Yang, Hensley, Gruen, Thibieroz: "Real-Time Concurrent Linked List Construction on the GPU" (2010), after
 * Carpenter's A-buffer (1984).
 *
 *   vitrailCreateContext   once per VkDevice
 *   vitrailCreateTarget    once per view: extent, pool capacity, colour images
 *   per frame, in one command buffer:
 *     (host)  opaque geometry into colour and depth
 *     vitrailCmdBegin       outside a rendering scope: empties the lists
 *     (host)  binds vitrailTargetDescriptorSet() to its own pipelines and draws the transparent geometry with depth
 *             test on, depth writes off, no culling, one sample a pixel
 *     vitrailCmdCollected   outside a rendering scope: makes the lists visible to the resolve
 *     vitrailCmdResolve     outside a rendering scope: sorts, blends, writes the colour image
 *   vitrailReadStats       later, whenever the frame has finished: what the frame held, and whether it was exact
 *
 * Threads: a context may be used from several threads at once; a target from one at a time. Recording calls
 * (vitrailCmd*) allocate nothing, wait for nothing and cannot fail. The library never submits, and keeps no global
 * state.
 *
 * This header needs <vulkan/vulkan_core.h> and no prototypes: define VK_NO_PROTOTYPES freely. */
#ifndef VITRAIL_VITRAIL_H
#define VITRAIL_VITRAIL_H

#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VITRAIL_VERSION_MAJOR 0
#define VITRAIL_VERSION_MINOR 1
#define VITRAIL_VERSION_PATCH 0

/* What a VkDevice must have been created with. A host that builds its own VkPhysicalDeviceFeatures sets this member:
 *   fragmentStoresAndAtomics = VK_TRUE
 * and creates the device for Vulkan 1.2 or later. Nothing else is asked for. */

typedef struct VitrailContext_T* VitrailContext;
typedef struct VitrailTarget_T* VitrailTarget;

typedef enum VitrailLogSeverity {
  VITRAIL_LOG_ERROR = 1, /* the call that logs this returns an error */
  VITRAIL_LOG_SEVERITY_MAX_ENUM = 0x7fffffff
} VitrailLogSeverity;

/* Receives one line, without a newline, that says what is wrong and what to do. Called on the thread of the call that
 * fails, before that call returns. The text is valid during the call only. */
typedef void (*VitrailLog)(VitrailLogSeverity severity, const char* message, void* user);

typedef struct VitrailContextDesc {
  VkInstance instance;                           /* required */
  VkPhysicalDevice physicalDevice;               /* required */
  VkDevice device;                               /* required; outlives the context */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr; /* required: the library has no loader of its own */
  VkPipelineCache cache;                         /* optional; must outlive the context */
  const VkAllocationCallbacks* allocator;        /* optional; must outlive the context */
  VitrailLog log;                                /* optional; default: silence */
  void* logUser;
} VitrailContextDesc;

/* Builds what the targets of a device share. Errors: VK_ERROR_INITIALIZATION_FAILED for a missing required field,
 * VK_ERROR_FEATURE_NOT_PRESENT where the physical device lacks fragmentStoresAndAtomics or Vulkan 1.2, or what Vulkan
 * returned. On error *context is VK_NULL_HANDLE. */
VkResult vitrailCreateContext(const VitrailContextDesc* desc, VitrailContext* context);

/* Destroys the context. Its targets must have been destroyed. Null is ignored. */
void vitrailDestroyContext(VitrailContext context);

/* How a fragment is stored. The stored value of a fragment is what is blended: "exact" means equal to blending all the
 * stored fragments of a pixel in depth order. */
typedef enum VitrailNodeFormat {
  /* 12 bytes a node.
   *   colour  8 bits a channel on the sRGB curve (IEC 61966-2-1), decoded to linear light before it is blended. Values
   *           are clamped to [0, 1]; the error is at most 0.5/255 on the curve.
   *   alpha   8 bits, linear, clamped to [0, 1]; the error is at most 0.5/255.
   *   depth   the full 32-bit float of gl_FragCoord.z, clamped to [0, 1]; no error.
   * A NaN in colour or alpha is stored as 0, in depth as the value farthest from the viewer. A fragment whose alpha is
   * rounded to 0 (below 0.5/255) is neither stored nor counted. */
  VITRAIL_NODE_STANDARD = 0,
  VITRAIL_NODE_FORMAT_MAX_ENUM = 0x7fffffff
} VitrailNodeFormat;

typedef enum VitrailDepthOrder {
  VITRAIL_DEPTH_NEAREST_IS_ZERO = 0, /* conventional depth: 0 at the near plane */
  VITRAIL_DEPTH_NEAREST_IS_ONE = 1,  /* reversed depth: 1 at the near plane */
  VITRAIL_DEPTH_ORDER_MAX_ENUM = 0x7fffffff
} VitrailDepthOrder;

/* The most colour images that one target resolves into (a swapchain's worth). */
#define VITRAIL_MAX_COLOR_VIEWS 8
/* The most frames of statistics that one target keeps. */
#define VITRAIL_MAX_FRAMES_IN_FLIGHT 8

typedef struct VitrailTargetDesc {
  VkExtent2D extent;            /* pixels; required, each side at least 1 */
  VitrailNodeFormat nodeFormat; /* default: VITRAIL_NODE_STANDARD */
  VitrailDepthOrder depthOrder; /* default: VITRAIL_DEPTH_NEAREST_IS_ZERO */
  /* The number of fragments that the pool can hold in one frame, at least 0 and at most vitrailMaxNodeCapacity().
   * More fragments than that overflow the frame: it is resolved from what was stored, and its statistics say so. */
  uint32_t nodeCapacity;
  /* The images that vitrailCmdResolve() may blend into, at least one. Each is a single-sample 2D view of at least
   * `extent`, created with VK_IMAGE_USAGE_STORAGE_BIT, in `colorFormat`: VK_FORMAT_R16G16B16A16_SFLOAT or
   * VK_FORMAT_R32G32B32A32_SFLOAT. The views are the host's and outlive the target. */
  VkFormat colorFormat; /* default: VK_FORMAT_R16G16B16A16_SFLOAT */
  uint32_t colorViewCount;
  const VkImageView* colorViews; /* read during the call only */
  /* How many frames the host may have in flight: the statistics of that many frames are kept apart. Default 2. */
  uint32_t framesInFlight;
  /* Optional: the host's own memory for the node pool: a buffer with VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, of at least
   * nodeBufferOffset + vitrailNodePoolSize() bytes, with the offset a multiple of minStorageBufferOffsetAlignment. It
   * outlives the target. Default: the target allocates and frees device-local memory. */
  VkBuffer nodeBuffer;
  VkDeviceSize nodeBufferOffset;
  const char* debugName; /* optional: prefix of the objects' debug names; default "vitrail" */
} VitrailTargetDesc;

/* Allocates the buffers of one view; the first target of a colour format also compiles its resolve pipeline. Errors:
 * VK_ERROR_INITIALIZATION_FAILED for a field that is not as described, VK_ERROR_FORMAT_NOT_SUPPORTED,
 * VK_ERROR_OUT_OF_DEVICE_MEMORY where the pool exceeds a device limit or the memory that is left, or what Vulkan
 * returned; the log says which and by how much. On error *target is VK_NULL_HANDLE. */
VkResult vitrailCreateTarget(VitrailContext context, const VitrailTargetDesc* desc, VitrailTarget* target);

/* Destroys the target. No command buffer that was recorded with it may still be pending. Null is ignored. */
void vitrailDestroyTarget(VitrailTarget target);

/* Bytes that a pool of nodeCapacity nodes takes in a format. */
VkDeviceSize vitrailNodePoolSize(VitrailNodeFormat format, uint32_t nodeCapacity);

/* The most nodes that one pool can have on this device (maxStorageBufferRange, the largest allocation, the largest
 * device-local heap, and 2^32 - 2 indices). */
uint32_t vitrailMaxNodeCapacity(VitrailContext context, VitrailNodeFormat format);

typedef struct VitrailMemory {
  VkDeviceSize nodeBytes;  /* the node pool, the host's own included */
  VkDeviceSize headBytes;  /* 4 bytes a pixel */
  VkDeviceSize otherBytes; /* counters, parameters, statistics, and 4 bytes a pixel that may have a long list */
} VitrailMemory;

void vitrailTargetMemory(VitrailTarget target, VitrailMemory* memory);

/* The layout of the one descriptor set that vitrailCollect() needs, the same for every target of the context: put it
 * into the host's pipeline layouts at the set number that its shaders define as VITRAIL_SET. The fragment stage sees
 * one uniform and three storage buffers. Owned by the context. */
VkDescriptorSetLayout vitrailDescriptorSetLayout(VitrailContext context);

/* The set to bind at VITRAIL_SET while the transparent geometry is drawn into this target. Owned by the target, valid
 * and unchanged until it is destroyed. */
VkDescriptorSet vitrailTargetDescriptorSet(VitrailTarget target);

typedef struct VitrailBeginInfo {
  /* The host's number of this frame, which vitrailReadStats() takes. Frame numbers rise by 1; frames framesInFlight
   * apart share a slot, so the host begins frame n only when frame n - framesInFlight has finished on the GPU. */
  uint64_t frame;
} VitrailBeginInfo;

/* Starts a frame: empties the lists and the counters. Outside a rendering scope, on a queue with graphics and compute.
 * Waits (on the GPU) for the collect and resolve of the target's previous frame; makes the empty lists visible to
 * fragment shaders of later commands. `info` may be null (frame 0). */
void vitrailCmdBegin(VkCommandBuffer commandBuffer, VitrailTarget target, const VitrailBeginInfo* info);

/* Ends the collect pass. Outside a rendering scope, after the draws. Makes the lists that fragment shaders wrote
 * visible to the resolve. */
void vitrailCmdCollected(VkCommandBuffer commandBuffer, VitrailTarget target);

typedef struct VitrailResolveInfo {
  uint32_t colorView; /* which of the target's colorViews to blend into */
} VitrailResolveInfo;

/* Sorts every list and blends it over the colour image, which holds the opaque scene in linear light with
 * premultiplied alpha: a pixel d becomes C + T * d, where (C, T) composes its fragments front to back. Pixels without
 * fragments are left alone.
 *
 * Outside a rendering scope, after vitrailCmdCollected(). Binds a compute pipeline and its descriptor set; the host's
 * compute bindings are lost, the graphics ones are not. The image is in VK_IMAGE_LAYOUT_GENERAL, and earlier writes to
 * it are visible to (COMPUTE_SHADER, SHADER_READ | SHADER_WRITE). Afterwards it was written by (COMPUTE_SHADER,
 * SHADER_WRITE): the host's next barrier names that as its source. `info` may be null (view 0). */
void vitrailCmdResolve(VkCommandBuffer commandBuffer, VitrailTarget target, const VitrailResolveInfo* info);

typedef struct VitrailStats {
  uint64_t frame;
  uint32_t exact;              /* 1: every fragment of the frame was blended, in order; 0: see missing and cut */
  uint64_t fragmentsRequested; /* fragments that reached vitrailCollect() with a stored alpha above 0 */
  uint64_t fragmentsStored;    /* of those, the ones that had a node */
  uint64_t fragmentsMissing;   /* requested - stored */
  uint32_t layersMax;          /* stored fragments of the deepest pixel: the depth complexity if the frame is exact */
  uint32_t coveredPixels;      /* pixels with at least one stored fragment; stored / covered is the mean depth */
  /* Pixels that the driver did not let the resolve finish. Always 0 on a GPU. Mesa's CPU driver ends a
   * shader's loops after 65,535 turns in total, which is enough for lists of 15,000 fragments. */
  uint32_t cutPixels;
} VitrailStats;

/* Reads what the GPU reported about a frame. Never blocks: VK_NOT_READY until the frame's resolve has executed, and
 * when the slot of that frame has been taken by a later one. The values are complete once the host has seen the frame's
 * fence or semaphore; a host that polls earlier gets VK_NOT_READY or the complete values. */
VkResult vitrailReadStats(VitrailTarget target, uint64_t frame, VitrailStats* stats);

#ifdef __cplusplus
}
#endif

#endif
