// A raster: what its passes keep, its pipelines, and its frames.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "buffer.h"
#include "context.h"
#include "core/frame_numbers.h"
#include "core/raster_needs.h"
#include "vitrail/raster/layout.h"
#include "vitrail/vulkan_raster.h"

namespace vitrail {

// The raster's own buffers. Those of one kind follow the same needs.
enum class RasterBuffer : std::uint8_t {
  Counts, // what frames always have: control, classes of tiles, totals and the frame's data
  Start,
  Tiles, // tiles
  TileList,
  Records, // records
  Astray,
  Medium,
  SampleMasks,
  Large, // and what else a band counts
  DeepTiles,
  DeepPixels,
  States,
  Blocks,
  Fragments,
  SortedFragments,
  Chunks,
  DrawPlaces, // draws
  DrawOfGroup,
  DrawOfVertexGroup,
  Items,
  Positions,
  Count
};
constexpr std::size_t kRasterBuffers = static_cast<std::size_t>(RasterBuffer::Count);

// Where the parts of RasterBuffer::Counts begin, at what any device aligns buffers to.
constexpr std::uint64_t kRasterControlAt = 0;
constexpr std::uint64_t kRasterClassesAt = 256;
constexpr std::uint64_t kRasterTotalsAt = 512; // not cleared from band to band
constexpr std::uint64_t kRasterFrameAt = 768;  // begin.comp
constexpr std::uint64_t kRasterCountBytes = kRasterFrameAt + sizeof(raster::VitrailRasterFrame);

// What the pass `begin` takes (push constants).
struct RasterBegin {
  std::array<std::uint32_t, raster::VITRAIL_RASTER_FRAME_WORDS> frame; // of VitrailRasterFrame
  std::uint32_t isFirst;
};
static_assert(sizeof(RasterBegin) <= 128); // which any device has

// The numbers of bindings of the raster's set are those of shaders/vitrail/raster/frame.glsl and the others in its
// folder. The set is there three times, with what shaders of a kind look at, as hosts have buffers of their own, and
// devices bind not many to a shader.
constexpr std::uint32_t kRasterBindings = 31;
constexpr std::uint32_t kFirstRasterConstant = 1710; // of frame.glsl: what is below is the host's

// What a stage of the host's shader was compiled for (raster.glsl).
struct RasterCompiled {
  std::uint32_t stage = 0;
  std::uint32_t set = 0;
  std::uint32_t planes = 0;
  std::uint32_t fragments = 1;
  bool several = false; // samples
};
enum class RasterSet : std::uint8_t {
  Own,      // of the library's kernels: all
  Geometry, // of positions and setting up
  Blend,    // of blending
  Count
};
// Vertices for each thread that asks for positions: more where there are very many.
constexpr std::uint32_t rasterVertices(std::uint64_t vertices) {
  return vertices < std::uint64_t{1} << 21U ? raster::VITRAIL_RASTER_FEW_VERTICES
                                            : raster::VITRAIL_RASTER_MANY_VERTICES;
}
// Turns of a work group that sets up triangles. With several samples one takes long enough.
constexpr std::uint32_t rasterTurns(std::uint32_t samples) { return samples > 1 ? 1 : 2; }

constexpr std::size_t kRasterBlends = 4; // pipelines for tiles, from few records to deep ones
constexpr std::size_t kRasterSets = static_cast<std::size_t>(RasterSet::Count);
bool hasRasterBinding(RasterSet set, std::uint32_t samples, std::uint32_t binding);
VkDescriptorType rasterBindingType(std::uint32_t binding);

// What frames have of draws.
struct RasterTables {
  std::uint64_t draws = 1;
  std::uint64_t groups = 1; // that set up triangles
  std::uint64_t vertexGroups = 1;
  std::uint64_t items = 1; // instances of all draws
  std::uint64_t vertices = 1;
};

// The library's own kernels, of src/kernels/raster/kernels.table.
enum class RasterKernel : std::uint8_t {
#define VITRAIL_RASTER_KERNEL(name, words, made) name,
#include "kernels/raster_names.inc"
#undef VITRAIL_RASTER_KERNEL
  Count
};
constexpr std::size_t kRasterKernels = static_cast<std::size_t>(RasterKernel::Count);

// A stage of the host's shader, kept for as long as pipelines are made of it.
struct RasterStage {
  VkShaderModule module = VK_NULL_HANDLE;
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<std::uint8_t> data;
};

// The memory that one frame's counters are copied to. The tag is another one, or 0, while they are not there.
struct RasterSlot {
  raster::VitrailRasterTotals totals;
  std::uint64_t tag; // RasterFacts::tag
};

// What the host's side knows of a frame.
struct RasterFacts {
  std::uint64_t frame = 0;
  std::uint64_t tag = 0; // of no other frame, also where numbers come twice
  VkExtent2D extent{};
  RasterNeeds room;
  bool counted = false;
  std::uint32_t bands = 0;
  std::uint32_t draws = 0;
  std::uint64_t tables = 0; // VitrailVkRaster_T::tableNumber
  bool deep = false;        // its passes of deep tiles are there, with so many
  std::uint32_t mergePasses = 0;
  std::uint32_t slices = 0;
  bool empty = false;   // nothing was to be drawn
  bool bounded = false; // what is hidden was left out
  bool misused = false;
  bool recorded = false; // all bands
  bool any = false;
};

// Draws that the GPU has found to be wrong: one more than the number of one of them, of each kind, or 0.
struct RasterWrong {
  std::uint32_t vertex = 0;
  std::uint32_t indices = 0;
  std::uint32_t blend = 0;

  [[nodiscard]] bool any() const { return vertex != 0 || indices != 0 || blend != 0; }
};

struct RetiredBuffer {
  Buffer buffer;
  FrameUse use;
};

} // namespace vitrail

struct VitrailVkRaster_T {
  VitrailVkContext context = nullptr; // which the raster owns a share of
  VkExtent2D extent{};
  std::uint32_t samples = 1;
  VkFormat colorFormat = VK_FORMAT_UNDEFINED;
  float depthStep = 0.0F; // of the opaque depth, as far as it differs from what is computed
  bool nearestIsZero = true;
  std::uint32_t indexBytes = 2; // 0: there are none
  bool keepsPositions = false;
  bool shuffles = false;
  std::uint32_t verticesOfThread = vitrail::raster::VITRAIL_RASTER_FEW_VERTICES; // that asks for positions
  std::uint64_t offsetAlignment = 1;                                             // of storage buffers
  std::uint32_t blendModes = 0;
  std::uint32_t clipPlanes = 0; // at most, in a frame
  std::uint32_t fragments = 1;  // of a surface
  bool solids = false;
  std::uint32_t hostSets = 0;
  std::uint64_t budget = 0;
  std::uint32_t framesInFlight = 2;
  std::string debugName;

  // Of each RasterSet. In pipeline layouts of the host's shader the set comes behind the host's own, else it is the
  // first.
  std::array<VkDescriptorSetLayout, vitrail::kRasterSets> setLayouts{};
  std::array<VkPipelineLayout, vitrail::kRasterSets> layouts{};
  VkDescriptorPool descriptors = VK_NULL_HANDLE;
  std::vector<std::array<VkDescriptorSet, vitrail::kRasterSets>> sets; // of framesInFlight frames

  VkPipeline positions = VK_NULL_HANDLE;
  VkPipeline setUp = VK_NULL_HANDLE;
  VkPipeline setUpMedium = VK_NULL_HANDLE;
  VkPipeline setUpLarge = VK_NULL_HANDLE;
  std::array<VkPipeline, vitrail::kRasterBlends> blends{};
  VkPipeline blendDeep = VK_NULL_HANDLE;
  std::array<VkPipeline, vitrail::kRasterKernels> kernels{};
  vitrail::RasterStage deepStage; // until the first frame that has deep tiles

  std::array<vitrail::Buffer, vitrail::kRasterBuffers> buffers;
  std::vector<vitrail::RetiredBuffer> retired; // that frames in flight use
  vitrail::RasterNeeds room;
  vitrail::RasterTables tables;
  vitrail::RasterNeeds guess; // what there is room for from the start
  std::uint32_t bandRows = 0; // of tiles
  // Records are counted before there are places for them, which takes a second turn of setting up, but no memory for
  // what pages leave free.
  bool counted = false;
  bool deepPlanned = false; // frames have the passes of deep tiles, and so many of some
  std::uint32_t mergePasses = 0;
  std::uint32_t slices = 1;
  vitrail::RasterLow low;
  std::uint64_t newestNews = 0; // the tag of the frame whose statistics were looked at last
  // The medium and large triangles of a band of the frame whose statistics were looked at last: so many work groups
  // await them.
  std::uint32_t mediums = vitrail::raster::VITRAIL_RASTER_GROUP * vitrail::raster::VITRAIL_RASTER_MEDIUM;
  bool anyLarge = true;
  // Tiles of each class in the last frame that was read: so many work groups blend them, and go on where there are
  // more.
  std::array<std::uint32_t, vitrail::raster::VITRAIL_RASTER_CLASSES> tilesOf{};
  bool tilesAreKnown = false;
  bool tablesAreMade = false;    // by a frame before, in the present buffers
  std::uint32_t tableDraws = 0;  // of how many draws they are
  std::uint64_t tableNumber = 0; // another one for each time that they are made
  // What the draws of such tables come to, and of which: 0: nobody knows yet.
  vitrail::raster::VitrailRasterStart start{};
  std::uint64_t startOf = 0;

  vitrail::Buffer stats; // RasterSlot[framesInFlight + 1]
  std::vector<vitrail::RasterFacts> facts;
  vitrail::FrameNumbers frames;
  std::uint64_t newestTag = 0;
  vitrail::RasterWrong toldWrong; // of the last frame whose statistics were read: the log has said so
  std::uint32_t nextBand = 0;     // of the frame that is being recorded; 0: it is whole

  [[nodiscard]] vitrail::Buffer& buffer(vitrail::RasterBuffer which) {
    return buffers[static_cast<std::size_t>(which)];
  }
  [[nodiscard]] VkPipeline kernel(vitrail::RasterKernel which) const {
    return kernels[static_cast<std::size_t>(which)];
  }
  // Without one of its own, a class of tiles has the last.
  [[nodiscard]] VkPipeline blend(std::uint32_t which) const {
    return blends.at(which) != VK_NULL_HANDLE ? blends.at(which) : blends.back();
  }
  [[nodiscard]] VkPipelineLayout layout(vitrail::RasterSet which) const {
    return layouts[static_cast<std::size_t>(which)];
  }
  [[nodiscard]] const std::array<VkDescriptorSet, vitrail::kRasterSets>& frameSets() const {
    return sets[frames.begun() % sets.size()];
  }
  // Nobody records the other bands of an open frame any more; perhaps its first were never submitted.
  void leaveOpenFrame() {
    if (nextBand != 0) tablesAreMade = false;
    nextBand = 0;
  }
  [[nodiscard]] std::uint32_t tilesX() const { return (extent.width + 7) / 8; }
  [[nodiscard]] std::uint32_t tilesY() const { return (extent.height + 7) / 8; }
  [[nodiscard]] std::uint32_t bands() const { return (tilesY() + bandRows - 1) / bandRows; }
  // How large the first pages of tiles are, of bands of so many rows: 2 to the power of this at least, and with the
  // room that there is.
  [[nodiscard]] std::uint32_t leastPageBits(std::uint32_t rows) const;
  [[nodiscard]] std::uint32_t pageBits() const;
  // Places for records that such bands have whatever is drawn.
  [[nodiscard]] std::uint64_t leastPlaces(std::uint32_t rows) const {
    return counted ? 1 : (std::uint64_t{tilesX()} * rows) << leastPageBits(rows);
  }
  [[nodiscard]] std::size_t slotOf(std::uint64_t frame) const { return frame % facts.size(); }
  // Bytes of a buffer that a shader can look at.
  [[nodiscard]] std::uint64_t reach() const {
    return std::min(context->limits.storageBufferRange, context->limits.allocationSize);
  }
  [[nodiscard]] vitrail::RasterBounds bounds(std::uint32_t rows) const;
};

namespace vitrail {

// Layouts and pipelines but those of deep tiles. Log their errors.
VkResult createRasterPipelines(VitrailVkRaster_T& raster, const VitrailVkRasterDesc& desc);
VkResult createDeepPipelines(VitrailVkRaster_T& raster);
void destroyRasterPipelines(VitrailVkRaster_T& raster);

// Makes room. Memory that frames in flight use is retired. Log their errors, on which nothing changes. `keepsTiles`:
// their memory stays where it is there, even if bands need much less of it.
VkResult resizeRasterRoom(VitrailVkRaster_T& raster, const RasterNeeds& room, std::uint32_t bandRows, const Log& log,
                          bool keepsTiles = false);
VkResult resizeRasterTables(VitrailVkRaster_T& raster, const RasterTables& tables, const Log& log);
VkResult createRasterBuffers(VitrailVkRaster_T& raster);
void freeRetired(VitrailVkRaster_T& raster, std::uint64_t place);

VkResult createRasterSets(VitrailVkRaster_T& raster);
// Writes the sets of the frame that is begun.
void writeRasterSets(VitrailVkRaster_T& raster, const VitrailVkRasterInfo& info);

} // namespace vitrail
