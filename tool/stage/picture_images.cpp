#include "picture_images.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "../gpu/accesses.h"
#include "../gpu/vk.h"

namespace vitrail::tool {

namespace {

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
  image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | info.depthUsage;
  image.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  if (info.stencil) image.aspect |= VK_IMAGE_ASPECT_STENCIL_BIT;
  return {gpu, image, "depth image"};
}

// A view that shaders sample, which may show one aspect only.
Unique<VkImageView> makeAspectView(Gpu& gpu, const GpuImage& depth, VkImageAspectFlags aspect, const char* name) {
  auto info = vkStruct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  info.image = depth.get();
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = depth.info().format;
  info.subresourceRange = {aspect, 0, 1, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(gpu.device(), &info, nullptr, &view), "vkCreateImageView (sampled depth or stencil)");
  setDebugName(gpu.device(), VK_OBJECT_TYPE_IMAGE_VIEW, view, name);
  return {gpu.device(), view, vkDestroyImageView};
}

} // namespace

PictureImages::PictureImages(Gpu& gpu, const PictureImagesInfo& info) : info_(info), part_(info.extent) {
  checkExtent(gpu, info.extent);
  color_ = UsedImage(makeColor(gpu, info, VK_SAMPLE_COUNT_1_BIT, "colour image"));
  depth_ = UsedImage(makeDepth(gpu, info));
  if ((info.depthUsage & VK_IMAGE_USAGE_SAMPLED_BIT) != 0) {
    sampledDepth_ = makeAspectView(gpu, depth_.get(), VK_IMAGE_ASPECT_DEPTH_BIT, "sampled depth");
    if (info.stencil) {
      sampledStencil_ = makeAspectView(gpu, depth_.get(), VK_IMAGE_ASPECT_STENCIL_BIT, "sampled stencil");
    }
  }
  if (info.samples > VK_SAMPLE_COUNT_1_BIT) {
    multisampled_ = UsedImage(makeColor(gpu, info, info.samples, "multisampled colour image"));
  }
}

void PictureImages::cmdBeginOpaque(VkCommandBuffer commands, const VkClearColorValue& background) {
  color_.discard();
  multisampled_.discard();
  depth_.discard();
  Scope scope = wholeScope();
  scope.colors.push_back({.image = &drawn(), .clear = background});
  scope.depth = {.image = &depth_, .depth = AspectUse::Write, .clear = VkClearDepthStencilValue{0.0F, 0}};
  if (info_.stencil) scope.depth.stencil = AspectUse::Write;
  cmdBeginScope(commands, scope);
}

Scope PictureImages::wholeScope() const {
  Scope scope;
  scope.extent = extent();
  scope.area = {{0, 0}, extent()};
  return scope;
}

Scope PictureImages::transparentScope(const VkRect2D& area) {
  Scope scope = wholeScope();
  scope.area = area;
  scope.depth = {.image = &depth_, .depth = AspectUse::Test};
  if (info_.stencil) scope.depth.stencil = AspectUse::Write;
  return scope;
}

void PictureImages::cmdToComputeResolve(VkCommandBuffer commands) {
  if (info_.samples > VK_SAMPLE_COUNT_1_BIT && !info_.perSample) {
    // The opaque draws wrote colour -> the resolve samples it.
    multisampled_.cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kComputeSample);
  }
  if (sampledDepth() != VK_NULL_HANDLE) {
    // The transparent draws tested depth -> the resolve samples it.
    depth_.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, kComputeSample);
  }
  // The opaque draws, or the resolve of another part, wrote colour -> the resolve reads and writes it.
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
}

Scope PictureImages::resolveScope(VkCommandBuffer commands, const VkRect2D& area) {
  const bool toOne = info_.samples > VK_SAMPLE_COUNT_1_BIT && !info_.perSample;
  if (toOne) {
    // The opaque draws wrote colour -> the resolve samples it.
    multisampled_.cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kFragmentSample);
  }
  Scope scope = wholeScope();
  scope.area = area;
  // The opaque draws, or the resolve of another part, wrote colour -> the resolve blends into it, or replaces it.
  scope.colors.push_back({.image = toOne ? &color_ : &drawn(), .keep = !toOne});
  scope.depth = {.image = &depth_, .sampled = sampledDepth() != VK_NULL_HANDLE};
  if (info_.stencil && !toOne) scope.depth.stencil = AspectUse::Test;
  return scope;
}

void PictureImages::cmdBoxFilter(VkCommandBuffer commands) {
  Scope scope = wholeScope();
  scope.colors.push_back({.image = &multisampled_, .average = &color_});
  cmdBeginScope(commands, scope);
  vkCmdEndRendering(commands);
}

void PictureImages::cmdToEncode(VkCommandBuffer commands) {
  // The last pass wrote colour -> the encoding reads it.
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeRead);
}

} // namespace vitrail::tool
