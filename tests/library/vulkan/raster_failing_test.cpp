// Vulkan runs out of memory at any call while a raster is made, grows or makes the pipelines of deep tiles: the call
// says so, nothing is left behind, and the raster goes on as it was.
#include <gtest/gtest.h>

#include <cstring>

#include "raster_host.h"

namespace vitrail::tests::vulkan {
namespace {

// Calls until one fails, which is the last to; negative: none does. And objects that there are.
int callsUntilFailure = -1;
int liveObjects = 0;

bool failsNow() { return callsUntilFailure >= 0 && callsUntilFailure-- == 0; }

template <class Handle>
VkResult counted(VkResult result, const Handle& handle) {
  if (result == VK_SUCCESS && handle != VK_NULL_HANDLE) ++liveObjects;
  return result;
}

#define VITRAIL_FAILING_CREATE(name, Info, Handle)                                                       \
  VKAPI_ATTR VkResult VKAPI_CALL failing##name(VkDevice device, const Info* info,                        \
                                               const VkAllocationCallbacks* allocator, Handle* handle) { \
    if (failsNow()) return VK_ERROR_OUT_OF_DEVICE_MEMORY;                                                \
    return counted(vk##name(device, info, allocator, handle), *handle);                                  \
  }
#define VITRAIL_COUNTED_DESTROY(name, Handle)                                                                        \
  VKAPI_ATTR void VKAPI_CALL counted##name(VkDevice device, Handle handle, const VkAllocationCallbacks* allocator) { \
    if (handle != VK_NULL_HANDLE) --liveObjects;                                                                     \
    vk##name(device, handle, allocator);                                                                             \
  }
VITRAIL_FAILING_CREATE(AllocateMemory, VkMemoryAllocateInfo, VkDeviceMemory)
VITRAIL_FAILING_CREATE(CreateBuffer, VkBufferCreateInfo, VkBuffer)
VITRAIL_FAILING_CREATE(CreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
VITRAIL_FAILING_CREATE(CreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
VITRAIL_FAILING_CREATE(CreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
VITRAIL_FAILING_CREATE(CreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
VITRAIL_COUNTED_DESTROY(FreeMemory, VkDeviceMemory)
VITRAIL_COUNTED_DESTROY(DestroyBuffer, VkBuffer)
VITRAIL_COUNTED_DESTROY(DestroyDescriptorPool, VkDescriptorPool)
VITRAIL_COUNTED_DESTROY(DestroyDescriptorSetLayout, VkDescriptorSetLayout)
VITRAIL_COUNTED_DESTROY(DestroyPipeline, VkPipeline)
VITRAIL_COUNTED_DESTROY(DestroyPipelineLayout, VkPipelineLayout)
VITRAIL_COUNTED_DESTROY(DestroyShaderModule, VkShaderModule)
#undef VITRAIL_FAILING_CREATE
#undef VITRAIL_COUNTED_DESTROY

VKAPI_ATTR VkResult VKAPI_CALL failingCreateComputePipelines(VkDevice device, VkPipelineCache cache,
                                                             std::uint32_t count,
                                                             const VkComputePipelineCreateInfo* infos,
                                                             const VkAllocationCallbacks* allocator,
                                                             VkPipeline* pipelines) {
  *pipelines = VK_NULL_HANDLE;
  if (failsNow()) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  return counted(vkCreateComputePipelines(device, cache, count, infos, allocator, pipelines), *pipelines);
}
VKAPI_ATTR VkResult VKAPI_CALL failingAllocateDescriptorSets(VkDevice device, const VkDescriptorSetAllocateInfo* info,
                                                             VkDescriptorSet* sets) {
  if (failsNow()) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  return vkAllocateDescriptorSets(device, info, sets);
}

PFN_vkVoidFunction VKAPI_CALL failingDeviceProc(VkDevice device, const char* name) {
#define VITRAIL_REPLACED(prefix, function) \
  if (std::strcmp(name, "vk" #function) == 0) return reinterpret_cast<PFN_vkVoidFunction>(prefix##function);
  VITRAIL_REPLACED(failing, AllocateMemory)
  VITRAIL_REPLACED(failing, AllocateDescriptorSets)
  VITRAIL_REPLACED(failing, CreateBuffer)
  VITRAIL_REPLACED(failing, CreateComputePipelines)
  VITRAIL_REPLACED(failing, CreateDescriptorPool)
  VITRAIL_REPLACED(failing, CreateDescriptorSetLayout)
  VITRAIL_REPLACED(failing, CreatePipelineLayout)
  VITRAIL_REPLACED(failing, CreateShaderModule)
  VITRAIL_REPLACED(counted, FreeMemory)
  VITRAIL_REPLACED(counted, DestroyBuffer)
  VITRAIL_REPLACED(counted, DestroyDescriptorPool)
  VITRAIL_REPLACED(counted, DestroyDescriptorSetLayout)
  VITRAIL_REPLACED(counted, DestroyPipeline)
  VITRAIL_REPLACED(counted, DestroyPipelineLayout)
  VITRAIL_REPLACED(counted, DestroyShaderModule)
#undef VITRAIL_REPLACED
  return vkGetDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL failingInstanceProc(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(failingDeviceProc);
  return vkGetInstanceProcAddr(instance, name);
}

class RasterFailingTest : public VulkanTest {
 protected:
  void SetUp() override {
    callsUntilFailure = -1;
    VitrailVkContextDesc desc = backend().contextDesc();
    desc.getInstanceProcAddr = failingInstanceProc;
    ASSERT_EQ(Context::create(desc, context_), VK_SUCCESS);
    before_ = liveObjects;
  }
  void expectOnlyError() {
    const std::vector<LogLine> log = backend().takeLog();
    EXPECT_EQ(log.size(), 1U);
  }

  Context context_;
  int before_ = 0;
};

TEST_F(RasterFailingTest, Creation) {
  RasterHost layouts({});
  const VitrailVkRasterDesc desc = RasterHost::descOf({}, layouts.layout());
  int calls = 0;
  for (VkResult result = VK_ERROR_UNKNOWN; result != VK_SUCCESS; ++calls) {
    ASSERT_LT(calls, 300);
    SCOPED_TRACE(calls);
    vitrail::vulkan::Raster raster;
    callsUntilFailure = calls;
    result = vitrail::vulkan::Raster::create(context_, desc, raster);
    if (callsUntilFailure >= 0) break; // it took no more calls
    EXPECT_EQ(result, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    EXPECT_FALSE(raster);
    EXPECT_EQ(liveObjects, before_);
    expectOnlyError();
  }
  callsUntilFailure = -1;
  EXPECT_GT(calls, 60);
  EXPECT_EQ(liveObjects, before_);
}

TEST_F(RasterFailingTest, GrowthAndTheFirstDeepTiles) {
  const std::uint32_t layers = backend().device().isCpu() ? 3000 : 17'000; // in one tile: more than are not deep
  RasterScene scene;
  scene.indices = {0, 1, 2};
  for (std::uint32_t i = 0; i < layers; ++i) {
    const float depth = static_cast<float>(i + 1) / static_cast<float>(layers + 1);
    scene.vertices.insert(scene.vertices.end(),
                          {{-1.0F, -1.0F, depth, 1.0F}, {-0.8F, -1.0F, depth, 1.0F}, {-1.0F, -0.8F, depth, 1.0F}});
    VitrailVkRasterDraw draw{};
    draw.count = 3;
    draw.instanceCount = 1;
    draw.vertexCount = 3;
    draw.vertexOffset = static_cast<std::int32_t>(3 * i);
    scene.draws.push_back(draw);
  }
  scene.colors = {{1.0F, 0.5F, 0.25F, 1.0F / 256.0F}};
  {
    RasterHostDesc desc;
    desc.context = &context_;
    RasterHost host(desc);
    host.setScene(scene);
    int failures = 0;
    for (int frame = 0; frame < 12; ++frame) {
      host.drawOnce();
      if (host.stats().exact == VK_TRUE) break;
      for (int calls = 0;; ++calls) {
        callsUntilFailure = calls;
        const VkResult result = host.raster().update();
        const bool failed = callsUntilFailure < 0;
        callsUntilFailure = -1;
        if (!failed) {
          EXPECT_EQ(result, VK_SUCCESS);
          break;
        }
        ++failures;
        EXPECT_EQ(result, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        expectOnlyError();
      }
    }
    EXPECT_EQ(host.stats().exact, VK_TRUE);
    EXPECT_EQ(host.stats().deepTiles, 1U);
    EXPECT_GT(failures, 10);
  }
  EXPECT_EQ(liveObjects, before_);
}

} // namespace
} // namespace vitrail::tests::vulkan
