#include "storage.h"

#include <algorithm>

#include "vitrail/bindings.h"

namespace vitrail {

namespace {

VkResult createDescriptorPool(const VitrailVkContext_T& context, Storage& storage) {
  const std::array<VkDescriptorPoolSize, 4> sizes = {
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VITRAIL_BINDINGS - 1},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, std::max(storage.viewCount, 1U)},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 * std::max(storage.viewCount, 1U)},
  };
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = 1 + storage.viewCount;
  info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  return context.vk.CreateDescriptorPool(context.device, &info, context.allocator, &storage.descriptors);
}

void writeBufferSet(const VitrailVkContext_T& context, const Storage& storage) {
  std::array<VkDescriptorBufferInfo, VITRAIL_BINDINGS> buffers{};
  const auto bind = [&](std::uint32_t binding, const StoragePart& part) {
    buffers[binding] = {storage.buffer, storage.offset + part.offset, part.size};
  };
  bind(VITRAIL_BINDING_PARAMETERS, storage.layout.parameters);
  bind(VITRAIL_BINDING_CONTROL, storage.layout.control);
  bind(VITRAIL_BINDING_HEADS, storage.layout.heads);
  bind(VITRAIL_BINDING_NODES, storage.layout.nodes);
  bind(VITRAIL_BINDING_SUMS, storage.layout.sums);
  bind(VITRAIL_BINDING_MEDIUM_LISTS, storage.layout.mediumLists);
  bind(VITRAIL_BINDING_LONG_LISTS, storage.layout.longLists);
  bind(VITRAIL_BINDING_COPY, storage.layout.copy);
  // Shaders that reach the pool by its address do not look at its binding, which cannot name all of a large one.
  VkDeviceSize& pool = buffers[VITRAIL_BINDING_NODES].range;
  pool = std::min(pool, context.limits.storageBufferRange);
  std::array<VkWriteDescriptorSet, VITRAIL_BINDINGS> writes{};
  for (std::uint32_t i = 0; i < VITRAIL_BINDINGS; ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = storage.set;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType =
        i == VITRAIL_BINDING_PARAMETERS ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[i].pBufferInfo = &buffers[i];
  }
  context.vk.UpdateDescriptorSets(context.device, VITRAIL_BINDINGS, writes.data(), 0, nullptr);
}

void writeViewSet(const VitrailVkContext_T& context, VkDescriptorSet set, const VitrailVkViews& views,
                  std::uint32_t view) {
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

VkResult createSets(const VitrailVkContext_T& context, Storage& storage, const StorageInfo& info) {
  VkResult result = createDescriptorPool(context, storage);
  if (result != VK_SUCCESS) return result;
  std::array<VkDescriptorSetLayout, 1 + VITRAIL_MAX_VIEWS> layouts{};
  layouts.fill(context.viewSetLayout);
  layouts[0] = context.setLayout;
  std::array<VkDescriptorSet, 1 + VITRAIL_MAX_VIEWS> sets{};
  VkDescriptorSetAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  allocate.descriptorPool = storage.descriptors;
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
  context.name(VK_OBJECT_TYPE_DESCRIPTOR_POOL, storage.descriptors, info.debugName);
  context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET, storage.set, info.debugName);
  return VK_SUCCESS;
}

} // namespace

VkBufferUsageFlags storageUsage(const VitrailVkContext_T& context) {
  VkBufferUsageFlags usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                             VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  if (context.limits.poolByAddress) usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  return usage;
}

VkResult Storage::create(const VitrailVkContext_T& context, const StorageInfo& info) {
  needs = info.needs;
  viewCount = info.views.count;
  layout = layoutStorage(needs);
  if (info.buffer != VK_NULL_HANDLE) {
    buffer = info.buffer;
    offset = info.bufferOffset;
  } else {
    const VkResult result = own.create(context, layout.total, storageUsage(context), 0,
                                       VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, info.debugName, "fragment lists");
    if (result != VK_SUCCESS) return result;
    buffer = own.buffer;
  }
  pool.wholeByBinding = layout.nodes.size <= context.limits.storageBufferRange;
  if (context.limits.poolByAddress) {
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = buffer;
    pool.address = context.vk.GetBufferDeviceAddress(context.device, &address) + offset + layout.nodes.offset;
  }
  const VkResult result = createSets(context, *this, info);
  if (result != VK_SUCCESS) return context.log.fail(result, "the target's descriptor sets could not be made");
  return VK_SUCCESS;
}

void Storage::destroy(const VitrailVkContext_T& context) {
  context.vk.DestroyDescriptorPool(context.device, descriptors, context.allocator);
  own.destroy(context);
  *this = {};
}

} // namespace vitrail
