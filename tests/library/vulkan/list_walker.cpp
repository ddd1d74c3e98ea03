#include "list_walker.h"

#include <array>
#include <cstring>
#include <span>

#include "shaders/walk.comp.h"
#include "shaders/walk_address.comp.h"
#include "shaders/walk_sorted.comp.h"
#include "shaders/walk_sorted_address.comp.h"

namespace vitrail::tests::vulkan {

namespace {

constexpr std::uint32_t kLayerWords = sizeof(VitrailLayer) / sizeof(std::uint32_t);
constexpr std::uint32_t kPixelWords = 2 + kLayerWords * PointHost::kMostWalked;

struct WalkConstants {
  VitrailRect area;
  std::uint32_t most;
};

Owned<VkDescriptorSetLayout> makeSetLayout(const Device& device) {
  VkDescriptorSetLayoutBinding binding{};
  binding.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  binding.descriptorCount = 1;
  binding.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
  auto info = zeroed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  info.bindingCount = 1;
  info.pBindings = &binding;
  return make(device, vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout, info);
}

Owned<VkPipelineLayout> makeWalkLayout(const Device& device, const std::array<VkDescriptorSetLayout, 2>& sets) {
  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(WalkConstants)};
  auto info = zeroed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  return make(device, vkCreatePipelineLayout, vkDestroyPipelineLayout, info);
}

std::span<const std::uint32_t> walkCode(const WalkKind& kind) {
  if (kind.sorted && kind.byAddress) return shaders::walk_sorted_address_comp;
  if (kind.sorted) return shaders::walk_sorted_comp;
  if (kind.byAddress) return shaders::walk_address_comp;
  return shaders::walk_comp;
}

Owned<VkPipeline> makeWalkPipeline(const Device& device, VkPipelineLayout layout, const WalkKind& kind) {
  const std::span<const std::uint32_t> code = walkCode(kind);
  auto moduleInfo = zeroed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  moduleInfo.codeSize = code.size_bytes();
  moduleInfo.pCode = code.data();
  const auto shader = make(device, vkCreateShaderModule, vkDestroyShaderModule, moduleInfo);
  auto info = zeroed<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
  info.stage = zeroed<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = shader.get();
  info.stage.pName = "main";
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device.get(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateComputePipelines");
  return Owned<VkPipeline>(pipeline, {device.get(), vkDestroyPipeline});
}

Owned<VkDescriptorPool> makePool(const Device& device) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
  auto info = zeroed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
  info.maxSets = 1;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  return make(device, vkCreateDescriptorPool, vkDestroyDescriptorPool, info);
}

} // namespace

ListWalker::ListWalker(const Device& device, VkDescriptorSetLayout set, const WalkKind& kind)
    : device_(device),
      setLayout_(makeSetLayout(device)),
      layout_(makeWalkLayout(device, {set, setLayout_.get()})),
      pipeline_(makeWalkPipeline(device, layout_.get(), kind)),
      pool_(makePool(device)) {
  auto info = zeroed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
  info.descriptorPool = pool_.get();
  info.descriptorSetCount = 1;
  VkDescriptorSetLayout own = setLayout_.get();
  info.pSetLayouts = &own;
  check(vkAllocateDescriptorSets(device.get(), &info, &set_), "vkAllocateDescriptorSets");
}

void ListWalker::cmdWalk(VkCommandBuffer commands, VkDescriptorSet set, const VitrailRect& area) {
  pixels_ = area.width * area.height;
  walked_ = Buffer(device_, std::uint64_t{pixels_} * kPixelWords * sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::Host);
  const VkDescriptorBufferInfo buffer{walked_.get(), 0, VK_WHOLE_SIZE};
  auto write = zeroed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
  write.dstSet = set_;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = &buffer;
  vkUpdateDescriptorSets(device_.get(), 1, &write, 0, nullptr);
  const std::array<VkDescriptorSet, 2> sets = {set, set_};
  const WalkConstants constants{area, PointHost::kMostWalked};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0,
                          static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
  vkCmdDispatch(commands, (area.width + 7) / 8, (area.height + 7) / 8, 1);
  // Writer: the walk. Reader: the host.
  cmdBarrier(commands, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT}, kHostAccess);
}

std::vector<std::optional<std::vector<VitrailLayer>>> ListWalker::read() const {
  std::vector<std::optional<std::vector<VitrailLayer>>> lists(pixels_);
  const auto* words = static_cast<const std::uint32_t*>(walked_.mapped());
  for (std::uint32_t pixel = 0; pixel < pixels_; ++pixel, words += kPixelWords) {
    if (words[0] > PointHost::kMostWalked || words[1] != 0) continue;
    std::vector<VitrailLayer> layers(words[0]);
    std::memcpy(layers.data(), words + 2, layers.size() * sizeof(VitrailLayer));
    lists[pixel] = std::move(layers);
  }
  return lists;
}

} // namespace vitrail::tests::vulkan
