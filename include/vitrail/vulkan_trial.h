/* Vitrail for Vulkan: which of several ways to draw takes the least time on a device, measured once and remembered.
 *
 * Fragment lists or the raster, lists built by fragment or by compute shaders, one resolve or the other: which is
 * faster hangs on the device, its driver and what is drawn, and no table of devices knows it. A trial has a renderer
 * draw its own frames in each way in turn, with time stamps around them, and tells which way was the fastest. It knows
 * nothing of what the ways are, submits nothing and waits for nothing.
 *
 *   vitrailVkCreateTrial        once, with what was remembered of the last run, if anything
 *   per frame, in one command buffer:
 *     vitrailVkTrialWay         before recording: the way in which this frame is drawn
 *     vitrailVkCmdTrialBegin    outside a rendering scope, before what the ways do differently
 *     (host)                    draws in that way
 *     vitrailVkCmdTrialEnd      outside a rendering scope
 *   vitrailVkReadTrial          VK_SUCCESS once it is over: how long each way takes
 *   vitrailVkTrialMemory        then: some bytes to keep, in a file of the host's
 *
 * Ways take turns from frame to frame, so that what slows the device down meets all of them, and the medians are
 * compared. A way may be drawn by other frames than the trial asks for: what counts is what vitrailVkCmdTrialBegin() is
 * told.
 *
 * Threads, null arguments, errors and the log are as in vulkan.h; a trial is used from one thread at a time. Recording
 * allocates nothing, waits for nothing and cannot fail. */
#ifndef VITRAIL_VULKAN_TRIAL_H
#define VITRAIL_VULKAN_TRIAL_H

#include <vitrail/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct VitrailVkTrial_T* VitrailVkTrial;

#define VITRAIL_VK_MAX_WAYS 8

typedef struct VitrailVkTrialDesc {
  const void* next;     /* null */
  uint32_t queueFamily; /* of the queue that the frames are submitted to: graphics or compute, with time stamps */
  uint32_t ways;        /* required: 2 to VITRAIL_VK_MAX_WAYS */
  /* Frames of each way that do not count, until memory has grown to what they need and caches are warm: default 4. And
   * frames that do: default 9. Each at most 1000. */
  uint32_t warmUps;
  uint32_t rounds;
  /* The host's number of what is measured: another one whenever its scene, its shaders or its ways are others. */
  uint64_t version;
  /* What vitrailVkTrialMemory() gave for a trial like this one, which may be freed after the call. Where it is of the
   * same device, driver, version and number of ways, the trial is over at once. Otherwise, or where it is damaged, it
   * is not looked at. Optional. */
  const void* memory;
  size_t memorySize;     /* bytes */
  const char* debugName; /* default "vitrail trial" */
} VitrailVkTrialDesc;

/* Makes a trial: a query pool and some kilobytes of memory that the host sees. Errors: VK_ERROR_INITIALIZATION_FAILED
 * for a field that is not as described, VK_ERROR_FEATURE_NOT_PRESENT where the queue family has no time stamps (a trial
 * that is remembered needs none), or what Vulkan returned; the log says which. On error *trial is null. */
VITRAIL_API VkResult vitrailVkCreateTrial(VitrailVkContext context, const VitrailVkTrialDesc* desc,
                                          VitrailVkTrial* trial);

/* Destroys the trial. No command buffer that was recorded with it may still be pending. Null is ignored. */
VITRAIL_API void vitrailVkDestroyTrial(VitrailVkTrial trial);

/* The way in which the next frame is to be drawn, counted from 0: while the trial goes on the one of which the fewest
 * frames were recorded, the lowest of several; then the fastest. Looks at what has finished, and waits for nothing. A
 * null trial: 0. */
VITRAIL_API uint32_t vitrailVkTrialWay(VitrailVkTrial trial);

/* Around what the ways do differently: time stamps, each once all commands before it are done. Both in one command
 * buffer, for a queue of queueFamily, outside a rendering scope. When the trial is over they record nothing. A way that
 * there is not, or an end without a begin, records nothing and logs an error. A frame whose end never came does not
 * count; the next begin logs a warning. Up to 64 frames may be in flight; of more the oldest do not count. */
VITRAIL_API void vitrailVkCmdTrialBegin(VkCommandBuffer commandBuffer, VitrailVkTrial trial, uint32_t way);
VITRAIL_API void vitrailVkCmdTrialEnd(VkCommandBuffer commandBuffer, VitrailVkTrial trial);

typedef struct VitrailVkTrialResult {
  void* next; /* null */
  uint32_t fastest;
  VkBool32 remembered;                      /* nothing was measured: it is from VitrailVkTrialDesc::memory */
  uint32_t rounds[VITRAIL_VK_MAX_WAYS];     /* frames of each way that were measured so far */
  double milliseconds[VITRAIL_VK_MAX_WAYS]; /* the median of each way; 0 where there is none yet */
} VitrailVkTrialResult;

/* What is known so far. VK_NOT_READY until each way has its rounds, which frames may never be that were not submitted:
 * they are drawn once more. Frames that have finished are seen once the host has seen their fence or semaphore, or
 * sooner. */
VITRAIL_API VkResult vitrailVkReadTrial(VitrailVkTrial trial, VitrailVkTrialResult* result);

/* What to give the next trial like this one. As vkGetPipelineCacheData(): with `data` null *size becomes the number of
 * bytes; else *size is the room at data, and becomes what was written. Errors: VK_NOT_READY while the trial goes on,
 * VK_INCOMPLETE where the room is too small. On either nothing is written and *size is 0. */
VITRAIL_API VkResult vitrailVkTrialMemory(VitrailVkTrial trial, size_t* size, void* data);

#ifdef __cplusplus
}
#endif

#endif
