// The smallest complete host: a cube of glass panes over a floor, drawn without a window. Every pane cuts through
// others: there is no order in which to draw them. What concerns Vitrail is in draw() and record().
//
//   minimal PICTURE.png          draws it
//   minimal PICTURE.png X Y      and lists the panes under that pixel of the file, front to back
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include <png.h>
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <vulkan/vulkan.hpp>

#include <vitrail/vitrail.hpp>

#include "shaders.h" // kVertexCode, kFloorCode, kGlassCode: made by CMakeLists.txt

namespace {

constexpr vk::Extent2D kExtent{.width = 1600, .height = 1200}; // four pixels make one of the file
constexpr vk::Format kColorFormat = vk::Format::eR32G32B32A32Sfloat;
constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;

// The first device, with Vulkan 1.2 and fragmentStoresAndAtomics: all that the library asks for.
struct Gpu {
  vk::UniqueInstance instance;
  vk::PhysicalDevice physicalDevice;
  uint32_t family = 0; // for graphics and compute
  vk::UniqueDevice device;

  Gpu() {
    const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_2};
    instance = vk::createInstanceUnique({.pApplicationInfo = &application});
    const std::vector<vk::PhysicalDevice> devices = instance->enumeratePhysicalDevices();
    if (devices.empty()) throw std::runtime_error("there is no Vulkan device");
    physicalDevice = devices[0];
    constexpr vk::QueueFlags kBoth = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
    const std::vector<vk::QueueFamilyProperties> families = physicalDevice.getQueueFamilyProperties();
    while (family + 1 < families.size() && (families[family].queueFlags & kBoth) != kBoth) ++family;
    const float priority = 1.0F;
    const vk::DeviceQueueCreateInfo queue{.queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
    const vk::PhysicalDeviceFeatures features{.fragmentStoresAndAtomics = true};
    device = physicalDevice.createDeviceUnique(
        {.queueCreateInfoCount = 1, .pQueueCreateInfos = &queue, .pEnabledFeatures = &features});
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
};

Image createImage(const Gpu& gpu, vk::Format format, vk::ImageUsageFlags usage) {
  Image result;
  vk::ImageCreateInfo info{.imageType = vk::ImageType::e2D, .format = format, .usage = usage};
  info.setExtent({kExtent.width, kExtent.height, 1}).setMipLevels(1).setArrayLayers(1);
  result.image = gpu.device->createImageUnique(info);
  const vk::MemoryRequirements needs = gpu.device->getImageMemoryRequirements(*result.image);
  result.memory = gpu.allocate(needs, vk::MemoryPropertyFlagBits::eDeviceLocal);
  gpu.device->bindImageMemory(*result.image, *result.memory, 0);
  const auto aspect = format == kDepthFormat ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
  vk::ImageViewCreateInfo view{.image = *result.image, .viewType = vk::ImageViewType::e2D, .format = format};
  result.view = gpu.device->createImageViewUnique(view.setSubresourceRange({aspect, 0, 1, 0, 1}));
  return result;
}

// A pass for opaque and transparent geometry, which leaves the colour to the resolve, a compute shader.
vk::UniqueRenderPass createRenderPass(vk::Device device) {
  constexpr vk::ImageLayout kDepthLayout = vk::ImageLayout::eDepthStencilAttachmentOptimal;
  const vk::AttachmentDescription attachments[] = {
      {.format = kColorFormat, .loadOp = vk::AttachmentLoadOp::eClear, .finalLayout = vk::ImageLayout::eGeneral},
      {.format = kDepthFormat, .loadOp = vk::AttachmentLoadOp::eClear, .finalLayout = kDepthLayout}};
  const vk::AttachmentReference color{.attachment = 0, .layout = vk::ImageLayout::eColorAttachmentOptimal};
  const vk::AttachmentReference depth{.attachment = 1, .layout = kDepthLayout};
  const vk::SubpassDescription subpass{
      .colorAttachmentCount = 1, .pColorAttachments = &color, .pDepthStencilAttachment = &depth};
  // Writer: the floor. Reader and writer: the resolve.
  vk::SubpassDependency toResolve{.srcSubpass = 0, .dstSubpass = VK_SUBPASS_EXTERNAL};
  toResolve.srcStageMask = vk::PipelineStageFlagBits::eColorAttachmentOutput;
  toResolve.srcAccessMask = vk::AccessFlagBits::eColorAttachmentWrite;
  toResolve.dstStageMask = vk::PipelineStageFlagBits::eComputeShader;
  toResolve.dstAccessMask = vk::AccessFlagBits::eShaderRead | vk::AccessFlagBits::eShaderWrite;
  return device.createRenderPassUnique(
      vk::RenderPassCreateInfo{}.setAttachments(attachments).setSubpasses(subpass).setDependencies(toResolve));
}

// The floor writes colour and depth. The glass writes neither: it is tested against the floor's depth, and collects.
template <size_t N>
vk::UniquePipeline createPipeline(vk::Device device, vk::PipelineLayout layout, vk::RenderPass pass,
                                  const uint32_t (&code)[N], bool opaque) {
  const auto vertex = device.createShaderModuleUnique({.codeSize = sizeof kVertexCode, .pCode = kVertexCode});
  const auto fragment = device.createShaderModuleUnique({.codeSize = sizeof code, .pCode = code});
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
      .depthTestEnable = true, .depthWriteEnable = opaque, .depthCompareOp = vk::CompareOp::eLess};
  vk::PipelineColorBlendAttachmentState attachment;
  if (opaque) attachment.colorWriteMask = vk::FlagTraits<vk::ColorComponentFlagBits>::allFlags;
  const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 1, .pAttachments = &attachment};
  vk::GraphicsPipelineCreateInfo info{.pVertexInputState = &input, .layout = layout, .renderPass = pass};
  info.setStages(stages).setPInputAssemblyState(&assembly).setPViewportState(&viewports);
  info.setPRasterizationState(&raster).setPMultisampleState(&samples);
  info.setPDepthStencilState(&depth).setPColorBlendState(&blend);
  return device.createGraphicsPipelineUnique({}, info).value;
}

// What a frame draws with.
struct Frame {
  vk::UniqueRenderPass pass;
  vk::UniqueFramebuffer framebuffer;
  vk::UniquePipelineLayout layout;
  vk::UniquePipeline floor;
  vk::UniquePipeline glass;
};

// A buffer that the host reads.
struct Readback {
  vk::UniqueDeviceMemory memory;
  vk::UniqueBuffer buffer;

  Readback(const Gpu& gpu, vk::DeviceSize size) {
    vk::BufferCreateInfo info{.usage = vk::BufferUsageFlagBits::eTransferDst};
    buffer = gpu.device->createBufferUnique(info.setSize(size));
    using Memory = vk::MemoryPropertyFlagBits;
    memory =
        gpu.allocate(gpu.device->getBufferMemoryRequirements(*buffer), Memory::eHostVisible | Memory::eHostCoherent);
    gpu.device->bindBufferMemory(*buffer, *memory, 0);
  }

  [[nodiscard]] const void* map(vk::Device device) const { return device.mapMemory(*memory, 0, VK_WHOLE_SIZE); }
};

// `pixel`: whose list is copied to `list`.
void record(vk::CommandBuffer commands, const vitrail::vulkan::Target& target, const Frame& frame,
            const VkOffset2D& pixel, vk::Buffer list) {
  const std::array kSky{0.70F, 0.77F, 0.84F, 1.0F};
  const vk::ClearValue clears[] = {vk::ClearColorValue{kSky}, vk::ClearDepthStencilValue{.depth = 1.0F}};
  vk::RenderPassBeginInfo begin{.renderPass = *frame.pass, .framebuffer = *frame.framebuffer};
  begin.setRenderArea({{}, kExtent}).setClearValues(clears);
  target.begin(commands);
  commands.beginRenderPass(begin, vk::SubpassContents::eInline);
  const vk::DescriptorSet lists = target.descriptorSet();
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *frame.layout, 0, lists, {});
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *frame.floor);
  commands.draw(4, 1, 0, 0);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *frame.glass);
  commands.draw(4, 9, 0, 1); // nine panes, in any order
  commands.endRenderPass();
  target.collected(commands);
  target.copyLists(commands, {.area = {pixel, {1, 1}}, .buffer = list, .size = target.copySize(1, 1)});
  target.resolve(commands);
  target.end(commands);
}

// Writer: the resolve. Reader: the copy. Its reader, and that of the list that was copied before, is the host.
void recordCopy(vk::CommandBuffer commands, vk::Image color, vk::Buffer copy) {
  using Stage = vk::PipelineStageFlagBits;
  using Access = vk::AccessFlagBits;
  const vk::MemoryBarrier toCopy{.srcAccessMask = Access::eShaderWrite, .dstAccessMask = Access::eTransferRead};
  commands.pipelineBarrier(Stage::eComputeShader, Stage::eTransfer, {}, toCopy, {}, {});
  vk::BufferImageCopy region{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1}};
  commands.copyImageToBuffer(color, vk::ImageLayout::eGeneral, copy,
                             region.setImageExtent({kExtent.width, kExtent.height, 1}));
  const vk::MemoryBarrier toHost{.srcAccessMask = Access::eTransferWrite, .dstAccessMask = Access::eHostRead};
  commands.pipelineBarrier(Stage::eTransfer, Stage::eHost, {}, toHost, {}, {});
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

// A copy of one pixel's list: the header, where its layers are, the layers. A pane has two, one behind the other.
void printPanes(const void* copy) {
  const auto* header = static_cast<const VitrailVkCopyHeader*>(copy);
  const auto* list = reinterpret_cast<const VitrailVkCopiedList*>(header + 1);
  const auto* layers = reinterpret_cast<const VitrailLayer*>(list + 1) + list->first;
  for (uint32_t i = 0; i < list->count; ++i) {
    if (i == 0 || layers[i].word != layers[i - 1].word)
      std::printf("pane %u at depth %.6f\n", layers[i].word, layers[i].depth);
  }
}

void draw(const char* path, const VkOffset2D* place) {
  const Gpu gpu;
  std::string reason;
  const auto check = [&](VkResult result) {
    if (result != VK_SUCCESS) throw std::runtime_error(reason);
  };
  VitrailVkContextDesc contextDesc{
      .instance = *gpu.instance, .physicalDevice = gpu.physicalDevice, .device = *gpu.device};
  contextDesc.getInstanceProcAddr = vkGetInstanceProcAddr;
  contextDesc.log = [](VitrailLogSeverity, const char* message, void* user) {
    *static_cast<std::string*>(user) = message;
  };
  contextDesc.logUser = &reason;
  vitrail::vulkan::Context context;
  check(vitrail::vulkan::Context::create(contextDesc, context));

  using Usage = vk::ImageUsageFlagBits;
  const Image color = createImage(gpu, kColorFormat, Usage::eColorAttachment | Usage::eStorage | Usage::eTransferSrc);
  const Image depth = createImage(gpu, kDepthFormat, Usage::eDepthStencilAttachment);
  const VkImageView colorView = *color.view;
  VitrailVkTargetDesc targetDesc{.extent = kExtent, .userWords = VK_TRUE, .nodeCapacity = 8'000'000, .copyLayers = 100};
  targetDesc.colorFormat = static_cast<VkFormat>(kColorFormat);
  targetDesc.views = {.count = 1, .color = &colorView};
  vitrail::vulkan::Target target;
  check(vitrail::vulkan::Target::create(context, targetDesc, target));

  const vk::Device device = *gpu.device;
  Frame frame;
  frame.pass = createRenderPass(device);
  const vk::ImageView views[] = {*color.view, *depth.view};
  vk::FramebufferCreateInfo framebuffer{.renderPass = *frame.pass, .width = kExtent.width, .height = kExtent.height};
  frame.framebuffer = device.createFramebufferUnique(framebuffer.setAttachments(views).setLayers(1));
  const vk::DescriptorSetLayout lists = context.descriptorSetLayout();
  frame.layout = device.createPipelineLayoutUnique({.setLayoutCount = 1, .pSetLayouts = &lists});
  frame.floor = createPipeline(device, *frame.layout, *frame.pass, kFloorCode, true);
  frame.glass = createPipeline(device, *frame.layout, *frame.pass, kGlassCode, false);

  const Readback picture(gpu, vk::DeviceSize{16} * kExtent.width * kExtent.height);
  const Readback list(gpu, target.copySize(1, 1));
  const VkOffset2D pixel = place != nullptr ? VkOffset2D{2 * place->x + 1, 2 * place->y + 1} : VkOffset2D{0, 0};
  const vk::UniqueCommandPool pool = device.createCommandPoolUnique({.queueFamilyIndex = gpu.family});
  const vk::CommandBuffer commands = device.allocateCommandBuffers({.commandPool = *pool, .commandBufferCount = 1})[0];
  commands.begin(vk::CommandBufferBeginInfo{});
  record(commands, target, frame, pixel, *list.buffer);
  recordCopy(commands, *color.image, *picture.buffer);
  commands.end();
  device.getQueue(gpu.family, 0).submit(vk::SubmitInfo{}.setCommandBuffers(commands));
  device.waitIdle();

  VitrailStats stats{};
  check(target.readStats(0, stats));
  if (stats.complete == 0) throw std::runtime_error("the node pool is too small for the frame");
  savePng(static_cast<const float*>(picture.map(device)), path);
  if (place != nullptr) printPanes(list.map(device));
}

} // namespace

int main(int argc, char** argv) {
  try {
    const bool lists = argc == 4;
    if (argc != 2 && !lists) throw std::runtime_error("usage: minimal PICTURE.png [X Y]");
    const VkOffset2D place = lists ? VkOffset2D{std::atoi(argv[2]), std::atoi(argv[3])} : VkOffset2D{};
    if (place.x < 0 || place.y < 0 || place.x >= int(kExtent.width / 2) || place.y >= int(kExtent.height / 2)) {
      throw std::runtime_error("the picture has 800 by 600 pixels");
    }
    draw(argv[1], lists ? &place : nullptr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "minimal: error: %s\n", error.what());
    return 1;
  }
}
