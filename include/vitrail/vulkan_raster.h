/* Vitrail for Vulkan 1.2 and later: exact order-independent transparency by a rasteriser in compute shaders.
 *
 * Beside vulkan.h, whose contexts it takes. Where that has the hardware's rasteriser draw into lists, this sets up the
 * triangles itself, sorts what covers each pixel of a tile in registers, and has the host's function shade it front to
 * back until nothing behind can change the picture. Nothing is stored for each fragment. It pays where triangles are
 * small and many, on GPUs with far more compute than raster hardware: docs/performance.md has the measurements, and
 * docs/raster.md takes a renderer through it.
 *
 *   shaders/vitrail/raster.glsl   what the host's shader includes: vitrailPosition() and vitrailShade()
 *   vitrailVkCreateRaster         once per view: extent, samples, the host's shader in five stages
 *   per frame, in one command buffer:
 *     vitrailVkUpdateRaster       before recording: lets the memory follow what frames need
 *     (host)  opaque geometry into colour and depth
 *     vitrailVkCmdRaster          outside a rendering scope: draws the transparent geometry over the opaque colour
 *   vitrailVkReadRasterStats      later, whenever the frame has finished: what it needed, and whether it was exact
 *
 * Exact: every triangle is drawn, in every pixel that hardware would cover, at any number of layers. A frame that needs
 * more memory than there is says so in its statistics (`exact` is 0, and what it leaves in the colour image is not the
 * picture); vitrailVkUpdateRaster() then makes room, or plans bands of rows where the budget has none, and the frame
 * that is drawn next is exact if it needs no more. A host that draws one picture repeats it until it is.
 *
 * Deterministic: the same frame gives the same bits, in whatever order its draws come and however many bands it takes.
 *
 * Threads, null arguments, errors and the log are as in vulkan.h. Frames of one raster are submitted to one queue, in
 * the order of recording. Recording allocates nothing, waits for nothing and cannot fail. */
#ifndef VITRAIL_VULKAN_RASTER_H
#define VITRAIL_VULKAN_RASTER_H

#include <vitrail/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct VitrailVkRaster_T* VitrailVkRaster;

/* ---- Draws ------------------------------------------------------------------------------------------------------ */

typedef enum VitrailVkRasterDrawFlagBits {
  VITRAIL_VK_RASTER_LINES = 1 << 0,           /* else triangles: pairs of vertices, a pixel wide */
  VITRAIL_VK_RASTER_POINTS = 1 << 1,          /* squares of VitrailVkRasterInfo::pointSize */
  VITRAIL_VK_RASTER_FRONT_CLOCKWISE = 1 << 2, /* else a front is counter-clockwise in the picture */
  VITRAIL_VK_RASTER_CULL_FRONT = 1 << 3,
  VITRAIL_VK_RASTER_CULL_BACK = 1 << 4,
  VITRAIL_VK_RASTER_DRAW_FLAG_MAX_ENUM = 0x7fffffff
} VitrailVkRasterDrawFlagBits;

/* A draw, as it lies in a buffer of the host's (48 bytes; std430 in shaders, VitrailRasterDraw). The first five are
 * those of VkDrawIndexedIndirectCommand. At most 2^30 triangles, and 2^30 vertices, of all instances of a draw. */
typedef struct VitrailVkRasterDraw {
  uint32_t count; /* of indices; what is left over of the last triangle or line is ignored */
  uint32_t instanceCount;
  uint32_t firstIndex;
  int32_t vertexOffset;
  uint32_t firstInstance;
  uint32_t vertexCount; /* greater than any of the draw's indices: positions of so many are kept for each instance */
  uint32_t flags;       /* VitrailVkRasterDrawFlagBits */
  uint32_t blend;       /* VitrailBlend, one of VitrailVkRasterDesc::blendModes */
  uint32_t word;        /* the host's: what its functions are given */
  uint32_t reserved[3];
} VitrailVkRasterDraw;

/* ---- Raster ----------------------------------------------------------------------------------------------------- */

/* SPIR-V of the host's shader for one stage. */
typedef struct VitrailVkRasterStage {
  const uint32_t* code;
  size_t size;                                /* bytes */
  const VkSpecializationInfo* specialization; /* of the host's own constants; optional */
} VitrailVkRasterStage;

/* What a host knows of its frames beforehand, so that the first has room. All optional: what is missing is found out.
 */
typedef struct VitrailVkRasterHints {
  uint32_t draws;
  uint32_t instances; /* of all draws together, and so on */
  uint64_t triangles;
  uint64_t vertices;
} VitrailVkRasterHints;

typedef struct VitrailVkRasterDesc {
  const void* next;              /* null */
  VkExtent2D extent;             /* pixels; required, each side 1 to 16384: the viewport is all of it */
  VkSampleCountFlagBits samples; /* 1, 2, 4 or 8, at Vulkan's standard places; default 1 */
  VkFormat colorFormat;          /* VK_FORMAT_R16G16B16A16_SFLOAT, the default, or VK_FORMAT_R32G32B32A32_SFLOAT */
  VkFormat depthFormat;          /* of the opaque depth; default VK_FORMAT_D32_SFLOAT */
  VitrailDepthOrder depthOrder;  /* default: VITRAIL_DEPTH_NEAREST_IS_ZERO */
  /* The layouts of the host's own descriptor sets, from set 0 on; the raster's comes behind them, which is the
   * VITRAIL_SET of the host's shader. At most 7. They may be destroyed after the call. */
  uint32_t setLayoutCount;
  const VkDescriptorSetLayout* setLayouts;
  /* The host's shader, compiled with VITRAIL_RASTER_STAGE 0 to 4. `positions` may be left out (code null): positions
   * are then asked for wherever they are needed and not kept, 16 bytes for each vertex of each instance; better where
   * vitrailPosition() does nothing but read them. The others are required. Code and specializations may be freed after
   * the call. The host's specialization constants have ids below 1710. */
  VitrailVkRasterStage positions;
  VitrailVkRasterStage setUp;
  VitrailVkRasterStage setUpLarge;
  VitrailVkRasterStage blend;
  VitrailVkRasterStage blendDeep;
  VkIndexType indexType; /* VK_INDEX_TYPE_UINT16, which is 0 and so the default, VK_INDEX_TYPE_UINT32, or
                            VK_INDEX_TYPE_NONE_KHR: draws have the vertices 0 to count - 1 */
  /* Which blend modes fragments may have, 1 << VitrailBlend each; default (0): all. Others than VITRAIL_BLEND_OVER
   * alone take longer, as there is no bound then of what is hidden but all of it. */
  uint32_t blendModes;
  VkBool32 solids; /* whether draws may be lines and points; else all are triangles, whatever their flags */
  /* Bytes of device memory for all that the raster keeps but positions, tables of draws and some kilobytes of counters.
   * Default 0: three quarters of what the device has. */
  VkDeviceSize memoryBudget;
  VitrailVkRasterHints hints;
  uint32_t framesInFlight; /* at most VITRAIL_MAX_FRAMES_IN_FLIGHT; default 2 */
  const char* debugName;   /* default "vitrail raster" */
} VitrailVkRasterDesc;

/* Storage buffers that each stage of the host's shader binds beside the host's own, which together are at most
 * maxPerStageDescriptorStorageBuffers. */
#define VITRAIL_VK_RASTER_STORAGE_BUFFERS 18

/* Makes the memory and the pipelines of one view. Errors: VK_ERROR_INITIALIZATION_FAILED for a field that is not as
 * described, VK_ERROR_FEATURE_NOT_PRESENT where the device binds fewer than 27 storage buffers to a shader (which the
 * library's own kernels need) or has no subgroup shuffles in compute shaders, VK_ERROR_FORMAT_NOT_SUPPORTED,
 * VK_ERROR_OUT_OF_DEVICE_MEMORY where the budget has no room for the tiles of a row, or what Vulkan returned; the log
 * says which. On error *raster is null. */
VITRAIL_API VkResult vitrailVkCreateRaster(VitrailVkContext context, const VitrailVkRasterDesc* desc,
                                           VitrailVkRaster* raster);

/* Destroys the raster. No command buffer that was recorded with it may still be pending. Null is ignored. */
VITRAIL_API void vitrailVkDestroyRaster(VitrailVkRaster raster);

/* Prepares the raster for recording `frame` (as VitrailVkRasterInfo has it): reads the statistics of the newest frame
 * that has finished, and where that had too little room makes more, up to the budget and to what the device has left,
 * beyond which frames are drawn in bands of rows (of the latter the log has a warning). Memory that frames in flight
 * use is freed when they have finished. The first time that frames need it, it makes the pipelines of deep tiles, which
 * takes as long as the driver's compiler does. Waits for nothing else. Between the bands of a frame it does nothing.
 * Errors: VK_ERROR_OUT_OF_DEVICE_MEMORY where a frame has no room even in bands of one row of tiles, or its positions
 * have none (the log says what to do); the raster stays as it was. */
VITRAIL_API VkResult vitrailVkUpdateRaster(VitrailVkRaster raster, uint64_t frame);

/* Gives the raster another extent from the next frame on, in bands where the device has no memory for all of it. A
 * frame of which bands are still to be recorded has ended with it. Errors: as vitrailVkCreateRaster. */
VITRAIL_API VkResult vitrailVkResizeRaster(VitrailVkRaster raster, VkExtent2D extent);

/* Bytes of device memory: for fragments and tiles (which the budget bounds), for draws and positions, and what frames
 * in flight still use of what was replaced. */
typedef struct VitrailVkRasterMemory {
  void* next; /* null */
  VkDeviceSize tileBytes;
  VkDeviceSize drawBytes;
  VkDeviceSize retiredBytes;
  VkDeviceSize totalBytes;
} VitrailVkRasterMemory;
VITRAIL_API void vitrailVkRasterMemory(VitrailVkRaster raster, VitrailVkRasterMemory* memory);

/* The bands of rows in which a frame is drawn that is recorded now, top to bottom: 1 where there is room for all. */
VITRAIL_API uint32_t vitrailVkRasterBands(VitrailVkRaster raster);

/* ---- Recording -------------------------------------------------------------------------------------------------- */

typedef struct VitrailVkRasterInfo {
  const void* next; /* null */
  /* The host's number of this frame, as VitrailVkBeginInfo::frame. A second time: nothing of the first one, no band
   * either, was submitted. */
  uint64_t frame;
  /* The host's sets, setLayoutCount of them, from set 0 on, with their dynamic offsets. */
  const VkDescriptorSet* sets;
  uint32_t dynamicOffsetCount;
  const uint32_t* dynamicOffsets;
  /* The draws, in a buffer with VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, at an offset that is a multiple of
   * minStorageBufferOffsetAlignment. Any order. */
  VkBuffer draws; /* required if drawCount > 0 */
  VkDeviceSize drawOffset;
  uint32_t drawCount; /* with countBuffer: the most */
  /* Where the GPU has worked out how many draws there are: a uint32_t at such an offset of such a buffer. Optional. */
  VkBuffer countBuffer;
  VkDeviceSize countOffset;
  /* Whether draws are those of the raster's last frame, bit for bit: their tables are not made again. */
  VkBool32 sameDraws;
  /* Indices of all draws, in such a buffer at such an offset. Shaders read them as words: from there on the buffer has
   * a multiple of 4 bytes. Required unless indexType says that there are none. */
  VkBuffer indices;
  VkDeviceSize indexOffset;
  /* An order for each instance number, a uint32_t each, in such a buffer: of more than 32 surfaces at one depth those
   * of lower orders are in front. Instances of one order are of one draw. Optional: the order of the draws, and so the
   * one thing in which their order shows. */
  VkBuffer orders;
  VkDeviceSize orderOffset;
  /* The most linear light that a surface sends to the eye (1 where colours are at most 1): what is hidden by so much
   * that all such light together would change the picture by less than 0.35 / 255 on the sRGB curve is left out.
   * Default 0: nobody knows, and only what is hidden altogether is left out. */
  float mostLight;
  float pointSize;              /* pixels; default 1 */
  uint32_t clipPlaneCount;      /* at most the VITRAIL_CLIP_PLANES of the host's shader */
  const float (*clipPlanes)[4]; /* of clip space: what has dot(plane, position) >= 0 is kept */
  /* The images, as VitrailVkViews has them: the colour that is drawn over, or, of several samples, into, in
   * VK_IMAGE_LAYOUT_GENERAL with VK_IMAGE_USAGE_STORAGE_BIT; the opaque depth (depth aspect, of `samples` samples), in
   * VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL with VK_IMAGE_USAGE_SAMPLED_BIT; of several samples the opaque
   * colour, in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL with VK_IMAGE_USAGE_SAMPLED_BIT. Required. They outlive the
   * frame. The colour is premultiplied and linear, of which alpha is how much of the pixel is covered. */
  VkImageView color;
  VkImageView depth;
  VkImageView opaque;
  /* For a frame in several submissions, each of which records a part of its bands, in order: the first, and how many.
   * Default (0, 0): all. The other fields are the same in all of them. */
  uint32_t firstBand;
  uint32_t bandCount;
  /* Optional: called when the commands of a pass have been recorded, with its name, for time stamps and labels. */
  void (*onPass)(const char* pass, VkCommandBuffer commandBuffer, void* user);
  void* user;
} VitrailVkRasterInfo;

/* Draws a frame: outside a rendering scope, on a queue with compute. What the host's functions read, the draws, the
 * indices and the images were made visible to (COMPUTE_SHADER, SHADER_READ | SHADER_WRITE | UNIFORM_READ) before.
 * Afterwards color was written by (COMPUTE_SHADER, SHADER_WRITE): the host's next barrier names that as its source. The
 * host's compute bindings are lost. A call that lacks something records nothing and logs an error, and the frame is
 * misused and not exact. */
VITRAIL_API void vitrailVkCmdRaster(VkCommandBuffer commandBuffer, VitrailVkRaster raster,
                                    const VitrailVkRasterInfo* info);

/* ---- Statistics ------------------------------------------------------------------------------------------------- */

typedef struct VitrailVkRasterStats {
  void* next; /* null */
  uint64_t frame;
  /* 1: the picture is right: all that was to be drawn had room, and no driver cut a pass short. */
  VkBool32 exact;
  /* 1: a call was wrong and recorded nothing, and the rest is 0; or draws were wrong and left out: they have indices
   * beyond the buffer or, where positions are kept, that are not below vertexCount, or a blend that is none of
   * blendModes. The log says which; of draws when the statistics are first read, here or by vitrailVkUpdateRaster. */
  VkBool32 misused;
  /* How far the picture may be from that of all surfaces, in steps of 8-bit colour (1/255 on the sRGB curve), before it
   * is rounded to colorFormat: what is hidden and left out; 0 where nobody knows mostLight. */
  float errorBound;
  uint32_t bands; /* in which it was drawn */
  uint32_t draws;
  uint64_t instances;
  uint64_t vertices;       /* whose positions were kept */
  uint64_t records;        /* triangles in tiles, of the band that has most of them, as all that follow */
  uint32_t largeTriangles; /* that were clipped, or may touch more than 64 tiles */
  uint32_t deepTiles;      /* whose fragments were collected */
  uint64_t deepFragments;
  uint32_t deepestPixel; /* the fragments of the pixel of a deep tile that has most; 0 without deep tiles */
  uint32_t cutPixels;    /* that a driver did not let the shaders finish */
} VitrailVkRasterStats;

/* Reads what the GPU reported about a frame: as vitrailVkReadStats(). VK_NOT_READY until it has finished. */
VITRAIL_API VkResult vitrailVkReadRasterStats(VitrailVkRaster raster, uint64_t frame, VitrailVkRasterStats* stats);

#ifdef __cplusplus
}
#endif

#endif
