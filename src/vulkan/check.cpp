#include "check.h"

#include "convert.h"
#include "core/target_common.h"

namespace vitrail {

namespace {

bool computeWrites(VkFormat format) {
  return format == VK_FORMAT_R16G16B16A16_SFLOAT || format == VK_FORMAT_R32G32B32A32_SFLOAT;
}

VkFormatFeatureFlags featuresOf(const VitrailVkContext_T& context, VkFormat format) {
  VkFormatProperties properties{};
  context.vk.GetPhysicalDeviceFormatProperties(context.physicalDevice, format, &properties);
  return properties.optimalTilingFeatures;
}

bool hasDepth(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return true;
    default:
      return false;
  }
}

bool hasStencil(VkFormat format) {
  switch (format) {
    case VK_FORMAT_S8_UINT:
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return true;
    default:
      return false;
  }
}

VkResult checkColorFormat(const VitrailVkContext_T& context, VkFormat format, bool compute) {
  if (compute && !computeWrites(format)) {
    return context.log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED,
                            "colorFormat %d: a compute resolve writes VK_FORMAT_R16G16B16A16_SFLOAT or "
                            "VK_FORMAT_R32G32B32A32_SFLOAT",
                            format);
  }
  constexpr VkFormat kLastOfCore = VK_FORMAT_ASTC_12x12_SRGB_BLOCK;
  constexpr int kFirstOfExtensions = 1000000000;
  if (format > kLastOfCore && static_cast<int>(format) < kFirstOfExtensions) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED, "colorFormat %d is none of VkFormat", format);
  }
  const VkFormatFeatureFlags needed =
      compute ? VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT : VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
  if ((featuresOf(context, format) & needed) == 0) {
    return context.log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED, "colorFormat %d: this device cannot use it as %s", format,
                            compute ? "storage image" : "blended attachment");
  }
  return VK_SUCCESS;
}

VkResult checkScope(const VitrailVkContext_T& context, const VitrailVkScope& scope) {
  if (scope.depthFormat != VK_FORMAT_UNDEFINED && !hasDepth(scope.depthFormat)) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED, "scope.depthFormat %d is no depth format",
                            scope.depthFormat);
  }
  if (scope.stencilFormat != VK_FORMAT_UNDEFINED && !hasStencil(scope.stencilFormat)) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED, "scope.stencilFormat %d is no stencil format",
                            scope.stencilFormat);
  }
  if (scope.depthFormat != VK_FORMAT_UNDEFINED && scope.stencilFormat != VK_FORMAT_UNDEFINED &&
      scope.depthFormat != scope.stencilFormat) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED,
                            "scope.depthFormat %d and stencilFormat %d: a scope has one image of both, of one format",
                            scope.depthFormat, scope.stencilFormat);
  }
  if (scope.stencilMask != 0 && (scope.stencilMask & 0xffU) == 0) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED, "scope.stencilMask 0x%x: a stencil has 8 bits",
                            scope.stencilMask);
  }
  return VK_SUCCESS;
}

} // namespace

VkResult checkNext(const Log& log, const void* next, const char* structure) {
  return toVk(checkNoNext(log, next, structure));
}

VkResult nullArgument(const VitrailVkContext_T* context, const char* call) {
  if (context != nullptr) context->log.error("%s: an argument is null", call);
  return VK_ERROR_INITIALIZATION_FAILED;
}

VkFormat colorFormatOf(const VitrailVkTargetDesc& desc) {
  return desc.colorFormat != VK_FORMAT_UNDEFINED ? desc.colorFormat : VK_FORMAT_R16G16B16A16_SFLOAT;
}

TargetInfo targetInfo(const VitrailVkContext_T& context, const VitrailVkTargetDesc& desc) {
  TargetInfo info = infoOf(desc);
  const VkFormat color = colorFormatOf(desc);
  info.canStoreColor = computeWrites(color) && desc.views.color != nullptr &&
                       (featuresOf(context, color) & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0;
  info.stencilMark = desc.scope.stencilMark != VK_FALSE;
  info.hasStencil = desc.scope.renderPass != VK_NULL_HANDLE || desc.scope.stencilFormat != VK_FORMAT_UNDEFINED;
  return info;
}

VkResult checkFormats(const VitrailVkContext_T& context, const VitrailVkTargetDesc& desc, const TargetInfo& info) {
  if (info.hostResolves()) return VK_SUCCESS; // the library writes to no image
  const bool compute = info.resolve == VITRAIL_RESOLVE_COMPUTE;
  const VkResult result = checkColorFormat(context, colorFormatOf(desc), compute);
  return result != VK_SUCCESS || compute ? result : checkScope(context, desc.scope);
}

} // namespace vitrail
