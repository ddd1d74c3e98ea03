// Records the passes of a raster's frame.
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "check.h"
#include "raster.h"

namespace vitrail {

namespace {

// Records of a tile that is not deep from the start, and how often it goes through 64 of them before it is. A CPU
// driver ends loops that it takes for endless.
constexpr std::uint32_t kMostWalked = 16384;
constexpr std::uint32_t kMostWalkedOnCpu = 2500;
constexpr std::uint32_t kMostVisits = 8192;
constexpr std::uint32_t kMostVisitsOnCpu = 1024;

constexpr std::uint32_t kSide = 8; // of a tile

struct Band {
  std::uint32_t top = 0; // rows of pixels
  std::uint32_t bottom = 0;

  [[nodiscard]] std::uint32_t tilesY() const { return (bottom - top + kSide - 1) / kSide; }
};

// A frame that is being recorded.
class Recording {
 public:
  Recording(VkCommandBuffer commands, VitrailVkRaster_T& raster, const VitrailVkRasterInfo& info)
      : commands_(commands), raster_(raster), info_(info), vk_(raster.context->vk) {}

  void drawBand(const Band& band, bool isFirst, bool isLast);

 private:
  [[nodiscard]] RasterFacts& facts() { return raster_.facts[raster_.slotOf(raster_.frames.newest())]; }
  [[nodiscard]] VkDeviceSize slotOffset() const { return raster_.slotOf(raster_.frames.newest()) * sizeof(RasterSlot); }

  void barrier(VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to, VkAccessFlags used) const {
    VkMemoryBarrier memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    memory.srcAccessMask = written;
    memory.dstAccessMask = used;
    vk_.CmdPipelineBarrier(commands_, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
  }
  // A pass has written -> the next ones go on with it, and take the sizes of their dispatches from it.
  void passBarrier() const {
    barrier(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
  }

  // The same where no sizes of dispatches have been written: not to wait for these takes half as long.
  void plainBarrier() const {
    barrier(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
  }

  void bind(RasterSet set);
  void push(const std::array<std::uint32_t, 3>& words, RasterSet set) const {
    vk_.CmdPushConstants(commands_, raster_.layout(set), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(words), words.data());
  }
  void begin(const Band& band, bool isFirst);
  void dispatch(VkPipeline pipeline, std::uint32_t x, std::uint32_t y) const {
    vk_.CmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vk_.CmdDispatch(commands_, x, y, 1);
  }
  void dispatch(VkPipeline pipeline, RasterBuffer sizes, std::size_t offset) const {
    vk_.CmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vk_.CmdDispatchIndirect(commands_, raster_.buffer(sizes).buffer, offset);
  }
  void dispatchTiles(VkPipeline pipeline, const Band& band) const { // 256 for a work group
    const std::uint32_t groups = (raster_.tilesX() * band.tilesY() + 255) / 256;
    dispatch(pipeline, std::min(groups, raster::VITRAIL_RASTER_ROW),
             (groups + raster::VITRAIL_RASTER_ROW - 1) / raster::VITRAIL_RASTER_ROW);
  }
  // What a frame's draws come to, whose sizes are known where a frame of the same ones was read: dispatches that need
  // not be looked up begin somewhat sooner.
  void dispatchDraws(VkPipeline pipeline, const raster::VitrailRasterDispatch& size, VkDeviceSize sizeAt) const {
    const bool isKnown = raster_.tablesAreMade && raster_.startOf == raster_.tableNumber;
    if (isKnown) return dispatch(pipeline, size.x, size.y);
    dispatch(pipeline, RasterBuffer::Start, sizeAt);
  }
  void positions() const {
    dispatchDraws(raster_.positions, raster_.start.vertices, offsetof(raster::VitrailRasterStart, vertices));
  }
  void fill(RasterBuffer which) const {
    vk_.CmdFillBuffer(commands_, raster_.buffer(which).buffer, 0, VK_WHOLE_SIZE, 0);
  }
  void passed(const char* pass) const {
    if (info_.onPass != nullptr) info_.onPass(pass, commands_, info_.user);
  }

  // Blocks of a row of tiles that large triangles are looked for in.
  [[nodiscard]] std::uint32_t largeBlocks() const {
    return (raster_.tilesX() + raster::VITRAIL_RASTER_LARGE_BLOCK - 1) / raster::VITRAIL_RASTER_LARGE_BLOCK;
  }
  [[nodiscard]] std::uint32_t largeGroups() const;
  [[nodiscard]] std::uint32_t mediumGroups() const;
  [[nodiscard]] std::uint32_t largeRows(const Band& band) const;
  [[nodiscard]] raster::VitrailRasterFrame frameOf(const Band& band) const;
  void clear(const Band& band, bool isFirst);
  void readDraws(bool isFirst);
  void setUp(const Band& band);
  void place(const Band& band);
  void bin(const Band& band);
  [[nodiscard]] bool knowsTiles() const { return raster_.tilesAreKnown && !raster_.context->limits.oneBlend; }
  void blend(const Band& band);
  void blendDeep();
  void note(bool isLast);

  VkCommandBuffer commands_;
  VitrailVkRaster_T& raster_;
  const VitrailVkRasterInfo& info_;
  const Functions& vk_;
};

void Recording::bind(RasterSet set) {
  const VkPipelineLayout layout = raster_.layout(set);
  const bool own = set == RasterSet::Own;
  if (!own && raster_.hostSets > 0) {
    vk_.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, raster_.hostSets, info_.sets,
                              info_.dynamicOffsetCount, info_.dynamicOffsets);
  }
  const VkDescriptorSet ours = raster_.frameSets()[static_cast<std::size_t>(set)];
  vk_.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, layout, own ? 0 : raster_.hostSets, 1, &ours, 0,
                            nullptr);
}

raster::VitrailRasterFrame Recording::frameOf(const Band& band) const {
  raster::VitrailRasterFrame data{};
  data.width = raster_.extent.width;
  data.height = raster_.extent.height;
  data.tilesX = raster_.tilesX();
  data.tilesY = band.tilesY();
  data.top = band.top;
  data.bottom = band.bottom;
  data.pageBits = raster_.pageBits();
  data.draws = info_.drawCount;
  const RasterNeeds& room = raster_.room;
  data.recordCapacity = static_cast<std::uint32_t>(room.records);
  data.largeCapacity = static_cast<std::uint32_t>(room.large);
  data.deepCapacity = static_cast<std::uint32_t>(room.deep);
  data.blockCapacity = static_cast<std::uint32_t>(room.blocks);
  data.fragmentCapacity = static_cast<std::uint32_t>(room.fragments);
  data.chunkCapacity = static_cast<std::uint32_t>(room.chunks);
  const bool onCpu = raster_.context->limits.isCpu;
  data.mostWalked = onCpu ? kMostWalkedOnCpu : kMostWalked;
  data.mostVisits = onCpu ? kMostVisitsOnCpu : kMostVisits;
  data.pointSize = info_.pointSize > 0.0F ? info_.pointSize : 1.0F;
  data.lightMost = info_.mostLight > 0.0F ? info_.mostLight : -1.0F;
  const RasterTables& tables = raster_.tables;
  data.drawCapacity = static_cast<std::uint32_t>(tables.draws);
  data.groupCapacity = static_cast<std::uint32_t>(tables.groups);
  data.vertexGroupCapacity = static_cast<std::uint32_t>(tables.vertexGroups);
  data.itemCapacity = static_cast<std::uint32_t>(tables.items);
  data.vertexCapacity = static_cast<std::uint32_t>(tables.vertices);
  data.drawBlends = raster_.fragments > 1 ? ~0U : raster_.blendModes; // of two fragments nobody looks at the draw's
  data.hasOrders = info_.orders != VK_NULL_HANDLE ? 1 : 0;
  data.countsDraws = info_.countBuffer != VK_NULL_HANDLE ? 1 : 0;
  data.depthStep = raster_.depthStep;
  data.largeGroups = largeGroups();
  for (std::uint32_t i = 0; i < std::size(data.clipPlanes); ++i) {
    if (i >= info_.clipPlaneCount) {
      data.clipPlanes[i] = {0.0F, 0.0F, 0.0F, 1.0F}; // keeps all that can be seen
      continue;
    }
    const float* plane = info_.clipPlanes[i];
    data.clipPlanes[i] = {plane[0], plane[1], plane[2], plane[3]};
    if (!raster_.nearestIsZero) continue;
    data.clipPlanes[i].z = -plane[2]; // of w - z, which is what positions are kept with
    data.clipPlanes[i].w = plane[3] + plane[2];
  }
  return data;
}

// Work groups that set up large triangles, of a row of tiles: so many that none takes long, as a driver ends loops that
// it takes for endless.
std::uint32_t Recording::largeGroups() const {
  constexpr std::uint64_t kTurns = 64;
  constexpr std::uint64_t kMostGroups = 65535; // that any device takes
  const std::uint32_t blocks = largeBlocks();
  const auto shares = static_cast<std::uint32_t>(
      std::min(raster_.room.large / (raster::VITRAIL_RASTER_GROUP * kTurns) + 2, kMostGroups / blocks));
  return blocks * shares;
}

// Work groups that set up medium triangles: as many as triangles.glsl says for somewhat more than there were, and so
// many that none takes long whatever comes.
std::uint32_t Recording::mediumGroups() const {
  constexpr std::uint64_t kLeastGroups = 64;
  constexpr std::uint64_t kMostTurns = 1024;
  const auto groupsOf = [](std::uint64_t triangles, std::uint64_t each) { return (triangles + each - 1) / each; };
  const std::uint64_t count = raster_.mediums + std::uint64_t{raster_.mediums} / 8;
  const std::uint64_t few =
      std::min<std::uint64_t>(groupsOf(count, raster::VITRAIL_RASTER_FEW_MEDIUM), raster::VITRAIL_RASTER_MEDIUM);
  const std::uint64_t groups = std::max({kLeastGroups, few, groupsOf(count, raster::VITRAIL_RASTER_GROUP),
                                         groupsOf(raster_.room.records, raster::VITRAIL_RASTER_GROUP * kMostTurns)});
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(groups, raster::VITRAIL_RASTER_ROW));
}

// Rows of work groups that set up large triangles: one for each row of tiles, or where there were none and cannot be
// many a few.
std::uint32_t Recording::largeRows(const Band& band) const {
  constexpr std::uint64_t kFewTriangles = 4096;
  constexpr std::uint32_t kFewRows = 8;
  const bool few = !raster_.anyLarge && raster_.room.large <= kFewTriangles;
  return few ? std::min(kFewRows, band.tilesY()) : band.tilesY();
}

// A dispatch takes less time than clearing by transfers, and it runs beside the one for positions.
void Recording::begin(const Band& band, bool isFirst) {
  const raster::VitrailRasterFrame data = frameOf(band);
  RasterBegin begin{};
  std::memcpy(begin.frame.data(), &data, sizeof(begin.frame));
  begin.isFirst = isFirst ? 1 : 0;
  bind(RasterSet::Own);
  vk_.CmdPushConstants(commands_, raster_.layout(RasterSet::Own), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(begin),
                       &begin);
  const std::uint32_t tiles = data.tilesX * data.tilesY;
  dispatch(raster_.kernel(RasterKernel::Begin),
           (tiles + raster::VITRAIL_RASTER_TABLE - 1) / raster::VITRAIL_RASTER_TABLE, 1);
  if (raster_.clipPlanes == 0) return;
  vk_.CmdUpdateBuffer(commands_, raster_.buffer(RasterBuffer::Counts).buffer,
                      kRasterFrameAt + offsetof(raster::VitrailRasterFrame, clipPlanes), sizeof(data.clipPlanes),
                      data.clipPlanes);
}

void Recording::clear(const Band& band, bool isFirst) {
  constexpr VkPipelineStageFlags kStages =
      VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
  constexpr VkAccessFlags kWrites = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  const bool transfers = raster_.deepPlanned || raster_.clipPlanes > 0;
  const VkPipelineStageFlags used =
      VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | (transfers ? VkPipelineStageFlags{VK_PIPELINE_STAGE_TRANSFER_BIT} : 0);
  const VkAccessFlags written =
      VK_ACCESS_SHADER_WRITE_BIT | (transfers ? VkAccessFlags{VK_ACCESS_TRANSFER_WRITE_BIT} : 0);
  // The last frame's or band's passes read and wrote them -> they are cleared, set and made. The sizes of dispatches
  // that come before the next passBarrier() are those of a frame before, which had one.
  barrier(kStages, kWrites, used, written | VK_ACCESS_SHADER_READ_BIT);
  // Nothing of what is cleared is looked at for positions. Where the draws are new their tables come first.
  if (isFirst && raster_.keepsPositions && raster_.tablesAreMade) {
    bind(RasterSet::Geometry);
    positions();
  }
  begin(band, isFirst);
  if (raster_.deepPlanned) fill(RasterBuffer::DeepPixels);
  // The clears, the frame's data and the positions -> all passes.
  barrier(used, written, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_UNIFORM_READ_BIT);
}

// Of a frame whose draws are new: what they come to, and their positions.
void Recording::readDraws(bool isFirst) {
  if (!isFirst || raster_.tablesAreMade) return;
  bind(RasterSet::Own);
  dispatch(raster_.kernel(RasterKernel::Prepare), 1, 1);
  passBarrier();
  dispatch(raster_.kernel(RasterKernel::Tables), RasterBuffer::Start, offsetof(raster::VitrailRasterStart, tables));
  passBarrier();
  if (raster_.keepsPositions) {
    bind(RasterSet::Geometry);
    positions();
    passBarrier();
  }
}

void Recording::setUp(const Band& band) {
  bind(RasterSet::Geometry);
  dispatchDraws(raster_.setUp, raster_.start.groups, offsetof(raster::VitrailRasterStart, groups));
  // Triangles were put aside -> they are taken up; records and counts go on.
  if (raster_.context->limits.isCpu) { // where work groups that have nothing to do take longest
    passBarrier();
    dispatch(raster_.setUpMedium, RasterBuffer::Counts,
             kRasterClassesAt + offsetof(raster::VitrailRasterTileClasses, medium));
    dispatch(raster_.setUpLarge, RasterBuffer::Counts,
             kRasterClassesAt + offsetof(raster::VitrailRasterTileClasses, large));
  } else {
    plainBarrier();
    dispatch(raster_.setUpMedium, mediumGroups(), 1);
    dispatch(raster_.setUpLarge, largeGroups(), largeRows(band));
  }
  // Tiles counted their records -> they are listed; records have pages -> they are brought there.
  plainBarrier();
}

// After a turn of setting up that only counted.
void Recording::place(const Band& band) {
  bind(RasterSet::Own);
  dispatchTiles(raster_.kernel(RasterKernel::Place), band);
  // Tiles have places for what was counted, and lists are empty -> records are made.
  passBarrier();
}

void Recording::bin(const Band& band) {
  bind(RasterSet::Own);
  dispatchTiles(raster_.kernel(RasterKernel::Plan), band);
  // Records are on their pages, and tiles on lists -> they are blended, and the counts say how many.
  if (knowsTiles()) {
    plainBarrier();
  } else {
    passBarrier();
  }
}

// A work group for each tile. Where a frame before told how many there were, as many as these: not to wait for the
// sizes takes less time, and where there are more tiles now, work groups go on to them. So many that none takes long
// whatever comes.
void Recording::blend(const Band& band) {
  constexpr std::uint32_t kMostTiles = 256;
  const std::uint32_t least = raster_.tilesX() * band.tilesY() / kMostTiles + 1;
  bind(RasterSet::Blend);
  constexpr std::array<std::uint32_t, raster::VITRAIL_RASTER_CLASSES> kPipelines = {0, 1, 2, 2, 2, 3};
  for (std::uint32_t i = raster::VITRAIL_RASTER_CLASSES; i-- > 0;) { // those that take longest first
    push({i, 0, 0}, RasterSet::Blend);
    if (knowsTiles()) {
      const std::uint32_t groups = std::max(raster_.tilesOf.at(i), least);
      dispatch(raster_.blend(kPipelines.at(i)), std::min(groups, raster::VITRAIL_RASTER_ROW),
               (groups + raster::VITRAIL_RASTER_ROW - 1) / raster::VITRAIL_RASTER_ROW);
      continue;
    }
    dispatch(
        raster_.blend(kPipelines.at(i)), RasterBuffer::Counts,
        kRasterClassesAt + offsetof(raster::VitrailRasterTileClasses, of) + i * sizeof(raster::VitrailRasterDispatch));
  }
}

// Tiles that the passes before have left over: their fragments are counted, collected, sorted and blended.
void Recording::blendDeep() {
  using raster::VitrailRasterControl;
  bind(RasterSet::Own);
  // Tiles were left over -> their records are gone through. And so on from pass to pass.
  passBarrier();
  dispatch(raster_.kernel(RasterKernel::DeepCount), RasterBuffer::Counts,
           kRasterControlAt + offsetof(VitrailRasterControl, blocks));
  passBarrier();
  dispatch(raster_.kernel(RasterKernel::DeepPlace), RasterBuffer::Counts,
           kRasterControlAt + offsetof(VitrailRasterControl, deep));
  passBarrier();
  dispatch(raster_.kernel(RasterKernel::DeepFill), RasterBuffer::Counts,
           kRasterControlAt + offsetof(VitrailRasterControl, blocks));
  passBarrier();
  passed("collect");
  dispatch(raster_.kernel(RasterKernel::DeepSort), RasterBuffer::Counts,
           kRasterControlAt + offsetof(VitrailRasterControl, chunks));
  for (std::uint32_t pass = 0; pass < raster_.mergePasses; ++pass) {
    passBarrier();
    push({pass, 0, 0}, RasterSet::Own);
    dispatch(raster_.kernel(RasterKernel::DeepMerge), RasterBuffer::Counts,
             kRasterControlAt + offsetof(VitrailRasterControl, chunks));
  }
  passed("sort");
  bind(RasterSet::Blend);
  for (std::uint32_t slice = 0; slice < raster_.slices; ++slice) {
    passBarrier();
    push({slice, raster_.mergePasses % 2, slice + 1 == raster_.slices ? 1U : 0U}, RasterSet::Blend);
    dispatch(raster_.blendDeep, RasterBuffer::Counts, kRasterControlAt + offsetof(VitrailRasterControl, deep));
  }
  passed("blend deep");
}

// Keeps what the band wanted, and after the last what the frame did, for the host.
void Recording::note(bool isLast) {
  passBarrier();
  bind(RasterSet::Own);
  dispatch(raster_.kernel(RasterKernel::Note), 1, 1);
  if (!isLast) return;
  barrier(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
          VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
  const VkBufferCopy copy{kRasterTotalsAt, slotOffset() + offsetof(RasterSlot, totals),
                          sizeof(raster::VitrailRasterTotals)};
  vk_.CmdCopyBuffer(commands_, raster_.buffer(RasterBuffer::Counts).buffer, raster_.stats.buffer, 1, &copy);
  // The counters are there before the tag says so.
  barrier(VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
          VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT,
          VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT);
  const std::uint64_t tag = facts().tag;
  vk_.CmdUpdateBuffer(commands_, raster_.stats.buffer, slotOffset() + offsetof(RasterSlot, tag), sizeof(tag), &tag);
  barrier(VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
          VK_ACCESS_HOST_READ_BIT);
}

// The passes of a band, from its triangles to its pixels.
void Recording::drawBand(const Band& band, bool isFirst, bool isLast) {
  clear(band, isFirst);
  const bool empty = info_.drawCount == 0;
  if (!empty) readDraws(isFirst);
  passed("clear");
  if (!empty) {
    if (raster_.counted) {
      setUp(band);
      place(band);
    }
    setUp(band);
    passed("set up");
    bin(band);
    passed("bin");
    blend(band);
  }
  if (raster_.samples > 1) { // beside the blend, in other tiles
    bind(RasterSet::Own);
    dispatch(raster_.kernel(RasterKernel::Mean), raster_.tilesX(), band.tilesY());
  }
  passed("blend");
  if (!empty && raster_.deepPlanned) blendDeep();
  note(isLast);
}

// ---- What is asked for

// Whether the call has what it needs; logs what not.
bool isWhole(const VitrailVkRaster_T& raster, const VitrailVkRasterInfo& info) {
  const Log& log = raster.context->log;
  constexpr std::uint32_t kMostPlanes = 8;
  const auto fails = [&](const char* what) {
    log.error("vitrailVkCmdRaster: %s", what);
    return false;
  };
  if (checkNext(log, info.next, "VitrailVkRasterInfo") != VK_SUCCESS) return false;
  if (info.color == VK_NULL_HANDLE || info.depth == VK_NULL_HANDLE) return fails("color and depth are required");
  if (raster.samples > 1 && info.opaque == VK_NULL_HANDLE) return fails("of several samples opaque is required");
  if (info.drawCount > 0 && info.draws == VK_NULL_HANDLE) return fails("drawCount is not 0, and draws is null");
  if (info.drawCount > 0 && raster.indexBytes > 0 && info.indices == VK_NULL_HANDLE) {
    return fails("indices is null, and indexType says that draws have some");
  }
  if (raster.hostSets > 0 && info.sets == nullptr)
    return fails("sets is null, and the raster was made with setLayouts");
  if (info.clipPlaneCount > kMostPlanes || (info.clipPlaneCount > 0 && info.clipPlanes == nullptr)) {
    return fails("clipPlanes has at most 8 planes");
  }
  if (info.clipPlaneCount > raster.clipPlanes) {
    log.error("vitrailVkCmdRaster: clipPlaneCount %u, and setUp was compiled with a VITRAIL_CLIP_PLANES of %u",
              info.clipPlaneCount, raster.clipPlanes);
    return false;
  }
  for (const VkDeviceSize offset : {info.drawOffset, info.indexOffset, info.orderOffset, info.countOffset}) {
    if (offset % raster.offsetAlignment == 0) continue;
    log.error("vitrailVkCmdRaster: offset %llu: offsets are multiples of minStorageBufferOffsetAlignment, %llu here",
              static_cast<unsigned long long>(offset), static_cast<unsigned long long>(raster.offsetAlignment));
    return false;
  }
  return true;
}

// Starts a frame on the host's side: its number, its memory, its sets.
void beginFrame(VitrailVkRaster_T& raster, const VitrailVkRasterInfo& info, bool misused) {
  raster.leaveOpenFrame();
  if (raster.frames.any() && info.frame != 0 && info.frame < raster.frames.newest()) {
    raster.context->log.warn("frame %llu is begun after frame %llu: frame numbers rise",
                             static_cast<unsigned long long>(info.frame),
                             static_cast<unsigned long long>(raster.frames.newest()));
  }
  // Bands of an open frame may have been submitted: only the host's number says that it was dropped.
  if (raster.frames.begin(info.frame, false)) { // a second time: the first one was never submitted
    for (RetiredBuffer& retired : raster.retired) retired.use.drop(raster.frames.begun());
    raster.tablesAreMade = false; // perhaps by that one
  }
  freeRetired(raster, raster.frames.begun());
  if (info.sameDraws == VK_FALSE || info.drawCount != raster.tableDraws) raster.tablesAreMade = false;
  RasterFacts& facts = raster.facts[raster.slotOf(raster.frames.newest())];
  facts = {};
  facts.tag = ++raster.newestTag;
  facts.any = true;
  facts.frame = raster.frames.newest();
  facts.extent = raster.extent;
  facts.room = raster.room;
  facts.counted = raster.counted;
  facts.bands = raster.bands();
  facts.draws = info.drawCount;
  facts.deep = raster.deepPlanned;
  facts.mergePasses = raster.mergePasses;
  facts.slices = raster.slices;
  facts.empty = info.drawCount == 0;
  facts.bounded = info.mostLight > 0.0F && raster.blendModes == 1U << VITRAIL_BLEND_OVER;
  facts.misused = misused;
}

// Whether a call is of the newest frame: one of its later bands. Where no frame is open, one that comes too late or has
// no first band is of the frame that it names, and another's statistics stay what they are.
bool isOfNewest(const VitrailVkRaster_T& raster, const VitrailVkRasterInfo& info) {
  if (info.firstBand == 0 || !raster.frames.any()) return false;
  const std::uint64_t newest = raster.frames.newest();
  if (raster.nextBand != 0) return true;
  return info.frame != 0 ? info.frame == newest : !raster.facts[raster.slotOf(newest)].recorded;
}

} // namespace

} // namespace vitrail

extern "C" void vitrailVkCmdRaster(VkCommandBuffer commandBuffer, VitrailVkRaster raster,
                                   const VitrailVkRasterInfo* info) {
  using namespace vitrail;
  if (raster == nullptr) return;
  if (commandBuffer == VK_NULL_HANDLE || info == nullptr) {
    nullArgument(raster->context, "vitrailVkCmdRaster");
    return;
  }
  const bool whole = isWhole(*raster, *info);
  if (!isOfNewest(*raster, *info)) beginFrame(*raster, *info, !whole);
  RasterFacts& facts = raster->facts[raster->slotOf(raster->frames.newest())];
  const std::uint32_t bands = raster->bands();
  const std::uint32_t count = info->bandCount != 0 ? info->bandCount : bands - std::min(bands, info->firstBand);
  const bool goesOn = info->firstBand == 0 || (raster->frames.any() && info->firstBand == raster->nextBand);
  if (!goesOn || count == 0 || count > bands - info->firstBand) {
    raster->context->log.error("vitrailVkCmdRaster: bands %u to %llu, and the frame has %u, in order", info->firstBand,
                               static_cast<unsigned long long>(info->firstBand) + count, bands);
    facts.misused = true;
    return;
  }
  if ((info->frame != 0 && info->frame != facts.frame) || info->drawCount != facts.draws) {
    raster->context->log.error("vitrailVkCmdRaster: frame and drawCount are those of the frame's first band");
    facts.misused = true;
    return;
  }
  if (!whole) {
    facts.misused = true;
    return;
  }
  if (info->firstBand == 0) writeRasterSets(*raster, *info);
  if (info->firstBand == 0 && !raster->tablesAreMade) ++raster->tableNumber;
  facts.tables = raster->tableNumber;
  Recording recording(commandBuffer, *raster, *info);
  const std::uint32_t step = raster->bandRows * kSide;
  for (std::uint32_t i = info->firstBand; i < info->firstBand + count; ++i) {
    recording.drawBand({i * step, std::min((i + 1) * step, raster->extent.height)}, i == 0, i + 1 == bands);
  }
  facts.recorded = info->firstBand + count == bands;
  raster->nextBand = facts.recorded ? 0 : info->firstBand + count;
  raster->tablesAreMade = info->drawCount > 0;
  raster->tableDraws = info->drawCount;
}
