#include "renderer.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "../methods/linked_list.h"
#include "../scene/srgb.h"
#include "barrier.h"
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

constexpr std::uint32_t kPasses = 5;

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

GraphicsPipelineInfo opaquePipeline(VkPipelineLayout layout) {
  GraphicsPipelineInfo info;
  info.layout = layout;
  info.vertexShader = shaders::surface_vert;
  info.fragmentShader = shaders::opaque_frag;
  info.surface = true;
  info.colorFormat = PictureImages::kColorFormat;
  info.depthTest = VK_COMPARE_OP_GREATER;
  info.depthWrite = true;
  info.name = "opaque";
  return info;
}

GraphicsPipelineInfo collectPipeline(VkPipelineLayout layout, const Method& method) {
  GraphicsPipelineInfo info;
  info.layout = layout;
  info.vertexShader = shaders::surface_vert;
  info.fragmentShader = method.collectShader();
  info.surface = true;
  info.depthTest = VK_COMPARE_OP_GREATER;
  info.name = "collect";
  return info;
}

GraphicsPipelineInfo skyPipeline(VkPipelineLayout layout) {
  GraphicsPipelineInfo info;
  info.layout = layout;
  info.vertexShader = shaders::sky_vert;
  info.fragmentShader = shaders::sky_frag;
  info.colorFormat = PictureImages::kColorFormat;
  info.name = "sky";
  return info;
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
  Submitter submitter;
  GpuScene scene;
  PictureImages images; // of the last picture's size; the method's target holds a view of them
  LinkedList method;
  GpuBuffer frameBuffer; // shaders::FrameData
  SingleSet frameSet;
  Unique<VkPipelineLayout> opaqueLayout;
  Unique<VkPipelineLayout> collectLayout;
  SurfacePipelines opaquePipelines;
  SurfacePipelines collectPipelines;
  Unique<VkPipeline> sky;
  EncodePass encode;
  Timers timers;
  std::uint64_t frame = 0;

  Impl(Gpu& device, const Scene& source, std::optional<float> opacity, DrawOrder order);
  void prepare(const RenderOptions& options);
  void record(VkCommandBuffer commands, const Background& background);
  void cmdOpaque(VkCommandBuffer commands, const Background& background);
  void cmdCollect(VkCommandBuffer commands);
  MethodStats renderUntilComplete(const RenderOptions& options);
  FrameReport report(const RenderOptions& options, const MethodStats& stats) const;
};

Renderer::Impl::Impl(Gpu& device, const Scene& source, std::optional<float> opacity, DrawOrder order)
    : gpu(device),
      submitter(gpu),
      scene(gpu, source, opacity, order),
      method(gpu),
      frameBuffer(gpu, sizeof(shaders::FrameData), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryKind::Upload,
                  "frame data"),
      frameSet(gpu,
               {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT},
                {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_SHADER_STAGE_VERTEX_BIT},
                {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT}},
               "frame"),
      opaqueLayout(makePipelineLayout(gpu, {frameSet.layout(), scene.textureLayout()}, 0, "opaque")),
      collectLayout(
          makePipelineLayout(gpu, {frameSet.layout(), scene.textureLayout(), method.collectLayout()}, 0, "collect")),
      opaquePipelines(gpu, opaquePipeline(opaqueLayout.get())),
      collectPipelines(gpu, collectPipeline(collectLayout.get(), method)),
      sky(makeGraphicsPipeline(gpu, skyPipeline(opaqueLayout.get()))),
      encode(gpu),
      timers(gpu, kPasses) {
  frameSet.writeBuffer(0, frameBuffer.get(), frameBuffer.size());
  frameSet.writeBuffer(1, scene.drawData().get(), sizeof(shaders::DrawData));
  frameSet.writeBuffer(2, scene.materials().get(), sizeof(shaders::MaterialData));
  // All that the scene needs, now: no frame waits for a pipeline.
  for (const GpuDraw& draw : scene.opaqueDraws()) opaquePipelines.get(draw.features);
  for (const GpuDraw& draw : scene.transparentDraws()) collectPipelines.get(draw.features);
}

void Renderer::Impl::prepare(const RenderOptions& options) {
  const VkExtent2D extent{options.width, options.height};
  if (extent.width != images.extent().width || extent.height != images.extent().height) {
    method.releaseTarget();
    images = PictureImages(); // first: the old size and the new one need not fit together
    images = PictureImages(gpu, extent);
    encode.setSource(images.color());
  }
  MethodTarget target;
  target.extent = extent;
  target.color = images.color().view();
  target.nodeCapacity = options.nodeCapacity;
  if (scene.transparentDraws().empty() && !target.nodeCapacity) target.nodeCapacity = 0;
  method.setTarget(target);
  const shaders::FrameData data = makeFrameData(options.view, options.width, options.height, scene.origin());
  std::memcpy(frameBuffer.mapped(), &data, sizeof(data));
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
}

void Renderer::Impl::cmdCollect(VkCommandBuffer commands) {
  images.cmdBeginCollect(commands);
  const VkDescriptorSet lists = method.collectSet();
  const VkPipelineLayout layout = collectLayout.get();
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 2, 1, &lists, 0, nullptr);
  cmdDrawSurfaces(commands, scene, scene.transparentDraws(), layout, frameSet.set(), collectPipelines);
  vkCmdEndRendering(commands);
}

void Renderer::Impl::record(VkCommandBuffer commands, const Background& background) {
  timers.cmdStart(commands);
  cmdOpaque(commands, background);
  timers.cmdEndPass(commands, "opaque");
  method.cmdClear(commands, frame);
  timers.cmdEndPass(commands, "clear");
  cmdCollect(commands);
  method.cmdCollected(commands);
  timers.cmdEndPass(commands, "collect");
  images.cmdToCompute(commands);
  method.cmdResolve(commands);
  timers.cmdEndPass(commands, "resolve");
  // The resolve wrote colour -> the encoding reads it.
  cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
  encode.cmdEncode(commands);
  timers.cmdEndPass(commands, "encode");
}

// Renders until every fragment has a node, or once where the pool is fixed.
MethodStats Renderer::Impl::renderUntilComplete(const RenderOptions& options) {
  MethodStats stats;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    ++frame;
    submitter.run("frame", [&](VkCommandBuffer commands) { record(commands, options.background); });
    stats = method.stats(frame);
    if (stats.fragmentsMissing == 0 && stats.cutPixels > 0) {
      throw GpuError(
          fmt::format("{} pixels have more surfaces, up to {}, than the driver of {} lets a shader sort: use a GPU",
                      stats.cutPixels, stats.layersMax, gpu.properties().deviceName));
    }
    if (stats.exact || !method.grow(stats)) return stats;
  }
  throw GpuError(fmt::format("{} counts the picture's fragments differently in each frame: {} were missing after {}",
                             gpu.properties().deviceName, stats.fragmentsMissing, kMaxAttempts));
}

FrameReport Renderer::Impl::report(const RenderOptions& options, const MethodStats& stats) const {
  FrameReport report;
  report.device = gpu.properties().deviceName;
  report.api = "Vulkan 1.3";
  report.method = method.name();
  report.width = options.width;
  report.height = options.height;
  report.exact = stats.exact;
  report.fragmentsRequested = stats.fragmentsRequested;
  report.fragmentsStored = stats.fragmentsStored;
  report.fragmentsMissing = stats.fragmentsMissing;
  report.layersMax = stats.layersMax;
  report.layersMean = stats.layersMean;
  report.nodesBytes = stats.nodesBytes;
  report.headsBytes = stats.headsBytes;
  report.peakBytes = gpu.peakMemory();
  report.passesMs = timers.milliseconds();
  for (const auto& [name, milliseconds] : report.passesMs) report.frameMs += milliseconds;
  return report;
}

Renderer::Renderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order)
    : impl_(std::make_unique<Impl>(gpu, scene, opacity, order)) {}

Renderer::~Renderer() = default;

RenderResult Renderer::render(const RenderOptions& options) {
  impl_->prepare(options);
  const MethodStats stats = impl_->renderUntilComplete(options);
  RenderResult result;
  result.picture.width = options.width;
  result.picture.height = options.height;
  result.picture.hasAlpha = options.background.kind == Background::Kind::Transparent;
  result.picture.rgba = impl_->encode.pixels();
  result.report = impl_->report(options, stats);
  return result;
}

} // namespace vitrail::tool
