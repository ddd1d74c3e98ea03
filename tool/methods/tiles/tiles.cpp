// A rasteriser in compute shaders that knows all triangles of a tile before it shades one: exact transparency without
// fragment lists. Tiles of 8 x 8 pixels as in Liu, Huang, Liu and Wu, "FreePipe" (I3D 2010), and Laine and Karras,
// "High-performance software rasterization on GPUs" (HPG 2011), coverage by Pineda, "A parallel algorithm for polygon
// rasterization" (SIGGRAPH 1988). docs/notes/tiles.md has the design.
//
// Each triangle is set up and makes a record in every tile in which it covers a pixel. A pixel keeps the nearest 8 to
// 32 of its fragments in registers, sorted, and shades them from the front; while some are left and still show, it
// takes the next. Tiles with very many records collect their fragments and sort them all.
//
// Cost: nothing is stored per fragment but in such deep tiles, and no fragment that is hidden is shaded. Memory: 52
// bytes for a triangle in a tile, 24 bytes a tile; 16 bytes a fragment in deep tiles. A picture that needs more than
// the last ones had room for is drawn again, in bands of tiles where the device cannot hold all of it. With several
// samples 8 bytes more for each of them and each triangle in a tile. Beside that 32 bytes for a vertex of an instance.
//
// What it gets wrong: nothing. Colours are not rounded before they are blended; what a pixel hardly shows is left out
// (TILES_STOP).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>

#include "../../gpu/accesses.h"
#include "../../gpu/counters.h"
#include "../../gpu/pipeline.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/device_needs.h"
#include "most_light.h"
#include "shaders/tiles_blend.comp.h"
#include "shaders/tiles_blend_32.comp.h"
#include "shaders/tiles_blend_32_constant.comp.h"
#include "shaders/tiles_blend_8.comp.h"
#include "shaders/tiles_blend_8_constant.comp.h"
#include "shaders/tiles_blend_constant.comp.h"
#include "shaders/tiles_blend_msaa.comp.h"
#include "shaders/tiles_blend_msaa_constant.comp.h"
#include "shaders/tiles_corners.comp.h"
#include "shaders/tiles_deep_blend.comp.h"
#include "shaders/tiles_deep_blend_constant.comp.h"
#include "shaders/tiles_deep_blend_msaa.comp.h"
#include "shaders/tiles_deep_blend_msaa_constant.comp.h"
#include "shaders/tiles_deep_collect.comp.h"
#include "shaders/tiles_deep_fill.comp.h"
#include "shaders/tiles_deep_fill_msaa.comp.h"
#include "shaders/tiles_deep_merge.comp.h"
#include "shaders/tiles_deep_place.comp.h"
#include "shaders/tiles_deep_sort.comp.h"
#include "shaders/tiles_large.comp.h"
#include "shaders/tiles_large_clipped.comp.h"
#include "shaders/tiles_mean.comp.h"
#include "shaders/tiles_plan.comp.h"
#include "shaders/tiles_scatter.comp.h"
#include "shaders/tiles_setup.comp.h"
#include "shaders/tiles_setup_clipped.comp.h"
#include "tiles_geometry.h"
#include "tiles_memory.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kSide = 8; // of a tile
constexpr Access kIndirectRead{VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT};

// Records of a tile that is not deep from the start, and how often it goes through 64 of them before it is. A CPU
// driver ends loops that it takes for endless.
constexpr std::uint32_t kMostWalked = 16384;
constexpr std::uint32_t kMostWalkedOnCpu = 2500;
constexpr std::uint32_t kMostVisits = 8192;
constexpr std::uint32_t kMostVisitsOnCpu = 1024;

std::uint32_t tilesOf(std::uint32_t pixels) { return (pixels + kSide - 1) / kSide; }

SingleSet makeSet(Gpu& gpu) {
  requireDevice(gpu, "tiles");
  std::vector<std::pair<VkDescriptorType, VkShaderStageFlags>> bindings(
      20, {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT});
  bindings[0].first = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  bindings[9].first = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  bindings[10].first = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  bindings[18].first = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  return {gpu, bindings, "tiles"};
}

class Tiles final : public Method {
 public:
  Tiles(const MethodHost& host, std::uint32_t samples);

  ImageNeeds needs() const override { return {.depthUsage = VK_IMAGE_USAGE_SAMPLED_BIT}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override;
  FrameStats stats() const override;

 private:
  struct Band {
    std::uint32_t top = 0; // rows of pixels
    std::uint32_t bottom = 0;
  };

  // What deep tiles are drawn with.
  struct DeepPipelines {
    Unique<VkPipeline> count;
    Unique<VkPipeline> place;
    Unique<VkPipeline> fill;
    Unique<VkPipeline> sort;
    Unique<VkPipeline> merge;
    Unique<VkPipeline> blend;
  };

  std::uint32_t shuffles() const { return gpu_.features().wideSubgroups ? VK_TRUE : VK_FALSE; } // batch.glsl
  std::uint32_t corners() const { return geometry_.cornerGroups() > 0 ? VK_TRUE : VK_FALSE; }   // geometry.glsl
  void makePipelines();
  std::span<const std::uint32_t> blendCode(std::uint32_t tileClass) const;
  std::span<const std::uint32_t> deepBlendCode() const;
  void planDeep();
  Unique<VkPipeline> makePipeline(std::span<const std::uint32_t> code, const char* name,
                                  const PipelineConstants& constants = {}) const;
  PipelineConstants shadingConstants() const;
  shaders::TilesFrame frameOf(const Band& band) const;
  void drawBand(Frame& frame, const Band& band);
  void drawNothing(Frame& frame);
  void takeMean(VkCommandBuffer commands, const Band& band);
  void clear(VkCommandBuffer commands, const Band& band);
  void rasterise(Frame& frame, const Band& band);
  void blend(Frame& frame);
  void blendDeep(Frame& frame);
  void takeNote();
  void splitBands(double excess);
  void cmdDispatch(VkCommandBuffer commands, const Unique<VkPipeline>& pipeline, std::uint32_t groups) const;
  void cmdPush(VkCommandBuffer commands, const std::array<std::uint32_t, 3>& words) const;
  void cmdIndirect(VkCommandBuffer commands, const Unique<VkPipeline>& pipeline, VkBuffer buffer,
                   std::uint64_t offset) const;
  void cmdDeep(VkCommandBuffer commands, const Unique<VkPipeline>& pipeline, std::uint64_t offset) const {
    cmdIndirect(commands, pipeline, control_.buffer().get(), offset);
  }

  Gpu& gpu_;
  const Surfaces& surfaces_;
  std::uint32_t samples_;
  TilesGeometry geometry_;
  float mostLight_;
  SingleSet set_;
  TilesMemory memory_;
  GpuBuffer frameBuffer_; // shaders::TilesFrame
  GpuBuffer classes_;     // shaders::TilesClasses
  Counters control_;      // shaders::TilesControl
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> corners_;
  Unique<VkPipeline> setup_;
  Unique<VkPipeline> large_;
  Unique<VkPipeline> plan_;
  Unique<VkPipeline> scatter_;
  Unique<VkPipeline> mean_;                                       // of several samples
  std::array<Unique<VkPipeline>, shaders::TILES_CLASSES> blends_; // of each class
  std::optional<DeepPipelines> deep_;
  VkExtent2D extent_{};
  std::uint64_t budget_ = 0;
  std::uint32_t bandTiles_ = 0; // rows of tiles in a band
  TilesNeeds wanted_;           // by the frame that was drawn last
  bool deepPlanned_ = false;    // whether frames have the passes of deep tiles, and how many of some
  std::uint32_t mergePasses_ = 0;
  std::uint32_t slices_ = 1;
  std::uint32_t mostFragments_ = 0; // of a pixel of a deep tile, of that frame
  std::uint32_t cutPixels_ = 0;
};

Tiles::Tiles(const MethodHost& host, std::uint32_t samples)
    : gpu_(host.gpu),
      surfaces_(host.surfaces),
      samples_(samples),
      geometry_(host),
      mostLight_(mostLight(host.scene, host.surfaces.scene())),
      set_(makeSet(gpu_)),
      memory_(gpu_, set_, samples),
      frameBuffer_(gpu_, sizeof(shaders::TilesFrame),
                   VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device,
                   "tiles frame"),
      classes_(
          gpu_, sizeof(shaders::TilesClasses),
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
          MemoryKind::Device, "tiles classes"),
      control_(gpu_, sizeof(shaders::TilesControl), "tiles control", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT) {
  set_.writeBuffer(0, frameBuffer_.get(), frameBuffer_.size());
  set_.writeBuffer(1, control_.buffer().get(), control_.buffer().size());
  set_.writeBuffer(17, classes_.get(), classes_.size());
  layout_ =
      makePipelineLayout(gpu_, {surfaces_.frameLayout(), geometry_.textureLayout(), geometry_.layout(), set_.layout()},
                         {VK_SHADER_STAGE_COMPUTE_BIT, 3 * sizeof(std::uint32_t)}, "tiles");
  if (geometry_.groups() > 0) makePipelines();
  if (samples_ > 1) mean_ = makePipeline(shaders::tiles_mean_comp, "tiles mean", {{6, samples_}});
}

PipelineConstants Tiles::shadingConstants() const {
  return {{0, geometry_.anyFeatures()},
          {1, geometry_.allFeatures()},
          {2, geometry_.textureCount()},
          {6, samples_},
          {7, shuffles()},
          {8, corners()}};
}

std::span<const std::uint32_t> Tiles::blendCode(std::uint32_t tileClass) const {
  if (geometry_.constantTextures()) {
    if (samples_ > 1) return shaders::tiles_blend_msaa_constant_comp;
    if (tileClass == 0) return shaders::tiles_blend_8_constant_comp;
    if (tileClass == 3) return shaders::tiles_blend_32_constant_comp;
    return shaders::tiles_blend_constant_comp;
  }
  if (samples_ > 1) return shaders::tiles_blend_msaa_comp;
  if (tileClass == 0) return shaders::tiles_blend_8_comp;
  if (tileClass == 3) return shaders::tiles_blend_32_comp;
  return shaders::tiles_blend_comp;
}

std::span<const std::uint32_t> Tiles::deepBlendCode() const {
  if (geometry_.constantTextures()) {
    if (samples_ > 1) return shaders::tiles_deep_blend_msaa_constant_comp;
    return shaders::tiles_deep_blend_constant_comp;
  }
  if (samples_ > 1) return shaders::tiles_deep_blend_msaa_comp;
  return shaders::tiles_deep_blend_comp;
}

Unique<VkPipeline> Tiles::makePipeline(std::span<const std::uint32_t> code, const char* name,
                                       const PipelineConstants& constants) const {
  return makeComputePipeline(gpu_, layout_.get(), code, name, constants);
}

void Tiles::makePipelines() {
  using Code = std::span<const std::uint32_t>;
  const bool clipped = surfaces_.list().isClipped();
  const PipelineConstants samples{{0, geometry_.anyFeatures()}, {6, samples_}, {8, corners()}};
  setup_ = makePipeline(clipped ? Code(shaders::tiles_setup_clipped_comp) : Code(shaders::tiles_setup_comp),
                        "tiles setup", samples);
  large_ = makePipeline(clipped ? Code(shaders::tiles_large_clipped_comp) : Code(shaders::tiles_large_comp),
                        "tiles large", samples);
  corners_ = makePipeline(shaders::tiles_corners_comp, "tiles corners");
  plan_ = makePipeline(shaders::tiles_plan_comp, "tiles plan");
  scatter_ = makePipeline(shaders::tiles_scatter_comp, "tiles scatter");
  for (std::uint32_t i = 0; i < shaders::TILES_CLASSES; ++i) {
    PipelineConstants constants = shadingConstants();
    constants.insert(constants.end(), {{3, i < 2 ? VK_TRUE : VK_FALSE}, {5, i}});
    blends_.at(i) = makePipeline(blendCode(i), fmt::format("tiles blend {}", i).c_str(), constants);
  }
}

// From the first picture on that has deep tiles, so that others do without.
void Tiles::planDeep() {
  deepPlanned_ = true;
  if (deep_) return;
  const auto fill = samples_ > 1 ? std::span<const std::uint32_t>(shaders::tiles_deep_fill_msaa_comp)
                                 : std::span<const std::uint32_t>(shaders::tiles_deep_fill_comp);
  deep_.emplace(DeepPipelines{makePipeline(shaders::tiles_deep_collect_comp, "tiles deep count", {{7, shuffles()}}),
                              makePipeline(shaders::tiles_deep_place_comp, "tiles deep place"),
                              makePipeline(fill, "tiles deep fill", {{6, samples_}, {7, shuffles()}}),
                              makePipeline(shaders::tiles_deep_sort_comp, "tiles deep sort"),
                              makePipeline(shaders::tiles_deep_merge_comp, "tiles deep merge"),
                              makePipeline(deepBlendCode(), "tiles deep blend", shadingConstants())});
}

void Tiles::setTarget(const MethodTarget& target) {
  set_.writeImage(9, target.color, VK_IMAGE_LAYOUT_GENERAL);
  set_.writeImage(10, target.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  if (samples_ > 1) set_.writeImage(18, target.opaque, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  const std::uint64_t budget = target.memoryBudget.value_or(std::numeric_limits<std::uint64_t>::max());
  if (bandTiles_ > 0 && budget == budget_) return; // released where the size changes
  releaseTarget();
  budget_ = budget;
  extent_ = target.extent;
  bandTiles_ = tilesOf(extent_.height);
  memory_.setTiles(tilesOf(extent_.width) * bandTiles_, budget);
  // Most models' triangles are each in a tile or two; what pictures need is known after the first.
  const std::uint64_t guess = std::clamp<std::uint64_t>(geometry_.triangles() * 2, 4096, 1U << 20U);
  constexpr TilesNeeds kLeast{.records = 1, .large = 1, .deep = 1, .blocks = 1, .fragments = 1, .chunks = 1};
  TilesNeeds needs = kLeast;
  needs.records = guess;
  needs.large = 256;
  if (memory_.grow(needs) > 0.0 && memory_.grow(kLeast) > 0.0) {
    throw GpuError(fmt::format("a memory budget of {} bytes has no room for the tiles of a picture of {}x{} pixels",
                               budget, extent_.width, extent_.height));
  }
}

void Tiles::releaseTarget() {
  memory_.release();
  bandTiles_ = 0;
}

shaders::TilesFrame Tiles::frameOf(const Band& band) const {
  shaders::TilesFrame data{};
  data.width = extent_.width;
  data.height = extent_.height;
  data.tilesX = tilesOf(extent_.width);
  data.tilesY = tilesOf(band.bottom - band.top);
  data.top = band.top;
  data.bottom = band.bottom;
  data.largeBlocks = (data.tilesX + shaders::TILES_LARGE_BLOCK - 1) / shaders::TILES_LARGE_BLOCK;
  const TilesNeeds& capacity = memory_.capacity();
  data.recordCapacity = static_cast<std::uint32_t>(capacity.records);
  data.largeCapacity = static_cast<std::uint32_t>(capacity.large);
  data.deepCapacity = static_cast<std::uint32_t>(capacity.deep);
  data.blockCapacity = static_cast<std::uint32_t>(capacity.blocks);
  data.fragmentCapacity = static_cast<std::uint32_t>(capacity.fragments);
  data.chunkCapacity = static_cast<std::uint32_t>(capacity.chunks);
  data.pointSize = surfaces_.pointSize();
  data.lightMost = mostLight_;
  const bool onCpu = gpu_.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  data.mostWalked = onCpu ? kMostWalkedOnCpu : kMostWalked;
  data.mostVisits = onCpu ? kMostVisitsOnCpu : kMostVisits;
  const glm::dmat4 toWorld = glm::inverse(glm::dmat4(surfaces_.view().viewProjection));
  for (std::uint32_t i = 0; i < shaders::CLIP_PLANE_COUNT; ++i) {
    data.clipPlanes[i] = glm::vec4(glm::dvec4(surfaces_.view().clipPlanes[i]) * toWorld);
  }
  return data;
}

void Tiles::draw(Frame& frame) {
  wanted_ = {};
  mostFragments_ = cutPixels_ = 0;
  if (geometry_.groups() == 0) return drawNothing(frame);
  const std::uint32_t step = bandTiles_ * kSide;
  for (std::uint32_t top = 0; top < extent_.height; top += step) {
    drawBand(frame, {top, std::min(top + step, extent_.height)});
    const bool last = top + step >= extent_.height;
    if (!last) frame.submitAndWait();
    if (!last) takeNote();
  }
}

void Tiles::cmdDispatch(VkCommandBuffer commands, const Unique<VkPipeline>& pipeline, std::uint32_t groups) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  vkCmdDispatch(commands, std::min(groups, shaders::TILES_ROW), (groups + shaders::TILES_ROW - 1) / shaders::TILES_ROW,
                1);
}

void Tiles::cmdIndirect(VkCommandBuffer commands, const Unique<VkPipeline>& pipeline, VkBuffer buffer,
                        std::uint64_t offset) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  vkCmdDispatchIndirect(commands, buffer, offset);
}

void Tiles::drawNothing(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  frame.images().cmdToComputeResolve(commands);
  const Band whole{0, extent_.height};
  clear(commands, whole);
  frame.endPass("clear");
  if (samples_ > 1) takeMean(commands, whole);
  frame.endPass("blend");
}

// Several samples: the picture where nothing transparent is.
void Tiles::takeMean(VkCommandBuffer commands, const Band& band) {
  const VkDescriptorSet set = set_.set();
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 3, 1, &set, 0, nullptr);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, mean_.get());
  vkCmdDispatch(commands, tilesOf(extent_.width), tilesOf(band.bottom - band.top), 1);
}

// The passes of a band, from its triangles to its pixels.
void Tiles::drawBand(Frame& frame, const Band& band) {
  VkCommandBuffer commands = frame.commands();
  frame.images().cmdToComputeResolve(commands);
  surfaces_.cmdBindView(commands, layout_.get(), VK_PIPELINE_BIND_POINT_COMPUTE);
  const std::array<VkDescriptorSet, 3> sets{geometry_.textures(), geometry_.set(), set_.set()};
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 1, 3, sets.data(), 0, nullptr);
  clear(commands, band);
  frame.endPass("clear");
  if (samples_ > 1) takeMean(commands, band); // the blend writes over it, after barriers of the passes between
  rasterise(frame, band);
  blend(frame);
  if (deepPlanned_) blendDeep(frame);
  control_.cmdRead(commands, kComputeWrite);
}

void Tiles::clear(VkCommandBuffer commands, const Band& band) {
  // The last frame's or band's passes read and wrote them -> they are cleared, set and made.
  cmdMemoryBarrier(commands, {kComputeRead.stages | kIndirectRead.stages, VK_ACCESS_2_NONE},
                   {kClear.stages | kComputeWrite.stages, kClear.accesses | kComputeWrite.accesses});
  if (corners() == VK_TRUE && band.top == 0) cmdDispatch(commands, corners_, geometry_.cornerGroups());
  vkCmdFillBuffer(commands, memory_.tileRecords().get(), 0, VK_WHOLE_SIZE, 0);
  if (deepPlanned_) vkCmdFillBuffer(commands, memory_.deepPixels().get(), 0, VK_WHOLE_SIZE, 0);
  vkCmdFillBuffer(commands, classes_.get(), 0, VK_WHOLE_SIZE, 0);
  const shaders::TilesFrame data = frameOf(band);
  vkCmdUpdateBuffer(commands, frameBuffer_.get(), 0, sizeof(data), &data);
  // The clears, the frame's data and the corners -> all passes.
  cmdMemoryBarrier(commands, {kClear.stages | kComputeWrite.stages, kClear.accesses | kComputeWrite.accesses},
                   {kComputeReadWrite.stages, kComputeReadWrite.accesses | VK_ACCESS_2_UNIFORM_READ_BIT});
  control_.cmdClear(commands, kComputeReadWrite);
}

void Tiles::rasterise(Frame& frame, const Band& band) {
  VkCommandBuffer commands = frame.commands();
  cmdDispatch(commands, setup_, geometry_.groups());
  // Triangles were put aside -> they are taken up; records and counts go on.
  cmdMemoryBarrier(commands, kComputeWrite, kComputeReadWrite);
  const std::uint32_t tilesX = tilesOf(extent_.width);
  const std::uint32_t tilesY = tilesOf(band.bottom - band.top);
  const std::uint32_t blocks = (tilesX + shaders::TILES_LARGE_BLOCK - 1) / shaders::TILES_LARGE_BLOCK;
  // So many that none takes long: a driver ends loops that it takes for endless.
  constexpr std::uint64_t kTurns = 64;
  const auto shares = static_cast<std::uint32_t>(memory_.capacity().large / (shaders::TILES_GROUP * kTurns) + 2);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, large_.get());
  vkCmdDispatch(commands, blocks * shares, tilesY, 1);
  // Tiles counted their records -> they are given room.
  cmdMemoryBarrier(commands, kComputeWrite, kComputeReadWrite);
  frame.endPass("set up");
  cmdDispatch(commands, plan_, (tilesX * tilesY + 255) / 256);
  // Tiles have room -> records go there.
  cmdMemoryBarrier(commands, kComputeWrite, kComputeReadWrite);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, scatter_.get());
  vkCmdDispatch(commands, shaders::TILES_SCATTER, 1, 1);
  // Records and lists of tiles -> they are blended, and the counts say how many.
  cmdMemoryBarrier(
      commands, kComputeWrite,
      {kComputeReadWrite.stages | kIndirectRead.stages, kComputeReadWrite.accesses | kIndirectRead.accesses});
  frame.endPass("bin");
}

void Tiles::blend(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  for (std::uint32_t i = shaders::TILES_CLASSES; i-- > 0;) { // those that take longest first
    cmdIndirect(commands, blends_.at(i), classes_.get(),
                offsetof(shaders::TilesClasses, of) + i * sizeof(shaders::TilesDispatch));
  }
  frame.endPass("blend");
}

// Tiles that the passes before have left over: their fragments are counted, collected, sorted and blended.
void Tiles::blendDeep(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  constexpr Access kNext{kComputeReadWrite.stages | kIndirectRead.stages,
                         kComputeReadWrite.accesses | kIndirectRead.accesses};
  // Tiles were left over -> their records are gone through. And so on from pass to pass.
  cmdMemoryBarrier(commands, kComputeWrite, kNext);
  cmdDeep(commands, deep_->count, offsetof(shaders::TilesControl, blocks));
  cmdMemoryBarrier(commands, kComputeWrite, kNext);
  cmdDeep(commands, deep_->place, offsetof(shaders::TilesControl, deep));
  cmdMemoryBarrier(commands, kComputeWrite, kNext);
  cmdDeep(commands, deep_->fill, offsetof(shaders::TilesControl, blocks));
  cmdMemoryBarrier(commands, kComputeWrite, kNext);
  frame.endPass("collect");
  cmdDeep(commands, deep_->sort, offsetof(shaders::TilesControl, chunks));
  for (std::uint32_t pass = 0; pass < mergePasses_; ++pass) {
    cmdMemoryBarrier(commands, kComputeWrite, kNext);
    cmdPush(commands, {pass, 0, 0});
    cmdDeep(commands, deep_->merge, offsetof(shaders::TilesControl, chunks));
  }
  frame.endPass("sort");
  for (std::uint32_t slice = 0; slice < slices_; ++slice) {
    cmdMemoryBarrier(commands, kComputeWrite, kNext);
    cmdPush(commands, {slice, mergePasses_ % 2, slice + 1 == slices_ ? 1U : 0U});
    cmdDeep(commands, deep_->blend, offsetof(shaders::TilesControl, deep));
  }
  frame.endPass("blend deep");
}

void Tiles::cmdPush(VkCommandBuffer commands, const std::array<std::uint32_t, 3>& words) const {
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(words), words.data());
}

// What the band that was drawn last needed.
void Tiles::takeNote() {
  const auto control = control_.read<shaders::TilesControl>();
  const auto raise = [](std::uint64_t& most, std::uint64_t value) { most = std::max(most, value); };
  const auto together = [](std::uint32_t high, std::uint32_t low) { return std::uint64_t{high} << 32U | low; };
  raise(wanted_.records, together(control.recordsHigh, control.records));
  raise(wanted_.large, control.large);
  raise(wanted_.deep, control.deep.count);
  raise(wanted_.blocks, control.blocks.count);
  raise(wanted_.fragments, together(control.fragmentsHigh, control.fragments));
  raise(wanted_.chunks, control.chunks.count);
  mostFragments_ = std::max(mostFragments_, control.mostFragments);
  cutPixels_ += control.cutPixels;
}

bool Tiles::finish() {
  if (geometry_.groups() == 0) return true;
  takeNote();
  const TilesNeeds& had = memory_.capacity();
  bool fits = wanted_.records <= had.records && wanted_.large <= had.large && wanted_.deep <= had.deep &&
              wanted_.blocks <= had.blocks && wanted_.fragments <= had.fragments && wanted_.chunks <= had.chunks;
  if (wanted_.deep > 0 && !deepPlanned_) {
    fits = false;
    planDeep();
  }
  std::uint32_t passes = 0;
  while (mostFragments_ > std::uint64_t{shaders::TILES_CHUNK} << passes) ++passes;
  const std::uint32_t slices = mostFragments_ / shaders::TILES_SLICE + 1;
  if (passes > mergePasses_ || slices > slices_) fits = false;
  mergePasses_ = std::max(mergePasses_, passes);
  slices_ = std::max(slices_, slices);
  if (fits) return true;
  if (const double excess = memory_.grow(wanted_); excess > 0.0) splitBands(excess);
  return false;
}

// The picture needs more than there may be: it is drawn in bands of fewer tiles.
void Tiles::splitBands(double excess) {
  if (bandTiles_ == 1) {
    throw GpuError(
        fmt::format("the method tiles has no room on {} for the {} triangles in a row of tiles, and for {} "
                    "fragments of deep tiles: use linked-list, a larger --memory-budget or a smaller --size",
                    gpu_.properties().deviceName, wanted_.records, wanted_.fragments));
  }
  const double parts = std::max(2.0, std::ceil(excess * 1.1));
  bandTiles_ = std::max(1U, static_cast<std::uint32_t>(bandTiles_ / parts));
}

FrameStats Tiles::stats() const {
  FrameStats stats;
  stats.resolve = "compute";
  stats.cutPixels = cutPixels_;
  stats.complete = cutPixels_ == 0;
  stats.errorBound = 0.5 + shaders::TILES_STOP + 0.05;
  stats.tiles = bandTiles_ > 0 ? (tilesOf(extent_.height) + bandTiles_ - 1) / bandTiles_ : 1;
  stats.nodesBytes = memory_.bytes(); // what the budget is for
  stats.totalBytes = memory_.bytes() + geometry_.bytes() + frameBuffer_.size() + classes_.size() + control_.bytes();
  return stats;
}

} // namespace

std::unique_ptr<Method> makeTiles(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<Tiles>(host, options.samples);
}

} // namespace vitrail::tool
