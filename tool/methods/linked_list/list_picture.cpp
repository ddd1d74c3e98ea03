#include "list_picture.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "../../gpu/gpu_error.h"
#include "../../stage/tile_runs.h"
#include "../shared/library_log.h"

namespace vitrail::tool {

namespace {

// The first guess: most models that are looked at have fewer fragments than this a pixel
// of the whole picture.
constexpr std::uint64_t kNodesPerPixel = 4;
constexpr std::uint64_t kLargestGuess = std::uint64_t{1} << 24U;

} // namespace

void requireWalk(const MethodOptions& options) {
  if (options.nodeCapacity == 0 && options.stencilMark == StencilMark::On) return;
  throw GpuError(
      "objects of this scene absorb light, which is resolved by walking complete lists: leave --overflow "
      "and --stencil-mark out");
}

void requireMark(const MethodOptions& options, bool drawn) {
  if (drawn || options.stencilMark == StencilMark::On) return;
  throw GpuError(
      "--stencil-mark off is of resolves that are drawn, which is not this device's choice: use --resolve "
      "fragment");
}

void ListPicture::start(const ListPictureInfo& info) {
  info_ = info;
  plan_ = TilePlan();
  nothing_ = !info.surfaces && !info.writesEveryPixel;
  if (nothing_) return; // what a target would take, its kernels too, is spared
  expected_ = 0;
  budget_ = info.memoryBudget.value_or(std::numeric_limits<std::uint64_t>::max());
  const bool buildsAll =
      info.listBuild == VITRAIL_LIST_BUILD_FRAGMENT || pixels() <= VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS;
  const std::uint64_t guess = std::min({kNodesPerPixel * pixels(), kLargestGuess, mostNodes()});
  if (options_.nodeCapacity > 0) return makeFixedTarget(buildsAll);
  inTiles_ = !buildsAll || !makeWholeTarget(info.surfaces ? guess : 0); // drawTiles() knows how large tiles are
}

bool ListPicture::startInFlight(const ListPictureInfo& info, std::uint64_t most) {
  info_ = info;
  plan_ = TilePlan();
  stats_ = {};
  nothing_ = !info.surfaces && !info.writesEveryPixel;
  if (nothing_) return true;
  if (info.listBuild == VITRAIL_LIST_BUILD_COMPUTE && pixels() > VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS) return false;
  ListPool pool;
  if (options_.nodeCapacity > 0) {
    pool.nodeCapacity = options_.nodeCapacity;
    return makeTarget(pool);
  }
  pool.memoryBudget = info.memoryBudget.value_or(most);
  const std::uint64_t guess = std::min({kNodesPerPixel * pixels(), kLargestGuess, mostNodes()});
  pool.nodeCapacity = static_cast<std::uint32_t>(std::max<std::uint64_t>(info.surfaces ? guess : 0, 1));
  return makeTarget(pool);
}

FrameStats ListPicture::totalsOf(const VitrailStats& stats) {
  stats_ = {};
  stats_.tiles = 0;
  stats_.complete = true;
  coveredPixels_ = 0;
  add(stats);
  FrameStats result = totals();
  result.nodeCapacity = stats.nodeCapacity;
  return result;
}

// A target that is neither enlarged nor drawn in tiles.
void ListPicture::makeFixedTarget(bool buildsAll) {
  if (!buildsAll) {
    throw GpuError(
        "--list-build compute draws so large a picture in tiles, and --overflow approximate draws it whole: "
        "use --list-build fragment, or a smaller --size");
  }
  inTiles_ = false;
  if (!makeWholeTarget(options_.nodeCapacity)) check(VITRAIL_ERROR_OUT_OF_MEMORY, "the target");
}

// A target for the whole picture, whose pool begins with so many nodes; with a budget it follows what pictures need.
// False where there is no memory for it.
bool ListPicture::makeWholeTarget(std::uint64_t nodeCapacity) {
  ListPool pool;
  pool.nodeCapacity = static_cast<std::uint32_t>(std::max<std::uint64_t>(nodeCapacity, 1)); // 0: the library's guess
  pool.memoryBudget = info_.memoryBudget.value_or(0);
  return makeTarget(pool);
}

void ListPicture::drawPicture() {
  stats_ = {};
  stats_.tiles = 0;
  stats_.complete = true;
  coveredPixels_ = 0;
  if (nothing_) stats_.tiles = 1;
  wasInTiles_ = inTiles_ || nothing_; // what there was to count has been counted
  if (nothing_) return;
  if (inTiles_) return drawTiles();
  if (info_.memoryBudget) check(updateTarget(), "updating the target"); // frees the pool that grow() replaced
  drawArea({0, 0, info_.width, info_.height}, surfaces_.transparentRuns());
}

// Every tile is waited for: what it reports decides whether its parts come next.
void ListPicture::drawTiles() {
  wait(); // for the opaque scene
  planTiles();
  const TileRuns runs(surfaces_, info_.width, info_.height);
  VitrailRect tile{};
  while (plan_ && plan_.next(tile)) {
    drawArea(tile, runs.touching(tile));
    wait();
    const VitrailStats stats = readStats();
    check(plan_.finish(stats), "vitrailFinishTile");
    if (stats.fragmentsMissing == 0) { // else its parts come next
      add(stats);
      stats_.drawnTiles.push_back({tile.x, tile.y, tile.width, tile.height, stats.fragmentsRequested});
    }
    expected_ = stats_.fragmentsRequested;
    if (info_.onTile) info_.onTile(stats_.tiles);
  }
}

// What words take at most of so many bytes of nodes with words: plans of tiles know nodes alone.
std::uint64_t ListPicture::wordsOf(std::uint64_t bytes) const {
  constexpr std::uint64_t kNodes = 1024;
  const std::uint64_t word = kNodes * sizeof(std::uint32_t);
  return bytes / (vitrailNodePoolSize(options_.nodes, kNodes) + word) * word;
}

void ListPicture::planTiles() {
  plan_ = TilePlan();
  const std::vector<VitrailBounds> bounds = clipBoxesOf(surfaces_);
  const bool everyPixel =
      info_.writesEveryPixel || std::ranges::any_of(surfaces_.scene().transparentDraws(), drawsPoints);
  if (bounds.empty() && !everyPixel) return; // nothing to draw
  VitrailTilePlanDesc desc{};
  desc.width = info_.width;
  desc.height = info_.height;
  desc.samples = options_.samples;
  desc.nodeFormat = options_.nodes;
  desc.limits = tileLimits();
  desc.log = rememberError;
  desc.logUser = &reason_;
  desc.boundsCount = everyPixel ? 0 : static_cast<std::uint32_t>(bounds.size());
  desc.bounds = bounds.data();
  desc.expectedFragments = expected_;
  // The device may have less memory left than it says that it can give: then less is tried.
  for (;;) {
    desc.memoryBudget = info_.words ? budget_ - wordsOf(budget_) : budget_;
    check(TilePlan::create(desc, plan_), "vitrailCreateTilePlan");
    ListPool pool;
    pool.nodeCapacity = plan_.nodeCapacity();
    pool.areaPixels = plan_.areaPixels();
    if (makeTarget(pool)) return;
    budget_ = vitrailNodePoolSize(options_.nodes, pool.nodeCapacity) / 2;
  }
}

bool ListPicture::finishPicture() {
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
bool ListPicture::grow(std::uint64_t fragments) {
  if (!info_.memoryBudget) return fragments <= mostNodes() && makeWholeTarget(fragments);
  const VitrailResult result = updateTarget();
  if (result != VITRAIL_ERROR_OUT_OF_MEMORY) check(result, "updating the target");
  const std::optional<VitrailMemory> held = memory();
  return held && held->nodeCapacity >= fragments;
}

void ListPicture::add(const VitrailStats& stats) {
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

FrameStats ListPicture::totals() const {
  FrameStats result = stats_;
  result.nodes = nameOf(options_.nodes);
  result.counted = true;
  result.errorBound = vitrailNodeErrorBound(options_.nodes, options_.samples, stats_.layersMax);
  result.layersMean = meanLayers(stats_.fragmentsStored, coveredPixels_);
  if (const std::optional<VitrailMemory> held = memory()) { // else nothing was drawn
    result.nodesBytes = held->nodeBytes;
    result.headsBytes = held->headBytes;
    result.totalBytes = held->totalBytes;
  }
  return result;
}

void ListPicture::check(VitrailResult result, const char* call) const {
  if (result == VITRAIL_SUCCESS) return;
  const std::string reason =
      reason_.empty() ? fmt::format("{} failed: result {}", call, static_cast<int>(result)) : reason_;
  if (result != VITRAIL_ERROR_OUT_OF_MEMORY) throw GpuError(reason);
  throw GpuError(reason + (info_.memoryBudget ? ": use a larger --memory-budget" : ": use a smaller --size"));
}

} // namespace vitrail::tool
