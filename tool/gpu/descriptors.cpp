#include "descriptors.h"

#include "vk.h"

namespace vitrail::tool {

SingleSet::SingleSet(Gpu& gpu, const std::vector<std::pair<VkDescriptorType, VkShaderStageFlags>>& bindings,
                     const std::string& name)
    : device_(gpu.device()) {
  std::vector<VkDescriptorSetLayoutBinding> layoutBindings;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const auto& [type, stages] : bindings) {
    VkDescriptorSetLayoutBinding binding{};
    binding.binding = static_cast<std::uint32_t>(layoutBindings.size());
    binding.descriptorType = type;
    binding.descriptorCount = 1;
    binding.stageFlags = stages;
    layoutBindings.push_back(binding);
    sizes.push_back({type, 1});
    types_.push_back(type);
  }
  auto layoutInfo = vkStruct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  layoutInfo.bindingCount = static_cast<std::uint32_t>(layoutBindings.size());
  layoutInfo.pBindings = layoutBindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(device_, &layoutInfo, nullptr, &layout), "vkCreateDescriptorSetLayout");
  layout_ = {device_, layout, vkDestroyDescriptorSetLayout};
  setDebugName(device_, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout, name);

  auto poolInfo = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
  poolInfo.maxSets = 1;
  poolInfo.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  poolInfo.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device_, &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
  pool_ = {device_, pool, vkDestroyDescriptorPool};
  setDebugName(device_, VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool, name);

  auto setInfo = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
  setInfo.descriptorPool = pool;
  setInfo.descriptorSetCount = 1;
  setInfo.pSetLayouts = &layout;
  check(vkAllocateDescriptorSets(device_, &setInfo, &set_), "vkAllocateDescriptorSets");
  setDebugName(device_, VK_OBJECT_TYPE_DESCRIPTOR_SET, set_, name);
}

void SingleSet::writeBuffer(std::uint32_t binding, VkBuffer buffer, VkDeviceSize range) {
  const VkDescriptorBufferInfo info{buffer, 0, range};
  write(binding, &info, nullptr);
}

void SingleSet::writeImage(std::uint32_t binding, VkImageView view, VkImageLayout imageLayout) {
  const VkDescriptorImageInfo info{VK_NULL_HANDLE, view, imageLayout};
  write(binding, nullptr, &info);
}

void SingleSet::write(std::uint32_t binding, const VkDescriptorBufferInfo* buffer, const VkDescriptorImageInfo* image) {
  auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
  write.dstSet = set_;
  write.dstBinding = binding;
  write.descriptorCount = 1;
  write.descriptorType = types_.at(binding);
  write.pBufferInfo = buffer;
  write.pImageInfo = image;
  vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

} // namespace vitrail::tool
