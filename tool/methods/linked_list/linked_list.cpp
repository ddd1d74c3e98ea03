// Per-pixel linked lists: exact transparency through libvitrail, as any host embeds it.
//
// A picture is drawn whole where that fits, into a pool that grows until it does: with a memory budget as the library
// lets it grow, within the budget. A picture that does not fit into it, or by default into what the device can hold, is
// drawn in tiles.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <vitrail/vitrail.hpp>

#include "../../gpu/device.h"
#include "../../gpu/vk.h"
#include "../../stage/picture_images.h"
#include "../../stage/tile_runs.h"
#include "../method.h"
#include "../methods.h"
#include "media.h"
#include "shaders/collect.frag.h"
#include "shaders/collect_address.frag.h"
#include "shaders/collect_coverage.frag.h"
#include "shaders/collect_coverage_address.frag.h"
#include "shaders/collect_media.frag.h"
#include "shaders/collect_media_address.frag.h"
#include "shaders/collect_media_coverage.frag.h"
#include "shaders/collect_media_coverage_address.frag.h"
#include "shaders/surface_object.vert.h"

namespace vitrail::tool {

namespace {

// The first guess: most models that are looked at have fewer fragments than this a pixel
// of the whole picture.
constexpr std::uint64_t kNodesPerPixel = 4;
constexpr std::uint64_t kLargestGuess = std::uint64_t{1} << 24U;

constexpr std::uint32_t kDepthFromW = 1; // the constant of collect.frag

void remember(VitrailLogSeverity severity, const char* message, void* reason) {
  if (severity == VITRAIL_LOG_ERROR) *static_cast<std::string*>(reason) = message;
}

std::uint32_t libraryFeatures(const GpuFeatures& features) {
  std::uint32_t bits = 0;
  if (features.poolByAddress) bits |= VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS;
  if (features.dualSourceBlending) bits |= VITRAIL_VK_FEATURE_DUAL_SRC_BLEND;
  if (features.sampleRateShading) bits |= VITRAIL_VK_FEATURE_SAMPLE_RATE_SHADING;
  return bits;
}

// Plans of tiles know no Vulkan.
VkResult resultOf(VitrailResult result) {
  if (result == VITRAIL_SUCCESS) return VK_SUCCESS;
  return result == VITRAIL_ERROR_OUT_OF_MEMORY ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_ERROR_INITIALIZATION_FAILED;
}

std::uint64_t pixelsOf(VkExtent2D extent) { return std::uint64_t{extent.width} * extent.height; }

std::span<const std::uint32_t> collectCode(bool media, bool coverage, bool address) {
  if (media && coverage && address) return shaders::collect_media_coverage_address_frag;
  if (media && coverage) return shaders::collect_media_coverage_frag;
  if (media && address) return shaders::collect_media_address_frag;
  if (media) return shaders::collect_media_frag;
  if (coverage && address) return shaders::collect_coverage_address_frag;
  if (coverage) return shaders::collect_coverage_frag;
  if (address) return shaders::collect_address_frag;
  return shaders::collect_frag;
}

bool sameTarget(const MethodTarget& a, const MethodTarget& b) {
  return a.extent.width == b.extent.width && a.extent.height == b.extent.height && a.color == b.color &&
         a.opaque == b.opaque && a.depth == b.depth && a.memoryBudget == b.memoryBudget && a.surfaces == b.surfaces;
}

class LinkedList final : public Method {
 public:
  LinkedList(const MethodHost& host, const MethodOptions& options);
  ~LinkedList() override;

  ImageNeeds needs() const override { return needs_; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override;
  FrameStats stats() const override;

 private:
  void makeContext();
  void chooseResolve();
  void makeSurfaces();
  VitrailVkTargetDesc targetDesc() const;
  bool createTarget(const VitrailVkTargetDesc& desc);
  void makeFixedTarget(bool buildsAll);
  bool createWholeTarget(std::uint64_t nodeCapacity);
  void countMemory();
  std::uint64_t wordsOf(std::uint64_t bytes) const;
  // Whether the resolve makes the picture out of several samples.
  bool writesEveryPixel() const { return options_.samples > 1 && !needs_.perSample; }
  void planTiles(std::span<const VitrailBounds> bounds);
  void drawTiles(Frame& frame);
  void drawCollecting(Frame& frame, std::span<const SurfaceRun> runs);
  void drawArea(Frame& frame, const VkRect2D& area, std::span<const SurfaceRun> runs);
  VitrailStats readStats() const;
  bool grow(std::uint64_t fragments);
  void add(const VitrailStats& stats);
  void check(VkResult result, const char* call) const;

  // What pipelines differ in beside the options.
  struct PipelineKind {
    VitrailListBuild listBuild = VITRAIL_LIST_BUILD_DEFAULT;
    bool depthFromW = false; // collect.frag
    bool operator==(const PipelineKind&) const = default;
  };

  Gpu& gpu_;
  const Surfaces& source_;
  MethodOptions options_;
  ImageNeeds needs_;
  std::string reason_; // what the library last logged
  vulkan::Context context_;
  std::optional<Media> media_; // where objects absorb light: what resolves the lists then
  PipelineKind pipelines_;     // of surfaces_
  std::optional<SurfacePipelines> surfaces_;
  std::optional<SurfacePipelines> untested_; // the same without a depth test, where media_ asks for them
  vulkan::Target target_;
  std::uint64_t frame_ = 0;    // of the target: rises with every area
  TilePlan plan_;              // where inTiles_
  VitrailVkTargetDesc made_{}; // what target_ was made for; its pointers are not kept
  MethodTarget wanted_;
  std::uint64_t budget_ = 0;   // bytes for a tile
  bool nothing_ = false;       // there is nothing transparent, and nothing that a resolve has to write
  bool inTiles_ = false;       // the next picture is
  bool wasInTiles_ = false;    // the present picture is
  std::uint64_t expected_ = 0; // the fragments of the last picture, 0 where that is not known
  std::uint64_t counted_ = 0;  // the target's bytes, as the Gpu counts them
  FrameStats stats_;           // of the present picture's areas so far
  std::uint64_t coveredPixels_ = 0;
};

LinkedList::LinkedList(const MethodHost& host, const MethodOptions& options)
    : gpu_(host.gpu), source_(host.surfaces), options_(options) {
  makeContext();
  // With a bound on the layers only the nearest are drawn as they are: then objects are as thick as their files say.
  if (source_.scene().solids().any() && options_.maxLayers == 0) {
    media_.emplace(host, context_.descriptorSetLayout(), options_.samples);
  }
  chooseResolve();
}

LinkedList::~LinkedList() { gpu_.memoryFreed(counted_); }

void LinkedList::makeContext() {
  VitrailVkContextDesc desc{};
  desc.instance = gpu_.instance();
  desc.physicalDevice = gpu_.physicalDevice();
  desc.device = gpu_.device();
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.features = libraryFeatures(gpu_.features());
  desc.log = remember;
  desc.logUser = &reason_;
  check(vulkan::Context::create(desc, context_), "vitrailVkCreateContext");
}

void LinkedList::chooseResolve() {
  const GpuFeatures& features = gpu_.features();
  if (media_ && (options_.nodeCapacity > 0 || options_.stencilMark == StencilMark::Off)) {
    throw GpuError(
        "objects of this scene absorb light, which is resolved by walking complete lists: leave --overflow "
        "and --stencil-mark out");
  }
  if (media_) { // which resolves by compute, a pixel at a time, whatever was asked for: there is no other way
    options_.resolve = VITRAIL_RESOLVE_COMPUTE;
    options_.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
    needs_.depthUsage = VK_IMAGE_USAGE_SAMPLED_BIT;
    return;
  }
  needs_.perSample = options_.samples > 1 && options_.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  if (needs_.perSample && !features.sampleRateShading) {
    throw GpuError(fmt::format("{} does not shade samples one by one: use --msaa-resolve per-pixel",
                               gpu_.properties().deviceName));
  }
  if (options_.resolve == VITRAIL_RESOLVE_DEFAULT) {
    VitrailVkTargetDesc target = targetDesc();
    const VkImageView anyView = VK_NULL_HANDLE;
    target.views = {1, &anyView, nullptr, nullptr}; // the colour image can be written by compute
    options_.resolve = context_.defaultResolve(target);
  }
  const bool drawn = options_.resolve == VITRAIL_RESOLVE_FRAGMENT;
  if (!drawn && options_.stencilMark == StencilMark::Off) {
    throw GpuError(
        "--stencil-mark off is of resolves that are drawn, which is not this device's choice: use --resolve "
        "fragment");
  }
  needs_.stencil = drawn && (options_.samples == 1 || needs_.perSample) && features.stencil &&
                   options_.stencilMark == StencilMark::On;
  if (options_.samples > 1 && !features.postDepthCoverage) needs_.depthUsage = VK_IMAGE_USAGE_SAMPLED_BIT;
}

// The pipelines for the picture that is wanted, where there are none yet or others.
void LinkedList::makeSurfaces() {
  const bool coverage = options_.samples > 1 && gpu_.features().postDepthCoverage;
  const bool address = gpu_.features().poolByAddress;
  VitrailVkTargetDesc desc = targetDesc();
  desc.listBuild =
      options_.listBuild != VITRAIL_LIST_BUILD_DEFAULT ? options_.listBuild : context_.defaultListBuild(desc);
  PipelineKind kind;
  kind.listBuild = desc.listBuild;
  // To spare the fragment shaders of GPUs; Mesa's CPU driver takes longer. Where samples are tested in the resolve,
  // depths are compared with those of the depth image.
  const bool isCpu = gpu_.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  const bool spares = !isCpu || kind.listBuild == VITRAIL_LIST_BUILD_COMPUTE;
  kind.depthFromW = spares && !media_ && source_.view().eye.w < 0.5F && (options_.samples == 1 || coverage);
  const bool wantsUntested = media_ && media_->objects().anyNear();
  if (surfaces_ && kind == pipelines_ && (untested_ || !wantsUntested)) return;
  pipelines_ = kind;
  const VitrailVkSpecialization specialization = context_.collectSpecialization(desc);
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = collectCode(media_.has_value(), coverage, address);
    if (media_) info.vertexShader = shaders::surface_object_vert;
    for (std::size_t i = 0; i < specialization.count; ++i) {
      info.constants.emplace_back(specialization.entries[i].constantID, specialization.data[i]);
    }
    info.constants.emplace_back(kDepthFromW, kind.depthFromW ? VK_TRUE : VK_FALSE);
    info.samples = flagOf(options_.samples);
    info.depthFormat = PictureImages::depthFormat(needs_.stencil);
    if (needs_.stencil) vitrailVkStencilMark(&info.stencil.emplace());
  };
  const SurfaceProgram program{.set = context_.descriptorSetLayout(), .name = "collect"};
  surfaces_.emplace(source_, source_.scene().transparentDraws(), program, describe);
  untested_.reset();
  if (!wantsUntested) return;
  const auto describeUntested = [&](std::uint32_t features, GraphicsPipelineInfo& info) {
    describe(features, info);
    info.depthTest = VK_COMPARE_OP_ALWAYS;
  };
  untested_.emplace(source_, source_.scene().transparentDraws(), program, describeUntested);
}

// All but the memory and the images.
VitrailVkTargetDesc LinkedList::targetDesc() const {
  VitrailVkTargetDesc desc{};
  desc.extent = wanted_.extent;
  desc.samples = flagOf(options_.samples);
  desc.nodeFormat = options_.nodes;
  desc.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  desc.resolve = media_ ? VITRAIL_RESOLVE_HOST : options_.resolve;
  desc.userWords = media_ ? VK_TRUE : VK_FALSE;
  desc.msaaResolve = options_.msaaResolve;
  desc.postDepthCoverage = options_.samples > 1 && gpu_.features().postDepthCoverage ? VK_TRUE : VK_FALSE;
  desc.maxLayers = options_.maxLayers;
  desc.listBuild = pipelines_.listBuild;
  // Skipped, the picture is drawn again, with a larger pool or in tiles.
  desc.overflow = options_.nodeCapacity > 0 ? VITRAIL_OVERFLOW_APPROXIMATE : VITRAIL_OVERFLOW_SKIP;
  desc.colorFormat = PictureImages::kColorFormat;
  if (needs_.stencil) {
    desc.scope.stencilFormat = PictureImages::depthFormat(true);
    desc.scope.stencilMark = VK_TRUE;
  }
  desc.framesInFlight = 1;
  return desc;
}

void LinkedList::setTarget(const MethodTarget& target) {
  if (media_) media_->setView(source_.view());
  if (wanted_.color != VK_NULL_HANDLE && sameTarget(target, wanted_)) {
    wanted_.onTile = target.onTile;
    return makeSurfaces();
  }
  releaseTarget();
  wanted_ = target;
  if (media_) media_->setTarget(target);
  makeSurfaces();
  nothing_ = !target.surfaces && !writesEveryPixel();
  if (nothing_) return; // what a target would take, its kernels too, is spared
  expected_ = 0;
  budget_ = target.memoryBudget.value_or(std::numeric_limits<std::uint64_t>::max());
  const bool buildsAll = pipelines_.listBuild == VITRAIL_LIST_BUILD_FRAGMENT ||
                         pixelsOf(target.extent) <= VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS;
  const std::uint64_t largest = context_.maxNodeCapacity(options_.nodes, flagOf(options_.samples));
  const std::uint64_t guess = std::min({kNodesPerPixel * pixelsOf(target.extent), kLargestGuess, largest});
  if (options_.nodeCapacity > 0) return makeFixedTarget(buildsAll);
  inTiles_ = !buildsAll || !createWholeTarget(target.surfaces ? guess : 0); // drawTiles() knows how large tiles are
}

// A target that is neither enlarged nor drawn in tiles.
void LinkedList::makeFixedTarget(bool buildsAll) {
  if (!buildsAll) {
    throw GpuError(
        "--list-build compute draws so large a picture in tiles, and --overflow approximate draws it whole: "
        "use --list-build fragment, or a smaller --size");
  }
  inTiles_ = false;
  if (!createWholeTarget(options_.nodeCapacity)) check(VK_ERROR_OUT_OF_DEVICE_MEMORY, "vitrailVkCreateTarget");
}

// A target for the whole picture, whose pool begins with so many nodes; with a budget it follows what pictures need.
// False where there is no memory for it.
bool LinkedList::createWholeTarget(std::uint64_t nodeCapacity) {
  VitrailVkTargetDesc desc = targetDesc();
  desc.nodeCapacity = static_cast<std::uint32_t>(std::max<std::uint64_t>(nodeCapacity, 1)); // 0: the library's guess
  if (wanted_.memoryBudget) desc.memoryBudget = *wanted_.memoryBudget;
  return createTarget(desc);
}

// False where the device has no memory for it.
bool LinkedList::createTarget(const VitrailVkTargetDesc& desc) {
  const bool same = made_.nodeCapacity == desc.nodeCapacity && made_.areaPixels == desc.areaPixels &&
                    made_.memoryBudget == desc.memoryBudget;
  if (target_ && same) return true; // the images are the same until releaseTarget()
  target_ = vulkan::Target();       // first: the old pool and the new one need not fit together
  gpu_.memoryFreed(std::exchange(counted_, 0));
  VitrailVkTargetDesc full = desc;
  if (!media_) {
    full.views.count = 1;
    full.views.color = &wanted_.color;
    if (options_.samples > 1 && !needs_.perSample) full.views.opaque = &wanted_.opaque;
    if (needs_.depthUsage != 0) full.views.depth = &wanted_.depth;
  }
  const VkResult result = vulkan::Target::create(context_, full, target_);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) return false; // the reason stays, in case that it ends the program
  check(result, "vitrailVkCreateTarget");
  reason_.clear();
  made_ = desc;
  countMemory();
  return true;
}

// What the target holds now, a pool that was replaced included.
void LinkedList::countMemory() {
  gpu_.memoryFreed(std::exchange(counted_, target_.memory().totalBytes));
  gpu_.memoryAllocated(counted_);
}

void LinkedList::releaseTarget() {
  target_ = vulkan::Target();
  plan_ = TilePlan();
  wanted_ = {};
  gpu_.memoryFreed(std::exchange(counted_, 0));
}

void LinkedList::draw(Frame& frame) {
  stats_ = {};
  stats_.tiles = 0;
  stats_.complete = true;
  coveredPixels_ = 0;
  if (nothing_) stats_.tiles = 1;
  wasInTiles_ = inTiles_ || nothing_; // what there was to count has been counted
  if (nothing_) return;
  if (inTiles_) return drawTiles(frame);
  if (wanted_.memoryBudget) {
    check(target_.update(frame_ + 1), "vitrailVkUpdateTarget"); // frees the pool that grow() replaced
    countMemory();
  }
  drawArea(frame, {{0, 0}, wanted_.extent}, source_.transparentRuns());
}

// Every tile is waited for: what it reports decides whether its parts come next.
void LinkedList::drawTiles(Frame& frame) {
  frame.submitAndWait(); // the opaque scene
  planTiles(clipBoxesOf(source_.list()));
  const TileRuns runs(source_.list(), wanted_.extent.width, wanted_.extent.height);
  VitrailRect tile{};
  while (plan_ && plan_.next(tile)) {
    const VkRect2D area{{static_cast<std::int32_t>(tile.x), static_cast<std::int32_t>(tile.y)},
                        {tile.width, tile.height}};
    drawArea(frame, area, runs.touching(tile));
    frame.submitAndWait();
    const VitrailStats stats = readStats();
    check(resultOf(plan_.finish(stats)), "vitrailFinishTile");
    if (stats.fragmentsMissing == 0) add(stats); // else its parts come next
    expected_ = stats_.fragmentsRequested;
    if (wanted_.onTile) wanted_.onTile(stats_.tiles);
  }
}

void LinkedList::drawCollecting(Frame& frame, std::span<const SurfaceRun> runs) {
  if (!media_ || !media_->objects().anyNear()) return frame.drawSurfaces(*surfaces_, target_.descriptorSet(), runs);
  frame.drawSurfaces(*surfaces_, target_.descriptorSet(), media_->objects().part(runs, false));
  frame.drawSurfaces(*untested_, target_.descriptorSet(), media_->objects().part(runs, true));
}

void LinkedList::drawArea(Frame& frame, const VkRect2D& area, std::span<const SurfaceRun> runs) {
  VkCommandBuffer commands = frame.commands();
  PictureImages& images = frame.images();
  target_.begin(commands, {nullptr, ++frame_, area});
  frame.endPass("clear");
  cmdBeginScope(commands, images.transparentScope(area));
  drawCollecting(frame, runs);
  vkCmdEndRendering(commands);
  if (pipelines_.listBuild == VITRAIL_LIST_BUILD_COMPUTE) frame.endPass("collect");
  target_.collected(commands);
  frame.endPass(pipelines_.listBuild == VITRAIL_LIST_BUILD_COMPUTE ? "build lists" : "collect");
  if (options_.resolve == VITRAIL_RESOLVE_FRAGMENT) {
    cmdBeginScope(commands, images.resolveScope(commands, area));
    target_.resolve(commands);
    vkCmdEndRendering(commands);
  } else {
    images.cmdToComputeResolve(commands);
    target_.resolve(commands);
    if (media_) media_->cmdResolve(commands, target_.descriptorSet(), area.extent);
  }
  frame.endPass("resolve");
  target_.end(commands);
  frame.endPass("statistics");
}

// What words take at most of so many bytes of nodes with words: plans of tiles know nodes alone.
std::uint64_t LinkedList::wordsOf(std::uint64_t bytes) const {
  constexpr std::uint64_t kNodes = 1024;
  const std::uint64_t word = kNodes * sizeof(std::uint32_t);
  return bytes / (vitrailNodePoolSize(options_.nodes, kNodes) + word) * word;
}

void LinkedList::planTiles(std::span<const VitrailBounds> bounds) {
  plan_ = TilePlan();
  const bool everyPixel = writesEveryPixel() || std::ranges::any_of(source_.scene().transparentDraws(), drawsPoints);
  if (bounds.empty() && !everyPixel) return; // nothing to draw
  VitrailTilePlanDesc desc{};
  desc.width = wanted_.extent.width;
  desc.height = wanted_.extent.height;
  desc.samples = options_.samples;
  desc.nodeFormat = options_.nodes;
  check(context_.tileLimits(options_.nodes, flagOf(options_.samples), desc.limits), "vitrailVkTileLimits");
  desc.log = remember;
  desc.logUser = &reason_;
  desc.boundsCount = everyPixel ? 0 : static_cast<std::uint32_t>(bounds.size());
  desc.bounds = bounds.data();
  desc.expectedFragments = expected_;
  // The device may have less memory left than it says that it can give: then less is tried.
  for (;;) {
    desc.memoryBudget = media_ ? budget_ - wordsOf(budget_) : budget_;
    check(resultOf(TilePlan::create(desc, plan_)), "vitrailCreateTilePlan");
    VitrailVkTargetDesc target = targetDesc();
    vitrailVkTilePlanTarget(plan_.handle(), &target);
    if (createTarget(target)) return;
    budget_ = vitrailNodePoolSize(options_.nodes, target.nodeCapacity) / 2;
  }
}

VitrailStats LinkedList::readStats() const {
  VitrailStats stats{};
  check(target_.readStats(frame_, stats), "vitrailVkReadStats");
  return stats;
}

bool LinkedList::finish() {
  if (wasInTiles_) return true;
  const VitrailStats stats = readStats();
  add(stats);
  if (stats.fragmentsMissing == 0 || options_.nodeCapacity > 0) return true;
  inTiles_ = !grow(stats.fragmentsRequested);
  expected_ = stats.fragmentsRequested;
  return false;
}

// Makes room for a picture of so many fragments, which is what the last one turned out to have. False where the budget,
// or the device, has no pool that large.
bool LinkedList::grow(std::uint64_t fragments) {
  if (!wanted_.memoryBudget) {
    const bool canBe = fragments <= context_.maxNodeCapacity(options_.nodes, flagOf(options_.samples));
    return canBe && createWholeTarget(fragments);
  }
  const VkResult result = target_.update(frame_ + 1);
  if (result != VK_ERROR_OUT_OF_DEVICE_MEMORY) check(result, "vitrailVkUpdateTarget");
  countMemory();
  return target_.memory().nodeCapacity >= fragments;
}

void LinkedList::add(const VitrailStats& stats) {
  ++stats_.tiles;
  stats_.complete = stats_.complete && stats.complete != 0;
  stats_.fragmentsRequested += stats.fragmentsRequested;
  stats_.fragmentsStored += stats.fragmentsStored;
  stats_.fragmentsMissing += stats.fragmentsMissing;
  stats_.approximatePixels += stats.approximatePixels;
  stats_.cutPixels += stats.cutPixels;
  stats_.layersMax = std::max(stats_.layersMax, stats.layersMax);
  coveredPixels_ += stats.coveredPixels;
}

FrameStats LinkedList::stats() const {
  FrameStats result = stats_;
  result.nodes = nameOf(options_.nodes);
  result.resolve = nameOf(options_.resolve);
  result.listBuild = nameOf(pipelines_.listBuild);
  if (options_.resolve == VITRAIL_RESOLVE_FRAGMENT && (options_.samples == 1 || needs_.perSample)) {
    result.stencilMark = needs_.stencil ? "on" : "off";
  }
  result.counted = true;
  result.errorBound = vitrailNodeErrorBound(options_.nodes, options_.samples, stats_.layersMax);
  result.layersMean = meanLayers(stats_.fragmentsStored, coveredPixels_);
  if (!target_) return result; // nothing was drawn
  const VitrailMemory memory = target_.memory();
  result.nodesBytes = memory.nodeBytes;
  result.headsBytes = memory.headBytes;
  result.totalBytes = memory.totalBytes;
  return result;
}

void LinkedList::check(VkResult result, const char* call) const {
  if (result == VK_SUCCESS) return;
  const std::string reason = reason_.empty() ? fmt::format("{} failed: {}", call, resultName(result)) : reason_;
  if (result != VK_ERROR_OUT_OF_DEVICE_MEMORY) throw GpuError(reason);
  throw GpuError(reason + (wanted_.memoryBudget ? ": use a larger --memory-budget" : ": use a smaller --size"));
}

} // namespace

std::unique_ptr<Method> makeLinkedList(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<LinkedList>(host, options);
}

} // namespace vitrail::tool
