// The library's rasteriser in compute shaders (vitrail/vulkan_raster.h), which knows all triangles of a tile before it
// shades one: exact transparency without fragment lists. Tiles of 8 x 8 pixels as in Liu, Huang, Liu and Wu, "FreePipe"
// (I3D 2010), and Laine and Karras, "High-performance software rasterization on GPUs" (HPG 2011), coverage by Pineda,
// "A parallel algorithm for polygon rasterization" (SIGGRAPH 1988). docs/notes/tiles.md has the design.
//
// Each triangle is set up and makes a record in every tile in which it covers a pixel. A pixel keeps the nearest 8 to
// 32 of its fragments in registers, sorted, and shades them from the front; while some are left and still show, it
// takes the next. Tiles with very many records collect their fragments and sort them all.
//
// Cost: nothing is stored per fragment but in such deep tiles, and no fragment that is hidden is shaded. Memory: 37
// to 85 bytes for a triangle in a tile, 152 bytes a tile; 16 bytes a fragment in deep tiles. A picture that needs more
// than the last ones had room for is drawn again, in bands of tiles where the device cannot hold all of it. With
// several samples 8 bytes more for each of them and each triangle in a tile. Beside that 32 bytes for a vertex of an
// instance.
//
// What it gets wrong: nothing. Colours are not rounded before they are blended; what a pixel hardly shows is left out
// (VitrailVkRasterStats::errorBound).
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>

#include "../../gpu/vk.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/device_needs.h"
#include "../shared/library_context.h"
#include "most_light.h"
#include "shaders/tiles_blend.h"
#include "shaders/tiles_blend_constant.h"
#include "shaders/tiles_blend_several.h"
#include "shaders/tiles_blend_several_constant.h"
#include "shaders/tiles_deep.h"
#include "shaders/tiles_deep_constant.h"
#include "shaders/tiles_deep_several.h"
#include "shaders/tiles_deep_several_constant.h"
#include "shaders/tiles_large.h"
#include "shaders/tiles_large_clipped.h"
#include "shaders/tiles_large_several.h"
#include "shaders/tiles_large_several_clipped.h"
#include "shaders/tiles_positions.h"
#include "shaders/tiles_set_up.h"
#include "shaders/tiles_set_up_clipped.h"
#include "shaders/tiles_set_up_several.h"
#include "shaders/tiles_set_up_several_clipped.h"
#include "tiles_geometry.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kOwnSet = 3; // VITRAIL_SET of tiles.glsl

Gpu& checked(Gpu& gpu) {
  requireDevice(gpu, "tiles");
  return gpu;
}

// The constants of surface_of_draws.glsl.
class SurfaceConstants {
 public:
  explicit SurfaceConstants(const TilesGeometry& geometry)
      // Where there is no draw, every feature is one that all have: those kernels would be others.
      : data_{geometry.anyFeatures(), geometry.anyFeatures() & geometry.allFeatures(), geometry.textureCount()} {
    for (std::uint32_t i = 0; i < data_.size(); ++i) {
      entries_.at(i) = {i, static_cast<std::uint32_t>(i * sizeof(std::uint32_t)), sizeof(std::uint32_t)};
    }
    info_ = {static_cast<std::uint32_t>(entries_.size()), entries_.data(), sizeof(data_), data_.data()};
  }
  SurfaceConstants(const SurfaceConstants&) = delete;
  SurfaceConstants& operator=(const SurfaceConstants&) = delete;

  VitrailVkRasterStage stage(std::span<const std::uint32_t> code) const {
    return {code.data(), code.size_bytes(), &info_};
  }

 private:
  std::array<std::uint32_t, 3> data_;
  std::array<VkSpecializationMapEntry, 3> entries_{};
  VkSpecializationInfo info_{};
};

// A stage as permutations.cmake compiles it: of one sample or several, with its other choice or without.
struct StageCode {
  std::span<const std::uint32_t> one;
  std::span<const std::uint32_t> several;
  std::span<const std::uint32_t> oneWith;
  std::span<const std::uint32_t> severalWith;

  std::span<const std::uint32_t> of(std::uint32_t samples, bool with) const {
    if (samples > 1) return with ? severalWith : several;
    return with ? oneWith : one;
  }
};

class Tiles final : public Method {
 public:
  Tiles(const MethodHost& host, std::uint32_t samples);
  ~Tiles() override { gpu_.memoryFreed(counted_); }

  ImageNeeds needs() const override { return {.depthUsage = VK_IMAGE_USAGE_SAMPLED_BIT}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override;
  FrameStats stats() const override { return statsFor(stats_); }
  bool drawsInFlight() const override { return target_.framesInFlight > 1; }
  std::uint64_t lastPicture() const override { return frame_; }
  FrameStats statsOf(std::uint64_t picture) override;

 private:
  void check(VkResult result, const char* call) const;
  void makeRaster();
  void setExtent(VkExtent2D extent);
  std::uint32_t blendModes() const;
  void countMemory();
  void follow();
  FrameStats statsFor(const VitrailVkRasterStats& stats) const;

  Gpu& gpu_;
  const Surfaces& surfaces_;
  std::uint32_t samples_;
  TilesGeometry geometry_;
  float mostLight_;
  std::string reason_; // of the library's last error
  vulkan::Context context_;
  vulkan::Raster raster_;
  MethodTarget target_;
  VkExtent2D extent_{}; // of the raster
  std::uint64_t budget_ = 0;
  std::uint64_t frame_ = 0;  // of the raster
  bool drawnBefore_ = false; // by the raster: its tables of draws are made
  VitrailVkRasterStats stats_{};
  std::uint64_t counted_ = 0; // the raster's bytes, as the Gpu counts them
};

Tiles::Tiles(const MethodHost& host, std::uint32_t samples)
    : gpu_(checked(host.gpu)),
      surfaces_(host.surfaces),
      samples_(samples),
      geometry_(host),
      mostLight_(mostLight(host.scene, host.surfaces.scene())) {
  check(makeLibraryContext(gpu_, reason_, context_), "vitrailVkCreateContext");
}

void Tiles::check(VkResult result, const char* call) const {
  if (result == VK_SUCCESS) return;
  if (result == VK_ERROR_DEVICE_LOST || reason_.empty()) tool::check(result, call);
  throw GpuError(reason_);
}

// Of tiles.glsl's surfaces.
std::uint32_t Tiles::blendModes() const {
  std::uint32_t modes = 1U << VITRAIL_BLEND_OVER;
  if ((geometry_.anyFeatures() & shaders::FEATURE_ADDITIVE) != 0) modes |= 1U << VITRAIL_BLEND_ADDITIVE;
  if ((geometry_.anyFeatures() & shaders::FEATURE_TRANSMISSION) != 0) {
    modes |= 1U << VITRAIL_BLEND_PREMULTIPLIED | 1U << VITRAIL_BLEND_MULTIPLY;
  }
  return modes;
}

void Tiles::makeRaster() {
  const std::array<VkDescriptorSetLayout, kOwnSet> layouts{surfaces_.frameLayout(), geometry_.textureLayout(),
                                                           geometry_.layout()};
  const bool clipped = surfaces_.list().isClipped();
  const SurfaceConstants constants(geometry_);
  VitrailVkRasterDesc desc{};
  desc.extent = extent_ = target_.extent;
  desc.samples = static_cast<VkSampleCountFlagBits>(samples_);
  desc.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  desc.setLayoutCount = static_cast<std::uint32_t>(layouts.size());
  desc.setLayouts = layouts.data();
  if (geometry_.keepsPositions()) desc.positions = constants.stage(shaders::tiles_positions);
  const StageCode setUp{shaders::tiles_set_up, shaders::tiles_set_up_several, shaders::tiles_set_up_clipped,
                        shaders::tiles_set_up_several_clipped};
  const StageCode large{shaders::tiles_large, shaders::tiles_large_several, shaders::tiles_large_clipped,
                        shaders::tiles_large_several_clipped};
  const StageCode blend{shaders::tiles_blend, shaders::tiles_blend_several, shaders::tiles_blend_constant,
                        shaders::tiles_blend_several_constant};
  const StageCode deep{shaders::tiles_deep, shaders::tiles_deep_several, shaders::tiles_deep_constant,
                       shaders::tiles_deep_several_constant};
  desc.setUp = constants.stage(setUp.of(samples_, clipped));
  desc.setUpLarge = constants.stage(large.of(samples_, clipped));
  desc.blend = constants.stage(blend.of(samples_, geometry_.constantTextures()));
  desc.blendDeep = constants.stage(deep.of(samples_, geometry_.constantTextures()));
  desc.indexType = VK_INDEX_TYPE_UINT32;
  desc.blendModes = blendModes();
  desc.solids = (geometry_.anyFeatures() & shaders::FEATURE_SOLID) != 0 ? VK_TRUE : VK_FALSE;
  desc.memoryBudget = budget_;
  desc.hints = geometry_.hints();
  desc.framesInFlight = surfaces_.framesInFlight();
  desc.debugName = "tiles";
  const VkResult result = vulkan::Raster::create(context_, desc, raster_);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) {
    throw GpuError(fmt::format("a memory budget of {} bytes has no room for the tiles of a picture of {}x{} pixels",
                               budget_, target_.extent.width, target_.extent.height));
  }
  check(result, "vitrailVkCreateRaster");
  drawnBefore_ = false;
  countMemory();
}

void Tiles::countMemory() {
  gpu_.memoryFreed(counted_);
  counted_ = raster_.memory().totalBytes;
  gpu_.memoryAllocated(counted_);
}

void Tiles::setTarget(const MethodTarget& target) {
  target_ = target;
  std::uint64_t budget = target.memoryBudget.value_or(std::numeric_limits<std::uint64_t>::max());
  constexpr std::uint64_t kShare = 2; // of the device's memory: there are other programs
  if (surfaces_.framesInFlight() > 1) budget = std::min(budget, gpu_.localMemory() / kShare);
  if (raster_ && budget == budget_) return;
  budget_ = budget;
  makeRaster();
}

// A picture may be a part of the target.
void Tiles::setExtent(VkExtent2D extent) {
  if (extent.width == extent_.width && extent.height == extent_.height) return;
  extent_ = extent;
  check(raster_.resize(extent), "vitrailVkResizeRaster");
  countMemory();
}

void Tiles::releaseTarget() { target_ = {}; }

// Makes the room that the pictures before have needed.
void Tiles::follow() {
  const VkResult result = raster_.update(frame_ + 1);
  countMemory();
  if (result == VK_SUCCESS) return;
  if (result != VK_ERROR_OUT_OF_DEVICE_MEMORY) check(result, "vitrailVkUpdateRaster");
  if (drawsInFlight()) return; // the picture's report says that it is not whole
  throw GpuError(
      fmt::format("the method tiles has no room on {} for the {} triangles in a row of tiles, and for {} "
                  "fragments of deep tiles: use linked-list, a larger --memory-budget or a smaller --size",
                  gpu_.properties().deviceName, stats_.records, stats_.deepFragments));
}

void Tiles::draw(Frame& frame) {
  setExtent(frame.images().extent());
  if (drawsInFlight()) follow();
  VkCommandBuffer commands = frame.commands();
  const std::array<VkDescriptorSet, kOwnSet> sets{surfaces_.viewSet(), geometry_.textures(), geometry_.set()};
  const std::uint32_t noDraw = 0; // the offset of its material
  const glm::dmat4 toWorld = glm::inverse(glm::dmat4(surfaces_.view().viewProjection));
  float planes[shaders::CLIP_PLANE_COUNT][4];
  for (std::uint32_t i = 0; i < shaders::CLIP_PLANE_COUNT; ++i) {
    const glm::vec4 plane(glm::dvec4(surfaces_.view().clipPlanes[i]) * toWorld);
    for (int k = 0; k < 4; ++k) planes[i][k] = plane[k];
  }
  VitrailVkRasterInfo info{};
  info.frame = ++frame_;
  info.sets = sets.data();
  info.dynamicOffsetCount = 1;
  info.dynamicOffsets = &noDraw;
  info.draws = geometry_.draws().get();
  info.drawCount = geometry_.drawCount();
  info.sameDraws = drawnBefore_ ? VK_TRUE : VK_FALSE;
  info.indices = surfaces_.scene().indices().get();
  info.orders = geometry_.orders().get();
  info.mostLight = mostLight_;
  info.pointSize = surfaces_.pointSize();
  if (surfaces_.list().isClipped()) {
    info.clipPlaneCount = shaders::CLIP_PLANE_COUNT;
    info.clipPlanes = planes;
  }
  info.color = target_.color;
  info.depth = target_.depth;
  info.opaque = target_.opaque;
  info.onPass = [](const char* pass, VkCommandBuffer, void* user) {
    const std::string name = pass;
    Frame& drawn = *static_cast<Frame*>(user);
    if (name.starts_with("blend")) {
      drawn.endPass(name);
    } else {
      drawn.endStep(name); // one that blends is sure to come
    }
  };
  info.user = &frame;
  const std::uint32_t bands = raster_.bands();
  drawnBefore_ = true;
  if (drawsInFlight()) { // in one submission, which has time stamps for a few bands
    constexpr std::uint32_t kTimedBands = 4;
    if (bands > kTimedBands) info.onPass = nullptr;
    frame.images().cmdToComputeResolve(commands);
    raster_.draw(commands, info);
    if (bands > kTimedBands) frame.endPass("tiles");
    return;
  }
  // A submission for each band: none takes long, and the Timers have room for its passes.
  info.bandCount = 1;
  for (info.firstBand = 0; info.firstBand < bands; ++info.firstBand) {
    if (info.firstBand > 0) {
      frame.submitAndWait();
      commands = frame.commands();
    }
    frame.images().cmdToComputeResolve(commands);
    raster_.draw(commands, info);
  }
}

bool Tiles::finish() {
  check(raster_.readStats(frame_, stats_), "vitrailVkReadRasterStats");
  if (stats_.misused == VK_TRUE) throw GpuError(reason_); // more room would not mend it
  if (stats_.exact == VK_TRUE || stats_.cutPixels > 0) return true;
  follow();
  return false;
}

FrameStats Tiles::statsOf(std::uint64_t picture) {
  VitrailVkRasterStats stats{};
  check(raster_.readStats(picture, stats), "vitrailVkReadRasterStats");
  return statsFor(stats);
}

FrameStats Tiles::statsFor(const VitrailVkRasterStats& drawn) const {
  const VitrailVkRasterMemory memory = raster_.memory();
  FrameStats stats;
  stats.resolve = "compute";
  stats.cutPixels = drawn.cutPixels;
  stats.complete = drawn.exact == VK_TRUE;
  stats.errorBound = 0.5 + drawn.errorBound + 0.05;
  stats.tiles = std::max(drawn.bands, 1U);
  if (drawn.bands == 1) stats.raster = RasterCounts{geometry_.hints().triangles, drawn.vertices, drawn.records};
  stats.nodesBytes = memory.tileBytes; // what the budget is for
  stats.totalBytes = memory.totalBytes + geometry_.bytes();
  return stats;
}

} // namespace

std::unique_ptr<Method> makeTiles(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<Tiles>(host, options.samples);
}

} // namespace vitrail::tool
