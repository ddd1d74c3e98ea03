#include "scope.h"

#include "accesses.h"
#include "vk.h"

namespace vitrail::tool {

namespace {

constexpr VkImageLayout kColorLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;

VkRenderingAttachmentInfo colorInfo(VkCommandBuffer commands, const ColorAttachment& color) {
  auto info = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  info.imageView = color.image->get().view();
  info.imageLayout = kColorLayout;
  info.loadOp = color.keep ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  if (color.clear) {
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.clearValue.color = *color.clear;
  }
  if (color.average == nullptr) {
    // Who used the image last -> the clear writes it, or the draws read and write it.
    color.image->cmdUse(commands, kColorLayout, color.clear ? kColorReplace : kColorBlend);
    return info;
  }
  // Who drew the samples -> the end of the scope reads them and writes the means.
  color.image->cmdUse(commands, kColorLayout, kColorRead);
  color.average->cmdUse(commands, kColorLayout, kColorReplace);
  info.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
  info.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
  info.resolveImageView = color.average->get().view();
  info.resolveImageLayout = kColorLayout;
  return info;
}

VkImageLayout depthLayout(AspectUse depth, AspectUse stencil) {
  const bool writesDepth = depth == AspectUse::Write;
  const bool writesStencil = stencil == AspectUse::Write;
  if (writesDepth && stencil == AspectUse::Test) return VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_STENCIL_READ_ONLY_OPTIMAL;
  if (writesDepth) return VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  if (writesStencil) return VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL;
  return VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
}

VkRenderingAttachmentInfo aspectInfo(const DepthAttachment& depth, VkImageLayout layout, AspectUse use) {
  auto info = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  info.imageView = depth.image->get().view();
  info.imageLayout = layout;
  info.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  info.storeOp = use == AspectUse::Write ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_NONE;
  if (use == AspectUse::Write && depth.clear) {
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.clearValue.depthStencil = *depth.clear;
  }
  return info;
}

Access depthAccess(const DepthAttachment& depth, AspectUse stencil) {
  Access access;
  if (depth.depth != AspectUse::None || stencil != AspectUse::None) access = kDepthTest;
  if (depth.depth == AspectUse::Write || stencil == AspectUse::Write) access = kDepthWrite;
  if (depth.sampled) {
    access.stages |= kFragmentSample.stages;
    access.accesses |= kFragmentSample.accesses;
  }
  return access;
}

} // namespace

void cmdBeginScope(VkCommandBuffer commands, const Scope& scope) {
  std::vector<VkRenderingAttachmentInfo> colors;
  colors.reserve(scope.colors.size());
  for (const ColorAttachment& color : scope.colors) colors.push_back(colorInfo(commands, color));

  auto info = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  info.renderArea = scope.area;
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  VkRenderingAttachmentInfo depth{};
  VkRenderingAttachmentInfo stencil{};
  if (scope.depth.image != nullptr) {
    const bool both = (scope.depth.image->get().info().aspect & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
    AspectUse stencilUse = scope.depth.stencil;
    if (both && scope.depth.depth != AspectUse::None && stencilUse == AspectUse::None) stencilUse = AspectUse::Test;
    const VkImageLayout layout = depthLayout(scope.depth.depth, stencilUse);
    const Access access = depthAccess(scope.depth, stencilUse);
    // Who used depth and stencil last -> the scope tests, writes or samples them.
    if (access.accesses != VK_ACCESS_2_NONE) scope.depth.image->cmdUse(commands, layout, access);
    depth = aspectInfo(scope.depth, layout, scope.depth.depth);
    stencil = aspectInfo(scope.depth, layout, stencilUse);
    if (scope.depth.depth != AspectUse::None) info.pDepthAttachment = &depth;
    if (stencilUse != AspectUse::None) info.pStencilAttachment = &stencil;
  }
  vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0.0F, 0.0F, static_cast<float>(scope.extent.width), static_cast<float>(scope.extent.height),
                            0.0F, 1.0F};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scope.area);
}

} // namespace vitrail::tool
