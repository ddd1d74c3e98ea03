// Moment-based order-independent transparency with four power moments: Muenstermann, Krumpen, Klein and Peters,
// "Moment-Based Order-Independent Transparency" (PACM CGIT 1(1), I3D 2018). A first draw of the surfaces adds up their
// absorbance, -ln of the transmittance, times the powers 0 to 4 of depth; a second one dims each fragment's light by
// the transmittance in front of it that those moments tell of, with the paper's bias (5e-7) and overestimation (0.25).
// The composite scales what was added to the opacity of all surfaces together, which is known, and puts it over the
// picture. Depth is on a logarithmic scale with perspective, fitted to the boxes around the surfaces.
//
// Cost: two draws of the surfaces, both shaded in full, whose fragments blend into 20 bytes (R32G32B32A32_SFLOAT and
// R32_SFLOAT; with filters 28) and into 8, and one pass over the picture: 28 bytes a pixel, 36 with filters. One sample
// a pixel: the second draw reads the moments of a pixel.
//
// What it gets wrong: four moments tell where two surfaces lie, and roughly where more do: light leaks through opaque
// surfaces that lie among many others, and colours of dense stacks are smeared over their depths. The overestimation
// alone puts two panes off by a few 255ths. A surface that lets nothing through counts as one that lets 1/4096 through.
// Surfaces behind tinted glass are dimmed and not tinted; what is behind all surfaces is tinted exactly. One surface in
// a pixel is exact. The order of submission changes the rounding of sums and nothing else.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "../../gpu/accesses.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/composite.h"
#include "../shared/depth_range.h"
#include "../shared/device_needs.h"
#include "../shared/planes.h"
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

SurfacePipelines makeAbsorbance(const MethodHost& host, bool filters, const Planes& planes) {
  requireDevice(host.gpu, "moment");
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

class Moment final : public Method {
 public:
  explicit Moment(const MethodHost& host);

  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override { planes_.releaseTarget(); }
  void draw(Frame& frame) override;
  FrameStats stats() const override { return {.totalBytes = planes_.bytes()}; }

 private:
  Gpu& gpu_;
  bool filters_;
  Planes planes_;
  SingleSet moments_; // what the second draw reads
  SurfacePipelines absorbance_;
  SurfacePipelines light_;
  Composite composite_;
};

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

} // namespace

std::unique_ptr<Method> makeMoment(const MethodHost& host, const MethodOptions& /*options*/) {
  return std::make_unique<Moment>(host);
}

} // namespace vitrail::tool
