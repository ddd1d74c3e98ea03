#include "vulkan_compute.h"

#include <volk.h>

#include <array>
#include <cstring>
#include <string>

#include "../host.h"

namespace vitrail::tests::direct3d {

namespace {

void checkVulkan(VkResult result, const char* call) {
  if (result != VK_SUCCESS) throw HostError(std::string(call) + " failed: VkResult " + std::to_string(result));
}

template <class Info>
Info zeroed(VkStructureType type) {
  Info info{};
  info.sType = type;
  return info;
}

// One device and queue for the whole program, which end with it.
struct Vulkan {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;

  Vulkan() {
    checkVulkan(volkInitialize(), "opening Vulkan");
    auto application = zeroed<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.apiVersion = VK_API_VERSION_1_2;
    auto instanceInfo = zeroed<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    instanceInfo.pApplicationInfo = &application;
    VkInstance instance = VK_NULL_HANDLE;
    checkVulkan(vkCreateInstance(&instanceInfo, nullptr, &instance), "vkCreateInstance");
    volkLoadInstance(instance);
    std::uint32_t one = 1;
    if (vkEnumeratePhysicalDevices(instance, &one, &physical) < 0 || one == 0) throw HostError("no Vulkan device");
    const float priority = 1.0F;
    auto queueInfo = zeroed<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    auto info = zeroed<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    checkVulkan(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
    volkLoadDevice(device);
    vkGetDeviceQueue(device, 0, 0, &queue);
  }
};

// A storage buffer that the host has mapped.
struct MappedBuffer {
  VkDevice device;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* mapped = nullptr;

  MappedBuffer(const Vulkan& vulkan, std::size_t bytes) : device(vulkan.device) {
    auto info = zeroed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    checkVulkan(vkCreateBuffer(device, &info, nullptr, &buffer), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    VkPhysicalDeviceMemoryProperties memories{};
    vkGetPhysicalDeviceMemoryProperties(vulkan.physical, &memories);
    auto allocation = zeroed<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize = needs.size;
    constexpr VkMemoryPropertyFlags kMapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    while ((needs.memoryTypeBits >> allocation.memoryTypeIndex & 1U) == 0 ||
           (memories.memoryTypes[allocation.memoryTypeIndex].propertyFlags & kMapped) != kMapped) {
      ++allocation.memoryTypeIndex;
    }
    checkVulkan(vkAllocateMemory(device, &allocation, nullptr, &memory), "vkAllocateMemory");
    checkVulkan(vkBindBufferMemory(device, buffer, memory, 0), "vkBindBufferMemory");
    checkVulkan(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
    std::memset(mapped, 0, bytes);
  }
  ~MappedBuffer() {
    vkDestroyBuffer(device, buffer, nullptr);
    vkFreeMemory(device, memory, nullptr);
  }
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;
};

// A compute shader with two storage buffers.
struct Pipeline {
  VkDevice device;
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;

  Pipeline(VkDevice on, std::span<const std::uint32_t> spirv, std::array<VkBuffer, 2> buffers) : device(on) {
    std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
    for (std::uint32_t i = 0; i < 2; ++i) {
      bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    }
    auto setInfo = zeroed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    setInfo.bindingCount = 2;
    setInfo.pBindings = bindings.data();
    checkVulkan(vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &setLayout), "vkCreateDescriptorSetLayout");
    auto layoutInfo = zeroed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &setLayout;
    checkVulkan(vkCreatePipelineLayout(device, &layoutInfo, nullptr, &layout), "vkCreatePipelineLayout");
    auto moduleInfo = zeroed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    moduleInfo.codeSize = spirv.size_bytes();
    moduleInfo.pCode = spirv.data();
    auto info = zeroed<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = zeroed<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.pName = "main";
    info.layout = layout;
    checkVulkan(vkCreateShaderModule(device, &moduleInfo, nullptr, &info.stage.module), "vkCreateShaderModule");
    const VkResult made = vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    vkDestroyShaderModule(device, info.stage.module, nullptr);
    checkVulkan(made, "vkCreateComputePipelines");
    makeSet(buffers);
  }
  ~Pipeline() {
    vkDestroyDescriptorPool(device, pool, nullptr);
    vkDestroyPipeline(device, pipeline, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyDescriptorSetLayout(device, setLayout, nullptr);
  }
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

 private:
  void makeSet(std::array<VkBuffer, 2> buffers) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    auto poolInfo = zeroed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    checkVulkan(vkCreateDescriptorPool(device, &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
    auto allocation = zeroed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocation.descriptorPool = pool;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &setLayout;
    checkVulkan(vkAllocateDescriptorSets(device, &allocation, &set), "vkAllocateDescriptorSets");
    for (std::uint32_t i = 0; i < 2; ++i) {
      const VkDescriptorBufferInfo whole{buffers.at(i), 0, VK_WHOLE_SIZE};
      auto write = zeroed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
      write.dstSet = set;
      write.dstBinding = i;
      write.descriptorCount = 1;
      write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
      write.pBufferInfo = &whole;
      vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
  }
};

void dispatch(const Vulkan& vulkan, const Pipeline& pipeline, std::uint32_t groups) {
  auto poolInfo = zeroed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  VkCommandPool pool = VK_NULL_HANDLE;
  checkVulkan(vkCreateCommandPool(vulkan.device, &poolInfo, nullptr, &pool), "vkCreateCommandPool");
  auto allocation = zeroed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  allocation.commandPool = pool;
  allocation.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  checkVulkan(vkAllocateCommandBuffers(vulkan.device, &allocation, &commands), "vkAllocateCommandBuffers");
  const auto begin = zeroed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  vkBeginCommandBuffer(commands, &begin);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &pipeline.set, 0, nullptr);
  vkCmdDispatch(commands, groups, 1, 1);
  vkEndCommandBuffer(commands);
  auto submit = zeroed<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  checkVulkan(vkQueueSubmit(vulkan.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  checkVulkan(vkQueueWaitIdle(vulkan.queue), "vkQueueWaitIdle");
  vkDestroyCommandPool(vulkan.device, pool, nullptr);
}

} // namespace

std::vector<std::byte> runByVulkan(std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> input,
                                   std::size_t bytes, std::uint32_t groups) {
  static const Vulkan vulkan;
  const MappedBuffer read(vulkan, input.size_bytes());
  const MappedBuffer written(vulkan, bytes);
  std::memcpy(read.mapped, input.data(), input.size_bytes());
  dispatch(vulkan, Pipeline(vulkan.device, spirv, {read.buffer, written.buffer}), groups);
  std::vector<std::byte> result(bytes);
  std::memcpy(result.data(), written.mapped, bytes);
  return result;
}

} // namespace vitrail::tests::direct3d
