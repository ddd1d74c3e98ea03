#include "renderer.h"

#include <fmt/format.h>

#include "../methods/method.h"
#include "../scene/srgb.h"
#include "encode_pass.h"
#include "frame.h"
#include "frame_data.h"
#include "picture_images.h"
#include "pipeline.h"
#include "screen_pass.h"
#include "shaders/opaque.frag.h"
#include "shaders/sky.frag.h"
#include "submit.h"
#include "surfaces.h"
#include "timers.h"

namespace vitrail::tool {

namespace {

// The first frame counts, the second one fits: more are never needed unless a device counts wrong.
constexpr int kMaxAttempts = 3;

VkClearColorValue clearColor(const Background& background) {
  VkClearColorValue value{};
  if (background.kind != Background::Kind::Color) return value;
  const glm::vec3 linear = linearFromSrgb(background.srgb);
  for (int i = 0; i < 3; ++i) value.float32[i] = linear[i];
  value.float32[3] = 1.0F;
  return value;
}

VkSampleCountFlagBits sampleFlag(const Gpu& gpu, std::uint32_t samples) {
  const VkSampleCountFlags offered = gpu.features().sampleCounts;
  if ((offered & samples) == 0) {
    throw GpuError(fmt::format("{} draws {} samples a pixel, not {}: choose one of these with --samples",
                               gpu.properties().deviceName, sampleCountsText(offered), samples));
  }
  return flagOf(samples);
}

GraphicsPipelineInfo skyPipeline(VkPipelineLayout layout, const PictureImagesInfo& images) {
  GraphicsPipelineInfo info = screenPipeline(layout, shaders::sky_frag, "sky");
  info.samples = images.samples;
  info.colors = {{PictureImages::kColorFormat, {}}};
  info.depthFormat = PictureImages::depthFormat(images.stencil);
  return info;
}

PictureImagesInfo imagesOf(const MethodNeeds& needs, VkSampleCountFlagBits samples) {
  PictureImagesInfo info;
  info.samples = samples;
  info.perSample = needs.perSample;
  info.stencil = needs.stencil;
  info.depthUsage = needs.depthUsage;
  return info;
}

} // namespace

struct Renderer::Impl {
  Gpu& gpu;
  MethodOptions options;
  VkSampleCountFlagBits samples;
  Submitter submitter;
  Surfaces surfaces;
  PictureImages images; // of the last picture's size; the method's target holds views of them
  std::unique_ptr<Method> method;
  PictureImagesInfo imagesInfo;
  SurfacePipelines opaquePipelines;
  Unique<VkPipeline> sky;
  EncodePass encode;
  Timers timers;

  Impl(Gpu& device, const Scene& source, std::optional<float> opacity, DrawOrder order, const MethodOptions& chosen);
  void makeImages(VkExtent2D extent);
  void prepare(const RenderOptions& picture);
  void drawOpaque(Frame& frame, const Background& background);
  void finishPicture(Frame& frame, bool encoded);
  bool draw(const Background& background, bool encoded);
  FrameReport drawUntilComplete(const RenderOptions& picture, bool encoded);
  FrameReport report(const RenderOptions& picture, const MethodStats& stats) const;
};

Renderer::Impl::Impl(Gpu& device, const Scene& source, std::optional<float> opacity, DrawOrder order,
                     const MethodOptions& chosen)
    : gpu(device),
      options(chosen),
      samples(sampleFlag(gpu, chosen.samples)),
      submitter(gpu),
      surfaces(gpu, source, opacity, order),
      method(makeMethod({gpu, surfaces, source}, chosen)),
      imagesInfo(imagesOf(method->needs(), samples)),
      opaquePipelines(surfaces, surfaces.scene().opaqueDraws(), {.name = "opaque"},
                      [this](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
                        info.fragmentShader = shaders::opaque_frag;
                        info.samples = samples;
                        info.colors = {{PictureImages::kColorFormat, {}}};
                        info.depthFormat = PictureImages::depthFormat(imagesInfo.stencil);
                        info.depthWrite = true;
                      }),
      sky(makeGraphicsPipeline(gpu, skyPipeline(opaquePipelines.layout(), imagesInfo))),
      encode(gpu),
      timers(gpu, Frame::kMostPasses) {}

void Renderer::Impl::makeImages(VkExtent2D extent) {
  if (extent.width == images.extent().width && extent.height == images.extent().height) return;
  method->releaseTarget();
  images = PictureImages(); // first: the old size and the new one need not fit together
  imagesInfo.extent = extent;
  images = PictureImages(gpu, imagesInfo);
  encode.setSource(images.color().get());
}

void Renderer::Impl::prepare(const RenderOptions& picture) {
  checkPictureOptions(options.name, picture.memoryBudget.has_value());
  makeImages({picture.width, picture.height});
  surfaces.setView(makeFrameData(picture.view, picture.width, picture.height, surfaces.scene().origin()));
  MethodTarget target;
  target.extent = images.extent();
  target.color = images.color().get().view();
  target.opaque = images.multisampled().view();
  target.depth = images.sampledDepth();
  target.stencil = images.sampledStencil();
  target.memoryBudget = picture.memoryBudget;
  target.surfaces = !surfaces.scene().transparentDraws().empty();
  method->setTarget(target);
}

void Renderer::Impl::drawOpaque(Frame& frame, const Background& background) {
  VkCommandBuffer commands = frame.commands();
  images.cmdBeginOpaque(commands, clearColor(background));
  if (background.kind == Background::Kind::Sky) {
    surfaces.cmdBindView(commands, opaquePipelines.layout());
    cmdDrawScreen(commands, sky.get());
  }
  const std::vector<GpuDraw>& draws = surfaces.scene().opaqueDraws();
  surfaces.cmdDraw(commands, draws, Surfaces::runsOf(draws), opaquePipelines);
  vkCmdEndRendering(commands);
  frame.endPass("opaque");
}

void Renderer::Impl::finishPicture(Frame& frame, bool encoded) {
  if (imagesInfo.perSample && samples > VK_SAMPLE_COUNT_1_BIT) {
    images.cmdBoxFilter(frame.commands());
    frame.endPass("box_filter");
  }
  if (!encoded) return;
  images.cmdToEncode(frame.commands());
  encode.cmdEncode(frame.commands());
  frame.endPass("encode");
}

// Draws a picture. False: the method has made room, and the picture must be drawn again.
bool Renderer::Impl::draw(const Background& background, bool encoded) {
  Frame frame(submitter, timers, images, surfaces);
  drawOpaque(frame, background);
  method->draw(frame);
  finishPicture(frame, encoded);
  frame.finish();
  return method->finish();
}

// Draws until the method has room for every fragment.
FrameReport Renderer::Impl::drawUntilComplete(const RenderOptions& picture, bool encoded) {
  prepare(picture);
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    const bool complete = draw(picture.background, encoded);
    const MethodStats stats = method->stats();
    if (stats.fragmentsMissing == 0 && stats.cutPixels > 0) {
      throw GpuError(
          fmt::format("{} pixels have more surfaces, up to {}, than the driver of {} lets a shader sort: use a GPU",
                      stats.cutPixels, stats.layersMax, gpu.properties().deviceName));
    }
    if (complete) return report(picture, stats);
  }
  throw GpuError(fmt::format("{} counts the picture's fragments differently in each of {} frames",
                             gpu.properties().deviceName, kMaxAttempts));
}

FrameReport Renderer::Impl::report(const RenderOptions& picture, const MethodStats& stats) const {
  FrameReport report;
  report.device = gpu.properties().deviceName;
  report.api = "Vulkan 1.3";
  report.method = method->name();
  report.width = picture.width;
  report.height = picture.height;
  report.samples = options.samples;
  report.nodes = method->nodes();
  report.resolve = method->resolve();
  report.listBuild = method->listBuild();
  if (!report.resolve.empty() && options.samples > 1) report.msaaResolve = nameOf(options.msaaResolve);
  report.exact = stats.exact;
  report.counted = stats.counted;
  report.fragmentsRequested = stats.fragmentsRequested;
  report.fragmentsStored = stats.fragmentsStored;
  report.fragmentsMissing = stats.fragmentsMissing;
  report.approximatePixels = stats.approximatePixels;
  report.layersMax = stats.layersMax;
  report.layersMean = stats.layersMean;
  report.tiles = stats.tiles;
  report.nodesBytes = stats.nodesBytes;
  report.headsBytes = stats.headsBytes;
  report.totalBytes = stats.totalBytes;
  report.peakBytes = gpu.peakMemory();
  report.pixelLayers = stats.pixelLayers;
  report.passesMs = timers.milliseconds();
  for (const auto& [name, milliseconds] : report.passesMs) report.frameMs += milliseconds;
  return report;
}

Renderer::Renderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order,
                   const MethodOptions& method)
    : impl_(std::make_unique<Impl>(gpu, scene, opacity, order, method)) {}

Renderer::~Renderer() = default;

RenderResult Renderer::render(const RenderOptions& options) {
  RenderResult result;
  result.report = impl_->drawUntilComplete(options, true);
  result.picture.width = options.width;
  result.picture.height = options.height;
  result.picture.hasAlpha = options.background.kind == Background::Kind::Transparent;
  result.picture.rgba = impl_->encode.pixels();
  return result;
}

FrameReport Renderer::measure(const RenderOptions& options) { return impl_->drawUntilComplete(options, false); }

} // namespace vitrail::tool
