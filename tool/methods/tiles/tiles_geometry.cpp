#include "tiles_geometry.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include <fmt/format.h>

#include "../../gpu/upload.h"
#include "../../gpu/vk.h"
#include "../shared/device_needs.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kGeometryBindings = 10;
// The lights are one more.
static_assert(kGeometryBindings + 1 + VITRAIL_VK_RASTER_STORAGE_BUFFERS <= kTilesBuffers);
constexpr std::uint64_t kMostPositionBytes = 1U << 30U; // of normals, too
constexpr std::uint64_t kPositionShare = 16;            // and at most this part of the device's memory
constexpr std::uint32_t kPositionBytes = 16;
constexpr VkBufferUsageFlags kTableUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr Access kTableRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};

template <typename Value>
GpuBuffer uploadTable(Gpu& gpu, const std::vector<Value>& values, const char* name) {
  GpuBuffer buffer(gpu, values.size() * sizeof(Value), kTableUsage, MemoryKind::Device, name);
  Uploader(gpu).toBuffer(std::as_bytes(std::span(values)), buffer, 0, kTableRead);
  return buffer;
}

void checkReach(const Gpu& gpu, const GpuBuffer& buffer, const char* what) {
  const std::uint64_t most = gpu.properties().limits.maxStorageBufferRange;
  if (buffer.size() <= most) return;
  throw GpuError(fmt::format("the {} of the model take {} MiB, and shaders of {} reach {}: use --method linked-list",
                             what, buffer.size() >> 20U, gpu.properties().deviceName, most >> 20U));
}

} // namespace

TilesGeometry::TilesGeometry(const MethodHost& host)
    : gpu_(host.gpu),
      set_(gpu_,
           std::vector(kGeometryBindings,
                       std::pair(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VkShaderStageFlags{VK_SHADER_STAGE_COMPUTE_BIT})),
           "tiles geometry") {
  listDraws(host.surfaces);
  planPositions();
  listTextures(host.surfaces);
  makeTextureLayout();
  makeTextureSet();
  writeSet(host.surfaces);
}

void TilesGeometry::listDraws(const Surfaces& surfaces) {
  const GpuScene& scene = surfaces.scene();
  for (const GpuDraw& draw : scene.transparentDraws()) {
    const std::uint32_t kind = draw.features & shaders::FEATURE_SOLID;
    const std::uint32_t triangles = kind == shaders::FEATURE_LINES    ? draw.indexCount / 2 * 2
                                    : kind == shaders::FEATURE_POINTS ? draw.indexCount * 2
                                                                      : draw.indexCount / 3;
    if (triangles == 0) continue;
    const VertexPlace& place = scene.streams().place(draw.mesh);
    VitrailVkRasterDraw item{};
    item.count = draw.indexCount;
    item.instanceCount = draw.instanceCount;
    item.firstIndex = draw.firstIndex;
    item.firstInstance = draw.firstInstance;
    item.vertexCount = place.vertices;
    if (kind == shaders::FEATURE_LINES) item.flags |= VITRAIL_VK_RASTER_LINES;
    if (kind == shaders::FEATURE_POINTS) item.flags |= VITRAIL_VK_RASTER_POINTS;
    if (draw.mirrored) item.flags |= VITRAIL_VK_RASTER_FRONT_CLOCKWISE;
    rasterList_.push_back(item);
    shaders::TilesDraw looked{};
    looked.materialNumber = draw.material;
    looked.features = draw.features;
    for (std::uint32_t i = 0; i < shaders::TILES_STREAMS; ++i) {
      looked.firstWords[i] = static_cast<std::uint32_t>(place.offsets.at(i) / sizeof(std::uint32_t));
      looked.vertexWords[i] = static_cast<std::uint32_t>(place.strides.at(i) / sizeof(std::uint32_t));
    }
    list_.push_back(looked);
    triangles_ += std::uint64_t{triangles} * draw.instanceCount;
    vertices_ += std::uint64_t{place.vertices} * draw.instanceCount;
    instances_ += draw.instanceCount;
    anyFeatures_ |= draw.features;
    allFeatures_ &= draw.features;
  }
  constexpr std::uint64_t kMost = 1U << 30U; // what the library draws at once, and what it sees of a draw
  if (triangles_ > kMost) {
    throw GpuError(
        fmt::format("the method tiles draws at most {} transparent triangles, and the model has {}: use "
                    "--method linked-list",
                    kMost, triangles_));
  }
  drawCount_ = static_cast<std::uint32_t>(list_.size());
  if (list_.empty()) { // something to bind
    list_.emplace_back();
    rasterList_.emplace_back();
  }
}

// Each vertex of each instance has a position that is kept, unless these take too much.
void TilesGeometry::planPositions() {
  const std::uint64_t most =
      std::min<std::uint64_t>({kMostPositionBytes, gpu_.localMemory() / kPositionShare,
                               gpu_.properties().limits.maxStorageBufferRange, gpu_.maxAllocation()});
  keepsPositions_ = vertices_ * kPositionBytes <= most;
}

VitrailVkRasterHints TilesGeometry::hints() const {
  return {.draws = drawCount_, .instances = instances_, .triangles = triangles_, .vertices = vertices_};
}

// Textures of all draws in one table, each once.
void TilesGeometry::listTextures(const Surfaces& surfaces) {
  std::map<std::pair<VkImageView, VkSampler>, std::uint32_t> known;
  const auto numberOf = [&](const std::pair<VkImageView, VkSampler>& texture) {
    const auto [found, isNew] = known.try_emplace(texture, static_cast<std::uint32_t>(table_.size()));
    if (isNew) table_.push_back(texture);
    return found->second;
  };
  for (std::uint32_t i = 0; i < drawCount_; ++i) {
    shaders::TilesDraw& draw = list_[i];
    const TextureSet& sampled = surfaces.scene().sampled(draw.materialNumber);
    for (std::uint32_t slot = 0; slot < shaders::SLOT_COUNT; ++slot) {
      if ((draw.features & 1U << slot) != 0) draw.textures[slot] = numberOf(sampled.at(slot));
    }
  }
  if (table_.empty() && drawCount_ > 0) table_.push_back(surfaces.scene().sampled(list_[0].materialNumber)[0]);
  textureCount_ = std::max<std::uint32_t>(static_cast<std::uint32_t>(table_.size()), 1);
  constantTextures_ = !gpu_.features().nonUniformTextures;
  const VkPhysicalDeviceLimits& limits = gpu_.properties().limits;
  const std::uint32_t most =
      constantTextures_
          ? (limits.maxPerStageDescriptorSamplers < shaders::TILES_CONSTANT_TEXTURES ? 0
                                                                                     : shaders::TILES_CONSTANT_TEXTURES)
          : std::min({limits.maxPerStageDescriptorSampledImages - 2, limits.maxPerStageDescriptorSamplers,
                      limits.maxDescriptorSetSampledImages});
  if (textureCount_ > most) {
    throw GpuError(
        fmt::format("the method tiles reaches all {} textures of transparent surfaces at once, and {} lets a "
                    "shader reach {}: use --method linked-list",
                    textureCount_, gpu_.properties().deviceName, most));
  }
}

void TilesGeometry::makeTextureLayout() {
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, texturePlaces(),
                                             VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  auto layoutInfo = vkStruct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  layoutInfo.bindingCount = 1;
  layoutInfo.pBindings = &binding;
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(gpu_.device(), &layoutInfo, nullptr, &layout), "vkCreateDescriptorSetLayout");
  textureLayout_ = {gpu_.device(), layout, vkDestroyDescriptorSetLayout};
  setDebugName(gpu_.device(), VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout, "tiles textures");
}

void TilesGeometry::makeTextureSet() {
  if (table_.empty()) return; // there is nothing to draw
  const std::uint32_t places = texturePlaces();
  VkDescriptorSetLayout layout = textureLayout_.get();
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, places};
  auto poolInfo = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
  poolInfo.maxSets = 1;
  poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(gpu_.device(), &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
  texturePool_ = {gpu_.device(), pool, vkDestroyDescriptorPool};
  setDebugName(gpu_.device(), VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool, "tiles textures");
  auto setInfo = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
  setInfo.descriptorPool = pool;
  setInfo.descriptorSetCount = 1;
  setInfo.pSetLayouts = &layout;
  check(vkAllocateDescriptorSets(gpu_.device(), &setInfo, &textureSet_), "vkAllocateDescriptorSets");
  setDebugName(gpu_.device(), VK_OBJECT_TYPE_DESCRIPTOR_SET, textureSet_, "tiles textures");
  std::vector<VkDescriptorImageInfo> images(places);
  for (std::uint32_t i = 0; i < places; ++i) { // a place that is never sampled holds something, too
    const auto& [view, sampler] = table_[std::min<std::size_t>(i, table_.size() - 1)];
    images[i] = {sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  }
  auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
  write.dstSet = textureSet_;
  write.descriptorCount = places;
  write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  write.pImageInfo = images.data();
  vkUpdateDescriptorSets(gpu_.device(), 1, &write, 0, nullptr);
}

void TilesGeometry::writeSet(const Surfaces& surfaces) {
  const GpuScene& scene = surfaces.scene();
  std::vector<std::uint32_t> orders(std::max<std::size_t>(scene.instanceCount(), 1));
  for (std::uint32_t i = 0; i < scene.instanceCount(); ++i) orders[i] = scene.sourceOf(i);
  drawBuffer_ = uploadTable(gpu_, list_, "tiles draws");
  rasterDraws_ = uploadTable(gpu_, rasterList_, "tiles raster draws");
  orders_ = uploadTable(gpu_, orders, "tiles orders");
  const bool areLit = (allFeatures_ & shaders::FEATURE_UNLIT) == 0;
  const std::uint64_t normals = keepsPositions_ && areLit ? std::max<std::uint64_t>(vertices_, 1) : 1;
  normals_ = GpuBuffer(gpu_, normals * kPositionBytes, kTableUsage, MemoryKind::Device, "tiles normals");
  std::array<const GpuBuffer*, kGeometryBindings> buffers{};
  for (std::size_t i = 0; i < kStreamCount; ++i) buffers.at(i) = &scene.streams().buffer(i);
  buffers[6] = &scene.instances();
  buffers[7] = &scene.materials();
  buffers[8] = &drawBuffer_;
  buffers[9] = &normals_;
  checkReach(gpu_, scene.indices(), "indices");
  for (std::uint32_t i = 0; i < kGeometryBindings; ++i) {
    checkReach(gpu_, *buffers.at(i), i < kStreamCount ? "vertices" : "objects");
    set_.writeBuffer(i, buffers.at(i)->get(), buffers.at(i)->size());
  }
}

std::uint64_t TilesGeometry::bytes() const {
  return drawBuffer_.size() + rasterDraws_.size() + orders_.size() + normals_.size();
}

} // namespace vitrail::tool
