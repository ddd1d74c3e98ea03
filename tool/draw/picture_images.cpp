#include "picture_images.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "vk.h"

namespace vitrail::tool {

namespace {

// The uses of the images. Blending reads colour, and a clear writes it.
constexpr Access kColorReplace{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr Access kColorBlend{kColorReplace.stages,
                             VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr Access kColorRead{kColorReplace.stages, VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT};
constexpr Access kDepthTest{VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
constexpr Access kDepthWrite{kDepthTest.stages, kDepthTest.accesses | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr Access kComputeReadWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                   VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Access kComputeSample{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
constexpr Access kFragmentSample{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
constexpr Access kComputeRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};

constexpr VkAccessFlags2 kReads = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
                                  VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                                  VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;

VkRenderingAttachmentInfo attachment(const GpuImage& image, VkImageLayout layout, VkAttachmentLoadOp load,
                                     VkAttachmentStoreOp store) {
  auto info = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  info.imageView = image.view();
  info.imageLayout = layout;
  info.loadOp = load;
  info.storeOp = store;
  return info;
}

// The attachments of a scope; null: none of that kind.
struct Attachments {
  const VkRenderingAttachmentInfo* color = nullptr;
  const VkRenderingAttachmentInfo* depth = nullptr;
  const VkRenderingAttachmentInfo* stencil = nullptr;
};

// The viewport is the whole picture, whatever part of it is drawn.
void cmdBeginScope(VkCommandBuffer commands, VkExtent2D picture, const VkRect2D& area, const Attachments& attachments) {
  auto info = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  info.renderArea = area;
  info.layerCount = 1;
  info.colorAttachmentCount = attachments.color != nullptr ? 1 : 0;
  info.pColorAttachments = attachments.color;
  info.pDepthAttachment = attachments.depth;
  info.pStencilAttachment = attachments.stencil;
  vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0.0F, 0.0F, static_cast<float>(picture.width), static_cast<float>(picture.height),
                            0.0F, 1.0F};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &area);
}

void checkExtent(const Gpu& gpu, VkExtent2D extent) {
  const VkPhysicalDeviceLimits& limits = gpu.properties().limits;
  const std::uint32_t width =
      std::min({limits.maxImageDimension2D, limits.maxFramebufferWidth, limits.maxViewportDimensions[0]});
  const std::uint32_t height =
      std::min({limits.maxImageDimension2D, limits.maxFramebufferHeight, limits.maxViewportDimensions[1]});
  if (extent.width < 1 || extent.height < 1) throw GpuError("a picture has at least 1x1 pixels");
  if (extent.width > width || extent.height > height) {
    throw GpuError(fmt::format("a picture of {}x{} pixels is too large: {} renders at most {}x{}", extent.width,
                               extent.height, gpu.properties().deviceName, width, height));
  }
}

GpuImage makeColor(Gpu& gpu, const PictureImagesInfo& info, VkSampleCountFlagBits samples, const char* name) {
  GpuImageInfo image;
  image.extent = info.extent;
  image.format = PictureImages::kColorFormat;
  image.samples = samples;
  image.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (samples == VK_SAMPLE_COUNT_1_BIT) image.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  if (samples > VK_SAMPLE_COUNT_1_BIT && !info.perSample) image.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  return {gpu, image, name};
}

GpuImage makeDepth(Gpu& gpu, const PictureImagesInfo& info) {
  GpuImageInfo image;
  image.extent = info.extent;
  image.format = PictureImages::depthFormat(info.stencil);
  image.samples = info.samples;
  image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if (info.sampledDepth) image.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  image.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  if (info.stencil) image.aspect |= VK_IMAGE_ASPECT_STENCIL_BIT;
  return {gpu, image, "depth image"};
}

// A view that shaders sample, which may not show a stencil too.
Unique<VkImageView> makeDepthView(Gpu& gpu, const GpuImage& depth) {
  auto info = vkStruct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  info.image = depth.get();
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = depth.info().format;
  info.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(gpu.device(), &info, nullptr, &view), "vkCreateImageView (sampled depth)");
  setDebugName(gpu.device(), VK_OBJECT_TYPE_IMAGE_VIEW, view, "sampled depth");
  return {gpu.device(), view, vkDestroyImageView};
}

} // namespace

void UsedImage::cmdUse(VkCommandBuffer commands, VkImageLayout layout, const Access& access) {
  const bool same = layout == layout_ && access.stages == access_.stages && access.accesses == access_.accesses;
  if (same && (access.accesses & ~kReads) == 0) return; // reading goes on
  cmdImageBarrier(commands, image_.get(), image_.range(), layout_, access_, layout, access);
  layout_ = layout;
  access_ = access;
}

void UsedImage::forget() {
  layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
  access_ = {};
}

PictureImages::PictureImages(Gpu& gpu, const PictureImagesInfo& info) : info_(info) {
  checkExtent(gpu, info.extent);
  color_ = UsedImage(makeColor(gpu, info, VK_SAMPLE_COUNT_1_BIT, "colour image"));
  depth_ = UsedImage(makeDepth(gpu, info));
  if (info.sampledDepth) sampledDepth_ = makeDepthView(gpu, depth_.get());
  if (info.samples > VK_SAMPLE_COUNT_1_BIT) {
    multisampled_ = UsedImage(makeColor(gpu, info, info.samples, "multisampled colour image"));
  }
}

void PictureImages::cmdBeginOpaque(VkCommandBuffer commands, const VkClearColorValue& background) {
  color_.forget();
  multisampled_.forget();
  depth_.forget();
  // Nobody (the frame before was waited for) -> the clear and the opaque draws write colour and depth.
  drawn().cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorReplace);
  depth_.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, kDepthWrite);
  auto color = attachment(drawn().get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR,
                          VK_ATTACHMENT_STORE_OP_STORE);
  color.clearValue.color = background;
  auto depth = attachment(depth_.get(), VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR,
                          VK_ATTACHMENT_STORE_OP_STORE);
  depth.clearValue.depthStencil = {0.0F, 0};
  cmdBeginScope(commands, extent(), {{0, 0}, extent()}, {&color, &depth, info_.stencil ? &depth : nullptr});
}

void PictureImages::cmdBeginTransparent(VkCommandBuffer commands, const VkRect2D& area, bool color) {
  // The opaque draws wrote depth and cleared the stencil -> the transparent draws test the one and mark the other.
  const VkImageLayout layout = info_.stencil ? VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL
                                             : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  depth_.cmdUse(commands, layout, info_.stencil ? kDepthWrite : kDepthTest);
  const auto depth = attachment(depth_.get(), layout, VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_NONE);
  const auto stencil = attachment(depth_.get(), layout, VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
  const auto blended = attachment(drawn().get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                                  VK_ATTACHMENT_STORE_OP_STORE);
  // The opaque draws wrote colour -> the transparent ones blend into it.
  if (color) drawn().cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  cmdBeginScope(commands, extent(), area, {color ? &blended : nullptr, &depth, info_.stencil ? &stencil : nullptr});
}

void PictureImages::cmdToSampled(VkCommandBuffer commands, VkPipelineStageFlags2 stage) {
  if (info_.samples == VK_SAMPLE_COUNT_1_BIT || info_.perSample) return;
  // The opaque draws wrote colour -> the resolve samples it.
  multisampled_.cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       {stage, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
}

void PictureImages::cmdToComputeResolve(VkCommandBuffer commands) {
  cmdToSampled(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  if (info_.sampledDepth) {
    // The transparent draws tested depth -> the resolve samples it.
    depth_.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, kComputeSample);
  }
  // The opaque draws, or the resolve of another part, wrote colour -> the resolve reads and writes it.
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
}

void PictureImages::cmdBeginResolve(VkCommandBuffer commands, const VkRect2D& area) {
  cmdToSampled(commands, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
  const bool toOne = info_.samples > VK_SAMPLE_COUNT_1_BIT && !info_.perSample;
  UsedImage& target = toOne ? color_ : drawn();
  // The opaque draws, or the resolve of another part, wrote colour -> the resolve blends into it, or replaces it.
  target.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  const auto color =
      attachment(target.get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 toOne ? VK_ATTACHMENT_LOAD_OP_DONT_CARE : VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
  const bool hasStencil = info_.stencil && !toOne;
  Access depthUse;
  if (hasStencil) depthUse = kDepthTest;
  if (info_.sampledDepth) {
    depthUse.stages |= kFragmentSample.stages;
    depthUse.accesses |= kFragmentSample.accesses;
  }
  // The transparent draws tested depth and marked the stencil -> the resolve samples the one and tests the other.
  if (depthUse.accesses != VK_ACCESS_2_NONE) {
    depth_.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, depthUse);
  }
  const auto stencil = attachment(depth_.get(), VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                  VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_NONE);
  cmdBeginScope(commands, extent(), area, {&color, nullptr, hasStencil ? &stencil : nullptr});
}

void PictureImages::cmdBoxFilter(VkCommandBuffer commands) {
  // The draws wrote every sample -> the end of an empty scope reads them and writes the picture.
  multisampled_.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorRead);
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorReplace);
  auto color = attachment(multisampled_.get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                          VK_ATTACHMENT_STORE_OP_NONE);
  color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
  color.resolveImageView = color_.get().view();
  color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  cmdBeginScope(commands, extent(), {{0, 0}, extent()}, {&color, nullptr, nullptr});
  vkCmdEndRendering(commands);
}

void PictureImages::cmdToEncode(VkCommandBuffer commands) {
  // The last pass wrote colour -> the encoding reads it.
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeRead);
}

} // namespace vitrail::tool
