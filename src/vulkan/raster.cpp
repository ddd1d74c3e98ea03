// Creation, resizing and destruction of a raster, how it follows what frames need, and what it tells.
#include "raster.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <new>
#include <optional>

#include "check.h"
#include "core/spirv_constant.h"
#include "core/structures.h"
#include "core/target_common.h"

vitrail::RasterBounds VitrailVkRaster_T::bounds(std::uint32_t rows) const {
  return {.reach = reach(), .budget = budget, .tiles = tilesX() * rows, .samples = samples, .counted = counted};
}

namespace vitrail {

namespace {

// Hosts and shaders mean the same.
static_assert(sizeof(VitrailVkRasterDraw) == sizeof(raster::VitrailRasterDraw));
static_assert(offsetof(VitrailVkRasterDraw, count) == offsetof(raster::VitrailRasterDraw, count));
static_assert(offsetof(VitrailVkRasterDraw, vertexOffset) == offsetof(raster::VitrailRasterDraw, vertexOffset));
static_assert(offsetof(VitrailVkRasterDraw, vertexCount) == offsetof(raster::VitrailRasterDraw, vertices));
static_assert(offsetof(VitrailVkRasterDraw, flags) == offsetof(raster::VitrailRasterDraw, flags));
static_assert(offsetof(VitrailVkRasterDraw, word) == offsetof(raster::VitrailRasterDraw, word));
static_assert(VITRAIL_VK_RASTER_LINES == raster::VITRAIL_RASTER_LINES);
static_assert(VITRAIL_VK_RASTER_POINTS == raster::VITRAIL_RASTER_POINTS);
static_assert(VITRAIL_VK_RASTER_FRONT_CLOCKWISE == raster::VITRAIL_RASTER_FRONT_CLOCKWISE);
static_assert(VITRAIL_VK_RASTER_CULL_FRONT == raster::VITRAIL_RASTER_CULL_FRONT);
static_assert(VITRAIL_VK_RASTER_CULL_BACK == raster::VITRAIL_RASTER_CULL_BACK);

constexpr std::uint32_t kAllBlends = 15;   // 1 << VitrailBlend each
constexpr std::uint32_t kMostSide = 16384; // pixels: coordinates within the guard band

constexpr Log kQuiet; // of what is tried

constexpr RasterNeeds kLeast{.records = 1, .large = 1, .deep = 1, .blocks = 1, .fragments = 1, .chunks = 1};

// ---- Checks

// What a stage was compiled for; none: by something else than vitrail/raster.glsl.
std::optional<RasterCompiled> compiledOf(const VitrailVkRasterStage& stage) {
  const std::optional<std::uint32_t> word =
      spirvConstant({stage.code, stage.size / sizeof(std::uint32_t)}, raster::VITRAIL_RASTER_COMPILED_ID);
  if (!word) return std::nullopt;
  const auto bits = [&](std::uint32_t first, std::uint32_t count) { return *word >> first & ((1U << count) - 1U); };
  return RasterCompiled{.stage = bits(raster::VITRAIL_RASTER_COMPILED_STAGE, 3),
                        .set = bits(raster::VITRAIL_RASTER_COMPILED_SET, 4),
                        .planes = bits(raster::VITRAIL_RASTER_COMPILED_PLANES, 4),
                        .fragments = bits(raster::VITRAIL_RASTER_COMPILED_FRAGMENTS, 2),
                        .several = bits(raster::VITRAIL_RASTER_COMPILED_SAMPLES, 1) != 0};
}

VkResult checkStage(const Log& log, const VitrailVkRasterStage& stage, const char* name) {
  if (stage.code == nullptr || stage.size < 20 || stage.size % 4 != 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "VitrailVkRasterDesc::%s: no SPIR-V (%s)", name,
                    stage.code == nullptr ? "code is null" : "its size is none");
  }
  const VkSpecializationInfo* host = stage.specialization;
  for (std::uint32_t i = 0; host != nullptr && i < host->mapEntryCount; ++i) {
    const std::uint32_t id = host->pMapEntries[i].constantID;
    if (id < kFirstRasterConstant) continue;
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "VitrailVkRasterDesc::%s: its specialization has a constant %u, and the host's are below %u", name,
                    id, kFirstRasterConstant);
  }
  return VK_SUCCESS;
}

// Whether a stage was compiled for what it is used for.
VkResult checkCompiled(const Log& log, const VitrailVkRasterDesc& desc, const VitrailVkRasterStage& stage,
                       const char* name, std::uint32_t number) {
  const std::optional<RasterCompiled> compiled = compiledOf(stage);
  if (!compiled) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "VitrailVkRasterDesc::%s: not compiled from this version's vitrail/raster.glsl", name);
  }
  if (compiled->stage != number) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "VitrailVkRasterDesc::%s: compiled with a VITRAIL_RASTER_STAGE of %u, and it is %u", name,
                    compiled->stage, number);
  }
  if (compiled->set != desc.setLayoutCount) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "VitrailVkRasterDesc::%s: compiled with a VITRAIL_SET of %u, and setLayoutCount is %u", name,
                    compiled->set, desc.setLayoutCount);
  }
  const bool asksSamples = number >= 1; // positions have none
  if (asksSamples && compiled->several != (desc.samples > 1)) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "VitrailVkRasterDesc::%s: compiled %s VITRAIL_MULTISAMPLED, and samples is %u", name,
                    compiled->several ? "with" : "without", std::max(1U, static_cast<std::uint32_t>(desc.samples)));
  }
  return VK_SUCCESS;
}

VkResult checkStages(const Log& log, const VitrailVkRasterDesc& desc) {
  VkResult result = VK_SUCCESS;
  std::uint32_t number = 0;
  const auto check = [&](const VitrailVkRasterStage& stage, const char* name, bool optional = false) {
    if (result == VK_SUCCESS && !(optional && stage.code == nullptr)) {
      result = checkStage(log, stage, name);
      if (result == VK_SUCCESS) result = checkCompiled(log, desc, stage, name, number);
    }
    ++number;
  };
  check(desc.positions, "positions", true);
  check(desc.setUp, "setUp");
  check(desc.setUpLarge, "setUpLarge");
  check(desc.blend, "blend");
  check(desc.blendDeep, "blendDeep");
  if (result != VK_SUCCESS) return result;
  if (compiledOf(desc.setUp)->planes != compiledOf(desc.setUpLarge)->planes) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "setUp and setUpLarge were compiled with unlike VITRAIL_CLIP_PLANES");
  }
  if (compiledOf(desc.blend)->fragments != compiledOf(desc.blendDeep)->fragments) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "blend and blendDeep were compiled with unlike VITRAIL_RASTER_FRAGMENTS");
  }
  return VK_SUCCESS;
}

VkResult checkExtent(const Log& log, const VkExtent2D& extent) {
  if (extent.width > 0 && extent.height > 0 && extent.width <= kMostSide && extent.height <= kMostSide) {
    return VK_SUCCESS;
  }
  return log.fail(VK_ERROR_INITIALIZATION_FAILED, "extent %ux%u: each side of a raster has 1 to %u pixels",
                  extent.width, extent.height, kMostSide);
}

// By how much a stored depth may differ from the one that was stored; negative: no depth format that is known.
float depthStepOf(VkFormat format, bool nearestIsZero) {
  constexpr float kStep24 = 1.0F / 16777216.0F;
  switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_D16_UNORM_S8_UINT:
      return 1.0F / 65535.0F;
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D24_UNORM_S8_UINT:
      return 2.0F * kStep24;
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return nearestIsZero ? 2.0F * kStep24 : 0.0F; // what 1 - depth rounds
    default:
      return -1.0F;
  }
}

VkResult checkFormats(const VitrailVkContext_T& context, const VitrailVkRaster_T& raster, VkFormat depth) {
  VkFormatProperties properties{};
  context.vk.GetPhysicalDeviceFormatProperties(context.physicalDevice, raster.colorFormat, &properties);
  const bool known =
      raster.colorFormat == VK_FORMAT_R16G16B16A16_SFLOAT || raster.colorFormat == VK_FORMAT_R32G32B32A32_SFLOAT;
  if (!known || (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) == 0) {
    return context.log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED,
                            "colorFormat %d: a raster writes storage images of VK_FORMAT_R16G16B16A16_SFLOAT or "
                            "VK_FORMAT_R32G32B32A32_SFLOAT",
                            raster.colorFormat);
  }
  if (raster.depthStep < 0.0F) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED, "depthFormat %d is no depth format", depth);
  }
  return VK_SUCCESS;
}

// What shaders of a raster need of the device.
VkResult checkDevice(const VitrailVkContext_T& context, VitrailVkRaster_T& raster) {
  constexpr std::uint32_t kBuffers = kRasterBindings - 4; // of a kernel of the library's
  VkPhysicalDeviceVulkan13Properties properties13{};
  properties13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES;
  VkPhysicalDeviceSubgroupProperties subgroups{};
  subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &subgroups;
  context.vk.GetPhysicalDeviceProperties2(context.physicalDevice, &properties);
  if (properties.properties.apiVersion >= VK_API_VERSION_1_3) {
    subgroups.pNext = &properties13;
    context.vk.GetPhysicalDeviceProperties2(context.physicalDevice, &properties);
  }
  const char* name = properties.properties.deviceName;
  const bool shuffles = (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
                        (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT) != 0;
  if (!shuffles) {
    return context.log.fail(VK_ERROR_FEATURE_NOT_PRESENT, "%s has no subgroup shuffles in compute shaders", name);
  }
  const std::uint32_t has = properties.properties.limits.maxPerStageDescriptorStorageBuffers;
  if (has < kBuffers) {
    return context.log.fail(VK_ERROR_FEATURE_NOT_PRESENT, "%s binds %u storage buffers to a shader; a raster needs %u",
                            name, has, kBuffers);
  }
  // Before Vulkan 1.3 a driver may take narrower ones than it says, where it has several sizes.
  raster.shuffles = properties13.minSubgroupSize >= 32;
  raster.offsetAlignment = properties.properties.limits.minStorageBufferOffsetAlignment;
  return VK_SUCCESS;
}

VkResult checkDesc(const VitrailVkContext_T& context, const VitrailVkRasterDesc& desc) {
  const Log& log = context.log;
  constexpr std::uint32_t kMostSets = 7;
  VkResult result = checkExtent(log, desc.extent);
  if (result != VK_SUCCESS) return result;
  const std::uint32_t samples = desc.samples == 0 ? 1 : desc.samples;
  if ((samples & (samples - 1)) != 0 || samples > 8 || (context.limits.sampleCounts & samples) == 0) {
    return log.fail(VK_ERROR_FEATURE_NOT_PRESENT, "samples %u: a raster takes 1, 2, 4 or 8, as the device offers",
                    samples);
  }
  if (desc.setLayoutCount > kMostSets || (desc.setLayoutCount > 0 && desc.setLayouts == nullptr)) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "setLayoutCount %u: setLayouts has up to %u layouts",
                    desc.setLayoutCount, kMostSets);
  }
  for (std::uint32_t i = 0; i < desc.setLayoutCount; ++i) {
    if (desc.setLayouts[i] != VK_NULL_HANDLE) continue;
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "setLayouts[%u] is null", i);
  }
  if (desc.indexType != VK_INDEX_TYPE_UINT16 && desc.indexType != VK_INDEX_TYPE_UINT32 &&
      desc.indexType != VK_INDEX_TYPE_NONE_KHR) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "indexType %d: indices have 16 or 32 bits, or there are none",
                    desc.indexType);
  }
  if ((desc.blendModes & ~kAllBlends) != 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "blendModes 0x%x: 0x%x is none of VitrailBlend", desc.blendModes,
                    desc.blendModes & ~kAllBlends);
  }
  if (desc.depthOrder != VITRAIL_DEPTH_NEAREST_IS_ZERO && desc.depthOrder != VITRAIL_DEPTH_NEAREST_IS_ONE) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "depthOrder %d is none of VitrailDepthOrder", desc.depthOrder);
  }
  if (desc.framesInFlight > VITRAIL_MAX_FRAMES_IN_FLIGHT) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "framesInFlight %u: %u is the most", desc.framesInFlight,
                    static_cast<unsigned>(VITRAIL_MAX_FRAMES_IN_FLIGHT));
  }
  return checkStages(log, desc);
}

// ---- Creation

std::unique_ptr<VitrailVkRaster_T> makeRaster(VitrailVkContext context, const VitrailVkRasterDesc& desc) {
  std::unique_ptr<VitrailVkRaster_T> made(new (std::nothrow) VitrailVkRaster_T);
  if (!made) return nullptr;
  made->context = context;
  ++context->owners;
  made->extent = desc.extent;
  made->samples = desc.samples == 0 ? 1 : desc.samples;
  made->colorFormat = desc.colorFormat != VK_FORMAT_UNDEFINED ? desc.colorFormat : VK_FORMAT_R16G16B16A16_SFLOAT;
  made->nearestIsZero = desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ZERO;
  made->depthStep = depthStepOf(desc.depthFormat != VK_FORMAT_UNDEFINED ? desc.depthFormat : VK_FORMAT_D32_SFLOAT,
                                made->nearestIsZero);
  made->indexBytes = desc.indexType == VK_INDEX_TYPE_UINT16 ? 2 : desc.indexType == VK_INDEX_TYPE_UINT32 ? 4 : 0;
  made->keepsPositions = desc.positions.code != nullptr;
  made->blendModes = desc.blendModes != 0 ? desc.blendModes : kAllBlends;
  made->clipPlanes = compiledOf(desc.setUp)->planes; // checkStages() has seen that they say it
  made->fragments = compiledOf(desc.blend)->fragments;
  made->solids = desc.solids != VK_FALSE;
  made->hostSets = desc.setLayoutCount;
  // What the device has is shared with the host's images and models.
  made->budget = desc.memoryBudget != 0 ? desc.memoryBudget : context->limits.heapSize / 4 * 3;
  made->framesInFlight = desc.framesInFlight != 0 ? desc.framesInFlight : 2;
  made->debugName = desc.debugName != nullptr ? desc.debugName : "vitrail raster";
  return made;
}

void warnOfBands(const VitrailVkRaster_T& raster) {
  raster.context->log.warn("%s: the device has no memory for all that a frame needs: frames are drawn in %u bands",
                           raster.debugName.c_str(), raster.bands());
}

// Room for the tiles of an extent: for all where the budget has it, else for bands. `had`: what there is, or is enough.
VkResult makeRoom(VitrailVkRaster_T& raster, const RasterNeeds& guess, const RasterNeeds& had) {
  std::uint32_t rows = raster.tilesY();
  RasterNeeds room;
  const bool wasCounted = raster.counted;
  raster.counted = false;
  const auto plan = [&](RasterNeeds needs, const RasterNeeds& before) {
    needs.records = std::max(needs.records, raster.leastPlaces(rows));
    return planRasterRoom(needs, before, raster.bounds(rows), room);
  };
  while (plan(guess, had) > 1.0 && plan(kLeast, {}) > 1.0) {
    if (rows == 1 && !raster.counted) {
      raster.counted = true;
      continue;
    }
    if (rows == 1) {
      raster.counted = wasCounted;
      return raster.context->log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                                      "%s: a memoryBudget of %llu bytes has no room for a row of tiles, %u pixels wide",
                                      raster.debugName.c_str(), static_cast<unsigned long long>(raster.budget),
                                      raster.extent.width);
    }
    rows = fewerRasterRows(rows, 1.0);
  }
  const bool isNew = raster.bandRows == 0;
  VkResult result = resizeRasterRoom(raster, room, rows, isNew || rows == 1 ? raster.context->log : kQuiet);
  if (result != VK_SUCCESS) raster.counted = wasCounted;
  while (result != VK_SUCCESS && !isNew && rows > 1) { // in what there is, as growWithoutMemory()
    rows /= 2;
    if (rows > 1 && rasterExcess(raster.room, raster.bounds(rows)) > 1.0) continue;
    result = resizeRasterRoom(raster, raster.room, rows, rows == 1 ? raster.context->log : kQuiet, true);
    if (result == VK_SUCCESS) warnOfBands(raster);
  }
  return result;
}

// Most models' triangles are each in a tile or two; what frames need is known after the first.
RasterNeeds guessOf(std::uint64_t triangles) {
  RasterNeeds guess = kLeast;
  guess.records = std::clamp<std::uint64_t>(triangles * 2, 4096, 1U << 20U);
  guess.large = 256;
  return guess;
}

RasterTables tablesOf(const VitrailVkRasterHints& hints, std::uint32_t samples, bool keepsPositions) {
  const std::uint64_t triangles =
      std::uint64_t{raster::VITRAIL_RASTER_SET_UP} * rasterTurns(samples); // of a work group
  const std::uint64_t vertices = std::uint64_t{raster::VITRAIL_RASTER_GROUP} * rasterVertices(hints.vertices);
  const auto atLeast = [](std::uint64_t value) { return std::max<std::uint64_t>(value, 1); };
  return {.draws = atLeast(hints.draws),
          .groups = atLeast(hints.triangles / triangles + hints.draws),
          .vertexGroups = keepsPositions ? atLeast(hints.vertices / vertices + hints.draws) : 1,
          .items = atLeast(hints.instances),
          .vertices = keepsPositions ? atLeast(hints.vertices) : 1};
}

VkResult createStats(VitrailVkRaster_T& raster) {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  raster.facts.resize(raster.framesInFlight + 1);
  const VkResult result =
      raster.stats.create(*raster.context, raster.facts.size() * sizeof(RasterSlot), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                          kHost, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, raster.debugName.c_str(), "statistics");
  if (result != VK_SUCCESS) return result;
  std::fill_n(static_cast<RasterSlot*>(raster.stats.mapped), raster.facts.size(), RasterSlot{});
  return VK_SUCCESS;
}

VkResult build(VitrailVkRaster_T& raster, const VitrailVkRasterDesc& desc) {
  raster.verticesOfThread = rasterVertices(desc.hints.vertices);
  VkResult result = checkDevice(*raster.context, raster);
  if (result == VK_SUCCESS) {
    result = checkFormats(*raster.context, raster,
                          desc.depthFormat != VK_FORMAT_UNDEFINED ? desc.depthFormat : VK_FORMAT_D32_SFLOAT);
  }
  if (result == VK_SUCCESS) result = createStats(raster);
  if (result == VK_SUCCESS) result = createRasterBuffers(raster);
  raster.guess = guessOf(desc.hints.triangles);
  if (result == VK_SUCCESS) result = makeRoom(raster, raster.guess, {});
  if (result == VK_SUCCESS) {
    result =
        resizeRasterTables(raster, tablesOf(desc.hints, raster.samples, raster.keepsPositions), raster.context->log);
  }
  if (result == VK_SUCCESS) result = createRasterPipelines(raster, desc);
  if (result == VK_SUCCESS) result = createRasterSets(raster);
  return result;
}

// ---- Statistics

// What a slot holds of a frame. False: it is not there (any more).
bool readSlot(const VitrailVkRaster_T& raster, std::uint64_t frame, raster::VitrailRasterTotals& totals) {
  const RasterFacts& facts = raster.facts[raster.slotOf(frame)];
  if (!facts.any || facts.frame != frame) return false;
  if (facts.misused) return true; // it leaves none
  // The GPU may start to write the slot again at any time: as readSlot() of a target.
  RasterSlot& slot = static_cast<RasterSlot*>(raster.stats.mapped)[raster.slotOf(frame)];
  const std::uint64_t tag = facts.tag;
  const std::atomic_ref<std::uint64_t> written(slot.tag);
  if (written.load(std::memory_order_acquire) != tag) return false;
  totals = slot.totals;
  std::atomic_thread_fence(std::memory_order_acquire);
  return written.load(std::memory_order_relaxed) == tag;
}

std::uint64_t together(std::uint32_t high, std::uint32_t low) { return std::uint64_t{high} << 32U | low; }

RasterNeeds needsOf(const raster::VitrailRasterTotals& totals) {
  return {.records = together(totals.recordsHigh, totals.records),
          .large = totals.large,
          .deep = totals.deep,
          .blocks = totals.blocks,
          .fragments = together(totals.fragmentsHigh, totals.fragments),
          .chunks = totals.chunks};
}

std::uint32_t mergePassesOf(std::uint32_t mostFragments) {
  std::uint32_t passes = 0;
  while (mostFragments > std::uint64_t{raster::VITRAIL_RASTER_CHUNK} << passes) ++passes;
  return passes;
}

std::uint32_t slicesOf(std::uint32_t mostFragments) { return mostFragments / raster::VITRAIL_RASTER_SLICE + 1; }

// Whether the frame had all that it needed.
bool hadRoom(const raster::VitrailRasterTotals& totals, const RasterFacts& facts) {
  const bool hasDeep = totals.deep == 0 || (facts.deep && mergePassesOf(totals.mostFragments) <= facts.mergePasses &&
                                            slicesOf(totals.mostFragments) <= facts.slices);
  return totals.start.fits != 0 && hasDeep && needsOf(totals).fitInto(facts.room);
}

RasterWrong wrongOf(const raster::VitrailRasterTotals& totals, const RasterFacts& facts) {
  if (facts.empty || facts.misused) return {};
  return {.vertex = totals.wrongVertex, .indices = totals.start.wrongIndices, .blend = totals.start.wrongBlend};
}

// Says which draws are wrong, of each kind once, until there are none.
void tellWrong(VitrailVkRaster_T& raster, const RasterWrong& wrong, std::uint64_t frame) {
  const auto tell = [&](std::uint32_t number, std::uint32_t& told, const char* what) {
    if (number != 0 && told == 0) {
      raster.context->log.error("%s: frame %llu: draw %u %s", raster.debugName.c_str(),
                                static_cast<unsigned long long>(frame), number - 1, what);
    }
    told = number;
  };
  tell(wrong.vertex, raster.toldWrong.vertex,
       "has an index that is not below its vertexCount: such triangles are left out");
  tell(wrong.indices, raster.toldWrong.indices, "has more indices from firstIndex on than the buffer: it is left out");
  tell(wrong.blend, raster.toldWrong.blend,
       "has a blend that is none of VitrailVkRasterDesc::blendModes: it is left out");
}

void decode(const raster::VitrailRasterTotals& totals, const RasterFacts& facts, VitrailVkRasterStats& stats) {
  clearKeepingNext(stats);
  stats.frame = facts.frame;
  stats.bands = facts.bands;
  const bool wrong = wrongOf(totals, facts).any();
  stats.misused = facts.misused || wrong ? VK_TRUE : VK_FALSE;
  if (facts.misused) return; // nothing of it is known
  const bool whole =
      facts.empty || (totals.bands == facts.bands && totals.cutPixels == 0 && !wrong && hadRoom(totals, facts));
  stats.exact = whole ? VK_TRUE : VK_FALSE;
  if (facts.empty) return;
  stats.errorBound = facts.bounded ? raster::VITRAIL_RASTER_STOP : 0.0F;
  stats.draws = totals.start.tables.count;
  stats.instances = totals.start.items;
  stats.vertices = totals.start.vertexCount;
  const RasterNeeds needs = needsOf(totals);
  stats.records = totals.recordsHigh == 0 ? totals.inTiles : needs.records;
  stats.largeTriangles = totals.large;
  stats.deepTiles = totals.deep;
  stats.deepFragments = needs.fragments;
  stats.deepestPixel = totals.mostFragments;
  stats.cutPixels = totals.cutPixels;
}

// ---- Growth

VkResult growTables(VitrailVkRaster_T& raster, const raster::VitrailRasterTotals& totals, const RasterFacts& facts) {
  if (totals.start.tooMany != 0) {
    return raster.context->log.fail(
        VK_ERROR_OUT_OF_DEVICE_MEMORY,
        "%s: the frame's draws have more than 2^31 triangles, instances or vertices, or one "
        "of them more than 2^30: draw fewer at once",
        raster.debugName.c_str());
  }
  const auto resize = [&](bool hasSpare, const Log& log) {
    const auto grown = [&](std::uint64_t wanted, std::uint64_t had) {
      if (wanted <= had) return had;
      return hasSpare ? withRasterSpare(wanted) : wanted;
    };
    const RasterTables& had = raster.tables;
    return resizeRasterTables(raster,
                              {.draws = grown(facts.draws, had.draws),
                               .groups = grown(totals.start.groups.count, had.groups),
                               .vertexGroups = grown(totals.start.vertices.count, had.vertexGroups),
                               .items = grown(totals.start.items, had.items),
                               .vertices = grown(totals.start.vertexCount, had.vertices)},
                              log);
  };
  if (resize(true, kQuiet) == VK_SUCCESS) return VK_SUCCESS;
  return resize(false, raster.context->log); // what is spare is not worth a refusal
}

// Instead of pages as many places as there are records: of a row of tiles, for which there is no room with pages.
// False: nor is there for that, and all stays as it was.
bool countRecords(VitrailVkRaster_T& raster, RasterNeeds needs, std::uint64_t inTiles) {
  if (raster.counted) return false;
  needs.records = 1 + inTiles;
  raster.counted = true;
  RasterNeeds next;
  const bool done = planRasterRoom(needs, {}, raster.bounds(1), next) <= 1.0 &&
                    resizeRasterRoom(raster, next, 1, kQuiet) == VK_SUCCESS;
  raster.counted = done;
  return done;
}

// Where the device has no memory for that: what is needed and none to spare, or else more bands, in what there is or in
// less than was wanted, and of a row places that are counted. How much those need is a guess, which the next frame
// corrects.
VkResult growWithoutMemory(VitrailVkRaster_T& raster, const RasterNeeds& needs, std::uint64_t inTiles) {
  const std::uint32_t rows = raster.bandRows;
  for (std::uint32_t parts = 1;; parts *= 2) {
    const std::uint32_t fewer = std::max(1U, rows / parts);
    const RasterBounds bounds = raster.bounds(fewer);
    RasterNeeds room = needs.part(parts).most(raster.room);
    if (rasterExcess(room, bounds) > 1.0) room = needs.part(parts).most(kLeast); // as planRasterRoom()
    if (rasterExcess(room, bounds) > 1.0) {
      if (fewer > 1) continue;
      room = raster.room;
    }
    const bool isMade = resizeRasterRoom(raster, room, fewer, kQuiet, true) == VK_SUCCESS ||
                        (fewer == 1 && countRecords(raster, needs.part(parts), inTiles / parts));
    if (isMade && fewer < rows) warnOfBands(raster);
    if (isMade) return VK_SUCCESS;
    if (fewer == 1) return resizeRasterRoom(raster, room, fewer, raster.context->log, true); // once more, to say why
  }
}

// A record that comes before its page takes some other place, and how many do is a matter of chance: a thousandth in
// one frame, and none in the next. Nobody may count on a frame that had just enough room.
RasterNeeds withChance(RasterNeeds needs, bool counted) {
  if (!counted) needs.records += needs.records / 32 + 8;
  return needs;
}

VkResult growRoom(VitrailVkRaster_T& raster, const RasterNeeds& needs, std::uint64_t inTiles) {
  const RasterNeeds wanted = withChance(needs, raster.counted);
  RasterNeeds next;
  std::uint32_t rows = raster.bandRows;
  const double excess = planRasterRoom(wanted, raster.room, raster.bounds(rows), next);
  if (excess > 1.0) {
    if (rows == 1) {
      if (countRecords(raster, needs, inTiles)) return VK_SUCCESS;
      return raster.context->log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                                      "%s: there is no room for the %llu triangles of a row of tiles and for %llu "
                                      "fragments of deep tiles: a larger "
                                      "memoryBudget or a smaller extent has it",
                                      raster.debugName.c_str(), static_cast<unsigned long long>(needs.records),
                                      static_cast<unsigned long long>(needs.fragments));
    }
    rows = fewerRasterRows(rows, excess);
    next = raster.room;
  }
  if (resizeRasterRoom(raster, next, rows, kQuiet) == VK_SUCCESS) return VK_SUCCESS;
  return growWithoutMemory(raster, wanted, inTiles);
}

// What is enough for the frame: where there is less room, tiles begin with smaller pages.
RasterNeeds leastOf(const VitrailVkRaster_T& raster, RasterNeeds needs, std::uint64_t inTiles) {
  needs.records = std::min(needs.records, raster.leastPlaces(raster.bandRows) + 4 * inTiles);
  return needs;
}

// Less memory, or fewer bands, where frames have needed little for long. What cannot be made then stays as it is.
void shrink(VitrailVkRaster_T& raster, const RasterNeeds& needs) {
  const bool splits = raster.counted || raster.bandRows < raster.tilesY();
  RasterNeeds most;
  if (!raster.low.note(needs, splits || isLowRasterNeed(needs, raster.room), most)) return;
  const std::uint32_t rows = std::min(raster.tilesY(), raster.bandRows * 2);
  RasterNeeds next;
  if (splits) {
    const bool wasCounted = raster.counted;
    raster.counted = false;
    if (wasCounted) most.records = 3 * most.records + raster.leastPlaces(rows); // with what pages leave free
    const bool joined = planJoinedBands(most, raster.room, raster.bounds(rows), next) &&
                        resizeRasterRoom(raster, next, rows, kQuiet) == VK_SUCCESS;
    raster.counted = wasCounted && !joined;
    return;
  }
  most = most.most(raster.guess); // what the host knew beforehand it still knows
  if (planRasterRoom(most, {}, raster.bounds(rows), next) <= 1.0) resizeRasterRoom(raster, next, rows, kQuiet);
}

// What frames like this one take: how many work groups are ready. Whatever it is, pictures are the same.
void learn(VitrailVkRaster_T& raster, const raster::VitrailRasterTotals& totals, const RasterFacts& facts) {
  if (facts.empty || facts.misused) return;
  raster.mediums = totals.medium;
  raster.anyLarge = totals.large > 0;
  std::copy(std::begin(totals.ofClass), std::end(totals.ofClass), raster.tilesOf.begin());
  raster.tilesAreKnown = totals.bands > 0 && hadRoom(totals, facts); // else none were listed
  if (facts.tables != raster.tableNumber || totals.bands == 0) return;
  raster.start = totals.start;
  raster.startOf = facts.tables;
}

// Makes what frames like this one need.
VkResult follow(VitrailVkRaster_T& raster, const raster::VitrailRasterTotals& totals, const RasterFacts& facts) {
  VkResult result = VK_SUCCESS;
  const RasterNeeds needs = needsOf(totals);
  if (totals.start.fits == 0) result = growTables(raster, totals, facts);
  if (result == VK_SUCCESS && totals.deep > 0) {
    result = createDeepPipelines(raster);
    if (result == VK_SUCCESS) {
      raster.deepPlanned = true;
      raster.mergePasses = std::max(raster.mergePasses, mergePassesOf(totals.mostFragments));
      raster.slices = std::max(raster.slices, slicesOf(totals.mostFragments));
    }
  }
  if (result != VK_SUCCESS) return result;
  // Draws are those of any extent. What their triangles need in another one says little.
  if (facts.extent.width != raster.extent.width || facts.extent.height != raster.extent.height) return VK_SUCCESS;
  if (facts.counted != raster.counted) return VK_SUCCESS; // nor what pages need where there are none
  if (needs.fitInto(raster.room)) {
    shrink(raster, leastOf(raster, needs, totals.inTiles));
    return VK_SUCCESS;
  }
  raster.low.forget();
  // A band of more rows than they are now needed more.
  if (facts.bands < raster.bands()) return VK_SUCCESS;
  return growRoom(raster, needs, totals.inTiles);
}

} // namespace

} // namespace vitrail

extern "C" VkResult vitrailVkCreateRaster(VitrailVkContext context, const VitrailVkRasterDesc* desc,
                                          VitrailVkRaster* raster) {
  using namespace vitrail;
  if (raster != nullptr) *raster = nullptr;
  if (context == nullptr || desc == nullptr || raster == nullptr) {
    return nullArgument(context, "vitrailVkCreateRaster");
  }
  if (context->destroyed) {
    return context->log.fail(VK_ERROR_INITIALIZATION_FAILED, "vitrailVkCreateRaster: the context was destroyed");
  }
  VkResult result = checkNext(context->log, desc->next, "VitrailVkRasterDesc");
  if (result == VK_SUCCESS) result = checkDesc(*context, *desc);
  if (result != VK_SUCCESS) return result;
  std::unique_ptr<VitrailVkRaster_T> made = makeRaster(context, *desc);
  if (!made) return context->log.fail(VK_ERROR_OUT_OF_HOST_MEMORY, "no memory for a raster");
  result = build(*made, *desc);
  if (result != VK_SUCCESS) {
    vitrailVkDestroyRaster(made.release());
    return result; // the log has the reason
  }
  *raster = made.release();
  return VK_SUCCESS;
}

extern "C" void vitrailVkDestroyRaster(VitrailVkRaster raster) {
  if (raster == nullptr) return;
  const std::unique_ptr<VitrailVkRaster_T> owned(raster);
  const VitrailVkContext_T& context = *raster->context;
  for (vitrail::RetiredBuffer& retired : raster->retired) retired.buffer.destroy(context);
  for (vitrail::Buffer& buffer : raster->buffers) buffer.destroy(context);
  raster->stats.destroy(context);
  context.vk.DestroyDescriptorPool(context.device, raster->descriptors, context.allocator);
  vitrail::destroyRasterPipelines(*raster);
  vitrail::releaseContext(raster->context);
}

extern "C" VkResult vitrailVkResizeRaster(VitrailVkRaster raster, VkExtent2D extent) {
  using namespace vitrail;
  if (raster == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  const VkResult result = checkExtent(raster->context->log, extent);
  if (result != VK_SUCCESS) return result;
  const VkExtent2D before = raster->extent;
  raster->extent = extent;
  RasterNeeds guess = raster->room;
  guess.deep = guess.blocks = guess.fragments = guess.chunks = 1;
  const VkResult made = makeRoom(*raster, guess, guess);
  if (made != VK_SUCCESS) {
    raster->extent = before;
    return made;
  }
  raster->low.forget();
  raster->leaveOpenFrame();
  return VK_SUCCESS;
}

extern "C" VkResult vitrailVkUpdateRaster(VitrailVkRaster raster, uint64_t frame) {
  using namespace vitrail;
  if (raster == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  // Bands that are still to be recorded go into the memory of the first.
  if (raster->nextBand != 0 && (frame == 0 || frame == raster->frames.newest())) return VK_SUCCESS;
  raster->leaveOpenFrame();
  // As vitrailVkUpdateTarget().
  const std::uint64_t number = std::min(raster->frames.numberOf(frame), raster->frames.numberOf(0));
  const bool again = raster->frames.any() && number == raster->frames.newest() && frame != 0;
  freeRetired(*raster, raster->frames.begun() + (again ? 0 : 1));
  raster::VitrailRasterTotals totals{};
  std::uint64_t newest = number;
  const bool read = readNewestOf(number, raster->facts.size(), [&](std::uint64_t one) {
    newest = one;
    // One that recorded nothing tells of no needs, and the one before it may.
    return !raster->facts[raster->slotOf(one)].misused && readSlot(*raster, one, totals);
  });
  const RasterFacts& facts = raster->facts[raster->slotOf(newest)];
  if (!read || facts.tag <= raster->newestNews) return VK_SUCCESS;
  tellWrong(*raster, wrongOf(totals, facts), facts.frame);
  learn(*raster, totals, facts);
  if (!facts.empty) {
    const VkResult result = follow(*raster, totals, facts);
    if (result != VK_SUCCESS) return result;
  }
  raster->newestNews = facts.tag;
  return VK_SUCCESS;
}

extern "C" void vitrailVkRasterMemory(VitrailVkRaster raster, VitrailVkRasterMemory* memory) {
  using namespace vitrail;
  if (memory == nullptr) return;
  clearKeepingNext(*memory);
  if (raster == nullptr) return;
  for (std::size_t i = 0; i < kRasterBuffers; ++i) {
    const bool ofDraws = i >= static_cast<std::size_t>(RasterBuffer::DrawPlaces);
    (ofDraws ? memory->drawBytes : memory->tileBytes) += raster->buffers[i].size;
  }
  for (const RetiredBuffer& retired : raster->retired) memory->retiredBytes += retired.buffer.size;
  memory->totalBytes = memory->tileBytes + memory->drawBytes + memory->retiredBytes + raster->stats.size;
}

extern "C" uint32_t vitrailVkRasterBands(VitrailVkRaster raster) { return raster != nullptr ? raster->bands() : 0; }

extern "C" VkResult vitrailVkReadRasterStats(VitrailVkRaster raster, uint64_t frame, VitrailVkRasterStats* stats) {
  using namespace vitrail;
  if (raster == nullptr || stats == nullptr) {
    if (stats != nullptr) clearKeepingNext(*stats);
    return nullArgument(raster != nullptr ? raster->context : nullptr, "vitrailVkReadRasterStats");
  }
  raster::VitrailRasterTotals totals{};
  std::uint64_t found = frame;
  const bool newest = frame == 0 && !raster->frames.areGiven();
  const bool read = newest ? readNewestOf(raster->frames.newest(), raster->facts.size(),
                                          [&](std::uint64_t one) {
                                            found = one;
                                            return readSlot(*raster, one, totals);
                                          })
                           : readSlot(*raster, frame, totals);
  if (!read) return VK_NOT_READY;
  const RasterFacts& facts = raster->facts[raster->slotOf(found)];
  decode(totals, facts, *stats);
  learn(*raster, totals, facts);
  tellWrong(*raster, wrongOf(totals, facts), facts.frame);
  return VK_SUCCESS;
}
