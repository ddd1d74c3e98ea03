// A descriptor set layout with one pool and one set of it.
#pragma once

#include <string>
#include <vector>

#include "device.h"
#include "unique.h"

namespace vitrail::tool {

class SingleSet {
 public:
  SingleSet() = default;
  // `bindings` are numbered by their place: binding 0 first.
  SingleSet(Gpu& gpu, const std::vector<std::pair<VkDescriptorType, VkShaderStageFlags>>& bindings,
            const std::string& name);

  VkDescriptorSetLayout layout() const { return layout_.get(); }
  VkDescriptorSet set() const { return set_; }

  // Points a binding at a buffer or an image. No command buffer that uses the set may be pending.
  void writeBuffer(std::uint32_t binding, VkBuffer buffer, VkDeviceSize range);
  void writeImage(std::uint32_t binding, VkImageView view, VkImageLayout imageLayout);

 private:
  // What the binding's type is of; the other is null.
  void write(std::uint32_t binding, const VkDescriptorBufferInfo* buffer, const VkDescriptorImageInfo* image);

  VkDevice device_ = VK_NULL_HANDLE;
  std::vector<VkDescriptorType> types_;
  Unique<VkDescriptorSetLayout> layout_;
  Unique<VkDescriptorPool> pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace vitrail::tool
