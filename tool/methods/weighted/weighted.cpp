// Weighted blended order-independent transparency: McGuire and Bavoil, "Weighted Blended Order-Independent
// Transparency" (JCGT 2(2), 2013). Every fragment adds its premultiplied colour and its opacity, both times a weight
// that falls with depth, and multiplies what is let through; the composite puts the weighted mean colour over the
// picture by the exact product of the transmittances. The weight is the paper's equation 10, max(1e-2, 3e3 (1 -
// d(z))^3), in which d(z) is the depth in a window whose near and far planes fit the boxes around the surfaces. Light
// of additive surfaces, and what tinted glass reflects without hiding anything, is added beside the mean; the filters
// of tinted glass multiply, in each channel.
//
// Cost: one draw of the surfaces, whose every fragment blends into two planes (R16G16B16A16_SFLOAT and R16_SFLOAT, 10
// bytes a sample; with filters three of 8 bytes), and one pass over the picture.
//
// What it gets wrong: only the order in which surfaces lie decides their colours' shares through the weight, so near
// surfaces that hide others let too much of them through, and colours wash out towards the mean: the more so the more
// opaque surfaces are and the closer they lie. Light that is added is not dimmed by what is in front of it. One surface
// in a pixel is exact; what is behind all surfaces is dimmed exactly, up to the planes' rounding. The order of
// submission changes the rounding of sums and nothing else.
#include <memory>
#include <vector>

#include "../method.h"
#include "../methods.h"
#include "../shared/composite.h"
#include "../shared/depth_range.h"
#include "../shared/device_needs.h"
#include "../shared/planes.h"
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
  requireDevice(host.gpu, "weighted");
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

class Weighted final : public Method {
 public:
  Weighted(const MethodHost& host, const MethodOptions& options);

  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override { planes_.releaseTarget(); }
  void draw(Frame& frame) override;
  FrameStats stats() const override { return {.totalBytes = planes_.bytes()}; }

 private:
  Gpu& gpu_;
  bool filters_;
  Planes planes_;
  SurfacePipelines surfaces_;
  Composite composite_;
};

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

} // namespace

std::unique_ptr<Method> makeWeighted(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<Weighted>(host, options);
}

} // namespace vitrail::tool
