// A host of the rasteriser in compute shaders whose surfaces have textures: leaves that a mask cuts out and stained
// glass, around a ball that the hardware draws. material.glsl shades them, here and in a fragment shader.
//
//   raster_textures PICTURE.png            draws it by the raster (vitrail/vulkan_raster.h)
//   raster_textures PICTURE.png --lists    draws it by fragment lists (vitrail/vulkan.h), to compare
#include <array>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "gpu.h"
#include "scene.h"
#include "shaders.h" // SPIR-V of the shaders: made by CMakeLists.txt

namespace {

// What both ways of drawing share: the scene in buffers, the texture, and the set that has them.
struct Host {
  Gpu gpu;
  Scene scene;
  Buffer vertices, indices, instances, picture;
  Image color, depth, texture;
  vk::UniqueSampler sampler;
  vk::UniqueDescriptorSetLayout setLayout;
  vk::UniqueDescriptorPool descriptors;
  vk::DescriptorSet set;
  vk::UniqueCommandPool pool;
  vk::CommandBuffer commands;
  std::string reason; // of the library's last error
  vitrail::vulkan::Context context;

  Host();
  void makeSet();
  void uploadTexture();
  void submit() {
    commands.end();
    gpu.device->getQueue(gpu.family, 0).submit(vk::SubmitInfo{}.setCommandBuffers(commands));
    gpu.device->waitIdle();
  }
  void begin() {
    gpu.device->resetCommandPool(*pool);
    commands.begin(vk::CommandBufferBeginInfo{.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  }
  void check(VkResult result) const {
    if (result != VK_SUCCESS) throw std::runtime_error(reason);
  }
};

using BufferUsage = vk::BufferUsageFlagBits;
using Usage = vk::ImageUsageFlagBits;

// The hardware and the raster take vertices and indices from the same buffers.
Host::Host()
    : vertices(gpu, std::span<const Vertex>(scene.vertices), BufferUsage::eVertexBuffer | BufferUsage::eStorageBuffer),
      indices(gpu, std::span<const uint16_t>(scene.indices), BufferUsage::eIndexBuffer | BufferUsage::eStorageBuffer),
      instances(gpu, std::span<const Matrix>(scene.instances), BufferUsage::eStorageBuffer),
      picture(gpu, vk::DeviceSize{16} * kExtent.width * kExtent.height, BufferUsage::eTransferDst),
      color(createImage(gpu, kColorFormat, Usage::eColorAttachment | Usage::eStorage | Usage::eTransferSrc)),
      depth(createImage(gpu, kDepthFormat, Usage::eDepthStencilAttachment | Usage::eSampled)),
      texture(createImage(gpu, vk::Format::eR8G8B8A8Srgb, Usage::eSampled | Usage::eTransferDst,
                          {kTextureSide, kTextureSide}, kTextureLevels, kTextures)) {
  pool = gpu.device->createCommandPoolUnique({.queueFamilyIndex = gpu.family});
  commands = gpu.device->allocateCommandBuffers({.commandPool = *pool, .commandBufferCount = 1})[0];
  uploadTexture();
  makeSet();
  VitrailVkContextDesc desc{.instance = *gpu.instance, .physicalDevice = gpu.physicalDevice, .device = *gpu.device};
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.log = [](VitrailLogSeverity, const char* message, void* user) { *static_cast<std::string*>(user) = message; };
  desc.logUser = &reason;
  check(vitrail::vulkan::Context::create(desc, context));
}

void Host::uploadTexture() {
  std::vector<uint8_t> bytes = makeTexture(leafTexel);
  const std::vector<uint8_t> glass = makeTexture(glassTexel);
  bytes.insert(bytes.end(), glass.begin(), glass.end());
  const Buffer staging(gpu, std::span<const uint8_t>(bytes), BufferUsage::eTransferSrc);
  std::vector<vk::BufferImageCopy> regions;
  vk::DeviceSize offset = 0;
  for (uint32_t i = 0; i < kTextures * kTextureLevels; ++i) {
    const uint32_t side = kTextureSide >> i % kTextureLevels;
    vk::BufferImageCopy region{.bufferOffset = offset, .imageExtent = {side, side, 1}};
    region.imageSubresource = {vk::ImageAspectFlagBits::eColor, i % kTextureLevels, i / kTextureLevels, 1};
    regions.push_back(region);
    offset += vk::DeviceSize{4} * side * side;
  }
  begin();
  recordBarrier(commands, texture, {}, kWritten);
  commands.copyBufferToImage(*staging.buffer, *texture.image, kWritten.layout, regions);
  recordBarrier(commands, texture, kWritten, kSampled);
  submit();
}

void Host::makeSet() {
  const vk::Device device = *gpu.device;
  sampler = device.createSamplerUnique({.magFilter = vk::Filter::eLinear,
                                        .minFilter = vk::Filter::eLinear,
                                        .mipmapMode = vk::SamplerMipmapMode::eLinear,
                                        .maxLod = VK_LOD_CLAMP_NONE});
  constexpr auto kTexture = vk::DescriptorType::eCombinedImageSampler;
  constexpr auto kBuffer = vk::DescriptorType::eStorageBuffer;
  constexpr auto kStages =
      vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment | vk::ShaderStageFlagBits::eCompute;
  const vk::DescriptorSetLayoutBinding bindings[] = {
      {0, kTexture, 1, kStages}, {1, kBuffer, 1, kStages}, {2, kBuffer, 1, kStages}};
  setLayout = device.createDescriptorSetLayoutUnique(vk::DescriptorSetLayoutCreateInfo{}.setBindings(bindings));
  const vk::DescriptorPoolSize sizes[] = {{kTexture, 1}, {kBuffer, 2}};
  descriptors = device.createDescriptorPoolUnique(vk::DescriptorPoolCreateInfo{.maxSets = 1}.setPoolSizes(sizes));
  set = device.allocateDescriptorSets(
      vk::DescriptorSetAllocateInfo{.descriptorPool = *descriptors}.setSetLayouts(*setLayout))[0];
  const vk::DescriptorImageInfo image{*sampler, *texture.view, kSampled.layout};
  const vk::DescriptorBufferInfo buffers[] = {{*vertices.buffer, 0, VK_WHOLE_SIZE},
                                              {*instances.buffer, 0, VK_WHOLE_SIZE}};
  vk::WriteDescriptorSet imageWrite{.dstSet = set, .dstBinding = 0, .descriptorType = kTexture};
  vk::WriteDescriptorSet bufferWrite{.dstSet = set, .dstBinding = 1, .descriptorType = kBuffer}; // and the next
  device.updateDescriptorSets({imageWrite.setImageInfo(image), bufferWrite.setBufferInfo(buffers)}, {});
}

// The ball and the floor; with lists also what is transparent, which is tested against their depth and collects.
struct Hardware {
  const Host& host;
  vk::UniquePipelineLayout layout;
  vk::UniquePipeline opaque, collect;

  explicit Hardware(const Host& itsHost) : host(itsHost) {
    const vk::DescriptorSetLayout sets[] = {*host.setLayout, host.context.descriptorSetLayout()};
    const vk::PushConstantRange push{vk::ShaderStageFlagBits::eFragment, 0, sizeof(uint32_t)};
    layout = host.gpu.device->createPipelineLayoutUnique(
        vk::PipelineLayoutCreateInfo{}.setSetLayouts(sets).setPushConstantRanges(push));
    opaque = createPipeline(kOpaqueCode, true);
    collect = createPipeline(kCollectCode, false);
  }

  vk::UniquePipeline createPipeline(std::span<const uint32_t> code, bool isOpaque) const {
    const vk::Device device = *host.gpu.device;
    const auto vertex = device.createShaderModuleUnique({.codeSize = sizeof kVertexCode, .pCode = kVertexCode});
    const auto fragment = device.createShaderModuleUnique({.codeSize = code.size_bytes(), .pCode = code.data()});
    const vk::PipelineShaderStageCreateInfo stages[] = {
        {.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex, .pName = "main"},
        {.stage = vk::ShaderStageFlagBits::eFragment, .module = *fragment, .pName = "main"}};
    const vk::VertexInputBindingDescription binding{0, sizeof(Vertex)};
    const vk::VertexInputAttributeDescription attributes[] = {
        {0, 0, vk::Format::eR32G32B32Sfloat, offsetof(Vertex, position)},
        {1, 0, vk::Format::eR32G32B32Sfloat, offsetof(Vertex, normal)},
        {2, 0, vk::Format::eR32G32Sfloat, offsetof(Vertex, texCoord)}};
    const auto input =
        vk::PipelineVertexInputStateCreateInfo{}.setVertexBindingDescriptions(binding).setVertexAttributeDescriptions(
            attributes);
    const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
    const vk::Viewport viewport{0.0F, 0.0F, float{kExtent.width}, float{kExtent.height}, 0.0F, 1.0F};
    const vk::Rect2D scissor{.extent = kExtent};
    const auto viewports = vk::PipelineViewportStateCreateInfo{}.setViewports(viewport).setScissors(scissor);
    const vk::PipelineRasterizationStateCreateInfo raster{.frontFace = vk::FrontFace::eCounterClockwise,
                                                          .lineWidth = 1.0F};
    const vk::PipelineMultisampleStateCreateInfo samples{};
    const vk::PipelineDepthStencilStateCreateInfo test{
        .depthTestEnable = true, .depthWriteEnable = isOpaque, .depthCompareOp = vk::CompareOp::eLessOrEqual};
    vk::PipelineColorBlendAttachmentState attachment;
    if (isOpaque) attachment.colorWriteMask = vk::FlagTraits<vk::ColorComponentFlagBits>::allFlags;
    const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 1, .pAttachments = &attachment};
    vk::PipelineRenderingCreateInfo rendering{.depthAttachmentFormat = kDepthFormat};
    rendering.setColorAttachmentFormats(kColorFormat);
    vk::GraphicsPipelineCreateInfo info{.pNext = &rendering, .pVertexInputState = &input, .layout = *layout};
    info.setStages(stages).setPInputAssemblyState(&assembly).setPViewportState(&viewports);
    info.setPRasterizationState(&raster).setPMultisampleState(&samples);
    info.setPDepthStencilState(&test).setPColorBlendState(&blend);
    return device.createGraphicsPipelineUnique({}, info).value;
  }

  void draw(const Mesh& mesh, uint32_t firstInstance, uint32_t count) const {
    host.commands.drawIndexed(mesh.indexCount, count, mesh.firstIndex, int32_t(mesh.firstVertex), firstInstance);
  }

  // The frame up to where Vitrail draws over it. `lists`: of the target that collects, or null.
  void record(vk::DescriptorSet lists) const {
    const vk::CommandBuffer commands = host.commands;
    // What a frame before has left in the images does not matter.
    recordBarrier(commands, host.color, {vk::ImageLayout::eUndefined, kCopiedColor.stages, {}}, kDrawnColor);
    recordBarrier(commands, host.depth, {vk::ImageLayout::eUndefined, kRasterDepth.stages, {}}, kDrawnDepth);
    const std::array kSky{0.70F, 0.77F, 0.84F, 1.0F};
    vk::RenderingAttachmentInfo colorInfo{.imageView = *host.color.view, .imageLayout = kDrawnColor.layout};
    colorInfo.setLoadOp(vk::AttachmentLoadOp::eClear).setClearValue(vk::ClearColorValue{kSky});
    vk::RenderingAttachmentInfo depthInfo{.imageView = *host.depth.view, .imageLayout = kDrawnDepth.layout};
    depthInfo.setLoadOp(vk::AttachmentLoadOp::eClear).setClearValue(vk::ClearDepthStencilValue{.depth = 1.0F});
    vk::RenderingInfo rendering{.renderArea = {{}, kExtent}, .layerCount = 1, .pDepthAttachment = &depthInfo};
    commands.beginRendering(rendering.setColorAttachments(colorInfo));
    commands.bindVertexBuffers(0, *host.vertices.buffer, vk::DeviceSize{0});
    commands.bindIndexBuffer(*host.indices.buffer, 0, vk::IndexType::eUint16);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout, 0, host.set, {});
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *opaque);
    draw(host.scene.ball, 0, 1);
    draw(host.scene.floor, 1, 1);
    if (lists) {
      commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout, 1, lists, {});
      commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *collect);
      for (const uint32_t material : {0U, 1U}) {
        commands.pushConstants<uint32_t>(*layout, vk::ShaderStageFlagBits::eFragment, 0, material);
        if (material == 0) draw(host.scene.leaf, Scene::kOpaque, Scene::kLeaves);
        if (material == 1) draw(host.scene.pane, Scene::kOpaque + Scene::kLeaves, Scene::kPanes);
      }
    }
    commands.endRendering();
    recordBarrier(commands, host.color, kDrawnColor, kRasterColor);
    recordBarrier(commands, host.depth, kDrawnDepth, kRasterDepth);
  }
};

// ---- Both ways to draw

void drawByLists(Host& host, const Hardware& hardware) {
  const VkImageView view = *host.color.view;
  VitrailVkTargetDesc desc{.extent = kExtent, .nodeFormat = VITRAIL_NODE_HDR, .nodeCapacity = 8'000'000};
  desc.colorFormat = static_cast<VkFormat>(kColorFormat);
  desc.views = {.count = 1, .color = &view};
  vitrail::vulkan::Target target;
  host.check(vitrail::vulkan::Target::create(host.context, desc, target));
  host.begin();
  target.begin(host.commands);
  hardware.record(target.descriptorSet());
  target.collected(host.commands);
  target.resolve(host.commands);
  target.end(host.commands);
  recordCopy(host.commands, host.color, *host.picture.buffer);
  host.submit();
  VitrailStats stats{};
  host.check(target.readStats(0, stats));
  if (stats.complete == 0) throw std::runtime_error("the node pool is too small for the frame");
}

VitrailVkRasterDraw rasterDraw(const Mesh& mesh, uint32_t firstInstance, uint32_t count, uint32_t material) {
  return {.count = mesh.indexCount,
          .instanceCount = count,
          .firstIndex = mesh.firstIndex,
          .vertexOffset = int32_t(mesh.firstVertex),
          .firstInstance = firstInstance,
          .vertexCount = mesh.vertexCount,
          .blend = VITRAIL_BLEND_OVER,
          .word = material};
}

void drawByRaster(Host& host, const Hardware& hardware) {
  const VkDescriptorSetLayout layout = *host.setLayout;
  VitrailVkRasterDesc desc{.extent = kExtent, .setLayoutCount = 1, .setLayouts = &layout};
  desc.colorFormat = static_cast<VkFormat>(kColorFormat);
  desc.depthFormat = static_cast<VkFormat>(kDepthFormat);
  desc.positions = {.code = kPositionsCode, .size = sizeof kPositionsCode};
  desc.setUp = {.code = kSetUpCode, .size = sizeof kSetUpCode};
  desc.setUpLarge = {.code = kSetUpLargeCode, .size = sizeof kSetUpLargeCode};
  desc.blend = {.code = kBlendCode, .size = sizeof kBlendCode};
  desc.blendDeep = {.code = kBlendDeepCode, .size = sizeof kBlendDeepCode};
  desc.indexType = VK_INDEX_TYPE_UINT16;
  desc.blendModes = 1U << VITRAIL_BLEND_OVER;
  desc.framesInFlight = 1; // host.submit() waits for each
  vitrail::vulkan::Raster raster;
  host.check(vitrail::vulkan::Raster::create(host.context, desc, raster));

  const VitrailVkRasterDraw draws[] = {rasterDraw(host.scene.leaf, Scene::kOpaque, Scene::kLeaves, 0),
                                       rasterDraw(host.scene.pane, Scene::kOpaque + Scene::kLeaves, Scene::kPanes, 1)};
  const Buffer table(host.gpu, std::span<const VitrailVkRasterDraw>(draws), BufferUsage::eStorageBuffer);
  const VkDescriptorSet set = host.set;
  VitrailVkRasterInfo info{.sets = &set, .draws = *table.buffer, .drawCount = 2, .indices = *host.indices.buffer};
  info.mostLight = 1.0F; // materialColor() gives no more
  info.color = *host.color.view;
  info.depth = *host.depth.view;
  VitrailVkRasterStats stats{};
  do { // after the first frame it knows how much room it needs
    host.check(raster.update(++info.frame));
    host.begin();
    hardware.record({});
    raster.draw(host.commands, info);
    recordCopy(host.commands, host.color, *host.picture.buffer);
    host.submit();
    host.check(raster.readStats(info.frame, stats));
  } while (stats.exact == VK_FALSE && stats.cutPixels == 0 && info.frame < 8);
  if (stats.exact == VK_FALSE) throw std::runtime_error("the picture is not exact: " + host.reason);
}

} // namespace

int main(int argc, char** argv) {
  try {
    const bool lists = argc == 3 && std::string(argv[2]) == "--lists";
    if (argc != 2 && !lists) throw std::runtime_error("usage: raster_textures PICTURE.png [--lists]");
    Host host;
    const Hardware hardware(host);
    lists ? drawByLists(host, hardware) : drawByRaster(host, hardware);
    savePng(static_cast<const float*>(host.picture.data), argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "raster_textures: error: %s\n", error.what());
    return 1;
  }
}
