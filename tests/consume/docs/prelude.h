/* What the guides' blocks of code in C and C++ take as given: the host's own variables and functions. */
#include <stdbool.h>
#include <stdint.h>

#include <vitrail/vulkan.h>
#include <vitrail/vulkan_raster.h>
#include <vitrail/vulkan_trial.h>
#include <vulkan/vulkan.h>

#ifdef __cplusplus
#include <string>
#include <vector>

#include <vitrail/vitrail.hpp>
extern vitrail::vulkan::Context ownedContext;
std::vector<unsigned char> readCache(const std::string& name);
void writeCache(const std::string& name, const std::vector<unsigned char>& bytes);
void drawTransparent(VkCommandBuffer commands, VkDescriptorSet lists);
extern "C" {
#else
void drawTransparent(VkCommandBuffer commands);
#endif

extern VkInstance instance;
extern VkPhysicalDevice physicalDevice;
extern VkDevice device;
extern VkResult result;

extern VitrailVkContextDesc contextDesc;
extern VitrailVkContext context;
extern VitrailVkTargetDesc targetDesc;
extern VitrailVkTargetDesc desc;
extern VitrailVkTarget target;
extern VitrailVkBeginInfo begin;
extern VitrailVkResolveInfo resolve;
extern VitrailBounds bounds;
extern uint64_t frame;
extern uint32_t framesInFlight;
extern uint32_t queueFamily;
extern bool hasPostDepthCoverage;

extern VkExtent2D extent;
extern VkExtent2D newExtent;
extern VkFormat colorFormat;
extern VkFormat depthStencilFormat;
extern VkImage colorImage;
extern VkImage hdrImage;
extern VkImageView hdrView;
extern VkImageView newView;
extern VkImageView multisampledColorView;
extern VkImageView multisampledDepthView;
extern VkBuffer poolBuffer;
extern VkDeviceSize firstFreeByte;
extern VkDeviceSize poolBufferSize;

extern VkPipeline pickPipeline;
extern VkPipelineLayout pickLayout;
extern VkDescriptorSet pickedSet;
extern const int32_t cursor[2];
extern VkBuffer readbackBuffer;
extern const void* readbackMapped;

extern VkRenderPass resolvePass;
extern VkRenderingInfo colorAndDepth;
extern VkRenderingInfo colorLoaded;
extern VkDescriptorSetLayout materialSetLayout;
extern VkPipelineLayout transparentLayout;
extern VkPipelineShaderStageCreateInfo fragmentStage;
extern VkPipelineDepthStencilStateCreateInfo depthStencil;
extern VkCommandBuffer commands;

extern VitrailVkRaster raster;
extern VitrailVkRasterInfo info;
extern const VitrailVkRasterStage stages[5];
extern const float planes[1][4];
extern uint32_t drawCount;
extern uint32_t instanceCount;
extern uint32_t triangleCount;
extern uint32_t vertexCount;
extern uint32_t indexCount;
extern uint32_t firstIndex;
extern int32_t vertexOffset;
extern uint32_t firstInstance;
extern uint32_t material;
extern uint32_t mostDraws;
extern VkBuffer culledDraws;
extern VkBuffer culledCount;
extern VkBuffer drawBuffer;
extern VkBuffer indexBuffer;
extern VkDescriptorSet materialSet;
extern VkImage depthImage;
extern VkImageView depthView;

void printReason(VitrailLogSeverity severity, const char* message, void* user);
void warn(const char* format, ...);
void imageBarrier(VkCommandBuffer commandBuffer, VkImage image, VkImageLayout oldLayout, VkImageLayout newLayout,
                  VkPipelineStageFlags oldStages, VkAccessFlags oldAccess, VkPipelineStageFlags newStages,
                  VkAccessFlags newAccess);
void drawOpaque(VkCommandBuffer commandBuffer);
void drawByLists(VkCommandBuffer commandBuffer);
void drawByRaster(VkCommandBuffer commandBuffer);
void drawInterface(VkCommandBuffer commandBuffer);
void waitForFenceOf(uint64_t pastFrame);
void printObject(uint32_t object);
void recordFrame(VitrailVkTarget drawnTarget, uint64_t frameNumber);
void recordRasterFrame(VitrailVkRaster drawnRaster, uint64_t frameNumber);
void submitAndWait(void);
VkCommandBuffer submitAndBegin(VkCommandBuffer recorded);
void drawTransparentFrame(VitrailVkTarget drawnTarget, const VitrailVkBeginInfo* info);
void graphUsesBuffer(VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, VkPipelineStageFlags source,
                     VkPipelineStageFlags destination);

#ifdef __cplusplus
}
#endif
