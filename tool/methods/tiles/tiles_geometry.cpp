#include "tiles_geometry.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>

#include <fmt/format.h>

#include "../../gpu/upload.h"
#include "../../gpu/vk.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kGeometryBindings = 15;
constexpr std::uint64_t kMostCornerBytes = 1U << 30U; // of each of two buffers
constexpr std::uint64_t kCornerShare = 16;            // and at most this part of the device's memory
constexpr std::uint32_t kCornerBytes = 16;
constexpr VkBufferUsageFlags kTableUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr Access kTableRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};

// Of the work groups of all draws, of which each has its first, that of each.
std::vector<std::uint32_t> drawsOfGroups(std::span<const shaders::TilesDraw> draws,
                                         std::uint32_t shaders::TilesDraw::*first, std::uint32_t groups) {
  std::vector<std::uint32_t> ofGroups(std::max(groups, 1U));
  for (std::uint32_t i = 0; i < draws.size() && groups > 0; ++i) {
    const std::uint32_t end = i + 1 < draws.size() ? draws[i + 1].*first : groups;
    std::fill(ofGroups.begin() + draws[i].*first, ofGroups.begin() + end, i);
  }
  return ofGroups;
}

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
  planCorners();
  listTextures(host.surfaces);
  makeTextureLayout();
  makeTextureSet();
  writeSet(host.surfaces);
}

void TilesGeometry::listDraws(const Surfaces& surfaces) {
  const GpuScene& scene = surfaces.scene();
  std::uint64_t groups = 0;
  for (const GpuDraw& draw : scene.transparentDraws()) {
    shaders::TilesDraw item{};
    const std::uint32_t kind = draw.features & shaders::FEATURE_SOLID;
    item.triangles = kind == shaders::FEATURE_LINES    ? draw.indexCount / 2 * 2
                     : kind == shaders::FEATURE_POINTS ? draw.indexCount * 2
                                                       : draw.indexCount / 3;
    if (item.triangles == 0) continue;
    item.firstGroup = static_cast<std::uint32_t>(groups);
    item.firstIndex = draw.firstIndex;
    item.firstInstance = draw.firstInstance;
    item.instances = draw.instanceCount;
    item.materialNumber = draw.material;
    item.features = draw.features;
    item.mirrored = draw.mirrored ? 1 : 0;
    const VertexPlace& place = scene.streams().place(draw.mesh);
    for (std::uint32_t i = 0; i < shaders::TILES_STREAMS; ++i) {
      item.firstWords[i] = static_cast<std::uint32_t>(place.offsets.at(i) / sizeof(std::uint32_t));
      item.vertexWords[i] = static_cast<std::uint32_t>(place.strides.at(i) / sizeof(std::uint32_t));
    }
    item.vertices = place.vertices;
    const std::uint64_t triangles = std::uint64_t{item.triangles} * item.instances;
    triangles_ += triangles;
    groups += (triangles + shaders::TILES_GROUP - 1) / shaders::TILES_GROUP;
    anyFeatures_ |= draw.features;
    allFeatures_ &= draw.features;
    list_.push_back(item);
  }
  // The primitive has 31 bits, and the number of a thread 32.
  if (triangles_ > std::numeric_limits<std::uint32_t>::max() / 2) {
    throw GpuError(
        fmt::format("the method tiles draws at most {} transparent triangles, and the model has {}: use "
                    "--method linked-list",
                    std::numeric_limits<std::uint32_t>::max() / 2, triangles_));
  }
  groups_ = static_cast<std::uint32_t>(groups);
  draws_ = static_cast<std::uint32_t>(list_.size());
  if (list_.empty()) list_.emplace_back(); // something to bind
}

// Each vertex of each instance has a place among all, unless these take too much.
void TilesGeometry::planCorners() {
  std::uint64_t groups = 0;
  for (std::uint32_t i = 0; i < draws_; ++i) {
    const std::uint64_t corners = std::uint64_t{list_[i].vertices} * list_[i].instances;
    list_[i].firstCorner = static_cast<std::uint32_t>(corners_);
    list_[i].firstCornerGroup = static_cast<std::uint32_t>(groups);
    corners_ += corners;
    groups += (corners + shaders::TILES_GROUP - 1) / shaders::TILES_GROUP;
  }
  const std::uint64_t most =
      std::min<std::uint64_t>({kMostCornerBytes, gpu_.localMemory() / kCornerShare,
                               gpu_.properties().limits.maxStorageBufferRange, gpu_.maxAllocation()});
  if (corners_ * kCornerBytes > most) corners_ = groups = 0;
  cornerGroups_ = static_cast<std::uint32_t>(groups);
}

// Textures of all draws in one table, each once.
void TilesGeometry::listTextures(const Surfaces& surfaces) {
  std::map<std::pair<VkImageView, VkSampler>, std::uint32_t> known;
  const auto numberOf = [&](const std::pair<VkImageView, VkSampler>& texture) {
    const auto [found, isNew] = known.try_emplace(texture, static_cast<std::uint32_t>(table_.size()));
    if (isNew) table_.push_back(texture);
    return found->second;
  };
  for (std::uint32_t i = 0; i < draws_; ++i) {
    shaders::TilesDraw& draw = list_[i];
    const TextureSet& sampled = surfaces.scene().sampled(draw.materialNumber);
    for (std::uint32_t slot = 0; slot < shaders::SLOT_COUNT; ++slot) {
      if ((draw.features & 1U << slot) != 0) draw.textures[slot] = numberOf(sampled.at(slot));
    }
  }
  if (table_.empty() && draws_ > 0) table_.push_back(surfaces.scene().sampled(list_[0].materialNumber)[0]);
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
  std::vector<std::array<std::uint32_t, 2>> ofInstances(std::max<std::size_t>(scene.instanceCount(), 1));
  for (std::uint32_t i = 0; i < draws_; ++i) {
    const std::uint32_t first = list_[i].firstInstance;
    for (std::uint32_t k = first; k < first + list_[i].instances; ++k) ofInstances[k] = {i, scene.sourceOf(k)};
  }
  const auto ofGroups = drawsOfGroups(list_, &shaders::TilesDraw::firstGroup, groups_);
  const auto ofCornerGroups = drawsOfGroups(list_, &shaders::TilesDraw::firstCornerGroup, cornerGroups_);
  drawBuffer_ = uploadTable(gpu_, list_, "tiles draws");
  groupDraws_ = uploadTable(gpu_, ofGroups, "tiles draws of groups");
  cornerGroupDraws_ = uploadTable(gpu_, ofCornerGroups, "tiles draws of corner groups");
  const std::uint64_t corners = std::max<std::uint64_t>(corners_, 1);
  const bool areLit = (allFeatures_ & shaders::FEATURE_UNLIT) == 0;
  cornerPlaces_ = GpuBuffer(gpu_, corners * kCornerBytes, kTableUsage, MemoryKind::Device, "tiles corners");
  cornerNormals_ =
      GpuBuffer(gpu_, (areLit ? corners : 1) * kCornerBytes, kTableUsage, MemoryKind::Device, "tiles corner normals");
  instanceDraws_ = uploadTable(gpu_, ofInstances, "tiles draws of instances");
  std::array<const GpuBuffer*, kGeometryBindings> buffers{};
  for (std::size_t i = 0; i < kStreamCount; ++i) buffers.at(i) = &scene.streams().buffer(i);
  buffers[6] = &scene.indices();
  buffers[7] = &scene.instances();
  buffers[8] = &scene.materials();
  buffers[9] = &drawBuffer_;
  buffers[10] = &instanceDraws_;
  buffers[11] = &groupDraws_;
  buffers[12] = &cornerPlaces_;
  buffers[13] = &cornerNormals_;
  buffers[14] = &cornerGroupDraws_;
  for (std::uint32_t i = 0; i < kGeometryBindings; ++i) {
    checkReach(gpu_, *buffers.at(i), i < kStreamCount ? "vertices" : i == 6 ? "indices" : "objects");
    set_.writeBuffer(i, buffers.at(i)->get(), buffers.at(i)->size());
  }
}

std::uint64_t TilesGeometry::bytes() const {
  return drawBuffer_.size() + instanceDraws_.size() + groupDraws_.size() + cornerGroupDraws_.size() +
         cornerPlaces_.size() + cornerNormals_.size();
}

} // namespace vitrail::tool
