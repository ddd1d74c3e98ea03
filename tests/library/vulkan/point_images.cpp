#include "point_images.h"

#include <algorithm>
#include <cstring>

#include "shaders/opaque.h"

namespace vitrail::tests::vulkan {

namespace {

VkRenderingAttachmentInfo attachment(const Image& image, VkImageLayout layout, VkAttachmentLoadOp load,
                                     VkAttachmentStoreOp store = VK_ATTACHMENT_STORE_OP_STORE) {
  auto info = zeroed<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  info.imageView = image.view();
  info.imageLayout = layout;
  info.loadOp = load;
  info.storeOp = store;
  return info;
}

VkClearValue clearTo(const FloatColor& color) {
  VkClearValue value{};
  std::copy(color.begin(), color.end(), value.color.float32);
  return value;
}

} // namespace

VkFormat PointImages::colorFormat(const HostDesc& desc) {
  return desc.colorFormat == ColorFormat::Float16 ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

VkFormat PointImages::depthFormat(const HostDesc& desc) {
  if (desc.stencilMark) return VK_FORMAT_D32_SFLOAT_S8_UINT;
  return desc.samples > 1 || !desc.opaqueDepth.empty() ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;
}

PointImages::PointImages(const Device& device, const HostDesc& desc) : desc_(desc) {
  const VkExtent2D extent = {desc.width, desc.height};
  const auto samples = static_cast<VkSampleCountFlagBits>(desc.samples);
  color_ = Image(device, extent, colorFormat(desc), VK_SAMPLE_COUNT_1_BIT,
                 VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                     VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  if (severalSamples()) {
    multisampled_ =
        Image(device, extent, colorFormat(desc), samples,
              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  }
  if (depthFormat(desc) != VK_FORMAT_UNDEFINED) {
    depth_ = Image(device, extent, depthFormat(desc), samples,
                   VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  }
  readback_ = Buffer(device, std::uint64_t{desc.width} * desc.height * sizeof(FloatColor),
                     VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::Host);
}

// Null attachments are left out.
void PointImages::cmdBeginScope(VkCommandBuffer commands, const VkRenderingAttachmentInfo* color,
                                const VkRenderingAttachmentInfo* depth,
                                const VkRenderingAttachmentInfo* stencil) const {
  auto info = zeroed<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  info.renderArea = {{0, 0}, {desc_.width, desc_.height}};
  info.layerCount = 1;
  info.colorAttachmentCount = color != nullptr ? 1 : 0;
  info.pColorAttachments = color;
  info.pDepthAttachment = depth;
  info.pStencilAttachment = stencil;
  vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0.0F, 0.0F, static_cast<float>(desc_.width), static_cast<float>(desc_.height), 0.0F, 1.0F};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
}

// Fills the image that a per-pixel resolve of several samples writes.
void PointImages::cmdClear(VkCommandBuffer commands) {
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  auto color = attachment(color_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR);
  color.clearValue = clearTo(desc_.beforeResolve);
  cmdBeginScope(commands, &color, nullptr, nullptr);
  vkCmdEndRendering(commands);
}

void PointImages::cmdOpaque(VkCommandBuffer commands, PointPipelines& pipelines) {
  for (Image* image : {&color_, &multisampled_, &depth_}) image->forget();
  if (severalSamples() && !perSample()) cmdClear(commands);
  Image& drawn = severalSamples() ? multisampled_ : color_;
  // Writer: nobody that matters, the old picture is dropped. Writers after: the clear and the draws.
  drawn.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  auto color = attachment(drawn, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR);
  color.clearValue = clearTo(desc_.behind);
  VkRenderingAttachmentInfo depth{};
  const float farthest = desc_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 0.0F : 1.0F;
  if (depth_) {
    depth_.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, kDepthWrite);
    depth = attachment(depth_, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR);
    depth.clearValue.depthStencil = {farthest, 0};
  }
  cmdBeginScope(commands, &color, depth_ ? &depth : nullptr, desc_.stencilMark ? &depth : nullptr);
  const bool differs = !desc_.behindSamples.empty() || !desc_.opaqueDepth.empty();
  for (std::uint32_t s = 0; differs && s < desc_.samples; ++s) {
    OpaqueConstants constants{};
    const FloatColor here = behindAt(desc_, s);
    std::copy(here.begin(), here.end(), constants.color);
    constants.depth = desc_.opaqueDepth.empty() ? farthest : desc_.opaqueDepth.at(s);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.opaque(1U << s));
    vkCmdPushConstants(commands, pipelines.opaqueLayout(), VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof(constants), &constants);
    vkCmdDraw(commands, 3, 1, 0, 0);
  }
  vkCmdEndRendering(commands);
}

void PointImages::cmdBeginPoints(VkCommandBuffer commands) {
  VkRenderingAttachmentInfo depth{};
  if (depth_) {
    // Writers: the opaque draws. Readers: the depth test; with a stencil, writers too.
    const VkImageLayout layout = desc_.stencilMark ? VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL
                                                   : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    depth_.cmdUse(commands, layout, desc_.stencilMark ? kDepthWrite : kDepthTest);
    depth = attachment(depth_, layout, VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_NONE);
  }
  VkRenderingAttachmentInfo stencil = depth;
  stencil.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  cmdBeginScope(commands, nullptr, depth_ ? &depth : nullptr, desc_.stencilMark ? &stencil : nullptr);
}

void PointImages::cmdToResolve(VkCommandBuffer commands) {
  const bool compute = desc_.resolve != VITRAIL_RESOLVE_FRAGMENT;
  const VkPipelineStageFlags2 stage =
      compute ? VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT : VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  if (severalSamples() && !perSample()) {
    // Writers: the opaque draws. Reader: the resolve.
    multisampled_.cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                         {stage, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
  }
  if (depth_) {
    // Writers: the opaque draws and the stencil marks. Readers: the resolve and its stencil test.
    depth_.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                  {stage | kDepthTest.stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | kDepthTest.accesses});
  }
  if (!compute) {
    cmdBeginResolve(commands);
    return;
  }
  // Writers: the opaque draws, or the resolve of another area. Reader and writer: the resolve.
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL,
                {stage, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
}

void PointImages::cmdBeginResolve(VkCommandBuffer commands) {
  Image& drawn = perSample() ? multisampled_ : color_;
  // Writers: the opaque draws, or the resolve of another area. Reader and writer: the resolve.
  drawn.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  const auto color = attachment(drawn, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD);
  const bool hasStencil = desc_.stencilMark && (!severalSamples() || perSample());
  VkRenderingAttachmentInfo stencil{};
  if (hasStencil) {
    stencil = attachment(depth_, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                         VK_ATTACHMENT_STORE_OP_NONE);
  }
  cmdBeginScope(commands, &color, nullptr, hasStencil ? &stencil : nullptr);
}

void PointImages::cmdPicture(VkCommandBuffer commands) {
  const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  const VkExtent3D all = {desc_.width, desc_.height, 1};
  if (perSample()) {
    // Writer: the resolve of the lists. Reader and writer: the box filter.
    multisampled_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL,
                         {VK_PIPELINE_STAGE_2_RESOLVE_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
    color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, {VK_PIPELINE_STAGE_2_RESOLVE_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
    const VkImageResolve region{layers, {}, layers, {}, all};
    vkCmdResolveImage(commands, multisampled_.get(), VK_IMAGE_LAYOUT_GENERAL, color_.get(), VK_IMAGE_LAYOUT_GENERAL, 1,
                      &region);
  }
  // Writer: the resolve. Reader: the copy.
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kCopyRead);
  VkBufferImageCopy copy{};
  copy.imageSubresource = layers;
  copy.imageExtent = all;
  vkCmdCopyImageToBuffer(commands, color_.get(), VK_IMAGE_LAYOUT_GENERAL, readback_.get(), 1, &copy);
  // Writer: the copy. Reader: the host.
  cmdBarrier(commands, kCopyWrite, kHostAccess);
}

std::vector<FloatColor> PointImages::pixels() const {
  std::vector<FloatColor> pixels;
  if (desc_.colorFormat != ColorFormat::Float32) return pixels;
  pixels.resize(std::size_t{desc_.width} * desc_.height);
  std::memcpy(pixels.data(), readback_.mapped(), pixels.size() * sizeof(FloatColor));
  return pixels;
}

} // namespace vitrail::tests::vulkan
