#include "raster_host.h"

#include <cstring>
#include <string>

#include "shaders/raster_test_0_one.h"
#include "shaders/raster_test_0_several.h"
#include "shaders/raster_test_1_one.h"
#include "shaders/raster_test_1_several.h"
#include "shaders/raster_test_2_one.h"
#include "shaders/raster_test_2_several.h"
#include "shaders/raster_test_3_one.h"
#include "shaders/raster_test_3_several.h"
#include "shaders/raster_test_3_two.h"
#include "shaders/raster_test_4_one.h"
#include "shaders/raster_test_4_several.h"
#include "shaders/raster_test_4_two.h"

namespace vitrail::tests::vulkan {

namespace {

constexpr VkFormat kColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr Access kClear{VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr Access kShaderRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
constexpr Access kShaderWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};

template <std::size_t N>
VitrailVkRasterStage stage(const std::uint32_t (&code)[N]) {
  return {code, sizeof(code), nullptr};
}

template <typename Value>
Buffer upload(const Device& device, const std::vector<Value>& values) {
  Buffer buffer(device, values.size() * sizeof(Value), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::Host);
  if (!values.empty()) std::memcpy(buffer.mapped(), values.data(), values.size() * sizeof(Value));
  return buffer;
}

Owned<VkDescriptorSetLayout> makeHostLayout(const Device& device) {
  std::array<VkDescriptorSetLayoutBinding, 3> bindings{};
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    bindings.at(i) = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  }
  auto info = zeroed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  return make(device, vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout, info);
}

Owned<VkDescriptorPool> makeRasterPool(const Device& device) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 3};
  auto info = zeroed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
  info.maxSets = 1;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  return make(device, vkCreateDescriptorPool, vkDestroyDescriptorPool, info);
}

} // namespace

VitrailVkRasterDesc RasterHost::descOf(const RasterHostDesc& desc, VkDescriptorSetLayout layout) {
  static VkDescriptorSetLayout layouts[1]; // pointed to
  layouts[0] = layout;
  const bool several = desc.samples > 1;
  VitrailVkRasterDesc raster{};
  raster.extent = {desc.width, desc.height};
  raster.samples = static_cast<VkSampleCountFlagBits>(desc.samples);
  raster.colorFormat = kColorFormat;
  raster.depthOrder = desc.depthOrder;
  raster.setLayoutCount = 1;
  raster.setLayouts = layouts;
  if (desc.keepsPositions) {
    raster.positions = several ? stage(shaders::raster_test_0_several) : stage(shaders::raster_test_0_one);
  }
  raster.setUp = several ? stage(shaders::raster_test_1_several) : stage(shaders::raster_test_1_one);
  raster.setUpLarge = several ? stage(shaders::raster_test_2_several) : stage(shaders::raster_test_2_one);
  raster.blend = several ? stage(shaders::raster_test_3_several) : stage(shaders::raster_test_3_one);
  raster.blendDeep = several ? stage(shaders::raster_test_4_several) : stage(shaders::raster_test_4_one);
  if (desc.shadesTwice) {
    raster.blend = stage(shaders::raster_test_3_two);
    raster.blendDeep = stage(shaders::raster_test_4_two);
  }
  raster.indexType = desc.indexType;
  raster.blendModes = desc.blendModes;
  raster.solids = desc.solids ? VK_TRUE : VK_FALSE;
  raster.memoryBudget = desc.memoryBudget;
  raster.hints = desc.hints;
  raster.framesInFlight = desc.framesInFlight;
  return raster;
}

RasterHost::RasterHost(const RasterHostDesc& desc)
    : desc_(desc),
      device_(backend().device()),
      commands_(device_),
      layout_(makeHostLayout(device_)),
      pool_(makeRasterPool(device_)),
      color_(device_, {desc.width, desc.height}, kColorFormat, VK_SAMPLE_COUNT_1_BIT,
             VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT),
      depth_(
          device_, {desc.width, desc.height}, VK_FORMAT_D32_SFLOAT, static_cast<VkSampleCountFlagBits>(desc.samples),
          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT),
      readback_(device_, VkDeviceSize{16} * desc.width * desc.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::Host) {
  if (desc.samples > 1) {
    opaque_ = Image(device_, {desc.width, desc.height}, kColorFormat, static_cast<VkSampleCountFlagBits>(desc.samples),
                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  }
  auto info = zeroed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
  VkDescriptorSetLayout layout = layout_.get();
  info.descriptorPool = pool_.get();
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  check(vkAllocateDescriptorSets(device_.get(), &info, &set_), "vkAllocateDescriptorSets");
  const Context& context = desc.context != nullptr ? *desc.context : backend().context(backend().allFeatures());
  check(vitrail::vulkan::Raster::create(context, descOf(desc, layout), raster_), "vitrailVkCreateRaster");
  info_.sets = &set_;
  info_.color = color_.view();
  info_.depth = depth_.sampledView();
  info_.opaque = desc.samples > 1 ? opaque_.view() : VK_NULL_HANDLE;
}

void RasterHost::setScene(const RasterScene& scene) {
  scene_ = scene;
  vertices_ = upload(device_, scene.vertices);
  colors_ = upload(device_, scene.colors);
  shifts_ = upload(device_, scene.shifts.empty() ? std::vector<Vec4>{Vec4{}} : scene.shifts);
  draws_ = upload(device_, scene.draws);
  orders_ = upload(device_, scene.orders);
  if (desc_.indexType == VK_INDEX_TYPE_UINT16) {
    std::vector<std::uint16_t> words(scene.indices.begin(), scene.indices.end());
    words.resize((words.size() + 1) / 2 * 2); // whole words
    indices_ = upload(device_, words);
  } else {
    indices_ = upload(device_, scene.indices);
  }
  info_.draws = draws_.get();
  info_.drawCount = static_cast<std::uint32_t>(scene.draws.size());
  info_.indices = desc_.indexType == VK_INDEX_TYPE_NONE_KHR ? VK_NULL_HANDLE : indices_.get();
  info_.orders = scene.orders.empty() ? VK_NULL_HANDLE : orders_.get();
  writeSet();
}

void RasterHost::writeSet() {
  const std::array<VkDescriptorBufferInfo, 3> buffers{VkDescriptorBufferInfo{vertices_.get(), 0, VK_WHOLE_SIZE},
                                                      VkDescriptorBufferInfo{colors_.get(), 0, VK_WHOLE_SIZE},
                                                      VkDescriptorBufferInfo{shifts_.get(), 0, VK_WHOLE_SIZE}};
  auto write = zeroed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
  write.dstSet = set_;
  write.descriptorCount = static_cast<std::uint32_t>(buffers.size());
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = buffers.data();
  vkUpdateDescriptorSets(device_.get(), 1, &write, 0, nullptr);
}

void RasterHost::record(VkCommandBuffer commands) { raster_.draw(commands, info_); }

void RasterHost::recordMore(VkCommandBuffer commands) {
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kShaderWrite);
  record(commands);
  copyPicture(commands);
}

void RasterHost::recordAll(VkCommandBuffer commands) {
  const bool nearestIsZero = desc_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ZERO;
  VkClearColorValue color{};
  std::memcpy(color.float32, scene_.behind.data(), sizeof(color.float32));
  const VkClearDepthStencilValue depth{scene_.opaqueDepth.value_or(nearestIsZero ? 1.0F : 0.0F), 0};
  const VkImageSubresourceRange colors{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  const VkImageSubresourceRange depths{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
  for (Image* image : {&color_, &opaque_}) {
    if (!*image) continue;
    image->cmdUse(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kClear);
    vkCmdClearColorImage(commands, image->get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1, &colors);
  }
  depth_.cmdUse(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kClear);
  vkCmdClearDepthStencilImage(commands, depth_.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &depth, 1, &depths);
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kShaderWrite);
  depth_.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, kShaderRead);
  if (opaque_) opaque_.cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kShaderRead);
  record(commands);
  copyPicture(commands);
}

void RasterHost::copyPicture(VkCommandBuffer commands) {
  color_.cmdUse(commands, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kCopyRead);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {desc_.width, desc_.height, 1};
  vkCmdCopyImageToBuffer(commands, color_.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, readback_.get(), 1, &region);
  cmdBarrier(commands, kCopyWrite, kHostAccess);
}

void RasterHost::readPicture() {
  const auto* pixels = static_cast<const float*>(readback_.mapped());
  picture_.assign(pixels, pixels + std::size_t{4} * desc_.width * desc_.height);
}

const std::vector<float>& RasterHost::drawOnce() {
  commands_.run([this](VkCommandBuffer commands) { recordAll(commands); });
  readPicture();
  return picture_;
}

const std::vector<float>& RasterHost::draw(int most) {
  for (int i = 0; i < most; ++i) {
    drawOnce();
    if (stats().exact == VK_TRUE) return picture_;
    check(raster_.update(), "vitrailVkUpdateRaster");
  }
  throw HostError("the picture is not exact after " + std::to_string(most) + " frames");
}

VitrailVkRasterStats RasterHost::stats() {
  VitrailVkRasterStats stats{};
  check(raster_.readStats(0, stats), "vitrailVkReadRasterStats");
  return stats;
}

Vec4 RasterHost::at(std::uint32_t x, std::uint32_t y) const {
  Vec4 color{};
  std::memcpy(color.data(), picture_.data() + std::size_t{4} * (y * desc_.width + x), sizeof(color));
  return color;
}

} // namespace vitrail::tests::vulkan
