// Stochastic transparency: Enderton, Sintorn, Shirley and Luebke, "Stochastic Transparency" (I3D 2010), in its
// depth-based form. In each pass surfaces first write depth, opaque, in a random part of their samples that is as large
// as their opacity; then all that no sample's depth hides add their light, as large as their opacity says. A surface so
// is seen as often as surfaces before it let light through, and the mean over samples and passes tends to the exact
// picture. What all surfaces together let through of the opaque scene is not left to chance: a first draw multiplies
// it. The samples of a pixel are stratified, as in the paper. Randomness is a hash of pixel, pass and fragment: a frame
// is the same each time. --samples gives samples for this and for edges alike, --passes the passes.
//
// Cost: 1 + 2 draws of the surfaces a pass, 16 passes by default, and a copy of the depth each; one pass over the
// picture. Where some surfaces tint what is behind them each channel has passes of its own, three times as many. 22
// bytes a sample (28 with filters), whatever the depth complexity.
//
// What it gets wrong: noise, whose deviation is in proportion to 1 / sqrt(passes x samples), and coloured in pictures
// with tinted glass. The mean is the exact picture, except among surfaces at the very same depth, which do not hide
// each other; and with several samples surfaces that cross are ordered in each sample, where lists order them once a
// pixel. One surface in a pixel is exact. The order of submission changes the rounding of sums and nothing else.
#include <algorithm>
#include <memory>
#include <vector>

#include "../../gpu/accesses.h"
#include "../../stage/surface_shared.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/composite.h"
#include "../shared/device_needs.h"
#include "../shared/planes.h"
#include "shaders/stochastic_composite.comp.h"
#include "shaders/stochastic_composite_samples.comp.h"
#include "shaders/stochastic_cover.frag.h"
#include "shaders/stochastic_light.frag.h"
#include "shaders/stochastic_total.frag.h"
#include "stochastic_shared.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kPasses = 16;
constexpr std::uint32_t kPassesTogether = 8; // in one submission
constexpr std::size_t kLightPlane = 0;       // planes
constexpr std::size_t kThroughPlane = 1;
constexpr std::uint64_t kSampleDepthBytes = 4;

bool tints(const MethodHost& host) {
  return std::ranges::any_of(host.surfaces.scene().transparentDraws(),
                             [](const GpuDraw& draw) { return (draw.features & shaders::FEATURE_TRANSMISSION) != 0; });
}

std::vector<PlaneInfo> stochasticPlanes(bool filters) {
  const PlaneInfo through =
      filters ? multiplyingPlane(VK_FORMAT_R16G16B16A16_SFLOAT, 8) : multiplyingPlane(VK_FORMAT_R16_SFLOAT, 2);
  return {addingPlane(VK_FORMAT_R32G32B32A32_SFLOAT, 16), through};
}

// What differs between the three kinds of draws.
struct Draws {
  const char* name;
  std::span<const std::uint32_t> shader;
  std::vector<ColorOutput> colors;
  bool depthWrite = false;
};

SurfacePipelines makeSurfaces(const MethodHost& host, std::uint32_t samples, const Draws& draws) {
  requireDevice(host.gpu, "stochastic");
  const SurfaceProgram program{.constantBytes = sizeof(shaders::StochasticPass), .name = draws.name};
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = draws.shader;
    info.constants = {{1, samples}};
    info.samples = flagOf(samples);
    info.colors = draws.colors;
    info.depthFormat = PictureImages::depthFormat(false);
    info.depthWrite = draws.depthWrite;
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), program, describe};
}

VkImageCopy wholeDepth(VkExtent2D extent) {
  VkImageCopy copy{};
  copy.srcSubresource = copy.dstSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
  copy.extent = {extent.width, extent.height, 1};
  return copy;
}

class Stochastic final : public Method {
 public:
  Stochastic(const MethodHost& host, const MethodOptions& options);

  ImageNeeds needs() const override { return {.depthUsage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  FrameStats stats() const override;

 private:
  void drawTotal(Frame& frame);
  void cmdCopyDepth(Frame& frame);
  void drawPass(Frame& frame, std::uint32_t number, std::uint32_t channel);

  Gpu& gpu_;
  std::uint32_t samples_;
  std::uint32_t passes_;
  bool filters_;
  bool tints_; // some surface lets channels through differently
  Planes planes_;
  SurfacePipelines total_;
  SurfacePipelines cover_;
  SurfacePipelines light_;
  Composite composite_;
  UsedImage depth_; // of a pass
};

Stochastic::Stochastic(const MethodHost& host, const MethodOptions& options)
    : gpu_(host.gpu),
      samples_(options.samples),
      passes_(options.passes > 0 ? options.passes : kPasses),
      filters_(hasFilters(host)),
      tints_(tints(host)),
      planes_(stochasticPlanes(filters_), samples_, "stochastic"),
      total_(makeSurfaces(host, samples_,
                          {"stochastic total", shaders::stochastic_total_frag, planes_.outputs(kThroughPlane, 1)})),
      cover_(makeSurfaces(
          host, samples_,
          {.name = "stochastic cover", .shader = shaders::stochastic_cover_frag, .colors = {}, .depthWrite = true})),
      light_(makeSurfaces(host, samples_,
                          {.name = "stochastic light",
                           .shader = shaders::stochastic_light_frag,
                           .colors = planes_.outputs(kLightPlane, 1)})),
      composite_(gpu_, {.one = shaders::stochastic_composite_comp,
                        .several = shaders::stochastic_composite_samples_comp,
                        .planes = 2,
                        .samples = samples_,
                        .filters = filters_,
                        .name = "stochastic composite"}) {}

void Stochastic::setTarget(const MethodTarget& target) {
  composite_.setTarget(target);
  planes_.setTarget(gpu_, target.extent, composite_);
  GpuImageInfo info;
  info.extent = target.extent;
  info.format = PictureImages::depthFormat(false);
  info.samples = flagOf(samples_);
  info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  depth_.ensure(gpu_, info, "stochastic depth");
}

void Stochastic::releaseTarget() {
  planes_.releaseTarget();
  depth_ = UsedImage();
}

void Stochastic::draw(Frame& frame) {
  drawTotal(frame);
  std::uint32_t recorded = 0;
  for (std::uint32_t number = 0; number < passes_; ++number) {
    for (std::uint32_t channel = 0; channel < (tints_ ? 3U : 1U); ++channel) {
      if (recorded > 0 && recorded % kPassesTogether == 0) frame.submitAndWait();
      drawPass(frame, number, tints_ ? channel : shaders::STOCHASTIC_ALL_CHANNELS);
      ++recorded;
    }
  }
  composite_.cmdComposite(frame, planes_.all());
  frame.endPass("composite");
}

// What all surfaces let through; and no light yet.
void Stochastic::drawTotal(Frame& frame) {
  planes_.cmdBegin(frame, kLightPlane, 1);
  vkCmdEndRendering(frame.commands());
  planes_.cmdBegin(frame, kThroughPlane, 1);
  frame.drawSurfaces(total_);
  vkCmdEndRendering(frame.commands());
  frame.endPass("total");
}

// The depth of the opaque scene, for surfaces to write theirs into.
void Stochastic::cmdCopyDepth(Frame& frame) {
  UsedImage& opaque = frame.images().depth();
  // The opaque draws wrote depth, the first draw tested it -> the copy reads it.
  opaque.cmdUse(frame.commands(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kCopyRead);
  // The last pass tested its depth -> the copy replaces it.
  depth_.discard();
  depth_.cmdUse(frame.commands(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kCopyWrite);
  const VkImageCopy copy = wholeDepth(frame.images().extent());
  vkCmdCopyImage(frame.commands(), opaque.get().get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, depth_.get().get(),
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
}

void Stochastic::drawPass(Frame& frame, std::uint32_t number, std::uint32_t channel) {
  const shaders::StochasticPass pass{number, channel, 1.0F / static_cast<float>(passes_)};
  const auto draw = [&](const Scope& scope, const SurfacePipelines& surfaces) {
    cmdBeginScope(frame.commands(), scope);
    vkCmdPushConstants(frame.commands(), surfaces.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(pass), &pass);
    frame.drawSurfaces(surfaces);
    vkCmdEndRendering(frame.commands());
  };
  cmdCopyDepth(frame);
  Scope cover = frame.images().wholeScope();
  cover.depth = {.image = &depth_, .depth = AspectUse::Write};
  draw(cover, cover_);
  frame.endPass("cover");

  Scope light = frame.images().wholeScope();
  light.colors.push_back({.image = &planes_.image(kLightPlane)});
  light.depth = {.image = &depth_, .depth = AspectUse::Test};
  draw(light, light_);
  frame.endPass("blend");
}

FrameStats Stochastic::stats() const {
  const VkExtent2D extent = depth_.get().info().extent;
  FrameStats stats;
  stats.totalBytes = planes_.bytes() + kSampleDepthBytes * samples_ * extent.width * extent.height;
  return stats;
}

} // namespace

std::unique_ptr<Method> makeStochastic(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<Stochastic>(host, options);
}

} // namespace vitrail::tool
