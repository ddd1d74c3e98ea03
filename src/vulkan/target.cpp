// Creation and destruction of a target: its buffers and its descriptor sets.
#include "target.h"

#include <memory>
#include <new>

#include "core/pool.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kDefaultFramesInFlight = 2;

VkResult check(VitrailContext_T& context, const VitrailTargetDesc& desc) {
  const Log& log = context.log;
  if (desc.extent.width == 0 || desc.extent.height == 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "extent %ux%u: both sides must be at least 1", desc.extent.width,
                    desc.extent.height);
  }
  if (desc.nodeFormat != VITRAIL_NODE_STANDARD) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "nodeFormat %d is none of VitrailNodeFormat", desc.nodeFormat);
  }
  if (desc.depthOrder != VITRAIL_DEPTH_NEAREST_IS_ZERO && desc.depthOrder != VITRAIL_DEPTH_NEAREST_IS_ONE) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "depthOrder %d is none of VitrailDepthOrder", desc.depthOrder);
  }
  if (desc.colorViewCount == 0 || desc.colorViewCount > VITRAIL_MAX_COLOR_VIEWS || desc.colorViews == nullptr) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "%u colour views: between 1 and %d are needed", desc.colorViewCount,
                    VITRAIL_MAX_COLOR_VIEWS);
  }
  if (desc.framesInFlight > VITRAIL_MAX_FRAMES_IN_FLIGHT) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "framesInFlight %u: at most %d", desc.framesInFlight,
                    VITRAIL_MAX_FRAMES_IN_FLIGHT);
  }
  const std::uint32_t most = vitrailMaxNodeCapacity(&context, desc.nodeFormat);
  if (desc.nodeCapacity > most) {
    return log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY, "nodeCapacity %u: this device holds at most %u nodes in one pool",
                    desc.nodeCapacity, most);
  }
  if (headBytes(desc.extent.width, desc.extent.height) > context.limits.storageBufferRange) {
    return log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY, "extent %ux%u: its head pointers exceed maxStorageBufferRange",
                    desc.extent.width, desc.extent.height);
  }
  if (desc.nodeBuffer != VK_NULL_HANDLE && desc.nodeBufferOffset % context.limits.storageBufferAlignment != 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "nodeBufferOffset %llu is not a multiple of %llu",
                    static_cast<unsigned long long>(desc.nodeBufferOffset),
                    static_cast<unsigned long long>(context.limits.storageBufferAlignment));
  }
  return VK_SUCCESS;
}

// The pipelines that resolve into images of a format.
VkResult findPipelines(VitrailContext_T& context, VkFormat format, ResolvePipelines* pipelines) {
  const std::size_t index = colorFormatIndex(format == VK_FORMAT_UNDEFINED ? VK_FORMAT_R16G16B16A16_SFLOAT : format);
  if (index == kColorFormats.size()) {
    return context.log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED,
                            "colorFormat %d: use VK_FORMAT_R16G16B16A16_SFLOAT or VK_FORMAT_R32G32B32A32_SFLOAT",
                            format);
  }
  return context.resolvePipelines(index, pipelines);
}

VkResult createBuffers(VitrailTarget_T& target, const VitrailTargetDesc& desc, const char* prefix) {
  const VitrailContext_T& context = *target.context;
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  constexpr VkMemoryPropertyFlags kDevice = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

  VkResult result = target.parameters.create(context, sizeof(layout::VitrailParameters),
                                             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, kHost, kDevice, prefix, "parameters");
  if (result != VK_SUCCESS) return result;
  auto* parameters = new (target.parameters.mapped) layout::VitrailParameters;
  parameters->width = desc.extent.width;
  parameters->height = desc.extent.height;
  parameters->capacity = desc.nodeCapacity;
  parameters->nearestIsOne = desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 1 : 0;

  result = target.control.create(context, sizeof(layout::VitrailControl),
                                 kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                 0, kDevice, prefix, "counters");
  if (result != VK_SUCCESS) return result;
  result = target.heads.create(context, headBytes(desc.extent.width, desc.extent.height),
                               kStorage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, 0, kDevice, prefix, "head pointers");
  if (result != VK_SUCCESS) return result;
  if (desc.nodeBuffer == VK_NULL_HANDLE) {
    result = target.nodes.create(context, nodePoolBytes(desc.nodeCapacity), kStorage, 0, kDevice, prefix, "node pool");
    if (result != VK_SUCCESS) return result;
    target.nodeBuffer = target.nodes.buffer;
  } else {
    target.nodeBuffer = desc.nodeBuffer;
    target.nodeOffset = desc.nodeBufferOffset;
  }
  result = target.longLists.create(context, longListBytes(desc.extent.width, desc.extent.height, desc.nodeCapacity),
                                   kStorage, 0, kDevice, prefix, "long lists");
  if (result != VK_SUCCESS) return result;
  result = target.stats.create(context, sizeof(StatsSlot) * target.framesInFlight, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               kHost, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, prefix, "statistics");
  if (result != VK_SUCCESS) return result;
  for (std::uint32_t i = 0; i < target.framesInFlight; ++i)
    new (static_cast<StatsSlot*>(target.stats.mapped) + i) StatsSlot{};
  return VK_SUCCESS;
}

VkResult createDescriptorPool(VitrailTarget_T& target) {
  const std::array<VkDescriptorPoolSize, 3> sizes = {
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kBindingCount - 1},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, target.colorViewCount},
  };
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = 1 + target.colorViewCount;
  info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  const VitrailContext_T& context = *target.context;
  return context.vk.CreateDescriptorPool(context.device, &info, context.allocator, &target.pool);
}

void writeBufferSet(const VitrailTarget_T& target) {
  const std::array<VkDescriptorBufferInfo, kBindingCount> buffers = {
      VkDescriptorBufferInfo{target.parameters.buffer, 0, VK_WHOLE_SIZE},
      VkDescriptorBufferInfo{target.control.buffer, 0, VK_WHOLE_SIZE},
      VkDescriptorBufferInfo{target.heads.buffer, 0, VK_WHOLE_SIZE},
      VkDescriptorBufferInfo{target.nodeBuffer, target.nodeOffset, nodePoolBytes(target.capacity)},
      VkDescriptorBufferInfo{target.longLists.buffer, 0, VK_WHOLE_SIZE},
  };
  std::array<VkWriteDescriptorSet, kBindingCount> writes{};
  for (std::uint32_t i = 0; i < kBindingCount; ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = target.set;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType =
        i == kParametersBinding ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[i].pBufferInfo = &buffers[i];
  }
  target.context->vk.UpdateDescriptorSets(target.context->device, kBindingCount, writes.data(), 0, nullptr);
}

void writeColorSet(const VitrailTarget_T& target, VkDescriptorSet set, VkImageView view) {
  VkDescriptorImageInfo image{};
  image.imageView = view;
  image.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = set;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  write.pImageInfo = &image;
  target.context->vk.UpdateDescriptorSets(target.context->device, 1, &write, 0, nullptr);
}

VkResult createSets(VitrailTarget_T& target, const VitrailTargetDesc& desc) {
  const VitrailContext_T& context = *target.context;
  VkResult result = createDescriptorPool(target);
  if (result != VK_SUCCESS) return result;

  std::array<VkDescriptorSetLayout, 1 + VITRAIL_MAX_COLOR_VIEWS> layouts{};
  layouts.fill(context.colorSetLayout);
  layouts[0] = context.setLayout;
  std::array<VkDescriptorSet, 1 + VITRAIL_MAX_COLOR_VIEWS> sets{};
  VkDescriptorSetAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorPool = target.pool;
  info.descriptorSetCount = 1 + target.colorViewCount;
  info.pSetLayouts = layouts.data();
  result = context.vk.AllocateDescriptorSets(context.device, &info, sets.data());
  if (result != VK_SUCCESS) return result;

  target.set = sets[0];
  writeBufferSet(target);
  for (std::uint32_t i = 0; i < target.colorViewCount; ++i) {
    target.colorSets[i] = sets[1 + i];
    writeColorSet(target, target.colorSets[i], desc.colorViews[i]);
  }
  return VK_SUCCESS;
}

VkResult build(VitrailTarget_T& target, const VitrailTargetDesc& desc) {
  const char* prefix = desc.debugName != nullptr ? desc.debugName : "vitrail";
  VkResult result = createBuffers(target, desc, prefix);
  if (result != VK_SUCCESS) return result; // the log has the reason
  result = createSets(target, desc);
  if (result != VK_SUCCESS) return target.context->log.fail(result, "the target's descriptor sets could not be made");
  target.context->name(VK_OBJECT_TYPE_DESCRIPTOR_POOL, target.pool, prefix);
  target.context->name(VK_OBJECT_TYPE_DESCRIPTOR_SET, target.set, prefix);
  for (std::uint32_t i = 0; i < target.colorViewCount; ++i) {
    target.context->name(VK_OBJECT_TYPE_DESCRIPTOR_SET, target.colorSets[i], prefix);
  }
  return VK_SUCCESS;
}

} // namespace

} // namespace vitrail

extern "C" VkResult vitrailCreateTarget(VitrailContext context, const VitrailTargetDesc* desc, VitrailTarget* target) {
  if (target == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  *target = nullptr;
  if (context == nullptr || desc == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  vitrail::ResolvePipelines resolve;
  VkResult result = vitrail::check(*context, *desc);
  if (result == VK_SUCCESS) result = vitrail::findPipelines(*context, desc->colorFormat, &resolve);
  if (result != VK_SUCCESS) return result;

  std::unique_ptr<VitrailTarget_T> made(new (std::nothrow) VitrailTarget_T);
  if (!made) return context->log.fail(VK_ERROR_OUT_OF_HOST_MEMORY, "no memory for a target");
  made->context = context;
  made->extent = desc->extent;
  made->capacity = desc->nodeCapacity;
  made->framesInFlight = desc->framesInFlight != 0 ? desc->framesInFlight : vitrail::kDefaultFramesInFlight;
  made->resolve = resolve;
  made->colorViewCount = desc->colorViewCount;
  result = vitrail::build(*made, *desc);
  if (result != VK_SUCCESS) {
    vitrailDestroyTarget(made.release());
    return result;
  }
  *target = made.release();
  return VK_SUCCESS;
}

extern "C" void vitrailDestroyTarget(VitrailTarget target) {
  if (target == nullptr) return;
  const std::unique_ptr<VitrailTarget_T> owned(target);
  const VitrailContext_T& context = *target->context;
  context.vk.DestroyDescriptorPool(context.device, target->pool, context.allocator);
  for (vitrail::Buffer* buffer :
       {&target->parameters, &target->control, &target->heads, &target->nodes, &target->longLists, &target->stats}) {
    buffer->destroy(context);
  }
}

extern "C" VkDescriptorSet vitrailTargetDescriptorSet(VitrailTarget target) { return target->set; }

extern "C" void vitrailTargetMemory(VitrailTarget target, VitrailMemory* memory) {
  memory->nodeBytes = vitrail::nodePoolBytes(target->capacity);
  memory->headBytes = target->heads.size;
  memory->otherBytes = target->parameters.size + target->control.size + target->longLists.size + target->stats.size;
}
