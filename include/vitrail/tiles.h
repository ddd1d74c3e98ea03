/* Tiles: a picture whose fragments do not fit into a memory budget is drawn in rectangles that do, one after the other
 * through the same small pool: each is collected and resolved by recording a frame with its area (for Vulkan
 * VitrailVkBeginInfo::area). The plan says which, and splits the ones that overflow. The picture is the same, bit for
 * bit, as without tiles.
 *
 * A plan makes no calls to a graphics API and keeps no reference to a context. One thread at a time. */
#ifndef VITRAIL_TILES_H
#define VITRAIL_TILES_H

#include <vitrail/types.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct VitrailTilePlan_T* VitrailTilePlan;

/* An axis-aligned box around transparent geometry, and the matrix (column-major, as GLSL's mat4) from its space to clip
 * space (x and y in [-w, w], depth in [0, w]). */
typedef struct VitrailBounds {
  float min[3];
  float max[3];
  float clipFromBox[16];
} VitrailBounds;

/* What a device can hold, as its backend says: vitrailVkTileLimits(). */
typedef struct VitrailTileLimits {
  void* next;            /* null */
  uint64_t memoryBytes;  /* of one allocation */
  uint64_t alignment;    /* of the parts of a target's memory; a power of two */
  uint32_t nodeCapacity; /* of one pool, in the node format and at the sample count of the plan */
  uint32_t areaPixels;   /* that head pointers can be kept for */
} VitrailTileLimits;

typedef struct VitrailTilePlanDesc {
  const void* next; /* null */
  uint32_t width;   /* of the picture, in pixels; required */
  uint32_t height;
  uint32_t samples; /* 1, 2, 4 or 8; default 1 */
  VitrailNodeFormat nodeFormat;
  uint32_t userWords; /* not 0: nodes carry a word of the host's */
  /* Bytes for one tile's nodes, head pointers and lists; at least 64 KiB. It is clamped to what the device can hold. */
  uint64_t memoryBudget;
  VitrailTileLimits limits; /* required */
  /* Only the smallest rectangle that these cover is drawn. Boxes that reach behind the eye cover everything. Default
   * (0): the whole picture, and always with samples > 1 resolved per pixel, which writes every pixel. */
  uint32_t boundsCount;
  const VitrailBounds* bounds; /* read during the call only */
  /* The fragments that the picture is expected to have, where that is known (from a frame that overflowed). Default 0:
   * the first tile is as large as its head pointers allow. */
  uint64_t expectedFragments;
  VitrailLog log; /* optional; default: silence */
  void* logUser;
} VitrailTilePlanDesc;

/* Errors: VITRAIL_ERROR_INVALID for a null argument, an empty extent, limits that are not filled in or an unknown
 * format, VITRAIL_ERROR_OUT_OF_MEMORY for a budget below 64 KiB, VITRAIL_ERROR_FORMAT for a node format without nodes
 * at that sample count. On error *plan is null. */
VITRAIL_API VitrailResult vitrailCreateTilePlan(const VitrailTilePlanDesc* desc, VitrailTilePlan* plan);
/* Null is ignored. */
VITRAIL_API void vitrailDestroyTilePlan(VitrailTilePlan plan);

/* What a target that draws the plan's tiles is made with: these two, and VITRAIL_OVERFLOW_SKIP. 0 for a null plan. */
VITRAIL_API uint32_t vitrailTilePlanNodeCapacity(VitrailTilePlan plan);
VITRAIL_API uint32_t vitrailTilePlanAreaPixels(VitrailTilePlan plan);

/* The next tile to draw. 0: all are done (or an argument is null). */
VITRAIL_API uint32_t vitrailNextTile(VitrailTilePlan plan, VitrailRect* tile);

/* Tells what became of the tile that vitrailNextTile() gave last. One that overflowed (fragmentsMissing > 0) is
 * split, and its parts are drawn next. VITRAIL_ERROR_OUT_OF_MEMORY: it was a single pixel; the log has the bytes that
 * it needs. VITRAIL_ERROR_INVALID for a null argument, for a frame that was misused, and for fragments that are missing
 * though the pool had room for them: no splitting helps there. */
VITRAIL_API VitrailResult vitrailFinishTile(VitrailTilePlan plan, const VitrailStats* stats);

/* The smallest rectangle of whole pixels that contains the projections of the boxes, clipped to a picture of that
 * extent; a width of 0 where nothing is visible. A null `area` is ignored. */
VITRAIL_API void vitrailProjectBounds(uint32_t count, const VitrailBounds* bounds, uint32_t width, uint32_t height,
                                      VitrailRect* area);

#ifdef __cplusplus
}
#endif

#endif
