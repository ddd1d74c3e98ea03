#include "storage.h"

#include <algorithm>

namespace vitrail {

namespace {

VkResult createDescriptorPool(const VitrailContext_T& context, Storage& storage) {
  const std::array<VkDescriptorPoolSize, 4> sizes = {
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VITRAIL_BINDING_LONG_LISTS},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, std::max(storage.viewCount, 1U)},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 * std::max(storage.viewCount, 1U)},
  };
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = 1 + storage.viewCount;
  info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  return context.vk.CreateDescriptorPool(context.device, &info, context.allocator, &storage.pool);
}

void writeBufferSet(const VitrailContext_T& context, const Storage& storage) {
  const auto part = [&](const StoragePart& p) {
    return VkDescriptorBufferInfo{storage.buffer, storage.offset + p.offset, p.size};
  };
  std::array<VkDescriptorBufferInfo, VITRAIL_BINDING_LONG_LISTS + 1> buffers = {
      part(storage.layout.parameters), part(storage.layout.control), part(storage.layout.heads),
      part(storage.layout.nodes),      part(storage.layout.sums),    part(storage.layout.mediumLists),
      part(storage.layout.longLists),
  };
  // Shaders that reach the pool by its address do not look at its binding, which cannot name all of a large one.
  buffers[VITRAIL_BINDING_NODES].range =
      std::min(buffers[VITRAIL_BINDING_NODES].range, context.limits.storageBufferRange);
  std::array<VkWriteDescriptorSet, buffers.size()> writes{};
  for (std::uint32_t i = 0; i < buffers.size(); ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = storage.set;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType =
        i == VITRAIL_BINDING_PARAMETERS ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[i].pBufferInfo = &buffers[i];
  }
  context.vk.UpdateDescriptorSets(context.device, static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

void writeViewSet(const VitrailContext_T& context, VkDescriptorSet set, const VitrailViews& views, std::uint32_t view) {
  std::array<VkDescriptorImageInfo, VITRAIL_VIEW_BINDINGS> images{};
  std::array<VkWriteDescriptorSet, VITRAIL_VIEW_BINDINGS> writes{};
  std::uint32_t count = 0;
  const auto add = [&](std::uint32_t binding, VkImageView image, VkImageLayout layout) {
    images[count] = {VK_NULL_HANDLE, image, layout};
    writes[count].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[count].dstSet = set;
    writes[count].dstBinding = binding;
    writes[count].descriptorCount = 1;
    writes[count].descriptorType =
        binding == VITRAIL_VIEW_BINDING_COLOR ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    writes[count].pImageInfo = &images[count];
    ++count;
  };
  if (views.color != nullptr) add(VITRAIL_VIEW_BINDING_COLOR, views.color[view], VK_IMAGE_LAYOUT_GENERAL);
  if (views.opaque != nullptr)
    add(VITRAIL_VIEW_BINDING_OPAQUE, views.opaque[view], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  if (views.depth != nullptr) {
    add(VITRAIL_VIEW_BINDING_DEPTH, views.depth[view], VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  } else if (views.opaque != nullptr) { // nobody looks at it, but shaders name it
    add(VITRAIL_VIEW_BINDING_DEPTH, views.opaque[view], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
  context.vk.UpdateDescriptorSets(context.device, count, writes.data(), 0, nullptr);
}

VkResult createSets(const VitrailContext_T& context, Storage& storage, const StorageInfo& info) {
  VkResult result = createDescriptorPool(context, storage);
  if (result != VK_SUCCESS) return result;
  std::array<VkDescriptorSetLayout, 1 + VITRAIL_MAX_COLOR_VIEWS> layouts{};
  layouts.fill(context.viewSetLayout);
  layouts[0] = context.setLayout;
  std::array<VkDescriptorSet, 1 + VITRAIL_MAX_COLOR_VIEWS> sets{};
  VkDescriptorSetAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  allocate.descriptorPool = storage.pool;
  allocate.descriptorSetCount = 1 + storage.viewCount;
  allocate.pSetLayouts = layouts.data();
  result = context.vk.AllocateDescriptorSets(context.device, &allocate, sets.data());
  if (result != VK_SUCCESS) return result;

  storage.set = sets[0];
  writeBufferSet(context, storage);
  for (std::uint32_t i = 0; i < storage.viewCount; ++i) {
    storage.viewSets[i] = sets[1 + i];
    writeViewSet(context, storage.viewSets[i], info.views, i);
    context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET, storage.viewSets[i], info.debugName);
  }
  context.name(VK_OBJECT_TYPE_DESCRIPTOR_POOL, storage.pool, info.debugName);
  context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET, storage.set, info.debugName);
  return VK_SUCCESS;
}

} // namespace

VkBufferUsageFlags storageUsage(const VitrailContext_T& context) {
  VkBufferUsageFlags usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                             VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  if (context.has(VITRAIL_FEATURE_BUFFER_DEVICE_ADDRESS)) usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  return usage;
}

VkResult Storage::create(const VitrailContext_T& context, const StorageInfo& info) {
  areaPixels = info.areaPixels;
  nodeCapacity = info.nodeCapacity;
  viewCount = info.views.count;
  layout = layoutStorage(info.areaPixels, info.nodeCapacity, info.format, info.keepSums, context.limits.alignment);
  if (info.buffer != VK_NULL_HANDLE) {
    buffer = info.buffer;
    offset = info.bufferOffset;
  } else {
    const VkResult result = own.create(context, layout.total, storageUsage(context), 0,
                                       VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, info.debugName, "fragment lists");
    if (result != VK_SUCCESS) return result;
    buffer = own.buffer;
  }
  if (context.has(VITRAIL_FEATURE_BUFFER_DEVICE_ADDRESS)) {
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = buffer;
    nodesAddress = context.vk.GetBufferDeviceAddress(context.device, &address) + offset + layout.nodes.offset;
  }
  const VkResult result = createSets(context, *this, info);
  if (result != VK_SUCCESS) return context.log.fail(result, "the target's descriptor sets could not be made");
  return VK_SUCCESS;
}

void Storage::destroy(const VitrailContext_T& context) {
  context.vk.DestroyDescriptorPool(context.device, pool, context.allocator);
  own.destroy(context);
  *this = {};
}

} // namespace vitrail
