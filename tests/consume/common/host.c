#include "host.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void hostFail(const Host* host, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fprintf(stderr, "%s: ", host->name);
  vfprintf(stderr, format, arguments);
  fprintf(stderr, "\n");
  va_end(arguments);
  exit(1);
}

void hostCheck(const Host* host, VkResult result, const char* what) {
  if (result != VK_SUCCESS) hostFail(host, "%s failed with VkResult %d", what, (int)result);
}

/* ---- The device ---------------------------------------------------------------------------------------------------
 */

static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                VkDebugUtilsMessageTypeFlagsEXT types,
                                                const VkDebugUtilsMessengerCallbackDataEXT* data, void* host) {
  (void)severity;
  (void)types;
  ++((Host*)host)->messages;
  fprintf(stderr, "%s: validation: %s\n", ((const Host*)host)->name, data->pMessage);
  return VK_FALSE;
}

static VkDebugUtilsMessengerCreateInfoEXT messengerInfo(Host* host) {
  VkDebugUtilsMessengerCreateInfoEXT info = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = onMessage;
  info.pUserData = host;
  return info;
}

static void openInstance(Host* host, uint32_t apiVersion) {
  PFN_vkCreateInstance createInstance =
      (PFN_vkCreateInstance)host->getInstanceProcAddr(VK_NULL_HANDLE, "vkCreateInstance");
  const char* layer = "VK_LAYER_KHRONOS_validation";
  const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(host);
  const VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                            .pNext = &messenger,
                                            .enabledValidationFeatureCount = 1,
                                            .pEnabledValidationFeatures = &enabled};
  const VkApplicationInfo application = {
      .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = host->name, .apiVersion = apiVersion};
  const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                     .pNext = &features,
                                     .pApplicationInfo = &application,
                                     .enabledLayerCount = 1,
                                     .ppEnabledLayerNames = &layer,
                                     .enabledExtensionCount = 2,
                                     .ppEnabledExtensionNames = extensions};
  const VkResult result = createInstance(&info, NULL, &host->instance);
  if (result == VK_ERROR_LAYER_NOT_PRESENT) hostFail(host, "%s is missing: install vulkan-validationlayers", layer);
  hostCheck(host, result, "vkCreateInstance");
#ifdef VK_NO_PROTOTYPES
  loadFunctions(host->instance, host->getInstanceProcAddr);
#endif
  PFN_vkCreateDebugUtilsMessengerEXT createMessenger =
      (PFN_vkCreateDebugUtilsMessengerEXT)host->getInstanceProcAddr(host->instance, "vkCreateDebugUtilsMessengerEXT");
  hostCheck(host, createMessenger(host->instance, &messenger, NULL, &host->messenger), "vkCreateDebugUtilsMessenger");
}

static bool findFamily(VkPhysicalDevice device, uint32_t* family) {
  VkQueueFamilyProperties families[16];
  uint32_t count = 16;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
  for (*family = 0; *family < count; ++*family) {
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if ((families[*family].queueFlags & both) == both) return true;
  }
  return false;
}

static void findDevice(Host* host, uint32_t apiVersion) {
  VkPhysicalDevice devices[16];
  uint32_t count = 16;
  if (vkEnumeratePhysicalDevices(host->instance, &count, devices) < 0) count = 0;
  for (uint32_t i = 0; i < count; ++i) {
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceProperties(devices[i], &properties);
    vkGetPhysicalDeviceFeatures(devices[i], &features);
    if (properties.apiVersion < apiVersion || !features.fragmentStoresAndAtomics) continue;
    host->physicalDevice = devices[i];
    if (findFamily(devices[i], &host->family)) return;
  }
  hostFail(host, "no Vulkan device for this test: install mesa-vulkan-drivers");
}

static void openDevice(Host* host, uint32_t apiVersion) {
  const VkPhysicalDeviceVulkan13Features features13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                       .dynamicRendering = VK_TRUE};
  const VkPhysicalDeviceFeatures features = {.fragmentStoresAndAtomics = VK_TRUE};
  const float priority = 1.0F;
  const VkDeviceQueueCreateInfo queueInfo = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                             .queueFamilyIndex = host->family,
                                             .queueCount = 1,
                                             .pQueuePriorities = &priority};
  const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                   .pNext = apiVersion >= VK_API_VERSION_1_3 ? &features13 : NULL,
                                   .queueCreateInfoCount = 1,
                                   .pQueueCreateInfos = &queueInfo,
                                   .pEnabledFeatures = &features};
  hostCheck(host, vkCreateDevice(host->physicalDevice, &info, NULL, &host->device), "vkCreateDevice");
  vkGetDeviceQueue(host->device, host->family, 0, &host->queue);
  const VkCommandPoolCreateInfo poolInfo = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .queueFamilyIndex = host->family};
  hostCheck(host, vkCreateCommandPool(host->device, &poolInfo, NULL, &host->pool), "vkCreateCommandPool");
}

void hostOpen(Host* host, const char* name, PFN_vkGetInstanceProcAddr getInstanceProcAddr, uint32_t apiVersion) {
  memset(host, 0, sizeof *host);
  host->name = name;
  host->getInstanceProcAddr = getInstanceProcAddr;
  openInstance(host, apiVersion);
  findDevice(host, apiVersion);
  openDevice(host, apiVersion);
}

int hostClose(Host* host) {
  vkDestroyCommandPool(host->device, host->pool, NULL);
  vkDestroyDevice(host->device, NULL);
  PFN_vkDestroyDebugUtilsMessengerEXT destroyMessenger =
      (PFN_vkDestroyDebugUtilsMessengerEXT)host->getInstanceProcAddr(host->instance, "vkDestroyDebugUtilsMessengerEXT");
  destroyMessenger(host->instance, host->messenger, NULL);
  vkDestroyInstance(host->instance, NULL);
  return host->messages == 0 ? 0 : 1;
}

static void printReason(VitrailLogSeverity severity, const char* message, void* host) {
  (void)severity;
  fprintf(stderr, "%s: the library says: %s\n", ((const Host*)host)->name, message);
}

VitrailVkContext hostCreateContext(Host* host) {
  const VitrailVkContextDesc desc = {.instance = host->instance,
                                     .physicalDevice = host->physicalDevice,
                                     .device = host->device,
                                     .getInstanceProcAddr = host->getInstanceProcAddr,
                                     .log = printReason,
                                     .logUser = host};
  VitrailVkContext context;
  hostCheck(host, vitrailVkCreateContext(&desc, &context), "vitrailVkCreateContext");
  return context;
}

/* ---- Memory -------------------------------------------------------------------------------------------------------
 */

static VkDeviceMemory allocate(const Host* host, const VkMemoryRequirements* needs, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(host->physicalDevice, &memory);
  VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs->size};
  for (; info.memoryTypeIndex < memory.memoryTypeCount; ++info.memoryTypeIndex) {
    const bool allowed = (needs->memoryTypeBits >> info.memoryTypeIndex & 1) != 0;
    if (allowed && (memory.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) == wanted) break;
  }
  if (info.memoryTypeIndex == memory.memoryTypeCount) hostFail(host, "no memory of the wanted kind");
  VkDeviceMemory result;
  hostCheck(host, vkAllocateMemory(host->device, &info, NULL, &result), "vkAllocateMemory");
  return result;
}

Buffer hostCreateBuffer(const Host* host, VkDeviceSize size, VkBufferUsageFlags usage, VkMemoryPropertyFlags memory) {
  Buffer buffer = {.size = size};
  const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
  hostCheck(host, vkCreateBuffer(host->device, &info, NULL, &buffer.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(host->device, buffer.buffer, &needs);
  buffer.memory = allocate(host, &needs, memory);
  hostCheck(host, vkBindBufferMemory(host->device, buffer.buffer, buffer.memory, 0), "vkBindBufferMemory");
  return buffer;
}

void hostDestroyBuffer(const Host* host, Buffer* buffer) {
  vkDestroyBuffer(host->device, buffer->buffer, NULL);
  vkFreeMemory(host->device, buffer->memory, NULL);
}

static VkImageAspectFlags aspectsOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D32_SFLOAT:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
      return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

Image hostCreateImage(const Host* host, VkExtent2D extent, VkFormat format, VkImageUsageFlags usage) {
  Image image = {.extent = extent, .format = format, .aspects = aspectsOf(format)};
  const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                  .imageType = VK_IMAGE_TYPE_2D,
                                  .format = format,
                                  .extent = {extent.width, extent.height, 1},
                                  .mipLevels = 1,
                                  .arrayLayers = 1,
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .usage = usage};
  hostCheck(host, vkCreateImage(host->device, &info, NULL, &image.image), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(host->device, image.image, &needs);
  image.memory = allocate(host, &needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  hostCheck(host, vkBindImageMemory(host->device, image.image, image.memory, 0), "vkBindImageMemory");
  const VkImageViewCreateInfo viewInfo = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                          .image = image.image,
                                          .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                          .format = format,
                                          .subresourceRange = {image.aspects, 0, 1, 0, 1}};
  hostCheck(host, vkCreateImageView(host->device, &viewInfo, NULL, &image.view), "vkCreateImageView");
  return image;
}

void hostDestroyImage(const Host* host, Image* image) {
  vkDestroyImageView(host->device, image->view, NULL);
  vkDestroyImage(host->device, image->image, NULL);
  vkFreeMemory(host->device, image->memory, NULL);
}

VkFormat hostDepthStencilFormat(const Host* host) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(host->physicalDevice, VK_FORMAT_D24_UNORM_S8_UINT, &properties);
  const bool has24 = (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
  return has24 ? VK_FORMAT_D24_UNORM_S8_UINT : VK_FORMAT_D32_SFLOAT_S8_UINT; /* every device has one of them */
}

/* ---- Commands -----------------------------------------------------------------------------------------------------
 */

VkCommandBuffer hostBegin(const Host* host) {
  const VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = host->pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 1};
  VkCommandBuffer commands;
  hostCheck(host, vkAllocateCommandBuffers(host->device, &info, &commands), "vkAllocateCommandBuffers");
  const VkCommandBufferBeginInfo beginInfo = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                              .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  hostCheck(host, vkBeginCommandBuffer(commands, &beginInfo), "vkBeginCommandBuffer");
  return commands;
}

void hostSubmit(const Host* host, VkCommandBuffer commands) {
  hostCheck(host, vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  const VkFenceCreateInfo fenceInfo = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence;
  hostCheck(host, vkCreateFence(host->device, &fenceInfo, NULL, &fence), "vkCreateFence");
  const VkSubmitInfo info = {
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
  hostCheck(host, vkQueueSubmit(host->queue, 1, &info, fence), "vkQueueSubmit");
  const uint64_t oneMinute = 60000000000U;
  hostCheck(host, vkWaitForFences(host->device, 1, &fence, VK_TRUE, oneMinute), "vkWaitForFences");
  vkDestroyFence(host->device, fence, NULL);
  vkFreeCommandBuffers(host->device, host->pool, 1, &commands);
}

void hostImageBarrier(VkCommandBuffer commands, const Image* image, const ImageBarrier* barrier) {
  const VkImageMemoryBarrier info = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                     .srcAccessMask = barrier->oldAccess,
                                     .dstAccessMask = barrier->newAccess,
                                     .oldLayout = barrier->oldLayout,
                                     .newLayout = barrier->newLayout,
                                     .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                     .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                     .image = image->image,
                                     .subresourceRange = {image->aspects, 0, 1, 0, 1}};
  vkCmdPipelineBarrier(commands, barrier->oldStages, barrier->newStages, 0, 0, NULL, 0, NULL, 1, &info);
}

void hostMemoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags oldStages, VkAccessFlags oldAccess,
                       VkPipelineStageFlags newStages, VkAccessFlags newAccess) {
  const VkMemoryBarrier info = {
      .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = oldAccess, .dstAccessMask = newAccess};
  vkCmdPipelineBarrier(commands, oldStages, newStages, 0, 1, &info, 0, NULL, 0, NULL);
}

/* ---- Pictures as numbers ------------------------------------------------------------------------------------------
 */

static double half(uint16_t bits) {
  const int exponent = bits >> 10 & 31;
  const double fraction = (bits & 1023) / 1024.0;
  const double magnitude = exponent == 0 ? ldexp(fraction, -14) : ldexp(1.0 + fraction, exponent - 15);
  return (bits & 0x8000) != 0 ? -magnitude : exponent == 31 ? NAN : magnitude;
}

static size_t channelBytes(const Host* host, VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8G8B8A8_UNORM:
      return 1;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return 2;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 4;
    default:
      hostFail(host, "pictures of VkFormat %d are not read", (int)format);
  }
}

static double channel(const uint8_t* bytes, size_t size) {
  if (size == 1) return *bytes / 255.0;
  if (size == 2) {
    uint16_t bits;
    memcpy(&bits, bytes, sizeof bits);
    return half(bits);
  }
  float value;
  memcpy(&value, bytes, sizeof value);
  return (double)value;
}

static void copyToBuffer(const Host* host, const Image* image, VkImageLayout layout, const Buffer* buffer) {
  VkCommandBuffer commands = hostBegin(host);
  /* Whoever wrote the picture has been waited for. Reader: the copy. */
  hostImageBarrier(commands, image,
                   &(ImageBarrier){layout, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                   VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT});
  const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                  .imageExtent = {image->extent.width, image->extent.height, 1}};
  vkCmdCopyImageToBuffer(commands, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer->buffer, 1, &copy);
  /* Writer: the copy. Reader: this program. */
  hostMemoryBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                    VK_ACCESS_HOST_READ_BIT);
  hostSubmit(host, commands);
}

double* hostReadPixels(const Host* host, const Image* image, VkImageLayout layout) {
  const size_t size = channelBytes(host, image->format);
  const size_t count = (size_t)image->extent.width * image->extent.height * 4;
  Buffer buffer = hostCreateBuffer(host, count * size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  copyToBuffer(host, image, layout, &buffer);
  void* mapped;
  hostCheck(host, vkMapMemory(host->device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  double* pixels = malloc(count * sizeof *pixels);
  if (pixels == NULL) hostFail(host, "out of memory");
  for (size_t i = 0; i < count; ++i) pixels[i] = channel((const uint8_t*)mapped + i * size, size);
  hostDestroyBuffer(host, &buffer);
  return pixels;
}
