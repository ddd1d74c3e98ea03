#include "gpu_pick.h"

#include <array>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "../gpu/accesses.h"
#include "../gpu/scope.h"
#include "../gpu/submit.h"
#include "../gpu/timers.h"
#include "../gpu/vk.h"
#include "../methods/shared/library_context.h"
#include "../stage/tile_runs.h"
#include "pick_shared.h"
#include "shaders/collect_instance.frag.h"
#include "shaders/collect_instance_address.frag.h"
#include "shaders/pick.comp.h"
#include "shaders/pick_address.comp.h"
#include "shaders/surface_object.vert.h"
#include "shaders/surface_object_clipped.vert.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kOpaqueConstant = 2; // of collect.frag
constexpr std::uint32_t kFirstNodes = 1024;  // of the pool

struct Found { // what pick.comp writes
  std::uint32_t count;
  std::uint32_t cut;
  std::uint32_t unused[2];
  VitrailLayer layers[shaders::PICK_MOST_LAYERS];
};

} // namespace

struct GpuPicker::Impl {
  Gpu& gpu;
  const Surfaces& surfaces;
  std::vector<DrawFacts> facts; // of the scene's draws
  std::string reason;
  vulkan::Context context;
  vulkan::Target target;
  VkExtent2D extent{}; // of it
  std::uint32_t nodes = kFirstNodes;
  std::uint64_t frame = 0;
  std::optional<SurfacePipelines> transparent;
  std::optional<SurfacePipelines> opaque;
  SingleSet set;
  Unique<VkPipelineLayout> layout;
  Unique<VkPipeline> pipeline;
  GpuBuffer found;
  Submitter submitter;
  Timers timers;

  Impl(const Surfaces& given, std::vector<DrawFacts> ofDraws);
  VitrailVkTargetDesc targetDesc() const;
  SurfacePipelines makePipelines(std::span<const GpuDraw> draws, bool isOpaque) const;
  void makeTarget(VkExtent2D wanted);
  void draw(VkCommandBuffer commands, std::span<const SurfaceRun> runs, const VkRect2D& area);
  void check(VkResult result, const char* call) const;
};

GpuPicker::Impl::Impl(const Surfaces& given, std::vector<DrawFacts> ofDraws)
    : gpu(given.gpu()),
      surfaces(given),
      facts(std::move(ofDraws)),
      set(gpu, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}}, "pick"),
      found(gpu, sizeof(Found), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::Readback, "picked layers"),
      submitter(gpu),
      timers(gpu, 2) {
  check(makeLibraryContext(gpu, reason, context), "vitrailVkCreateContext");
  transparent.emplace(makePipelines(surfaces.scene().transparentDraws(), false));
  opaque.emplace(makePipelines(surfaces.scene().opaqueDraws(), true));
  set.writeBuffer(0, found.get(), found.size());
  layout = makePipelineLayout(gpu, {context.descriptorSetLayout(), set.layout()},
                              {VK_SHADER_STAGE_COMPUTE_BIT, sizeof(std::int32_t[2])}, "pick");
  const bool address = gpu.features().poolByAddress;
  pipeline = makeComputePipeline(gpu, layout.get(),
                                 address ? std::span<const std::uint32_t>(shaders::pick_address_comp)
                                         : std::span<const std::uint32_t>(shaders::pick_comp),
                                 "pick");
}

void GpuPicker::Impl::check(VkResult result, const char* call) const {
  if (result != VK_SUCCESS && !reason.empty()) throw GpuError(reason);
  tool::check(result, call);
}

SurfacePipelines GpuPicker::Impl::makePipelines(std::span<const GpuDraw> draws, bool isOpaque) const {
  const bool address = gpu.features().poolByAddress;
  const VitrailVkSpecialization specialization = context.collectSpecialization(targetDesc());
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.vertexShader = surfaces.list().isClipped()
                            ? std::span<const std::uint32_t>(shaders::surface_object_clipped_vert)
                            : std::span<const std::uint32_t>(shaders::surface_object_vert);
    info.fragmentShader = address ? std::span<const std::uint32_t>(shaders::collect_instance_address_frag)
                                  : std::span<const std::uint32_t>(shaders::collect_instance_frag);
    for (std::size_t i = 0; i < specialization.count; ++i) {
      info.constants.emplace_back(specialization.entries[i].constantID, specialization.data[i]);
    }
    info.constants.emplace_back(kOpaqueConstant, isOpaque ? VK_TRUE : VK_FALSE);
  };
  return {surfaces, draws, {.set = context.descriptorSetLayout(), .name = "pick"}, describe};
}

VitrailVkTargetDesc GpuPicker::Impl::targetDesc() const {
  VitrailVkTargetDesc desc{};
  desc.extent = extent;
  desc.nodeFormat = VITRAIL_NODE_HDR;
  desc.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  desc.resolve = VITRAIL_RESOLVE_HOST;
  desc.overflow = VITRAIL_OVERFLOW_SKIP;
  desc.listBuild = VITRAIL_LIST_BUILD_FRAGMENT;
  desc.userWords = VK_TRUE;
  desc.nodeCapacity = nodes;
  desc.areaPixels = 1;
  desc.framesInFlight = 1;
  desc.debugName = "pick";
  return desc;
}

void GpuPicker::Impl::makeTarget(VkExtent2D wanted) {
  extent = wanted;
  check(vulkan::Target::create(context, targetDesc(), target), "vitrailVkCreateTarget");
}

void GpuPicker::Impl::draw(VkCommandBuffer commands, std::span<const SurfaceRun> runs, const VkRect2D& area) {
  target.begin(commands, {nullptr, ++frame, area});
  Scope scope;
  scope.extent = extent;
  scope.area = area;
  cmdBeginScope(commands, scope);
  const std::vector<GpuDraw>& opaqueDraws = surfaces.scene().opaqueDraws();
  surfaces.cmdDraw(commands, opaqueDraws, runsOf(opaqueDraws), *opaque, target.descriptorSet());
  surfaces.cmdDraw(commands, surfaces.scene().transparentDraws(), runs, *transparent, target.descriptorSet());
  vkCmdEndRendering(commands);
  target.collected(commands);
  timers.cmdEndPass(commands, "collect");
  target.resolve(commands); // which is the walk
  const std::array<VkDescriptorSet, 2> sets{target.descriptorSet(), set.set()};
  const std::int32_t pixel[2] = {area.offset.x, area.offset.y};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout.get(), 0,
                          static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
  vkCmdPushConstants(commands, layout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pixel), pixel);
  vkCmdDispatch(commands, 1, 1, 1);
  // The walk writes what it found -> the host reads it after the fence.
  cmdMemoryBarrier(commands, kComputeWrite, kHostRead);
  target.end(commands);
  timers.cmdEndPass(commands, "walk");
}

GpuPicker::GpuPicker(const Surfaces& surfaces, std::vector<DrawFacts> facts)
    : impl_(std::make_unique<Impl>(surfaces, std::move(facts))) {}
GpuPicker::~GpuPicker() = default;

std::optional<std::vector<PickedLayer>> GpuPicker::at(const View& view, std::uint32_t width, std::uint32_t height,
                                                      std::uint32_t x, std::uint32_t y) {
  Impl& impl = *impl_;
  if (!impl.target || impl.extent.width != width || impl.extent.height != height) impl.makeTarget({width, height});
  const std::vector<SurfaceRun> runs = TileRuns(impl.surfaces.list(), width, height).touching({x, y, 1, 1});
  const VkRect2D area{{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)}, {1, 1}};
  VitrailStats stats{};
  while (true) {
    VkCommandBuffer commands = impl.submitter.begin();
    impl.timers.startFrame();
    impl.timers.cmdStart(commands);
    impl.draw(commands, runs, area);
    impl.submitter.execute("pick");
    impl.timers.addSubmission();
    impl.check(impl.target.readStats(impl.frame, stats), "vitrailVkReadStats");
    if (stats.fragmentsMissing == 0) break;
    if (stats.fragmentsRequested <= impl.nodes || stats.fragmentsRequested > UINT32_MAX) {
      throw GpuError("the fragments of the pixel have no room on the device");
    }
    impl.nodes = static_cast<std::uint32_t>(stats.fragmentsRequested);
    impl.makeTarget(impl.extent);
  }
  const Found& found = *static_cast<const Found*>(impl.found.mapped());
  if (found.cut != 0 || stats.cutPixels != 0) return std::nullopt; // by the walk, or before it by the sort
  std::vector<VitrailLayer> layers(found.count);
  std::memcpy(layers.data(), found.layers, layers.size() * sizeof(VitrailLayer));
  std::vector<bool> isOpaque(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    isOpaque[i] = (layers[i].word & shaders::PICK_OPAQUE) != 0;
    layers[i].word = impl.surfaces.scene().sourceOf(layers[i].word & ~shaders::PICK_OPAQUE);
  }
  return pickedOf(layers, isOpaque, impl.facts, {view, width, height, x, y});
}

double GpuPicker::milliseconds() const {
  double sum = 0.0;
  for (const auto& [name, milliseconds] : impl_->timers.milliseconds()) sum += milliseconds;
  return sum;
}

} // namespace vitrail::tool
