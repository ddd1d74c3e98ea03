#include "composite.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "../../gpu/accesses.h"
#include "../../stage/surface_shared.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kOpaque = 1; // bindings of composite.glsl
constexpr std::uint32_t kFirstPlane = 2;

SingleSet makeSet(Gpu& gpu, const CompositeInfo& info) {
  std::vector<std::pair<VkDescriptorType, VkShaderStageFlags>> bindings{
      {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}};
  bindings.resize(kFirstPlane + info.planes, {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT});
  return {gpu, bindings, info.name};
}

} // namespace

bool hasFilters(const MethodHost& host) {
  return std::ranges::any_of(host.surfaces.scene().transparentDraws(), [](const GpuDraw& draw) {
    return (draw.features & (shaders::FEATURE_TRANSMISSION | shaders::FEATURE_ADDITIVE)) != 0;
  });
}

GpuImageInfo planeInfo(VkExtent2D extent, VkFormat format, std::uint32_t samples) {
  GpuImageInfo info;
  info.extent = extent;
  info.format = format;
  info.samples = flagOf(samples);
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  return info;
}

Composite::Composite(Gpu& gpu, const CompositeInfo& info)
    : severalSamples_(info.samples > 1),
      set_(makeSet(gpu, info)),
      pass_(gpu, set_,
            {.shader = severalSamples_ ? info.several : info.one,
             .name = info.name,
             .constants = {{0, info.samples}, {1, info.filters ? 1 : 0}}}) {}

void Composite::setTarget(const MethodTarget& target) {
  set_.writeImage(0, target.color, VK_IMAGE_LAYOUT_GENERAL);
  if (severalSamples_) set_.writeImage(kOpaque, target.opaque, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void Composite::setPlane(std::uint32_t plane, const UsedImage& image) {
  set_.writeImage(kFirstPlane + plane, image.get().view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void Composite::cmdComposite(Frame& frame, std::span<UsedImage* const> planes) const {
  VkCommandBuffer commands = frame.commands();
  // The surfaces' passes blended into the planes -> the composite samples them.
  for (UsedImage* plane : planes) plane->cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kComputeSample);
  frame.images().cmdToComputeResolve(commands);
  pass_.cmdRun(commands, frame.images().extent());
}

} // namespace vitrail::tool
