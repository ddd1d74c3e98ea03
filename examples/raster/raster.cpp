// The smallest host of the rasteriser in compute shaders (vitrail/vulkan_raster.h): the scene of examples/minimal,
// whose floor the hardware draws, and whose glass the raster. What concerns Vitrail is in Glass and in draw().
//
//   raster PICTURE.png
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <png.h>
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <vulkan/vulkan.hpp>

#include <vitrail/vitrail.hpp>

#include "shaders.h" // kVertexCode, kFloorCode and the stages of glass.glsl: made by CMakeLists.txt

namespace {

constexpr vk::Extent2D kExtent{.width = 1600, .height = 1200}; // four pixels make one of the file
constexpr vk::Format kColorFormat = vk::Format::eR32G32B32A32Sfloat;
constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;

// The first device. Vulkan 1.3 is for dynamic rendering: the library asks for 1.2, subgroup shuffles and 27 storage
// buffers a shader, and vitrailVkCreateRaster() says what is missing.
struct Gpu {
  vk::UniqueInstance instance;
  vk::PhysicalDevice physicalDevice;
  uint32_t family = 0; // for graphics and compute
  vk::UniqueDevice device;

  Gpu() {
    const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_3};
    instance = vk::createInstanceUnique({.pApplicationInfo = &application});
    const std::vector<vk::PhysicalDevice> devices = instance->enumeratePhysicalDevices();
    if (devices.empty()) throw std::runtime_error("there is no Vulkan device");
    physicalDevice = devices[0];
    constexpr vk::QueueFlags kBoth = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
    const std::vector<vk::QueueFamilyProperties> families = physicalDevice.getQueueFamilyProperties();
    while (family + 1 < families.size() && (families[family].queueFlags & kBoth) != kBoth) ++family;
    const float priority = 1.0F;
    const vk::DeviceQueueCreateInfo queue{.queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
    const vk::PhysicalDeviceVulkan13Features rendering{.synchronization2 = true, .dynamicRendering = true};
    const vk::PhysicalDeviceFeatures features{.fragmentStoresAndAtomics = true}; // what a context asks for
    device = physicalDevice.createDeviceUnique(
        {.pNext = &rendering, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue, .pEnabledFeatures = &features});
  }

  vk::UniqueDeviceMemory allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) const {
    const vk::PhysicalDeviceMemoryProperties memory = physicalDevice.getMemoryProperties();
    for (uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
      const bool allowed = (needs.memoryTypeBits >> type & 1) != 0;
      if (!allowed || (memory.memoryTypes[type].propertyFlags & wanted) != wanted) continue;
      return device->allocateMemoryUnique({.allocationSize = needs.size, .memoryTypeIndex = type});
    }
    throw std::runtime_error("the device lacks a kind of memory");
  }
};

struct Image {
  vk::UniqueDeviceMemory memory;
  vk::UniqueImage image;
  vk::UniqueImageView view;
  vk::ImageAspectFlagBits aspect = vk::ImageAspectFlagBits::eColor;
};

Image createImage(const Gpu& gpu, vk::Format format, vk::ImageUsageFlags usage) {
  Image result;
  vk::ImageCreateInfo info{.imageType = vk::ImageType::e2D, .format = format, .usage = usage};
  info.setExtent({kExtent.width, kExtent.height, 1}).setMipLevels(1).setArrayLayers(1);
  result.image = gpu.device->createImageUnique(info);
  const vk::MemoryRequirements needs = gpu.device->getImageMemoryRequirements(*result.image);
  result.memory = gpu.allocate(needs, vk::MemoryPropertyFlagBits::eDeviceLocal);
  gpu.device->bindImageMemory(*result.image, *result.memory, 0);
  if (format == kDepthFormat) result.aspect = vk::ImageAspectFlagBits::eDepth;
  vk::ImageViewCreateInfo view{.image = *result.image, .viewType = vk::ImageViewType::e2D, .format = format};
  result.view = gpu.device->createImageViewUnique(view.setSubresourceRange({result.aspect, 0, 1, 0, 1}));
  return result;
}

// A buffer that the host writes or reads.
struct Buffer {
  vk::UniqueDeviceMemory memory;
  vk::UniqueBuffer buffer;
  void* data = nullptr;

  Buffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage) {
    using Memory = vk::MemoryPropertyFlagBits;
    buffer = gpu.device->createBufferUnique({.size = size, .usage = usage});
    memory =
        gpu.allocate(gpu.device->getBufferMemoryRequirements(*buffer), Memory::eHostVisible | Memory::eHostCoherent);
    gpu.device->bindBufferMemory(*buffer, *memory, 0);
    data = gpu.device->mapMemory(*memory, 0, VK_WHOLE_SIZE);
  }
};

struct Floor {
  vk::UniquePipelineLayout layout;
  vk::UniquePipeline pipeline;

  explicit Floor(vk::Device device) {
    layout = device.createPipelineLayoutUnique({});
    const auto vertex = device.createShaderModuleUnique({.codeSize = sizeof kVertexCode, .pCode = kVertexCode});
    const auto fragment = device.createShaderModuleUnique({.codeSize = sizeof kFloorCode, .pCode = kFloorCode});
    const vk::PipelineShaderStageCreateInfo stages[] = {
        {.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex, .pName = "main"},
        {.stage = vk::ShaderStageFlagBits::eFragment, .module = *fragment, .pName = "main"}};
    const vk::PipelineVertexInputStateCreateInfo input{};
    const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleStrip};
    const vk::Viewport viewport{0.0F, 0.0F, float{kExtent.width}, float{kExtent.height}, 0.0F, 1.0F};
    const vk::Rect2D scissor{.extent = kExtent};
    const auto viewports = vk::PipelineViewportStateCreateInfo{}.setViewports(viewport).setScissors(scissor);
    const vk::PipelineRasterizationStateCreateInfo raster{.cullMode = vk::CullModeFlagBits::eNone, .lineWidth = 1.0F};
    const vk::PipelineMultisampleStateCreateInfo samples{};
    const vk::PipelineDepthStencilStateCreateInfo depth{
        .depthTestEnable = true, .depthWriteEnable = true, .depthCompareOp = vk::CompareOp::eLess};
    vk::PipelineColorBlendAttachmentState attachment;
    attachment.colorWriteMask = vk::FlagTraits<vk::ColorComponentFlagBits>::allFlags;
    const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 1, .pAttachments = &attachment};
    vk::PipelineRenderingCreateInfo rendering{.depthAttachmentFormat = kDepthFormat};
    rendering.setColorAttachmentFormats(kColorFormat);
    vk::GraphicsPipelineCreateInfo info{.pNext = &rendering, .pVertexInputState = &input, .layout = *layout};
    info.setStages(stages).setPInputAssemblyState(&assembly).setPViewportState(&viewports);
    info.setPRasterizationState(&raster).setPMultisampleState(&samples);
    info.setPDepthStencilState(&depth).setPColorBlendState(&blend);
    pipeline = device.createGraphicsPipelineUnique({}, info).value;
  }
};

// Vitrail's side: the raster, and the draws that it takes.
struct Glass {
  std::string reason; // of the library's last error
  vitrail::vulkan::Context context;
  vitrail::vulkan::Raster raster;
  Buffer draws;

  explicit Glass(const Gpu& gpu) : draws(gpu, sizeof(VitrailVkRasterDraw), vk::BufferUsageFlagBits::eStorageBuffer) {
    VitrailVkContextDesc contextDesc{
        .instance = *gpu.instance, .physicalDevice = gpu.physicalDevice, .device = *gpu.device};
    contextDesc.getInstanceProcAddr = vkGetInstanceProcAddr;
    contextDesc.log = [](VitrailLogSeverity, const char* message, void* user) {
      *static_cast<std::string*>(user) = message;
    };
    contextDesc.logUser = &reason;
    check(vitrail::vulkan::Context::create(contextDesc, context));

    VitrailVkRasterDesc desc{.extent = kExtent};
    desc.colorFormat = static_cast<VkFormat>(kColorFormat);
    desc.depthFormat = static_cast<VkFormat>(kDepthFormat);
    desc.setUp = {.code = kSetUpCode, .size = sizeof kSetUpCode};
    desc.setUpLarge = {.code = kSetUpLargeCode, .size = sizeof kSetUpLargeCode};
    desc.blend = {.code = kBlendCode, .size = sizeof kBlendCode};
    desc.blendDeep = {.code = kBlendDeepCode, .size = sizeof kBlendDeepCode};
    desc.indexType = VK_INDEX_TYPE_NONE_KHR;
    desc.blendModes = 1U << VITRAIL_BLEND_PREMULTIPLIED | 1U << VITRAIL_BLEND_MULTIPLY;
    desc.framesInFlight = 1; // draw() waits for each
    check(vitrail::vulkan::Raster::create(context, desc, raster));

    // Nine panes of two triangles: instances 1 to 9 of glass.glsl. A draw's blend mode is for shaders of one fragment.
    const VitrailVkRasterDraw panes{
        .count = 6, .instanceCount = 9, .firstInstance = 1, .vertexCount = 6, .blend = VITRAIL_BLEND_MULTIPLY};
    std::memcpy(draws.data, &panes, sizeof panes);
  }
  Glass(const Glass&) = delete; // the log has its address
  Glass& operator=(const Glass&) = delete;

  void check(VkResult result) const {
    if (result != VK_SUCCESS) throw std::runtime_error(reason);
  }
};

// What an image is used for: how it lies, by whom, and how.
struct Use {
  vk::ImageLayout layout;
  vk::PipelineStageFlags2 stages;
  vk::AccessFlags2 access;
};
using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
constexpr Use kDrawnColor{vk::ImageLayout::eColorAttachmentOptimal, Stage::eColorAttachmentOutput,
                          Access::eColorAttachmentWrite};
constexpr Use kDrawnDepth{vk::ImageLayout::eDepthStencilAttachmentOptimal,
                          Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                          Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite};
// What the raster wants: it draws over the colour, and reads the depth.
constexpr Use kRasterColor{vk::ImageLayout::eGeneral, Stage::eComputeShader,
                           Access::eShaderRead | Access::eShaderWrite};
constexpr Use kRasterDepth{vk::ImageLayout::eDepthStencilReadOnlyOptimal, Stage::eComputeShader, Access::eShaderRead};
constexpr Use kCopiedColor{vk::ImageLayout::eGeneral, Stage::eAllTransfer, Access::eTransferRead};

void recordBarrier(vk::CommandBuffer commands, const Image& image, const Use& before, const Use& after) {
  vk::ImageMemoryBarrier2 barrier{.oldLayout = before.layout, .newLayout = after.layout, .image = *image.image};
  barrier.setSrcStageMask(before.stages).setSrcAccessMask(before.access);
  barrier.setDstStageMask(after.stages).setDstAccessMask(after.access);
  barrier.setSubresourceRange({image.aspect, 0, 1, 0, 1});
  commands.pipelineBarrier2(vk::DependencyInfo{}.setImageMemoryBarriers(barrier));
}

void recordFloor(vk::CommandBuffer commands, const Floor& floor, const Image& color, const Image& depth) {
  // What a frame before has left in the images does not matter.
  recordBarrier(commands, color, {vk::ImageLayout::eUndefined, kCopiedColor.stages, {}}, kDrawnColor);
  recordBarrier(commands, depth, {vk::ImageLayout::eUndefined, kRasterDepth.stages, {}}, kDrawnDepth);
  const std::array kSky{0.70F, 0.77F, 0.84F, 1.0F};
  vk::RenderingAttachmentInfo colorInfo{.imageView = *color.view, .imageLayout = kDrawnColor.layout};
  colorInfo.setLoadOp(vk::AttachmentLoadOp::eClear).setClearValue(vk::ClearColorValue{kSky});
  vk::RenderingAttachmentInfo depthInfo{.imageView = *depth.view, .imageLayout = kDrawnDepth.layout};
  depthInfo.setLoadOp(vk::AttachmentLoadOp::eClear).setClearValue(vk::ClearDepthStencilValue{.depth = 1.0F});
  vk::RenderingInfo rendering{.renderArea = {{}, kExtent}, .layerCount = 1, .pDepthAttachment = &depthInfo};
  commands.beginRendering(rendering.setColorAttachments(colorInfo));
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *floor.pipeline);
  commands.draw(4, 1, 0, 0);
  commands.endRendering();
}

// Writer: the raster. Reader: the copy, whose reader is the host.
void recordCopy(vk::CommandBuffer commands, const Image& color, vk::Buffer copy) {
  recordBarrier(commands, color, kRasterColor, kCopiedColor);
  vk::BufferImageCopy region{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1}};
  commands.copyImageToBuffer(*color.image, vk::ImageLayout::eGeneral, copy,
                             region.setImageExtent({kExtent.width, kExtent.height, 1}));
  vk::MemoryBarrier2 toHost{.srcStageMask = Stage::eAllTransfer, .srcAccessMask = Access::eTransferWrite};
  toHost.setDstStageMask(Stage::eHost).setDstAccessMask(Access::eHostRead);
  commands.pipelineBarrier2(vk::DependencyInfo{}.setMemoryBarriers(toHost));
}

void savePng(const float* pixels, const char* path) {
  constexpr uint32_t kWidth = kExtent.width / 2, kHeight = kExtent.height / 2, kRow = 4 * kExtent.width;
  std::vector<png_byte> bytes;
  for (uint32_t i = 0; i < kWidth * kHeight * 3; ++i) {
    const float* p = pixels + size_t{2} * kRow * (i / 3 / kWidth) + 8 * (i / 3 % kWidth) + i % 3;
    const float mean = std::fmin((p[0] + p[4] + p[kRow] + p[kRow + 4]) / 4, 1.0F);
    const float curve = mean <= 0.0031308F ? 12.92F * mean : 1.055F * std::pow(mean, 1 / 2.4F) - 0.055F; // sRGB
    bytes.push_back(static_cast<png_byte>(std::lround(255 * curve)));
  }
  png_image image{nullptr, PNG_IMAGE_VERSION, kWidth, kHeight, PNG_FORMAT_RGB, 0, 0, 0, {}};
  if (png_image_write_to_file(&image, path, 0, bytes.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("cannot write ") + path + ": " + image.message);
  }
}

// Draws the frame until it is exact: after the first, the raster knows how much room it needs.
void draw(const char* path) {
  const Gpu gpu;
  const vk::Device device = *gpu.device;
  using Usage = vk::ImageUsageFlagBits;
  const Image color = createImage(gpu, kColorFormat, Usage::eColorAttachment | Usage::eStorage | Usage::eTransferSrc);
  const Image depth = createImage(gpu, kDepthFormat, Usage::eDepthStencilAttachment | Usage::eSampled);
  const Buffer picture(gpu, vk::DeviceSize{16} * kExtent.width * kExtent.height, vk::BufferUsageFlagBits::eTransferDst);
  const Floor floor(device);
  Glass glass(gpu);
  const vk::UniqueCommandPool pool = device.createCommandPoolUnique({.queueFamilyIndex = gpu.family});
  const vk::CommandBuffer commands = device.allocateCommandBuffers({.commandPool = *pool, .commandBufferCount = 1})[0];
  VitrailVkRasterInfo info{.draws = *glass.draws.buffer, .drawCount = 1, .color = *color.view, .depth = *depth.view};
  VitrailVkRasterStats stats{};
  do {
    glass.check(glass.raster.update(++info.frame));
    device.resetCommandPool(*pool);
    commands.begin(vk::CommandBufferBeginInfo{.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    recordFloor(commands, floor, color, depth);
    recordBarrier(commands, color, kDrawnColor, kRasterColor);
    recordBarrier(commands, depth, kDrawnDepth, kRasterDepth);
    glass.raster.draw(commands, info);
    recordCopy(commands, color, *picture.buffer);
    commands.end();
    device.getQueue(gpu.family, 0).submit(vk::SubmitInfo{}.setCommandBuffers(commands));
    device.waitIdle();
    glass.check(glass.raster.readStats(info.frame, stats));
  } while (stats.exact == VK_FALSE && stats.cutPixels == 0 && info.frame < 8);
  if (stats.exact == VK_FALSE) throw std::runtime_error("the picture is not exact: " + glass.reason);
  savePng(static_cast<const float*>(picture.data), path);
}

} // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::runtime_error("usage: raster PICTURE.png");
    draw(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "raster: error: %s\n", error.what());
    return 1;
  }
}
