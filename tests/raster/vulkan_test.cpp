// Coverage by the rasteriser against that of the machine's Vulkan device: a GPU, or lavapipe.
#include <cstring>
#include <map>
#include <memory>
#include <string>

#include "../library/vulkan/objects.h"
#include "coverage.h"
#include "shaders/coverage.frag.h"
#include "shaders/coverage.vert.h"

namespace vitrail::tests::raster {
namespace {

using vulkan::check;
using vulkan::Device;
using vulkan::make;
using vulkan::Owned;
using vulkan::zeroed;

Owned<VkShaderModule> makeShader(const Device& device, std::span<const std::uint32_t> code) {
  auto info = zeroed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  return make(device, vkCreateShaderModule, vkDestroyShaderModule, info);
}

// Draws triangles without attachments; their fragments count themselves.
class DeviceCoverage {
 public:
  DeviceCoverage() {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                                               nullptr};
    auto layout = zeroed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    layout.bindingCount = 1;
    layout.pBindings = &binding;
    setLayout_ = make(device_, vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout, layout);
    makePipelineLayout();
    makeSet();
  }

  // Whether the device can draw without attachments with so many samples.
  bool has(std::uint32_t samples) const {
    return (device_.limits().framebufferNoAttachmentsSampleCounts & samples) != 0;
  }
  Sums cover(const CoverageFrame& frame);
  std::vector<std::string> takeErrors() { return device_.takeErrors(); }

 private:
  void makePipelineLayout() {
    const VkPushConstantRange range{VK_SHADER_STAGE_FRAGMENT_BIT, 0, 4};
    const VkDescriptorSetLayout set = setLayout_.get();
    auto info = zeroed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    info.setLayoutCount = 1;
    info.pSetLayouts = &set;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    layout_ = make(device_, vkCreatePipelineLayout, vkDestroyPipelineLayout, info);
  }

  void makeSet() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    auto pool = zeroed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    pool_ = make(device_, vkCreateDescriptorPool, vkDestroyDescriptorPool, pool);
    const VkDescriptorSetLayout layout = setLayout_.get();
    auto info = zeroed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    info.descriptorPool = pool_.get();
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    check(vkAllocateDescriptorSets(device_.get(), &info, &set_), "vkAllocateDescriptorSets");
  }

  VkPipeline pipeline(std::uint32_t samples);
  void bind(const vulkan::Buffer& sums);

  Device device_;
  vulkan::Commands commands_{device_};
  Owned<VkDescriptorSetLayout> setLayout_;
  Owned<VkPipelineLayout> layout_;
  Owned<VkDescriptorPool> pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  std::map<std::uint32_t, Owned<VkPipeline>> pipelines_;
};

VkPipeline DeviceCoverage::pipeline(std::uint32_t samples) {
  auto& made = pipelines_[samples];
  if (made) return made.get();
  const auto vertexShader = makeShader(device_, shaders::coverage_vert);
  const auto fragmentShader = makeShader(device_, shaders::coverage_frag);
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  for (auto& stage : stages) {
    stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stage.pName = "main";
  }
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = vertexShader.get();
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = fragmentShader.get();
  const VkVertexInputBindingDescription binding{0, sizeof(Position), VK_VERTEX_INPUT_RATE_VERTEX};
  const VkVertexInputAttributeDescription attribute{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0};
  auto input = zeroed<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  input.vertexBindingDescriptionCount = 1;
  input.pVertexBindingDescriptions = &binding;
  input.vertexAttributeDescriptionCount = 1;
  input.pVertexAttributeDescriptions = &attribute;
  auto assembly =
      zeroed<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  auto viewports = zeroed<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  viewports.viewportCount = 1;
  viewports.scissorCount = 1;
  auto raster =
      zeroed<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  raster.lineWidth = 1.0F;
  auto multisample =
      zeroed<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  multisample.rasterizationSamples = static_cast<VkSampleCountFlagBits>(samples);
  auto blend = zeroed<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
  constexpr std::array<VkDynamicState, 2> kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  auto dynamic = zeroed<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
  dynamic.dynamicStateCount = kDynamic.size();
  dynamic.pDynamicStates = kDynamic.data();
  const auto rendering = zeroed<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
  auto info = zeroed<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
  info.pNext = &rendering;
  info.stageCount = stages.size();
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewports;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &multisample;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout_.get();
  VkPipeline handle = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device_.get(), VK_NULL_HANDLE, 1, &info, nullptr, &handle),
        "vkCreateGraphicsPipelines");
  made = Owned<VkPipeline>(handle, {device_.get(), vkDestroyPipeline});
  return handle;
}

void DeviceCoverage::bind(const vulkan::Buffer& sums) {
  const VkDescriptorBufferInfo buffer{sums.get(), 0, VK_WHOLE_SIZE};
  auto write = zeroed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
  write.dstSet = set_;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = &buffer;
  vkUpdateDescriptorSets(device_.get(), 1, &write, 0, nullptr);
}

Sums DeviceCoverage::cover(const CoverageFrame& frame) {
  const vulkan::Buffer vertices(device_, frame.positions.size() * sizeof(Position), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                vulkan::Memory::Host);
  std::memcpy(vertices.mapped(), frame.positions.data(), frame.positions.size() * sizeof(Position));
  const std::size_t bytes = frame.pixels() * sizeof(PixelSum);
  const vulkan::Buffer sums(device_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, vulkan::Memory::Host);
  std::memset(sums.mapped(), 0, bytes);
  bind(sums);
  commands_.run([&](VkCommandBuffer commands) {
    auto rendering = zeroed<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = {{}, {frame.width, frame.height}};
    rendering.layerCount = 1;
    vkCmdBeginRendering(commands, &rendering);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline(frame.samples));
    const auto corner = -static_cast<float>(frame.origin);
    const auto width = static_cast<float>(frame.picture == 0 ? frame.width : frame.picture);
    const auto height = static_cast<float>(frame.picture == 0 ? frame.height : frame.picture);
    const VkViewport viewport{corner, corner, width, height, 0.0F, 1.0F};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &rendering.renderArea);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &set_, 0, nullptr);
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, 4, &frame.width);
    const VkBuffer buffer = vertices.get();
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
    vkCmdDraw(commands, static_cast<std::uint32_t>(frame.positions.size()), 1, 0, 0);
    vkCmdEndRendering(commands);
    // From the fragment shader's sums to the host that reads them.
    cmdBarrier(commands, {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
               vulkan::kHostAccess);
  });
  Sums covered(frame.pixels());
  std::memcpy(covered.data(), sums.mapped(), bytes);
  return covered;
}

class VulkanCoverageTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { device_ = std::make_unique<DeviceCoverage>(); }
  static void TearDownTestSuite() { device_.reset(); }
  void TearDown() override {
    for (const std::string& error : device_->takeErrors()) ADD_FAILURE() << error;
  }

  // Only triangles that need no clipping.
  void compare(const CoverageFrame& frame, const std::string& what) {
    if (!device_->has(frame.samples)) return;
    Raster raster(VITRAIL_CPU_BEST);
    EXPECT_EQ(differences(coveredBy(raster, frame), device_->cover(frame)), 0U)
        << what << ", " << frame.samples << " samples";
    triangles_ += frame.triangles();
  }

  static std::unique_ptr<DeviceCoverage> device_;
  std::size_t triangles_ = 0;
};

std::unique_ptr<DeviceCoverage> VulkanCoverageTest::device_;

TEST_F(VulkanCoverageTest, IsTheDevices) {
  for (const TriangleKind& kind : triangleKinds()) {
    if (!kind.isInView) continue;
    for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
      Random random(100 + samples);
      for (std::uint32_t round = 0; round < roundsOfTests(); ++round) {
        compare(kind.make(random, samples), kind.name + std::string(", round ") + std::to_string(round));
      }
    }
  }
  std::printf("  %zu triangles\n", triangles_);
}

// Where drivers clip, the new corners are rounded in their own ways: both are near the truth.
TEST_F(VulkanCoverageTest, IsNearTheDevicesWhereTrianglesAreClipped) {
  Random random(7);
  for (const bool isNear : {true, false}) {
    const CoverageFrame frame = isNear ? throughTheNearPlane(random) : beyondTheGuardBand(random);
    const Distances device = distancesOf(frame, [](const CoverageFrame& one) { return device_->cover(one); });
    device.print(isNear ? "near plane, device" : "guard band, device");
    std::uint64_t differ = 0;
    const Distances ours = distancesOf(frame, [&differ](const CoverageFrame& one) {
      const Sums sums = coveredByRules(one);
      const Sums theirs = device_->cover(one);
      for (std::size_t i = 0; i < sums.size(); ++i) {
        differ += static_cast<std::uint64_t>((sums[i].count > 0) != (theirs[i].count > 0));
      }
      return sums;
    });
    ours.print(isNear ? "near plane, ours" : "guard band, ours");
    std::printf("  between the two %llu samples differ\n", static_cast<unsigned long long>(differ));
    EXPECT_LT(ours.farthest, 1.0 / 128.0);
    EXPECT_LE(differ, ours.wrong + device.wrong);
  }
}

} // namespace
} // namespace vitrail::tests::raster
