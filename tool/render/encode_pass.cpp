#include "encode_pass.h"

#include <algorithm>
#include <cstring>

#include "../gpu/barrier.h"
#include "../gpu/pipeline.h"
#include "encode_shared.h"
#include "shaders/encode.comp.h"

namespace vitrail::tool {

namespace {

// A band's offset in the buffer is a multiple of 256 bytes, the largest alignment that a device may ask for.
constexpr std::uint32_t kRowAlignment = 64;

std::uint32_t pixelBytes(Encoding encoding) { return encoding == Encoding::Srgb8 ? 4 : 8; }

} // namespace

EncodePass::EncodePass(Gpu& gpu)
    : gpu_(gpu),
      set_(gpu,
           {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, VK_SHADER_STAGE_COMPUTE_BIT}},
           "encode"),
      layout_(makePipelineLayout(gpu, {set_.layout()}, {VK_SHADER_STAGE_COMPUTE_BIT, sizeof(EncodeBand)}, "encode")),
      pipeline_(makeComputePipeline(gpu, layout_.get(), shaders::encode_comp, "encode")) {}

std::uint64_t EncodePass::rowBytes() const { return std::uint64_t{extent_.width} * pixelBytes(encoding_); }

void EncodePass::setSource(const GpuImage& color) {
  extent_ = color.info().extent;
  makeOutput();
  set_.writeImage(0, color.view(), VK_IMAGE_LAYOUT_GENERAL);
}

void EncodePass::setEncoding(Encoding encoding) {
  if (encoding == encoding_) return;
  encoding_ = encoding;
  pipeline_ = makeComputePipeline(gpu_, layout_.get(), shaders::encode_comp, "encode",
                                  {{0, static_cast<std::uint32_t>(encoding)}});
  if (extent_.width > 0) makeOutput();
}

void EncodePass::makeOutput() {
  const std::uint64_t fitting = gpu_.properties().limits.maxStorageBufferRange / rowBytes();
  bandRows_ = extent_.height;
  if (fitting < extent_.height) bandRows_ = static_cast<std::uint32_t>(fitting / kRowAlignment * kRowAlignment);
  const std::uint64_t bands = (extent_.height + bandRows_ - 1) / bandRows_;

  output_ = GpuBuffer(); // first: the old picture and the new one need not fit together
  output_ = GpuBuffer(gpu_, bands * bandRows_ * rowBytes(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::Readback,
                      "encoded picture");
  set_.writeBuffer(1, output_.get(), bandRows_ * rowBytes());
}

void EncodePass::cmdEncode(VkCommandBuffer commands) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  const VkDescriptorSet set = set_.set();
  for (std::uint32_t row = 0; row < extent_.height; row += bandRows_) {
    const EncodeBand band{extent_.width, extent_.height, row, std::min(bandRows_, extent_.height - row)};
    const std::uint64_t offset = row * rowBytes();
    const auto dynamicOffset = static_cast<std::uint32_t>(offset);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set, 1, &dynamicOffset);
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(band), &band);
    vkCmdDispatch(commands, encodeGroups(band.width), encodeGroups(band.rows), 1);
  }
  // The encoding shader writes the pixels -> the host reads them after the fence.
  cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

std::vector<std::uint8_t> EncodePass::pixels() const {
  std::vector<std::uint8_t> result(std::size_t{extent_.width} * extent_.height * 4);
  std::memcpy(result.data(), output_.mapped(), result.size());
  return result;
}

std::vector<std::uint16_t> EncodePass::deepPixels() const {
  std::vector<std::uint16_t> result(std::size_t{extent_.width} * extent_.height * 4);
  std::memcpy(result.data(), output_.mapped(), result.size() * sizeof(std::uint16_t));
  return result;
}

} // namespace vitrail::tool
