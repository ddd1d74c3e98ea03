#include "surfaces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "shaders/surface.vert.h"
#include "shaders/surface_clipped.vert.h"

namespace vitrail::tool {

namespace {

constexpr VkShaderStageFlags kSurfaceStages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

Unique<VkPipelineLayout> makeLayout(const Surfaces& surfaces, const SurfaceProgram& program) {
  std::vector<VkDescriptorSetLayout> sets{surfaces.frameLayout(), surfaces.scene().textureLayout()};
  if (program.set != VK_NULL_HANDLE) sets.push_back(program.set);
  return makePipelineLayout(surfaces.gpu(), sets, {VK_SHADER_STAGE_FRAGMENT_BIT, program.constantBytes}, program.name);
}

VkPrimitiveTopology topologyOf(std::uint32_t features) {
  if ((features & shaders::FEATURE_SOLID) == shaders::FEATURE_LINES) return VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
  if ((features & shaders::FEATURE_SOLID) == shaders::FEATURE_POINTS) return VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
}

void checkClipPlanes(const Gpu& gpu, const Scene& scene) {
  if (scene.clipPlanes.empty() || gpu.features().clipPlanes >= shaders::CLIP_PLANE_COUNT) return;
  throw GpuError(
      fmt::format("{} cannot cut a model: it lacks clip distances (see --clip-plane)", gpu.properties().deviceName));
}

} // namespace

float drawnPointSize(const Gpu& gpu, float wanted) {
  if (!gpu.features().largePoints) return 1.0F;
  const auto& range = gpu.properties().limits.pointSizeRange;
  return std::clamp(wanted, range[0], range[1]);
}

SurfacePipelines::SurfacePipelines(const Surfaces& surfaces, std::span<const GpuDraw> draws,
                                   const SurfaceProgram& program, const Describe& describe)
    : layout_(makeLayout(surfaces, program)) {
  for (const GpuDraw& draw : draws) {
    if (pipelines_.contains(draw.features)) continue;
    GraphicsPipelineInfo info;
    info.vertexShader = surfaces.list().isClipped() ? std::span<const std::uint32_t>(shaders::surface_clipped_vert)
                                                    : std::span<const std::uint32_t>(shaders::surface_vert);
    info.vertices = surfaceVertexLayout();
    info.topology = topologyOf(draw.features);
    info.depthTest = VK_COMPARE_OP_GREATER_OR_EQUAL; // of surfaces in one plane the one that is drawn last is seen
    describe(draw.features, info);
    info.layout = layout_.get();
    info.constants.emplace_back(0, draw.features);
    info.constants.emplace_back(shaders::POINT_SIZE_CONSTANT, std::bit_cast<std::uint32_t>(surfaces.pointSize()));
    info.name = fmt::format("{} (features {:#x})", program.name, draw.features);
    pipelines_.emplace(draw.features, makeGraphicsPipeline(surfaces.gpu(), info));
  }
}

Surfaces::Surfaces(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released,
                   std::uint32_t framesInFlight)
    : gpu_(gpu),
      scene_(gpu, scene, opacity, order, released),
      pointSize_(drawnPointSize(gpu, scene.pointSize)),
      list_(scene_, scene, scene_.lightCount()),
      views_(framesInFlight) {
  checkClipPlanes(gpu, scene);
  for (ViewSlot& view : views_) {
    view.buffer = GpuBuffer(gpu, sizeof(shaders::FrameData), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryKind::Upload,
                            "frame data");
    view.set = SingleSet(gpu,
                         {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kSurfaceStages},
                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, kSurfaceStages},
                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSurfaceStages}},
                         "frame");
    view.set.writeBuffer(0, view.buffer.get(), view.buffer.size());
    view.set.writeBuffer(1, scene_.materials().get(), sizeof(shaders::MaterialData));
    view.set.writeBuffer(2, scene_.lights().get(), scene_.lights().size());
  }
}

void Surfaces::setView(const shaders::FrameData& view) {
  list_.setView(view);
  view_ = (view_ + 1) % views_.size();
  std::memcpy(views_[view_].buffer.mapped(), &list_.view(), sizeof(view));
}

void Surfaces::cmdBindView(VkCommandBuffer commands, VkPipelineLayout layout, VkPipelineBindPoint point) const {
  const VkDescriptorSet set = viewSet();
  const std::uint32_t offset = 0; // of no draw
  vkCmdBindDescriptorSets(commands, point, layout, 0, 1, &set, 1, &offset);
}

// Runs of one draw that follow each other bind nothing anew.
void Surfaces::cmdDraw(VkCommandBuffer commands, std::span<const GpuDraw> draws, std::span<const SurfaceRun> runs,
                       const SurfacePipelines& pipelines, VkDescriptorSet set, VkBuffer indices) const {
  if (runs.empty()) return;
  const VkPipelineLayout layout = pipelines.layout();
  if (set != VK_NULL_HANDLE) {
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 2, 1, &set, 0, nullptr);
  }
  scene_.cmdBindInstances(commands);
  vkCmdBindIndexBuffer(commands, indices != VK_NULL_HANDLE ? indices : scene_.indices().get(), 0, VK_INDEX_TYPE_UINT32);
  VkPipeline pipeline = VK_NULL_HANDLE;
  const GpuDraw* bound = nullptr;
  for (const SurfaceRun& run : runs) {
    const GpuDraw& draw = draws[run.draw];
    if (VkPipeline wanted = pipelines.get(draw.features); wanted != pipeline) {
      pipeline = wanted;
      vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    }
    if (&draw != bound) {
      cmdBind(commands, layout, draw, bound);
      bound = &draw;
    }
    vkCmdDrawIndexed(commands, run.indexCount, run.instanceCount, run.firstIndex, 0, run.firstInstance);
  }
}

// Binds what a draw reads; of what `before`, if anything, has bound, what differs.
void Surfaces::cmdBind(VkCommandBuffer commands, VkPipelineLayout layout, const GpuDraw& draw,
                       const GpuDraw* before) const {
  if (before == nullptr || before->material != draw.material) {
    const std::array<VkDescriptorSet, 2> sets{views_[view_].set.set(), scene_.textures(draw.material)};
    const std::uint32_t offset = draw.material * kUniformStride<shaders::MaterialData>;
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 2, sets.data(), 1, &offset);
  }
  if (before == nullptr || before->mesh != draw.mesh) scene_.streams().cmdBind(commands, draw.mesh);
  // A mirror turns the triangles round, and glTF means the side that was outside before.
  if (before == nullptr || before->mirrored != draw.mirrored) {
    vkCmdSetFrontFace(commands, draw.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
  }
  if (before == nullptr || before->backFaceCulled != draw.backFaceCulled) {
    vkCmdSetCullMode(commands, draw.backFaceCulled ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE);
  }
}

} // namespace vitrail::tool
