#include "renderer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

#include <fmt/format.h>

#include "../methods/method.h"
#include "../scene/srgb.h"
#include "descriptors.h"
#include "encode_pass.h"
#include "frame_data.h"
#include "gpu_scene.h"
#include "picture_images.h"
#include "pipeline.h"
#include "shaders/opaque.frag.h"
#include "shaders/sky.frag.h"
#include "shaders/sky.vert.h"
#include "shaders/surface.vert.h"
#include "submit.h"
#include "timers.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kMostPasses = 6; // in one submission

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
  return static_cast<VkSampleCountFlagBits>(samples); // a flag's value is its count
}

// What the pipelines of every surface have in common.
GraphicsPipelineInfo surfacePipeline(VkPipelineLayout layout, VkSampleCountFlagBits samples, const MethodNeeds& needs) {
  GraphicsPipelineInfo info;
  info.layout = layout;
  info.vertexShader = shaders::surface_vert;
  info.surface = true;
  info.samples = samples;
  info.depthFormat = PictureImages::depthFormat(needs.stencil);
  info.depthTest = VK_COMPARE_OP_GREATER;
  return info;
}

GraphicsPipelineInfo opaquePipeline(VkPipelineLayout layout, VkSampleCountFlagBits samples, const MethodNeeds& needs) {
  GraphicsPipelineInfo info = surfacePipeline(layout, samples, needs);
  info.fragmentShader = shaders::opaque_frag;
  info.colorFormat = PictureImages::kColorFormat;
  info.depthWrite = true;
  info.name = "opaque";
  return info;
}

GraphicsPipelineInfo transparentPipeline(VkPipelineLayout layout, VkSampleCountFlagBits samples, const Method& method,
                                         std::uint32_t features) {
  const MethodNeeds needs = method.needs();
  const SurfaceDrawing drawing = method.surface(features);
  GraphicsPipelineInfo info = surfacePipeline(layout, samples, needs);
  info.fragmentShader = drawing.fragmentShader;
  info.constants = drawing.constants;
  if (needs.blending == Blending::AsDrawn) {
    info.colorFormat = PictureImages::kColorFormat;
    info.blend = drawing.blend;
  }
  if (needs.stencil) info.stencil = drawing.stencil;
  info.name = "transparent";
  return info;
}

GraphicsPipelineInfo skyPipeline(VkPipelineLayout layout, VkSampleCountFlagBits samples, const MethodNeeds& needs) {
  GraphicsPipelineInfo info;
  info.layout = layout;
  info.vertexShader = shaders::sky_vert;
  info.fragmentShader = shaders::sky_frag;
  info.samples = samples;
  info.colorFormat = PictureImages::kColorFormat;
  info.depthFormat = PictureImages::depthFormat(needs.stencil);
  info.name = "sky";
  return info;
}

// Sets 0 and 1 are the renderer's, set 2 is the method's where it has one.
Unique<VkPipelineLayout> transparentLayout(Gpu& gpu, VkDescriptorSetLayout frame, VkDescriptorSetLayout textures,
                                           const Method& method) {
  std::vector<VkDescriptorSetLayout> sets{frame, textures};
  if (VkDescriptorSetLayout own = method.surfaceLayout(); own != VK_NULL_HANDLE) sets.push_back(own);
  return makePipelineLayout(gpu, sets, 0, "transparent");
}

// The boxes of the transparent surfaces, seen with a frame's view.
std::vector<VitrailBounds> projectedBoxes(const GpuScene& scene, const shaders::FrameData& frame) {
  std::vector<VitrailBounds> result;
  result.reserve(scene.transparentBoxes().size());
  for (const PlacedBox& placed : scene.transparentBoxes()) {
    const glm::mat4 clip(glm::dmat4(frame.viewProjection) * glm::dmat4(placed.model));
    VitrailBounds bounds{};
    std::memcpy(bounds.min, &placed.box.min, sizeof(bounds.min));
    std::memcpy(bounds.max, &placed.box.max, sizeof(bounds.max));
    std::memcpy(bounds.clipFromBox, &clip, sizeof(bounds.clipFromBox));
    result.push_back(bounds);
  }
  return result;
}

// Draws surfaces in the present rendering scope. `frame` is set 0; set 2 is bound by the caller.
void cmdDrawSurfaces(VkCommandBuffer commands, const GpuScene& scene, const std::vector<GpuDraw>& draws,
                     VkPipelineLayout layout, VkDescriptorSet frame, SurfacePipelines& pipelines) {
  if (draws.empty()) return;
  const VkBuffer vertices = scene.vertices().get();
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &offset);
  vkCmdBindIndexBuffer(commands, scene.indices().get(), 0, VK_INDEX_TYPE_UINT32);
  VkPipeline pipeline = VK_NULL_HANDLE;
  for (const GpuDraw& draw : draws) {
    if (VkPipeline wanted = pipelines.get(draw.features); wanted != pipeline) {
      pipeline = wanted;
      vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    }
    const std::array<VkDescriptorSet, 2> sets{frame, draw.textures};
    const std::array<std::uint32_t, 2> offsets{draw.dataOffset, draw.materialOffset};
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 2, sets.data(), 2, offsets.data());
    vkCmdSetFrontFace(commands, draw.frontFace);
    vkCmdSetCullMode(commands, draw.cullMode);
    vkCmdDrawIndexed(commands, draw.indexCount, 1, draw.firstIndex, draw.vertexOffset, 0);
  }
}

} // namespace

struct Renderer::Impl {
  Gpu& gpu;
  MethodOptions options;
  VkSampleCountFlagBits samples;
  Submitter submitter;
  GpuScene scene;
  PictureImages images; // of the last picture's size; the method's target holds views of them
  std::unique_ptr<Method> method;
  MethodNeeds needs;
  GpuBuffer frameBuffer; // shaders::FrameData
  SingleSet frameSet;
  Unique<VkPipelineLayout> opaqueLayout;
  Unique<VkPipelineLayout> transparentLayout;
  SurfacePipelines opaquePipelines;
  SurfacePipelines transparentPipelines;
  Unique<VkPipeline> sky;
  EncodePass encode;
  Timers timers;
  std::vector<VitrailBounds> boxes; // of the transparent surfaces in the present view
  std::uint64_t frame = 0;

  Impl(Gpu& device, const Scene& source, std::optional<float> opacity, DrawOrder order, const MethodOptions& chosen);
  void prepare(const RenderOptions& picture);
  void makeImages(VkExtent2D extent);
  void cmdOpaque(VkCommandBuffer commands, const Background& background);
  void cmdSurfaces(VkCommandBuffer commands, const VkRect2D& area);
  void cmdResolve(VkCommandBuffer commands, const VkRect2D& area);
  void cmdTransparent(VkCommandBuffer commands, const VkRect2D& area);
  void cmdFinish(VkCommandBuffer commands, bool encoded);
  void submit(const std::function<void(VkCommandBuffer)>& record);
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
      scene(gpu, source, opacity, order),
      method(makeMethod(gpu, chosen)),
      needs(method->needs()),
      frameBuffer(gpu, sizeof(shaders::FrameData), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryKind::Upload,
                  "frame data"),
      frameSet(gpu,
               {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT},
                {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_SHADER_STAGE_VERTEX_BIT},
                {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT}},
               "frame"),
      opaqueLayout(makePipelineLayout(gpu, {frameSet.layout(), scene.textureLayout()}, 0, "opaque")),
      transparentLayout(tool::transparentLayout(gpu, frameSet.layout(), scene.textureLayout(), *method)),
      opaquePipelines(
          gpu, [this](std::uint32_t /*features*/) { return opaquePipeline(opaqueLayout.get(), samples, needs); }),
      transparentPipelines(gpu,
                           [this](std::uint32_t features) {
                             return transparentPipeline(transparentLayout.get(), samples, *method, features);
                           }),
      sky(makeGraphicsPipeline(gpu, skyPipeline(opaqueLayout.get(), samples, needs))),
      encode(gpu),
      timers(gpu, kMostPasses) {
  frameSet.writeBuffer(0, frameBuffer.get(), frameBuffer.size());
  frameSet.writeBuffer(1, scene.drawData().get(), sizeof(shaders::DrawData));
  frameSet.writeBuffer(2, scene.materials().get(), sizeof(shaders::MaterialData));
  // All that the scene needs, now: no frame waits for a pipeline.
  for (const GpuDraw& draw : scene.opaqueDraws()) opaquePipelines.get(draw.features);
  for (const GpuDraw& draw : scene.transparentDraws()) transparentPipelines.get(draw.features);
}

void Renderer::Impl::makeImages(VkExtent2D extent) {
  if (extent.width == images.extent().width && extent.height == images.extent().height) return;
  method->releaseTarget();
  images = PictureImages(); // first: the old size and the new one need not fit together
  PictureImagesInfo info;
  info.extent = extent;
  info.samples = samples;
  info.perSample = needs.perSample;
  info.stencil = needs.stencil;
  info.sampledDepth = needs.sampledDepth;
  images = PictureImages(gpu, info);
  encode.setSource(images.color());
}

void Renderer::Impl::prepare(const RenderOptions& picture) {
  makeImages({picture.width, picture.height});
  MethodTarget target;
  target.extent = images.extent();
  target.color = images.color().view();
  target.opaque = images.multisampled().view();
  target.depth = images.sampledDepth();
  target.nodeCapacity = picture.nodeCapacity;
  target.memoryBudget = picture.memoryBudget;
  target.surfaces = !scene.transparentDraws().empty();
  method->setTarget(target);
  const shaders::FrameData data = makeFrameData(picture.view, picture.width, picture.height, scene.origin());
  std::memcpy(frameBuffer.mapped(), &data, sizeof(data));
  boxes = projectedBoxes(scene, data);
}

void Renderer::Impl::cmdOpaque(VkCommandBuffer commands, const Background& background) {
  images.cmdBeginOpaque(commands, clearColor(background));
  if (background.kind == Background::Kind::Sky) {
    const VkDescriptorSet set = frameSet.set();
    const std::array<std::uint32_t, 2> offsets{}; // of no draw: the sky reads the frame data alone
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, opaqueLayout.get(), 0, 1, &set, 2,
                            offsets.data());
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, sky.get());
    vkCmdDraw(commands, 3, 1, 0, 0);
  }
  cmdDrawSurfaces(commands, scene, scene.opaqueDraws(), opaqueLayout.get(), frameSet.set(), opaquePipelines);
  vkCmdEndRendering(commands);
  timers.cmdEndPass(commands, "opaque");
}

void Renderer::Impl::cmdSurfaces(VkCommandBuffer commands, const VkRect2D& area) {
  images.cmdBeginTransparent(commands, area, needs.blending == Blending::AsDrawn);
  const VkPipelineLayout layout = transparentLayout.get();
  if (const VkDescriptorSet own = method->surfaceSet(); own != VK_NULL_HANDLE) {
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 2, 1, &own, 0, nullptr);
  }
  cmdDrawSurfaces(commands, scene, scene.transparentDraws(), layout, frameSet.set(), transparentPipelines);
  vkCmdEndRendering(commands);
}

void Renderer::Impl::cmdResolve(VkCommandBuffer commands, const VkRect2D& area) {
  if (needs.blending == Blending::Compute) {
    images.cmdToComputeResolve(commands);
    method->cmdResolve(commands);
  } else {
    images.cmdBeginResolve(commands, area);
    method->cmdResolve(commands);
    vkCmdEndRendering(commands);
  }
}

void Renderer::Impl::cmdTransparent(VkCommandBuffer commands, const VkRect2D& area) {
  if (needs.blending == Blending::AsDrawn) {
    cmdSurfaces(commands, area);
    timers.cmdEndPass(commands, "blend");
    return;
  }
  method->cmdBegin(commands, frame, area);
  timers.cmdEndPass(commands, "clear");
  cmdSurfaces(commands, area);
  method->cmdCollected(commands);
  timers.cmdEndPass(commands, "collect");
  cmdResolve(commands, area);
  method->cmdEnd(commands);
  timers.cmdEndPass(commands, "resolve");
}

void Renderer::Impl::cmdFinish(VkCommandBuffer commands, bool encoded) {
  if (needs.perSample && samples > VK_SAMPLE_COUNT_1_BIT) {
    images.cmdBoxFilter(commands);
    timers.cmdEndPass(commands, "box_filter");
  }
  if (!encoded) return;
  images.cmdToEncode(commands);
  encode.cmdEncode(commands);
  timers.cmdEndPass(commands, "encode");
}

void Renderer::Impl::submit(const std::function<void(VkCommandBuffer)>& record) {
  submitter.run("frame", [&](VkCommandBuffer commands) {
    timers.cmdStart(commands);
    record(commands);
  });
  timers.addSubmission();
}

// Draws a picture. False: the method has made room, and the picture must be drawn again.
bool Renderer::Impl::draw(const Background& background, bool encoded) {
  timers.startFrame();
  method->startPicture(boxes);
  if (!method->inTiles()) {
    ++frame;
    submit([&](VkCommandBuffer commands) {
      cmdOpaque(commands, background);
      cmdTransparent(commands, {{0, 0}, images.extent()});
      cmdFinish(commands, encoded);
    });
    return method->finishArea(frame);
  }
  submit([&](VkCommandBuffer commands) { cmdOpaque(commands, background); });
  while (const std::optional<VkRect2D> tile = method->nextTile()) {
    ++frame;
    submit([&](VkCommandBuffer commands) { cmdTransparent(commands, *tile); });
    if (!method->finishArea(frame)) return false;
  }
  submit([&](VkCommandBuffer commands) { cmdFinish(commands, encoded); });
  return true;
}

// Draws until every fragment has a node, or once where the pool is fixed.
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
  if (needs.blending != Blending::AsDrawn) {
    report.resolve = needs.blending == Blending::Compute ? "compute" : "fragment";
    if (options.samples > 1) report.msaaResolve = nameOf(options.msaaResolve);
  }
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
