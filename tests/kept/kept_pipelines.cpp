#include "kept_pipelines.h"

#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <type_traits>
#include <unordered_map>

namespace vitrail::tests {

namespace {

// All that a pipeline is made of, in bytes.
class Content {
 public:
  template <class Value>
  void add(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value> && !std::is_pointer_v<Value>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  template <class Value>
  void addAll(const Value* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Value> && !std::is_pointer_v<Value>);
    add(count);
    if (values != nullptr) bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
  }
  void add(const std::string& bytes) { addAll(bytes.data(), bytes.size()); }
  // A structure without pointers but pNext, from the field behind that.
  template <class State, class Field>
  void addFrom(const State& state, const Field& first) {
    const auto* begin = reinterpret_cast<const char*>(&first);
    addAll(begin, static_cast<std::size_t>(reinterpret_cast<const char*>(&state + 1) - begin));
  }
  // A chain that nobody here knows: such a pipeline is not kept.
  void refuse(const void* next) { known_ = known_ && next == nullptr; }

  [[nodiscard]] std::optional<std::string> get() const { return known_ ? std::optional(bytes_) : std::nullopt; }

 private:
  std::string bytes_;
  bool known_ = true;
};

struct Kept {
  VkPipeline pipeline = VK_NULL_HANDLE;
  std::size_t users = 0;
};

struct Functions {
  PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
  PFN_vkGetDeviceProcAddr getDeviceProcAddr = nullptr;
  PFN_vkCreateShaderModule createShaderModule = nullptr;
  PFN_vkDestroyShaderModule destroyShaderModule = nullptr;
  PFN_vkCreateDescriptorSetLayout createDescriptorSetLayout = nullptr;
  PFN_vkDestroyDescriptorSetLayout destroyDescriptorSetLayout = nullptr;
  PFN_vkCreatePipelineLayout createPipelineLayout = nullptr;
  PFN_vkDestroyPipelineLayout destroyPipelineLayout = nullptr;
  PFN_vkCreateComputePipelines createComputePipelines = nullptr;
  PFN_vkCreateGraphicsPipelines createGraphicsPipelines = nullptr;
  PFN_vkDestroyPipeline destroyPipeline = nullptr;
};

// What objects are made of, by their handles, while they are there.
template <class Handle>
using Contents = std::unordered_map<Handle, std::optional<std::string>>;

struct State {
  std::mutex mutex;
  Functions next;
  Contents<VkShaderModule> modules;
  std::unordered_map<VkShaderModule, std::set<std::uint32_t>> constants; // that they look at
  Contents<VkDescriptorSetLayout> setLayouts;
  Contents<VkPipelineLayout> layouts;
  std::map<std::string, Kept> pipelines;
  std::unordered_map<VkPipeline, std::string> keys;
  bool destroyedTwice = false;
};

State& state() {
  static State state;
  return state;
}

template <class Handle>
void addObject(Content& content, const Contents<Handle>& contents, Handle handle) {
  const auto found = contents.find(handle);
  if (found == contents.end() || !found->second) {
    content.refuse(&content);
  } else {
    content.add(*found->second);
  }
}

void addStage(Content& content, const VkPipelineShaderStageCreateInfo& stage) {
  content.refuse(stage.pNext);
  content.add(stage.flags);
  content.add(stage.stage);
  addObject(content, state().modules, stage.module);
  content.add(std::string(stage.pName));
  const VkSpecializationInfo* constants = stage.pSpecializationInfo;
  content.add(constants != nullptr);
  if (constants == nullptr) return;
  const auto asked = state().constants.find(stage.module);
  if (asked == state().constants.end()) return content.refuse(&content);
  for (const VkSpecializationMapEntry& entry : std::span(constants->pMapEntries, constants->mapEntryCount)) {
    if (!asked->second.contains(entry.constantID)) continue;
    content.add(entry.constantID);
    content.addAll(static_cast<const char*>(constants->pData) + entry.offset, entry.size);
  }
}

std::optional<std::string> contentOf(const VkComputePipelineCreateInfo& info) {
  Content content;
  content.refuse(info.pNext);
  content.add('c');
  content.add(info.flags);
  addStage(content, info.stage);
  addObject(content, state().layouts, info.layout);
  return content.get();
}

// What the structure has, where there is one.
template <class Info, class Add>
void addOptional(Content& content, const Info* info, const Add& add) {
  content.add(info != nullptr);
  if (info != nullptr) add(*info);
}

void addMultisample(Content& content, const VkPipelineMultisampleStateCreateInfo& info) {
  if (info.pNext != nullptr) {
    const auto& places = *static_cast<const VkPipelineSampleLocationsStateCreateInfoEXT*>(info.pNext);
    if (places.sType != VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT) {
      return content.refuse(info.pNext);
    }
    content.refuse(places.pNext);
    content.add(places.sampleLocationsEnable);
    content.add(places.sampleLocationsInfo.sampleLocationsPerPixel);
    content.add(places.sampleLocationsInfo.sampleLocationGridSize);
    content.addAll(places.sampleLocationsInfo.pSampleLocations, places.sampleLocationsInfo.sampleLocationsCount);
  }
  content.add(info.flags);
  content.add(info.rasterizationSamples);
  content.add(info.sampleShadingEnable);
  content.add(info.minSampleShading);
  content.addAll(info.pSampleMask, info.pSampleMask != nullptr ? 1 : 0); // of at most 32 samples
  content.add(info.alphaToCoverageEnable);
  content.add(info.alphaToOneEnable);
}

void addRendering(Content& content, const void* next) {
  const auto* rendering = static_cast<const VkPipelineRenderingCreateInfo*>(next);
  if (rendering == nullptr || rendering->sType != VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO) {
    return content.refuse(&content);
  }
  content.refuse(rendering->pNext);
  content.add(rendering->viewMask);
  content.addAll(rendering->pColorAttachmentFormats, rendering->colorAttachmentCount);
  content.add(rendering->depthAttachmentFormat);
  content.add(rendering->stencilAttachmentFormat);
}

// Of dynamic rendering; those of render passes are not kept.
std::optional<std::string> contentOf(const VkGraphicsPipelineCreateInfo& info) {
  Content content;
  content.add('g');
  addRendering(content, info.pNext);
  content.add(info.flags);
  content.add(std::size_t{info.stageCount});
  for (const VkPipelineShaderStageCreateInfo& stage : std::span(info.pStages, info.stageCount)) {
    addStage(content, stage);
  }
  addOptional(content, info.pVertexInputState, [&](const VkPipelineVertexInputStateCreateInfo& vertices) {
    content.refuse(vertices.pNext);
    content.addAll(vertices.pVertexBindingDescriptions, vertices.vertexBindingDescriptionCount);
    content.addAll(vertices.pVertexAttributeDescriptions, vertices.vertexAttributeDescriptionCount);
  });
  addOptional(content, info.pInputAssemblyState, [&](const VkPipelineInputAssemblyStateCreateInfo& assembly) {
    content.refuse(assembly.pNext);
    content.addFrom(assembly, assembly.flags);
  });
  content.refuse(info.pTessellationState);
  addOptional(content, info.pViewportState, [&](const VkPipelineViewportStateCreateInfo& viewport) {
    content.refuse(viewport.pNext);
    content.refuse(viewport.pViewports); // they are dynamic
    content.refuse(viewport.pScissors);
    content.add(viewport.viewportCount);
    content.add(viewport.scissorCount);
  });
  addOptional(content, info.pRasterizationState, [&](const VkPipelineRasterizationStateCreateInfo& raster) {
    content.refuse(raster.pNext);
    content.addFrom(raster, raster.flags);
  });
  addOptional(content, info.pMultisampleState,
              [&](const VkPipelineMultisampleStateCreateInfo& samples) { addMultisample(content, samples); });
  addOptional(content, info.pDepthStencilState, [&](const VkPipelineDepthStencilStateCreateInfo& depth) {
    content.refuse(depth.pNext);
    content.addFrom(depth, depth.flags);
  });
  addOptional(content, info.pColorBlendState, [&](const VkPipelineColorBlendStateCreateInfo& blend) {
    content.refuse(blend.pNext);
    content.add(blend.flags);
    content.add(blend.logicOpEnable);
    content.add(blend.logicOp);
    content.addAll(blend.pAttachments, blend.attachmentCount);
    content.addAll(blend.blendConstants, 4);
  });
  addOptional(content, info.pDynamicState, [&](const VkPipelineDynamicStateCreateInfo& dynamic) {
    content.refuse(dynamic.pNext);
    content.addAll(dynamic.pDynamicStates, dynamic.dynamicStateCount);
  });
  addObject(content, state().layouts, info.layout);
  content.refuse(info.renderPass);
  return content.get();
}

std::optional<std::string> contentOf(const VkShaderModuleCreateInfo& info) {
  Content content;
  content.refuse(info.pNext);
  content.addAll(info.pCode, info.codeSize / sizeof(std::uint32_t));
  return content.get();
}

// The numbers of the constants that a module looks at: a pipeline is the same whatever the others are.
std::set<std::uint32_t> constantsOf(const VkShaderModuleCreateInfo& info) {
  constexpr std::size_t kHeader = 5; // words
  constexpr std::uint32_t kOpDecorate = 71;
  constexpr std::uint32_t kSpecId = 1;
  std::set<std::uint32_t> constants;
  const std::span code(info.pCode, info.codeSize / sizeof(std::uint32_t));
  for (std::size_t at = kHeader; at < code.size();) {
    const std::size_t words = code[at] >> 16U;
    if (words == 0 || words > code.size() - at) break;
    if ((code[at] & 0xffffU) == kOpDecorate && words == 4 && code[at + 2] == kSpecId) constants.insert(code[at + 3]);
    at += words;
  }
  return constants;
}

std::optional<std::string> contentOf(const VkDescriptorSetLayoutCreateInfo& info) {
  Content content;
  if (info.pNext != nullptr) {
    const auto& flags = *static_cast<const VkDescriptorSetLayoutBindingFlagsCreateInfo*>(info.pNext);
    if (flags.sType != VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO) return std::nullopt;
    content.refuse(flags.pNext);
    content.addAll(flags.pBindingFlags, flags.bindingCount);
  }
  content.add(info.flags);
  content.add(std::size_t{info.bindingCount});
  for (const VkDescriptorSetLayoutBinding& binding : std::span(info.pBindings, info.bindingCount)) {
    content.add(binding.binding);
    content.add(binding.descriptorType);
    content.add(binding.descriptorCount);
    content.add(binding.stageFlags);
    content.refuse(binding.pImmutableSamplers);
  }
  return content.get();
}

std::optional<std::string> contentOf(const VkPipelineLayoutCreateInfo& info) {
  Content content;
  content.refuse(info.pNext);
  content.add(info.flags);
  content.add(std::size_t{info.setLayoutCount});
  for (const VkDescriptorSetLayout layout : std::span(info.pSetLayouts, info.setLayoutCount)) {
    addObject(content, state().setLayouts, layout);
  }
  content.addAll(info.pPushConstantRanges, info.pushConstantRangeCount);
  return content.get();
}

// ---- In place of Vulkan's functions

template <class Handle, class Info, class Create>
VkResult remember(Contents<Handle>& contents, const Create& create, VkDevice device, const Info* info,
                  const VkAllocationCallbacks* allocator, Handle* handle) {
  const VkResult result = create(device, info, allocator, handle);
  const std::lock_guard lock(state().mutex);
  if (result == VK_SUCCESS) contents[*handle] = contentOf(*info);
  return result;
}

template <class Map, class Handle>
void forget(Map& contents, Handle handle) {
  const std::lock_guard lock(state().mutex);
  contents.erase(handle);
}

VKAPI_ATTR VkResult VKAPI_CALL createShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                  const VkAllocationCallbacks* allocator, VkShaderModule* module) {
  const VkResult result = remember(state().modules, state().next.createShaderModule, device, info, allocator, module);
  const std::lock_guard lock(state().mutex);
  if (result == VK_SUCCESS) state().constants[*module] = constantsOf(*info);
  return result;
}

VKAPI_ATTR void VKAPI_CALL destroyShaderModule(VkDevice device, VkShaderModule module,
                                               const VkAllocationCallbacks* allocator) {
  forget(state().modules, module);
  forget(state().constants, module);
  state().next.destroyShaderModule(device, module, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL createDescriptorSetLayout(VkDevice device, const VkDescriptorSetLayoutCreateInfo* info,
                                                         const VkAllocationCallbacks* allocator,
                                                         VkDescriptorSetLayout* layout) {
  return remember(state().setLayouts, state().next.createDescriptorSetLayout, device, info, allocator, layout);
}

VKAPI_ATTR void VKAPI_CALL destroyDescriptorSetLayout(VkDevice device, VkDescriptorSetLayout layout,
                                                      const VkAllocationCallbacks* allocator) {
  forget(state().setLayouts, layout);
  state().next.destroyDescriptorSetLayout(device, layout, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL createPipelineLayout(VkDevice device, const VkPipelineLayoutCreateInfo* info,
                                                    const VkAllocationCallbacks* allocator, VkPipelineLayout* layout) {
  return remember(state().layouts, state().next.createPipelineLayout, device, info, allocator, layout);
}

VKAPI_ATTR void VKAPI_CALL destroyPipelineLayout(VkDevice device, VkPipelineLayout layout,
                                                 const VkAllocationCallbacks* allocator) {
  forget(state().layouts, layout);
  state().next.destroyPipelineLayout(device, layout, allocator);
}

// Those that hosts allocate memory for themselves are not kept: they count what is theirs.
template <class Info, class Create>
VkResult makeOrFind(const Create& create, VkDevice device, VkPipelineCache cache, std::uint32_t count, const Info* info,
                    const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  if (count != 1 || allocator != nullptr) return create(device, cache, count, info, allocator, pipelines);
  const std::lock_guard lock(state().mutex);
  const std::optional<std::string> content = contentOf(*info);
  if (!content) return create(device, cache, count, info, allocator, pipelines);
  Kept& kept = state().pipelines[*content];
  if (kept.pipeline == VK_NULL_HANDLE) {
    const VkResult result = create(device, cache, count, info, allocator, &kept.pipeline);
    if (result != VK_SUCCESS) {
      state().pipelines.erase(*content);
      *pipelines = VK_NULL_HANDLE;
      return result;
    }
    state().keys[kept.pipeline] = *content;
  }
  ++kept.users;
  *pipelines = kept.pipeline;
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL createComputePipelines(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                                      const VkComputePipelineCreateInfo* infos,
                                                      const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  return makeOrFind(state().next.createComputePipelines, device, cache, count, infos, allocator, pipelines);
}

VKAPI_ATTR VkResult VKAPI_CALL createGraphicsPipelines(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                                       const VkGraphicsPipelineCreateInfo* infos,
                                                       const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  return makeOrFind(state().next.createGraphicsPipelines, device, cache, count, infos, allocator, pipelines);
}

VKAPI_ATTR void VKAPI_CALL destroyPipeline(VkDevice device, VkPipeline pipeline,
                                           const VkAllocationCallbacks* allocator) {
  const std::lock_guard lock(state().mutex);
  const auto key = state().keys.find(pipeline);
  if (key == state().keys.end()) return state().next.destroyPipeline(device, pipeline, allocator);
  Kept& kept = state().pipelines.at(key->second);
  if (kept.users == 0) {
    state().destroyedTwice = true;
  } else {
    --kept.users;
  }
}

} // namespace

PFN_vkVoidFunction keepingFunction(const char* name) {
  const std::pair<const char*, PFN_vkVoidFunction> functions[] = {
      {"vkCreateShaderModule", reinterpret_cast<PFN_vkVoidFunction>(createShaderModule)},
      {"vkDestroyShaderModule", reinterpret_cast<PFN_vkVoidFunction>(destroyShaderModule)},
      {"vkCreateDescriptorSetLayout", reinterpret_cast<PFN_vkVoidFunction>(createDescriptorSetLayout)},
      {"vkDestroyDescriptorSetLayout", reinterpret_cast<PFN_vkVoidFunction>(destroyDescriptorSetLayout)},
      {"vkCreatePipelineLayout", reinterpret_cast<PFN_vkVoidFunction>(createPipelineLayout)},
      {"vkDestroyPipelineLayout", reinterpret_cast<PFN_vkVoidFunction>(destroyPipelineLayout)},
      {"vkCreateComputePipelines", reinterpret_cast<PFN_vkVoidFunction>(createComputePipelines)},
      {"vkCreateGraphicsPipelines", reinterpret_cast<PFN_vkVoidFunction>(createGraphicsPipelines)},
      {"vkDestroyPipeline", reinterpret_cast<PFN_vkVoidFunction>(destroyPipeline)},
  };
  for (const auto& [known, function] : functions) {
    if (std::strcmp(known, name) == 0) return function;
  }
  return nullptr;
}

namespace {

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  const PFN_vkVoidFunction function = keepingFunction(name);
  return function != nullptr ? function : state().next.getDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
  const PFN_vkVoidFunction function = keepingFunction(name);
  return function != nullptr ? function : state().next.getInstanceProcAddr(instance, name);
}

// Puts a function before another, once.
template <class Function>
void replace(Function& of, Function by, Function& next) {
  if (of == by) return;
  next = of;
  of = by;
}

} // namespace

void keepPipelines() {
  Functions& next = state().next;
  replace(vkGetInstanceProcAddr, getInstanceProcAddr, next.getInstanceProcAddr);
  replace(vkGetDeviceProcAddr, getDeviceProcAddr, next.getDeviceProcAddr);
  replace(vkCreateShaderModule, createShaderModule, next.createShaderModule);
  replace(vkDestroyShaderModule, destroyShaderModule, next.destroyShaderModule);
  replace(vkCreateDescriptorSetLayout, createDescriptorSetLayout, next.createDescriptorSetLayout);
  replace(vkDestroyDescriptorSetLayout, destroyDescriptorSetLayout, next.destroyDescriptorSetLayout);
  replace(vkCreatePipelineLayout, createPipelineLayout, next.createPipelineLayout);
  replace(vkDestroyPipelineLayout, destroyPipelineLayout, next.destroyPipelineLayout);
  replace(vkCreateComputePipelines, createComputePipelines, next.createComputePipelines);
  replace(vkCreateGraphicsPipelines, createGraphicsPipelines, next.createGraphicsPipelines);
  replace(vkDestroyPipeline, destroyPipeline, next.destroyPipeline);
}

void keepPipelinesOf(VkDevice device, PFN_vkGetDeviceProcAddr next) {
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(next(device, name));
  };
  Functions& functions = state().next;
  find(functions.createShaderModule, "vkCreateShaderModule");
  find(functions.destroyShaderModule, "vkDestroyShaderModule");
  find(functions.createDescriptorSetLayout, "vkCreateDescriptorSetLayout");
  find(functions.destroyDescriptorSetLayout, "vkDestroyDescriptorSetLayout");
  find(functions.createPipelineLayout, "vkCreatePipelineLayout");
  find(functions.destroyPipelineLayout, "vkDestroyPipelineLayout");
  find(functions.createComputePipelines, "vkCreateComputePipelines");
  find(functions.createGraphicsPipelines, "vkCreateGraphicsPipelines");
  find(functions.destroyPipeline, "vkDestroyPipeline");
}

std::vector<std::string> destroyKeptPipelines(VkDevice device) {
  State& kept = state();
  const std::lock_guard lock(kept.mutex);
  std::size_t left = 0;
  for (const auto& [content, pipeline] : kept.pipelines) {
    left += pipeline.users;
    kept.next.destroyPipeline(device, pipeline.pipeline, nullptr);
  }
  kept.pipelines.clear();
  kept.keys.clear();
  std::vector<std::string> mistakes;
  if (left > 0) mistakes.push_back(std::to_string(left) + " pipelines are left");
  if (kept.destroyedTwice) mistakes.emplace_back("a pipeline was destroyed twice");
  return mistakes;
}

} // namespace vitrail::tests
