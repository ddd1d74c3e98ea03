#include "weighted.h"

#include <vector>

#include <fmt/format.h>

#include "../shared/depth_range.h"
#include "shaders/weighted.frag.h"
#include "shaders/weighted_composite.comp.h"
#include "shaders/weighted_composite_samples.comp.h"
#include "shaders/weighted_filters.frag.h"

namespace vitrail::tool {

namespace {

constexpr VkFormat kHalves = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr std::uint32_t kWeightedPlanes = 3;

std::vector<PlaneInfo> weightedPlanes(bool filters) {
  if (!filters) return {addingPlane(kHalves, 8), multiplyingPlane(VK_FORMAT_R16_SFLOAT, 2)};
  return {addingPlane(kHalves, 8), multiplyingPlane(kHalves, 8), addingPlane(kHalves, 8)};
}

SurfacePipelines makeSurfaces(const MethodHost& host, std::uint32_t samples, bool filters, const Planes& planes) {
  if (!host.gpu.features().independentBlending) {
    throw GpuError(
        fmt::format("{} does not blend in each of several images its own way, which the method weighted "
                    "needs: use linked-list",
                    host.gpu.properties().deviceName));
  }
  const SurfaceProgram program{.constantBytes = sizeof(DepthRange), .name = "weighted"};
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::weighted_frag;
    if (filters) info.fragmentShader = shaders::weighted_filters_frag;
    info.samples = flagOf(samples);
    info.colors = planes.outputs(0, planes.size());
    info.depthFormat = PictureImages::depthFormat(false);
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), program, describe};
}

} // namespace

Weighted::Weighted(const MethodHost& host, const MethodOptions& options)
    : gpu_(host.gpu),
      filters_(hasFilters(host)),
      planes_(weightedPlanes(filters_), options.samples, "weighted"),
      surfaces_(makeSurfaces(host, options.samples, filters_, planes_)),
      composite_(gpu_, {.one = shaders::weighted_composite_comp,
                        .several = shaders::weighted_composite_samples_comp,
                        .planes = kWeightedPlanes,
                        .samples = options.samples,
                        .filters = filters_,
                        .name = "weighted composite"}) {}

void Weighted::setTarget(const MethodTarget& target) {
  composite_.setTarget(target);
  planes_.setTarget(gpu_, target.extent, composite_);
  if (!filters_) composite_.setPlane(kWeightedPlanes - 1, planes_.image(0)); // is not read
}

void Weighted::draw(Frame& frame) {
  const DepthRange depths = transparentDepths(frame.surfaces()); // the push constants of weighted.frag
  planes_.cmdBegin(frame, 0, planes_.size());
  vkCmdPushConstants(frame.commands(), surfaces_.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(depths), &depths);
  frame.drawSurfaces(surfaces_);
  vkCmdEndRendering(frame.commands());
  frame.endPass("blend");
  composite_.cmdComposite(frame, planes_.all());
  frame.endPass("composite");
}

} // namespace vitrail::tool
