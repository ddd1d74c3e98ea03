/* What the hosts share that is not particular to any of them: a device under validation, images and buffers, one submit
 * that is waited for, and pictures as numbers. Whatever fails ends the program with one line. */
#ifndef HOST_H
#define HOST_H

#include <stdbool.h>
#include <stdint.h>

#include <vitrail/vulkan.h>
#include <vulkan/vulkan.h>

#ifdef VK_NO_PROTOTYPES
#include "loader.h" /* of the host that brings one */
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct Host {
  const char* name;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  VkInstance instance;
  VkDebugUtilsMessengerEXT messenger;
  VkPhysicalDevice physicalDevice;
  VkDevice device;
  uint32_t family; /* graphics and compute */
  VkQueue queue;
  VkCommandPool pool;
  unsigned messages; /* of the validation layer; they stand on standard error */
} Host;

/* Opens the first device that has the Vulkan version, under the validation layer with synchronization validation. The
 * device has fragmentStoresAndAtomics and, from Vulkan 1.3 on, dynamic rendering; nothing else. */
void hostOpen(Host* host, const char* name, PFN_vkGetInstanceProcAddr getInstanceProcAddr, uint32_t apiVersion);

/* Destroys what hostOpen() made. The program's exit code: 1 if the validation layer has said anything. */
int hostClose(Host* host);

/* Ends the program with one line on standard error. */
#if defined(__GNUC__)
__attribute__((noreturn, format(printf, 2, 3)))
#endif
void hostFail(const Host* host, const char* format, ...);

/* Fails if `result` is not VK_SUCCESS. */
void hostCheck(const Host* host, VkResult result, const char* what);

/* The library's context on the host's device; it prints the reason of a failure. */
VitrailVkContext hostCreateContext(Host* host);

typedef struct Buffer {
  VkBuffer buffer;
  VkDeviceMemory memory;
  VkDeviceSize size;
} Buffer;

/* `memory`: what the allocation must be. */
Buffer hostCreateBuffer(const Host* host, VkDeviceSize size, VkBufferUsageFlags usage, VkMemoryPropertyFlags memory);
void hostDestroyBuffer(const Host* host, Buffer* buffer);

typedef struct Image {
  VkImage image;
  VkDeviceMemory memory;
  VkImageView view;
  VkExtent2D extent;
  VkFormat format;
  VkImageAspectFlags aspects;
} Image;

Image hostCreateImage(const Host* host, VkExtent2D extent, VkFormat format, VkImageUsageFlags usage);
void hostDestroyImage(const Host* host, Image* image);

/* A format with depth and stencil that the device can draw to. */
VkFormat hostDepthStencilFormat(const Host* host);

VkCommandBuffer hostBegin(const Host* host);

/* Ends, submits, waits and frees. */
void hostSubmit(const Host* host, VkCommandBuffer commands);

/* A barrier on the whole image. */
typedef struct ImageBarrier {
  VkImageLayout oldLayout;
  VkPipelineStageFlags oldStages;
  VkAccessFlags oldAccess;
  VkImageLayout newLayout;
  VkPipelineStageFlags newStages;
  VkAccessFlags newAccess;
} ImageBarrier;

void hostImageBarrier(VkCommandBuffer commands, const Image* image, const ImageBarrier* barrier);

void hostMemoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags oldStages, VkAccessFlags oldAccess,
                       VkPipelineStageFlags newStages, VkAccessFlags newAccess);

/* The picture, four numbers a pixel, in rows from the top: 32-bit and 16-bit floats and 8-bit UNORM formats with the
 * channels r, g, b, a. The image has VK_IMAGE_USAGE_TRANSFER_SRC_BIT, is in `layout`, and nothing uses it. To be
 * freed. */
double* hostReadPixels(const Host* host, const Image* image, VkImageLayout layout);

#ifdef __cplusplus
}
#endif

#endif
