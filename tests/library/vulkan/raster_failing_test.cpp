// Vulkan runs out of memory at any call while a raster is made, grows or makes the pipelines of deep tiles: the call
// says so, nothing is left behind, and the raster goes on as it was. Where memory is short for what a frame needs, it
// is drawn in bands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <random>

#include "raster_host.h"

namespace vitrail::tests::vulkan {
namespace {

// Calls until one fails, which is the last to; negative: none does. And objects that there are.
int callsUntilFailure = -1;
int liveObjects = 0;

// Of all memory together, and what the next bytes get.
constexpr VkDeviceSize kUnbounded = std::numeric_limits<VkDeviceSize>::max();
VkDeviceSize mostBytes = kUnbounded;
VkDeviceSize liveBytes = 0;
VkResult whenShort = VK_ERROR_OUT_OF_DEVICE_MEMORY;
std::map<VkDeviceMemory, VkDeviceSize> memories;

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
VITRAIL_FAILING_CREATE(CreateBuffer, VkBufferCreateInfo, VkBuffer)
VITRAIL_FAILING_CREATE(CreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
VITRAIL_FAILING_CREATE(CreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
VITRAIL_FAILING_CREATE(CreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
VITRAIL_FAILING_CREATE(CreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
VITRAIL_COUNTED_DESTROY(DestroyBuffer, VkBuffer)
VITRAIL_COUNTED_DESTROY(DestroyDescriptorPool, VkDescriptorPool)
VITRAIL_COUNTED_DESTROY(DestroyDescriptorSetLayout, VkDescriptorSetLayout)
VITRAIL_COUNTED_DESTROY(DestroyPipeline, VkPipeline)
VITRAIL_COUNTED_DESTROY(DestroyPipelineLayout, VkPipelineLayout)
VITRAIL_COUNTED_DESTROY(DestroyShaderModule, VkShaderModule)
#undef VITRAIL_FAILING_CREATE
#undef VITRAIL_COUNTED_DESTROY

VKAPI_ATTR VkResult VKAPI_CALL failingAllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                                     const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
  if (failsNow()) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  if (info->allocationSize > mostBytes - std::min(mostBytes, liveBytes)) return whenShort;
  const VkResult result = counted(vkAllocateMemory(device, info, allocator, memory), *memory);
  if (result == VK_SUCCESS) liveBytes += memories[*memory] = info->allocationSize;
  return result;
}
VKAPI_ATTR void VKAPI_CALL countedFreeMemory(VkDevice device, VkDeviceMemory memory,
                                             const VkAllocationCallbacks* allocator) {
  if (memory != VK_NULL_HANDLE) {
    --liveObjects;
    liveBytes -= memories[memory];
    memories.erase(memory);
  }
  vkFreeMemory(device, memory, allocator);
}

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
    mostBytes = kUnbounded;
    whenShort = VK_ERROR_OUT_OF_DEVICE_MEMORY;
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
        if (result == VK_SUCCESS) { // with less to spare, or in more bands
          for (const LogLine& line : backend().takeLog()) EXPECT_EQ(line.severity, VITRAIL_LOG_WARNING) << line.text;
          break;
        }
        EXPECT_EQ(result, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        expectOnlyError();
      }
    }
    EXPECT_EQ(host.stats().exact, VK_TRUE);
    EXPECT_EQ(host.stats().deepTiles, 1U);
    EXPECT_GT(failures, 5); // of pipelines alone
  }
  EXPECT_EQ(liveObjects, before_);
}

// Triangles of all sizes at depths of their own, of a picture with eight rows of tiles.
constexpr std::uint32_t kBandedSide = 64;
RasterScene manyTriangles(std::uint32_t count) {
  std::mt19937 random(11);
  const auto unit = [&] { return static_cast<float>(random() % 1024) / 1024.0F; };
  RasterScene scene;
  VitrailVkRasterDraw draw{};
  draw.count = draw.vertexCount = 3 * count;
  draw.instanceCount = 1;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float depth = static_cast<float>(i + 1) / static_cast<float>(count + 1);
    for (int corner = 0; corner < 3; ++corner) {
      scene.vertices.push_back({2.0F * unit() - 1.0F, 2.0F * unit() - 1.0F, depth, 1.0F});
      scene.indices.push_back(static_cast<std::uint32_t>(scene.indices.size()));
    }
  }
  scene.draws = {draw};
  scene.colors = {{1.0F, 0.5F, 0.25F, 1.0F / 64.0F}};
  return scene;
}

RasterHostDesc hostOf(const Context& context) {
  RasterHostDesc desc;
  desc.context = &context;
  desc.width = desc.height = kBandedSide;
  return desc;
}

TEST_F(RasterFailingTest, FramesWithoutMemoryAreDrawnInBands) {
  const RasterScene scene = manyTriangles(1500);
  const VkDeviceSize before = liveBytes;
  RasterHost whole(hostOf(context_));
  whole.setScene(scene);
  const std::vector<float> expected = whole.draw();
  ASSERT_EQ(whole.stats().bands, 1U);
  const VkDeviceSize needed = liveBytes - before;
  for (const VkResult code : {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_TOO_MANY_OBJECTS}) {
    SCOPED_TRACE(code);
    RasterHost host(hostOf(context_));
    host.setScene(scene);
    mostBytes = before + needed + needed / 2;
    whenShort = code;
    EXPECT_TRUE(host.draw() == expected);
    EXPECT_GT(host.stats().bands, 1U);
    const std::vector<LogLine> log = backend().takeLog();
    EXPECT_FALSE(log.empty());
    for (const LogLine& line : log) {
      EXPECT_EQ(line.severity, VITRAIL_LOG_WARNING) << line.text;
      EXPECT_NE(line.text.find("has no memory for all that a frame needs"), std::string::npos) << line.text;
    }
    // And goes on like that, also where the memory is there again.
    mostBytes = kUnbounded;
    EXPECT_TRUE(host.draw() == expected);
  }
}

// Pages leave places free. A row for which the device has no pages has as many places as records.
TEST_F(RasterFailingTest, ARowWithoutMemoryForPagesIsCounted) {
  RasterHostDesc row = hostOf(context_);
  row.height = 8;
  const RasterScene scene = manyTriangles(2000);
  const VkDeviceSize before = liveBytes;
  RasterHost whole(row);
  whole.setScene(scene);
  const std::vector<float> expected = whole.draw();
  const VkDeviceSize needed = liveBytes - before;
  const VkDeviceSize pages = whole.raster().memory().tileBytes;
  RasterHost host(row);
  host.setScene(scene);
  host.drawOnce(); // asks for tables
  ASSERT_EQ(host.raster().update(), VK_SUCCESS);
  mostBytes = before + needed + (needed - pages) + pages * 2 / 3;
  EXPECT_TRUE(host.draw() == expected);
  EXPECT_EQ(host.stats().exact, VK_TRUE);
  EXPECT_LT(host.raster().memory().tileBytes, pages * 2 / 3);
}

TEST_F(RasterFailingTest, ExtentsWithoutMemoryAreDrawnInBands) {
  RasterHost host(hostOf(context_));
  host.setScene(manyTriangles(100));
  const std::vector<float> expected = host.draw();
  const VkDeviceSize tileBytes = host.raster().memory().tileBytes;
  mostBytes = 0;
  EXPECT_EQ(host.raster().resize({4 * kBandedSide, 4 * kBandedSide}), VK_SUCCESS);
  EXPECT_GT(host.raster().bands(), 1U);
  EXPECT_EQ(host.raster().memory().tileBytes, tileBytes);
  const std::vector<LogLine> log = backend().takeLog();
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].severity, VITRAIL_LOG_WARNING);
  // One whose rows are too long for what there is: the raster stays as it was.
  EXPECT_EQ(host.raster().resize({16384, 2 * kBandedSide}), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  expectOnlyError();
  EXPECT_EQ(host.raster().resize({kBandedSide, kBandedSide}), VK_SUCCESS);
  EXPECT_TRUE(host.draw() == expected);
}

TEST_F(RasterFailingTest, WithoutMemoryForARowNothingChanges) {
  RasterHost host(hostOf(context_));
  host.setScene(manyTriangles(100));
  const std::vector<float> small = host.draw();
  host.setScene(manyTriangles(100'000));
  host.drawOnce(); // asks for tables
  ASSERT_EQ(host.raster().update(), VK_SUCCESS);
  host.drawOnce();
  EXPECT_EQ(host.stats().exact, VK_FALSE);
  mostBytes = 0;
  const VitrailVkRasterMemory memory = host.raster().memory();
  EXPECT_EQ(host.raster().update(), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  expectOnlyError();
  EXPECT_EQ(host.raster().memory().tileBytes, memory.tileBytes);
  EXPECT_EQ(host.raster().memory().drawBytes, memory.drawBytes);
  EXPECT_EQ(host.raster().bands(), 1U);
  // What there is room for is drawn as before.
  host.setScene(manyTriangles(100));
  EXPECT_TRUE(host.drawOnce() == small);
  EXPECT_EQ(host.stats().exact, VK_TRUE);
}

} // namespace
} // namespace vitrail::tests::vulkan
