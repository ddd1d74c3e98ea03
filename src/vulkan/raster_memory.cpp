// The memory of a raster: its buffers, how they follow what frames need, and the sets that name them.
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <utility>

#include "raster.h"

namespace vitrail {

namespace {

// Bindings of frame.glsl and the others in its folder.
constexpr std::uint32_t kFrameBinding = 0;
constexpr std::uint32_t kControlBinding = 1; // the parts of RasterBuffer::Counts
constexpr std::uint32_t kClassBinding = 17;
constexpr std::uint32_t kTotalBinding = 30;
constexpr std::uint32_t kDrawBinding = 20; // the host's buffers
constexpr std::uint32_t kIndexBinding = 26;
constexpr std::uint32_t kOrderBinding = 28;
constexpr std::uint32_t kCountBinding = 29;
constexpr std::uint32_t kColorBinding = 9; // and images
constexpr std::uint32_t kDepthBinding = 10;
constexpr std::uint32_t kOpaqueBinding = 18;

struct BufferKind {
  std::uint32_t binding;
  const char* name;
};

constexpr std::array<BufferKind, kRasterBuffers> kKinds = {
    BufferKind{kControlBinding, "counts"}, // and others
    {22, "start"},
    {2, "tiles"},
    {7, "lists of tiles"},
    {3, "records"},
    {4, "records astray"},
    {5, "medium triangles"},
    {19, "samples of records"},
    {6, "large triangles"},
    {8, "deep tiles"},
    {11, "pixels of deep tiles"},
    {16, "states of pixels"},
    {12, "blocks of records"},
    {13, "fragments"},
    {14, "sorted fragments"},
    {15, "chunks of fragments"},
    {21, "places of draws"},
    {23, "draws of groups"},
    {24, "draws of vertex groups"},
    {25, "instances"},
    {27, "positions"},
};

VkBufferUsageFlags usageOf(RasterBuffer which) {
  VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  switch (which) {
    case RasterBuffer::Counts:
      usage |=
          VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
      break;
    case RasterBuffer::Start:
      usage |= VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
      break;
    default:
      break;
  }
  return usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
}

// Buffers that take the place of those that a raster has.
class Replacement {
 public:
  Replacement(VitrailVkRaster_T& raster, const Log& log) : raster_(raster), log_(log) {}
  ~Replacement() {
    for (auto& [which, buffer] : made_) buffer.destroy(*raster_.context);
  }
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  // Makes one, unless the raster has it in that size, or in up to so many times that.
  void make(RasterBuffer which, std::uint64_t bytes, std::uint64_t times = 1) {
    bytes = std::max<std::uint64_t>(bytes, 16); // what is bound has a size
    const std::uint64_t has = raster_.buffer(which).size;
    if (result_ != VK_SUCCESS || (has >= bytes && has <= bytes * times)) return;
    Buffer buffer;
    result_ = buffer.create(*raster_.context, bytes, usageOf(which), 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                            raster_.debugName.c_str(), kKinds[static_cast<std::size_t>(which)].name, &log_);
    made_.emplace_back(which, buffer); // also one without memory, which is not put in place
  }

  // Puts them in place, if all could be made.
  VkResult commit() {
    if (result_ != VK_SUCCESS) return result_;
    for (auto& [which, buffer] : made_) {
      Buffer& old = raster_.buffer(which);
      if (old.buffer != VK_NULL_HANDLE) {
        RetiredBuffer retired{old, {}};
        // Also the frame before the last: that one may turn out never to have been submitted.
        if (raster_.frames.begun() > 1) retired.use.add(raster_.frames.begun() - 1);
        if (raster_.frames.any()) retired.use.add(raster_.frames.begun());
        raster_.retired.push_back(retired);
      }
      old = buffer;
    }
    made_.clear();
    return VK_SUCCESS;
  }

 private:
  VitrailVkRaster_T& raster_;
  const Log& log_;
  VkResult result_ = VK_SUCCESS;
  std::vector<std::pair<RasterBuffer, Buffer>> made_;
};

} // namespace

} // namespace vitrail

// Where memory is no matter they are no small ones. Small in bands, which are there because memory is short.
std::uint32_t VitrailVkRaster_T::leastPageBits(std::uint32_t rows) const {
  using namespace vitrail;
  constexpr std::uint64_t kOfBudget = 32;
  const std::uint64_t good = (std::uint64_t{tilesX()} * rows) << raster::VITRAIL_RASTER_GOOD_PAGE;
  const bool hasMemory = rows >= tilesY() && good * rasterRecordBytes(samples, false) <= budget / kOfBudget;
  return hasMemory ? raster::VITRAIL_RASTER_GOOD_PAGE : raster::VITRAIL_RASTER_LEAST_PAGE;
}

// At most three quarters of what there is room for, so that most tiles have no other page.
std::uint32_t VitrailVkRaster_T::pageBits() const {
  using namespace vitrail;
  if (counted) return raster::VITRAIL_RASTER_COUNTED;
  const std::uint64_t tiles = std::uint64_t{tilesX()} * bandRows;
  std::uint32_t bits = leastPageBits(bandRows);
  if (bandRows < tilesY()) return bits;
  while (bits < raster::VITRAIL_RASTER_MOST_PAGE && (tiles << (bits + 1)) / 3 * 4 <= room.records) ++bits;
  return bits;
}

namespace vitrail {

VkResult createRasterBuffers(VitrailVkRaster_T& raster) {
  Replacement made(raster, raster.context->log);
  made.make(RasterBuffer::Counts, kRasterCountBytes);
  made.make(RasterBuffer::Start, sizeof(raster::VitrailRasterStart));
  return made.commit();
}

VkResult resizeRasterRoom(VitrailVkRaster_T& raster, const RasterNeeds& room, std::uint32_t bandRows, const Log& log,
                          bool keepsTiles) {
  const std::uint64_t tiles = std::uint64_t{raster.tilesX()} * bandRows;
  Replacement made(raster, log);
  // Extents come and go: what is small is kept, where the budget has room for it.
  constexpr std::uint32_t kLarger = 4;
  RasterBounds larger = raster.bounds(bandRows);
  larger.tiles *= kLarger;
  std::uint64_t times = rasterExcess(room, larger) <= 1.0 ? kLarger : 1;
  if (keepsTiles) times = std::numeric_limits<std::uint32_t>::max();
  made.make(RasterBuffer::Tiles, tiles * kRasterTileBytes, times);
  made.make(RasterBuffer::TileList, tiles * kRasterTileListBytes, times);
  made.make(RasterBuffer::Records, room.records * kRasterRecordBytes);
  made.make(RasterBuffer::Astray, room.records * rasterAstrayBytes(raster.counted));
  made.make(RasterBuffer::Medium, room.records * rasterMediumBytes(raster.counted));
  made.make(RasterBuffer::SampleMasks, room.records * rasterMaskBytes(raster.samples));
  made.make(RasterBuffer::Large, room.large * kRasterListedBytes);
  made.make(RasterBuffer::DeepTiles, room.deep * kRasterDeepTileBytes);
  made.make(RasterBuffer::DeepPixels, room.deep * kRasterDeepPixelsBytes);
  made.make(RasterBuffer::States, room.deep * rasterStateBytes(raster.samples));
  made.make(RasterBuffer::Blocks, room.blocks * kRasterListedBytes);
  made.make(RasterBuffer::Fragments, room.fragments * kRasterFragmentBytes);
  made.make(RasterBuffer::SortedFragments, room.fragments * kRasterFragmentBytes);
  made.make(RasterBuffer::Chunks, room.chunks * kRasterListedBytes);
  const VkResult result = made.commit();
  if (result != VK_SUCCESS) return result;
  raster.room = room;
  raster.bandRows = bandRows;
  return VK_SUCCESS;
}

VkResult resizeRasterTables(VitrailVkRaster_T& raster, const RasterTables& tables, const Log& log) {
  constexpr std::uint64_t kWord = sizeof(std::uint32_t);
  const std::uint64_t most = std::max({tables.draws * sizeof(raster::VitrailRasterPlace), tables.groups * kWord,
                                       tables.vertexGroups * kWord, tables.items * kWord});
  const std::uint64_t reach = raster.reach();
  if (most > reach) {
    return log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                    "%s: a frame's draws need a table of %llu bytes, and shaders reach %llu: draw fewer "
                    "triangles or instances at once",
                    raster.debugName.c_str(), static_cast<unsigned long long>(most),
                    static_cast<unsigned long long>(reach));
  }
  if (tables.vertices * kRasterPositionBytes > reach) {
    return log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                    "%s: the positions of %llu vertices take more than the %llu bytes that shaders "
                    "reach: make the raster without the stage positions",
                    raster.debugName.c_str(), static_cast<unsigned long long>(tables.vertices),
                    static_cast<unsigned long long>(reach));
  }
  Replacement made(raster, log);
  made.make(RasterBuffer::DrawPlaces, tables.draws * sizeof(raster::VitrailRasterPlace));
  made.make(RasterBuffer::DrawOfGroup, tables.groups * kWord);
  made.make(RasterBuffer::DrawOfVertexGroup, tables.vertexGroups * kWord);
  made.make(RasterBuffer::Items, tables.items * kRasterItemBytes);
  made.make(RasterBuffer::Positions, tables.vertices * kRasterPositionBytes);
  const VkResult result = made.commit();
  if (result != VK_SUCCESS) return result;
  raster.tables = tables;
  raster.tablesAreMade = false;
  return VK_SUCCESS;
}

void freeRetired(VitrailVkRaster_T& raster, std::uint64_t place) {
  std::erase_if(raster.retired, [&](RetiredBuffer& retired) {
    if (!retired.use.isFree(place, raster.framesInFlight)) return false;
    retired.buffer.destroy(*raster.context);
    return true;
  });
}

bool hasRasterBinding(RasterSet set, std::uint32_t samples, std::uint32_t binding) {
  constexpr auto kBits = [](std::initializer_list<std::uint32_t> bindings) {
    std::uint32_t bits = 0;
    for (const std::uint32_t one : bindings) bits |= 1U << one;
    return bits;
  };
  constexpr std::uint32_t kGeometry = kBits({0, 1, 2, 3, 4, 5, 6, 17, 19, 21, 22, 23, 24, 25, 26, 27});
  constexpr std::uint32_t kBlend = kBits({0, 1, 2, 3, 7, 8, 9, 10, 11, 12, 13, 14, 16, 17, 18, 19, 21, 25, 26, 27, 28});
  if (binding == kOpaqueBinding && samples == 1) return false; // there is no such image
  const std::uint32_t has = set == RasterSet::Own ? 0xffffffffU : set == RasterSet::Geometry ? kGeometry : kBlend;
  return (has >> binding & 1U) != 0;
}

VkDescriptorType rasterBindingType(std::uint32_t binding) {
  if (binding == kFrameBinding) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  if (binding == kColorBinding) return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  if (binding == kDepthBinding || binding == kOpaqueBinding) return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

VkResult createRasterSets(VitrailVkRaster_T& raster) {
  const VitrailVkContext_T& context = *raster.context;
  const std::uint32_t count = raster.framesInFlight * static_cast<std::uint32_t>(kRasterSets);
  const std::array<VkDescriptorPoolSize, 4> sizes = {
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, count},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count * (kRasterBindings - 4)},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, count},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 * count},
  };
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = count;
  info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkResult result = context.vk.CreateDescriptorPool(context.device, &info, context.allocator, &raster.descriptors);
  raster.sets.resize(raster.framesInFlight);
  for (auto& sets : raster.sets) {
    if (result != VK_SUCCESS) break;
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = raster.descriptors;
    allocate.descriptorSetCount = static_cast<std::uint32_t>(kRasterSets);
    allocate.pSetLayouts = raster.setLayouts.data();
    result = context.vk.AllocateDescriptorSets(context.device, &allocate, sets.data());
    if (result != VK_SUCCESS) break;
    for (const VkDescriptorSet set : sets) context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET, set, raster.debugName.c_str());
  }
  if (result != VK_SUCCESS) return context.log.fail(result, "%s: no descriptor sets", raster.debugName.c_str());
  return VK_SUCCESS;
}

void writeRasterSets(VitrailVkRaster_T& raster, const VitrailVkRasterInfo& info) {
  std::array<VkDescriptorBufferInfo, kRasterBindings> buffers{};
  std::array<VkDescriptorImageInfo, kRasterBindings> images{};
  for (std::size_t i = 0; i < kRasterBuffers; ++i) {
    buffers[kKinds[i].binding] = {raster.buffers[i].buffer, 0, VK_WHOLE_SIZE};
  }
  const VkBuffer counts = raster.buffer(RasterBuffer::Counts).buffer;
  buffers[kControlBinding] = {counts, kRasterControlAt, sizeof(raster::VitrailRasterControl)};
  buffers[kClassBinding] = {counts, kRasterClassesAt, sizeof(raster::VitrailRasterTileClasses)};
  // Without the clip planes, which no shader writes.
  buffers[kTotalBinding] = {counts, kRasterTotalsAt,
                            kRasterFrameAt + offsetof(raster::VitrailRasterFrame, clipPlanes) - kRasterTotalsAt};
  buffers[kFrameBinding] = {counts, kRasterFrameAt, sizeof(raster::VitrailRasterFrame)};
  // What the host leaves out shaders name all the same, and nobody looks at it.
  const VkDescriptorBufferInfo nothing{raster.buffer(RasterBuffer::Start).buffer, 0, VK_WHOLE_SIZE};
  const auto addHost = [&](std::uint32_t binding, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size) {
    buffers[binding] = buffer != VK_NULL_HANDLE ? VkDescriptorBufferInfo{buffer, offset, size} : nothing;
  };
  addHost(kDrawBinding, info.drawCount > 0 ? info.draws : VK_NULL_HANDLE, info.drawOffset,
          info.drawCount * sizeof(VitrailVkRasterDraw));
  addHost(kIndexBinding, info.indices, info.indexOffset, VK_WHOLE_SIZE);
  addHost(kOrderBinding, info.orders, info.orderOffset, VK_WHOLE_SIZE);
  addHost(kCountBinding, info.countBuffer, info.countOffset, sizeof(std::uint32_t));
  images[kColorBinding] = {VK_NULL_HANDLE, info.color, VK_IMAGE_LAYOUT_GENERAL};
  images[kDepthBinding] = {VK_NULL_HANDLE, info.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
  images[kOpaqueBinding] = {VK_NULL_HANDLE, info.opaque, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  std::array<VkWriteDescriptorSet, kRasterSets * kRasterBindings> writes{};
  std::uint32_t count = 0;
  for (std::size_t s = 0; s < kRasterSets; ++s) {
    for (std::uint32_t i = 0; i < kRasterBindings; ++i) {
      if (!hasRasterBinding(static_cast<RasterSet>(s), raster.samples, i)) continue;
      VkWriteDescriptorSet& write = writes[count++];
      write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
      write.dstSet = raster.frameSets()[s];
      write.dstBinding = i;
      write.descriptorCount = 1;
      write.descriptorType = rasterBindingType(i);
      write.pBufferInfo = &buffers[i];
      write.pImageInfo = &images[i];
    }
  }
  raster.context->vk.UpdateDescriptorSets(raster.context->device, count, writes.data(), 0, nullptr);
}

} // namespace vitrail
