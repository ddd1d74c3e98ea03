// Per-pixel linked lists: exact transparency through libvitrail, as any host embeds it. Whether a picture is drawn
// whole or in tiles is list_picture.h's.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include "../../gpu/device.h"
#include "../../gpu/vk.h"
#include "../../stage/picture_images.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/library_context.h"
#include "list_picture.h"
#include "media.h"
#include "plain_resolve.h"
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

constexpr std::uint32_t kDepthFromW = 1; // the constant of collect.frag

VitrailResult resultOf(VkResult result) {
  if (result == VK_SUCCESS) return VITRAIL_SUCCESS;
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) return VITRAIL_ERROR_OUT_OF_MEMORY;
  return VITRAIL_ERROR_INVALID;
}

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
         a.opaque == b.opaque && a.depth == b.depth && a.memoryBudget == b.memoryBudget && a.surfaces == b.surfaces &&
         a.framesInFlight == b.framesInFlight && (a.peel > 0) == (b.peel > 0);
}

class LinkedList final : public Method, private ListPicture {
 public:
  LinkedList(const MethodHost& host, const MethodOptions& options);
  ~LinkedList() override;

  ImageNeeds needs() const override { return needs_; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override { return finishPicture(); }
  FrameStats stats() const override;
  bool drawsInFlight() const override { return inFlight_; }
  std::uint64_t lastPicture() const override { return frame_; }
  FrameStats statsOf(std::uint64_t picture) override;

 private:
  bool makeTarget(const ListPool& pool) override;
  VitrailResult updateTarget() override;
  std::optional<VitrailMemory> memory() const override;
  std::uint64_t mostNodes() const override;
  VitrailTileLimits tileLimits() const override;
  void drawArea(const VitrailRect& area, std::span<const SurfaceRun> runs) override;
  void wait() override { drawn_->submitAndWait(); }
  VitrailStats readStats() const override { return readStats(frame_); }
  VitrailStats readStats(std::uint64_t frame) const;

  void makeContext();
  void chooseResolve();
  void makeSurfaces();
  VitrailVkTargetDesc targetDesc() const;
  void countMemory();
  // Who resolves the lists of the picture that is wanted: the library where it is neither.
  bool isPlain() const { return wanted_.peel > 0 || !options_.sorted; }
  bool isMedia() const { return media_ && !isPlain(); }
  bool hostResolves() const { return isMedia() || isPlain(); }
  void cmdResolve(VkCommandBuffer commands, const VkRect2D& area);
  // Whether the resolve makes the picture out of several samples.
  bool writesEveryPixel() const { return options_.samples > 1 && !needs_.perSample; }
  void drawCollecting(std::span<const SurfaceRun> runs);
  void drawInFlight(const PictureImages& images);
  FrameStats withChoices(FrameStats stats) const;
  void check(VkResult result, const char* call) const {
    if (result == VK_ERROR_DEVICE_LOST) tool::check(result, call);
    ListPicture::check(resultOf(result), call);
  }

  // What pipelines differ in beside the options.
  struct PipelineKind {
    VitrailListBuild listBuild = VITRAIL_LIST_BUILD_DEFAULT;
    VitrailOverflow overflow = VITRAIL_OVERFLOW_SKIP;
    bool media = false;      // isMedia()
    bool plain = false;      // isPlain()
    bool depthFromW = false; // collect.frag
    bool operator==(const PipelineKind&) const = default;
  };

  Gpu& gpu_;
  const Surfaces& source_;
  MethodOptions options_;
  ImageNeeds needs_;
  vulkan::Context context_;
  std::optional<Media> media_;        // where objects absorb light: what resolves the lists then
  std::optional<PlainResolve> plain_; // once isPlain()
  PipelineKind pipelines_;            // of surfaces_
  std::optional<SurfacePipelines> surfaces_;
  std::optional<SurfacePipelines> untested_; // the same without a depth test, where media_ asks for them
  vulkan::Target target_;
  std::uint64_t frame_ = 0; // of the target: rises with every area
  ListPool made_;           // what target_ was made for
  bool inFlight_ = false;
  MethodTarget wanted_;
  Frame* drawn_ = nullptr;    // the frame at hand
  std::uint64_t counted_ = 0; // the target's bytes, as the Gpu counts them
};

LinkedList::LinkedList(const MethodHost& host, const MethodOptions& options)
    : ListPicture(host.surfaces.list(), options_), gpu_(host.gpu), source_(host.surfaces), options_(options) {
  makeContext();
  // With a bound on the layers only the nearest are drawn as they are: then objects are as thick as their files say.
  if (source_.scene().solids().any() && options_.maxLayers == 0) {
    media_.emplace(host, context_.descriptorSetLayout(), options_.samples);
  }
  chooseResolve();
}

LinkedList::~LinkedList() { gpu_.memoryFreed(counted_); }

void LinkedList::makeContext() { check(makeLibraryContext(gpu_, reason(), context_), "vitrailVkCreateContext"); }

void LinkedList::chooseResolve() {
  const GpuFeatures& features = gpu_.features();
  if (media_) { // which resolves by compute, a pixel at a time, whatever was asked for: there is no other way
    requireWalk(options_);
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
  requireMark(options_, drawn);
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
  kind.overflow = desc.overflow;
  kind.media = isMedia();
  kind.plain = isPlain();
  // To spare the fragment shaders of GPUs; Mesa's CPU driver takes longer. Where samples are tested in the resolve,
  // depths are compared with those of the depth image.
  const bool isCpu = gpu_.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  const bool spares = !isCpu || kind.listBuild == VITRAIL_LIST_BUILD_COMPUTE;
  kind.depthFromW = spares && !isMedia() && source_.view().eye.w < 0.5F && (options_.samples == 1 || coverage);
  const bool wantsUntested = isMedia() && media_->objects().anyNear();
  if (surfaces_ && kind == pipelines_ && (untested_ || !wantsUntested)) return;
  if (wanted_.waitForFrames) wanted_.waitForFrames(); // which draw with those that there are
  pipelines_ = kind;
  const VitrailVkSpecialization specialization = context_.collectSpecialization(desc);
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = collectCode(kind.media, coverage, address);
    if (kind.media) info.vertexShader = shaders::surface_object_vert;
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
  desc.resolve = hostResolves() ? VITRAIL_RESOLVE_HOST : options_.resolve;
  desc.userWords = isMedia() ? VK_TRUE : VK_FALSE;
  desc.msaaResolve = options_.msaaResolve;
  desc.postDepthCoverage = options_.samples > 1 && gpu_.features().postDepthCoverage ? VK_TRUE : VK_FALSE;
  desc.maxLayers = options_.maxLayers;
  desc.listBuild = pipelines_.listBuild;
  // Skipped, the picture is drawn again, with a larger pool or in tiles.
  const bool isShown = options_.nodeCapacity > 0 || wanted_.framesInFlight > 1; // and seen meanwhile
  desc.overflow = isShown ? VITRAIL_OVERFLOW_APPROXIMATE : VITRAIL_OVERFLOW_SKIP;
  desc.colorFormat = PictureImages::kColorFormat;
  if (needs_.stencil && !hostResolves()) {
    desc.scope.stencilFormat = PictureImages::depthFormat(true);
    desc.scope.stencilMark = VK_TRUE;
  }
  desc.framesInFlight = wanted_.framesInFlight;
  return desc;
}

void LinkedList::setTarget(const MethodTarget& target) {
  if (media_) media_->setView(source_.view());
  if (wanted_.color != VK_NULL_HANDLE && sameTarget(target, wanted_)) {
    wanted_.peel = target.peel;
    setOnTile(target.onTile);
    return makeSurfaces();
  }
  releaseTarget();
  wanted_ = target;
  if (media_) media_->setTarget(target);
  if (isPlain()) {
    if (!plain_) plain_.emplace(gpu_, context_.descriptorSetLayout(), options_.samples, options_.sorted);
    plain_->setTarget(target);
  }
  makeSurfaces();
  const ListPictureInfo picture{.width = target.extent.width,
                                .height = target.extent.height,
                                .memoryBudget = target.memoryBudget,
                                .surfaces = target.surfaces,
                                .writesEveryPixel = writesEveryPixel(),
                                .words = isMedia(),
                                .listBuild = pipelines_.listBuild,
                                .onTile = target.onTile};
  if (target.framesInFlight == 1) return start(picture);
  constexpr std::uint64_t kShare = 2; // of the device's memory: there are other programs
  inFlight_ = startInFlight(picture, gpu_.localMemory() / kShare);
  reason().clear(); // without room pictures are drawn in another way
}

bool LinkedList::makeTarget(const ListPool& pool) {
  if (target_ && made_ == pool) return true; // the images are the same until releaseTarget()
  target_ = vulkan::Target();                // first: the old pool and the new one need not fit together
  gpu_.memoryFreed(std::exchange(counted_, 0));
  VitrailVkTargetDesc desc = targetDesc();
  desc.nodeCapacity = pool.nodeCapacity;
  desc.memoryBudget = pool.memoryBudget;
  desc.areaPixels = pool.areaPixels;
  if (!hostResolves()) {
    desc.views.count = 1;
    desc.views.color = &wanted_.color;
    if (options_.samples > 1 && !needs_.perSample) desc.views.opaque = &wanted_.opaque;
    if (needs_.depthUsage != 0) desc.views.depth = &wanted_.depth;
  }
  const VkResult result = vulkan::Target::create(context_, desc, target_);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) return false; // the reason stays, in case that it ends the program
  check(result, "vitrailVkCreateTarget");
  reason().clear();
  made_ = pool;
  countMemory();
  return true;
}

VitrailResult LinkedList::updateTarget() {
  const VkResult result = target_.update(frame_ + 1);
  countMemory();
  return resultOf(result);
}

std::optional<VitrailMemory> LinkedList::memory() const {
  return target_ ? std::optional(target_.memory()) : std::nullopt;
}

std::uint64_t LinkedList::mostNodes() const {
  return context_.maxNodeCapacity(options_.nodes, flagOf(options_.samples));
}

VitrailTileLimits LinkedList::tileLimits() const {
  VitrailTileLimits limits{};
  check(context_.tileLimits(options_.nodes, flagOf(options_.samples), limits), "vitrailVkTileLimits");
  return limits;
}

// What the target holds now, a pool that was replaced included.
void LinkedList::countMemory() {
  gpu_.memoryFreed(std::exchange(counted_, target_.memory().totalBytes));
  gpu_.memoryAllocated(counted_);
}

void LinkedList::releaseTarget() {
  if (wanted_.waitForFrames) wanted_.waitForFrames();
  target_ = vulkan::Target();
  inFlight_ = false;
  wanted_ = {};
  gpu_.memoryFreed(std::exchange(counted_, 0));
}

void LinkedList::draw(Frame& frame) {
  drawn_ = &frame;
  inFlight_ ? drawInFlight(frame.images()) : drawPicture();
}

void LinkedList::drawInFlight(const PictureImages& images) {
  if (isEmpty()) return;
  const VitrailResult result = updateTarget();
  if (result != VITRAIL_ERROR_OUT_OF_MEMORY)
    ListPicture::check(result, "updating the target"); // else it stays as it was
  drawArea({0, 0, images.extent().width, images.extent().height}, source_.list().transparentRuns());
}

void LinkedList::drawCollecting(std::span<const SurfaceRun> runs) {
  Frame& frame = *drawn_;
  if (!isMedia() || !media_->objects().anyNear()) return frame.drawSurfaces(*surfaces_, target_.descriptorSet(), runs);
  frame.drawSurfaces(*surfaces_, target_.descriptorSet(), media_->objects().part(runs, false));
  frame.drawSurfaces(*untested_, target_.descriptorSet(), media_->objects().part(runs, true));
}

void LinkedList::drawArea(const VitrailRect& part, std::span<const SurfaceRun> runs) {
  Frame& frame = *drawn_;
  const VkRect2D area{{static_cast<std::int32_t>(part.x), static_cast<std::int32_t>(part.y)},
                      {part.width, part.height}};
  VkCommandBuffer commands = frame.commands();
  PictureImages& images = frame.images();
  target_.begin(commands, {nullptr, ++frame_, area});
  frame.endStep("clear");
  cmdBeginScope(commands, images.transparentScope(area));
  drawCollecting(runs);
  vkCmdEndRendering(commands);
  if (pipelines_.listBuild == VITRAIL_LIST_BUILD_COMPUTE) frame.endStep("collect");
  target_.collected(commands);
  frame.endStep(pipelines_.listBuild == VITRAIL_LIST_BUILD_COMPUTE ? "build lists" : "collect");
  cmdResolve(commands, area);
  frame.endStep("resolve");
  target_.end(commands);
  frame.endPass("statistics");
}

void LinkedList::cmdResolve(VkCommandBuffer commands, const VkRect2D& area) {
  PictureImages& images = drawn_->images();
  if (options_.resolve == VITRAIL_RESOLVE_FRAGMENT && !hostResolves()) {
    cmdBeginScope(commands, images.resolveScope(commands, area));
    target_.resolve(commands);
    vkCmdEndRendering(commands);
    return;
  }
  images.cmdToComputeResolve(commands);
  target_.resolve(commands);
  if (isMedia()) media_->cmdResolve(commands, target_.descriptorSet(), area.extent);
  if (isPlain()) {
    plain_->cmdResolve(commands, target_.descriptorSet(), area.extent, wanted_.peel, wanted_.framesInFlight > 1);
  }
}

VitrailStats LinkedList::readStats(std::uint64_t frame) const {
  VitrailStats stats{};
  check(target_.readStats(frame, stats), "vitrailVkReadStats");
  return stats;
}

FrameStats LinkedList::stats() const { return withChoices(totals()); }

FrameStats LinkedList::statsOf(std::uint64_t picture) {
  if (isEmpty()) {
    FrameStats nothing = totals();
    nothing.complete = true;
    return withChoices(nothing);
  }
  return withChoices(totalsOf(readStats(picture)));
}

FrameStats LinkedList::withChoices(FrameStats result) const {
  result.resolve = nameOf(isPlain() ? VITRAIL_RESOLVE_COMPUTE : options_.resolve);
  result.complete = result.complete && options_.sorted;
  result.listBuild = nameOf(pipelines_.listBuild);
  const bool isDrawn = options_.resolve == VITRAIL_RESOLVE_FRAGMENT && !hostResolves();
  if (isDrawn && (options_.samples == 1 || needs_.perSample)) {
    result.stencilMark = needs_.stencil ? "on" : "off";
  }
  return result;
}

} // namespace

std::unique_ptr<Method> makeLinkedList(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<LinkedList>(host, options);
}

} // namespace vitrail::tool
