#include "moment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "../../gpu/accesses.h"
#include "../shared/depth_range.h"
#include "shaders/moment.frag.h"
#include "shaders/moment_absorbance.frag.h"
#include "shaders/moment_absorbance_filters.frag.h"
#include "shaders/moment_composite.comp.h"

namespace vitrail::tool {

namespace {

// The planes: the light of the second draw; of the first one the moments, the total, and with filters transmittances.
constexpr std::size_t kLight = 0;
constexpr std::size_t kMoments = 1;
constexpr std::size_t kTotal = 2;
constexpr std::uint32_t kThrough = 3;
constexpr std::uint32_t kPlanes = 4;

struct Depths { // the push constants of moments.glsl
  float scale;
  float offset;
  std::uint32_t logarithmic;
};

// Takes the depths of a view to [-1, 1].
Depths depthsOf(const Surfaces& surfaces) {
  const DepthRange range = transparentDepths(surfaces);
  const bool logarithmic = surfaces.view().eye.w < 0.5F;
  const auto warped = [&](float depth) { return logarithmic ? std::log(depth) : depth; };
  const float low = warped(range.nearest);
  const float span = std::max(warped(range.farthest) - low, 1e-6F * std::max(std::abs(low), 1e-6F));
  return {2.0F / span, -2.0F * low / span - 1.0F, logarithmic ? 1U : 0U};
}

std::vector<PlaneInfo> momentPlanes(bool filters) {
  std::vector<PlaneInfo> infos{addingPlane(VK_FORMAT_R16G16B16A16_SFLOAT, 8),
                               addingPlane(VK_FORMAT_R32G32B32A32_SFLOAT, 16), addingPlane(VK_FORMAT_R32_SFLOAT, 4)};
  if (filters) infos.push_back(multiplyingPlane(VK_FORMAT_R16G16B16A16_SFLOAT, 8));
  return infos;
}

void checkDevice(const Gpu& gpu) {
  if (gpu.features().independentBlending && gpu.features().floatBlending) return;
  throw GpuError(
      fmt::format("{} does not blend 32-bit floats, each of several images in its own way, which the method "
                  "moment needs: use linked-list",
                  gpu.properties().deviceName));
}

SurfacePipelines makeAbsorbance(const MethodHost& host, bool filters, const Planes& planes) {
  checkDevice(host.gpu);
  const SurfaceProgram program{.constantBytes = sizeof(Depths), .name = "moment absorbance"};
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::moment_absorbance_frag;
    if (filters) info.fragmentShader = shaders::moment_absorbance_filters_frag;
    info.colors = planes.outputs(kMoments, planes.size() - kMoments);
    info.depthFormat = PictureImages::depthFormat(false);
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), program, describe};
}

SurfacePipelines makeLight(const MethodHost& host, VkDescriptorSetLayout set, const Planes& planes) {
  const SurfaceProgram program{.set = set, .constantBytes = sizeof(Depths), .name = "moment light"};
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::moment_frag;
    info.colors = planes.outputs(kLight, 1);
    info.depthFormat = PictureImages::depthFormat(false);
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), program, describe};
}

} // namespace

Moment::Moment(const MethodHost& host)
    : gpu_(host.gpu),
      filters_(hasFilters(host)),
      planes_(momentPlanes(filters_), 1, "moment"),
      moments_(gpu_,
               {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT},
                {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}},
               "moment planes"),
      absorbance_(makeAbsorbance(host, filters_, planes_)),
      light_(makeLight(host, moments_.layout(), planes_)),
      composite_(gpu_, {.one = shaders::moment_composite_comp,
                        .several = {},
                        .planes = kPlanes,
                        .filters = filters_,
                        .name = "moment composite"}) {}

void Moment::setTarget(const MethodTarget& target) {
  composite_.setTarget(target);
  planes_.setTarget(gpu_, target.extent, composite_);
  if (!filters_) composite_.setPlane(kThrough, planes_.image(kLight)); // is not read
  for (const std::size_t plane : {kMoments, kTotal}) {
    moments_.writeImage(static_cast<std::uint32_t>(plane - kMoments), planes_.image(plane).get().view(),
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
}

void Moment::draw(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  const Depths depths = depthsOf(frame.surfaces());
  planes_.cmdBegin(frame, kMoments, planes_.size() - kMoments);
  vkCmdPushConstants(commands, absorbance_.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(depths), &depths);
  frame.drawSurfaces(absorbance_);
  vkCmdEndRendering(commands);
  frame.endPass("absorbance");
  for (const std::size_t plane : {kMoments, kTotal}) {
    // The first draw added to the planes -> the second one reads them.
    planes_.image(plane).cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kFragmentSample);
  }
  planes_.cmdBegin(frame, kLight, 1);
  vkCmdPushConstants(commands, light_.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(depths), &depths);
  frame.drawSurfaces(light_, moments_.set());
  vkCmdEndRendering(commands);
  frame.endPass("blend");
  composite_.cmdComposite(frame, planes_.all());
  frame.endPass("composite");
}

} // namespace vitrail::tool
