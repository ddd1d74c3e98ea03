#include "upload.h"

#include <algorithm>
#include <cstring>

namespace vitrail::tool {

namespace {

// More than a row of the widest image that devices take (32768 pixels of up to 8 bytes), so that images are cut between
// rows.
constexpr std::uint64_t kStagingBytes = std::uint64_t{16} << 20U;

constexpr Access kNothing{};
constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr Access kTransferRead{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr Access kShaderSample{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                               VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};

VkImageSubresourceRange level(std::uint32_t index) { return {VK_IMAGE_ASPECT_COLOR_BIT, index, 1, 0, 1}; }

VkOffset3D corner(VkExtent2D extent, std::uint32_t mip) {
  return {static_cast<std::int32_t>(std::max(extent.width >> mip, 1U)),
          static_cast<std::int32_t>(std::max(extent.height >> mip, 1U)), 1};
}

void cmdCopyRows(VkCommandBuffer commands, VkBuffer staging, const GpuImage& image, std::uint32_t firstRow,
                 std::uint32_t rows) {
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageOffset = {0, static_cast<std::int32_t>(firstRow), 0};
  copy.imageExtent = {image.info().extent.width, rows, 1};
  vkCmdCopyBufferToImage(commands, staging, image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
}

// Fills the levels below the base one and hands all of them to fragment and compute shaders.
void cmdFillMipmaps(VkCommandBuffer commands, const GpuImage& image) {
  const std::uint32_t levels = image.info().mipLevels;
  for (std::uint32_t i = 1; i < levels; ++i) {
    // The copy or blit that wrote level i - 1 -> the blit that reads it.
    cmdImageBarrier(commands, image.get(), level(i - 1), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kTransferWrite,
                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kTransferRead);
    VkImageBlit blit{};
    blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i - 1, 0, 1};
    blit.srcOffsets[1] = corner(image.info().extent, i - 1);
    blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i, 0, 1};
    blit.dstOffsets[1] = corner(image.info().extent, i);
    vkCmdBlitImage(commands, image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image.get(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
    // The blit has read level i - 1 (its writer's data were made available before) -> shaders sample it.
    cmdImageBarrier(commands, image.get(), level(i - 1), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kTransferRead,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kShaderSample);
  }
  // The copy or blit that wrote the last level -> shaders sample it.
  cmdImageBarrier(commands, image.get(), level(levels - 1), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kTransferWrite,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kShaderSample);
}

} // namespace

Uploader::Uploader(Gpu& gpu)
    : submitter_(gpu),
      staging_(gpu, kStagingBytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryKind::Upload, "upload buffer") {}

void Uploader::toBuffer(std::span<const std::byte> data, const GpuBuffer& buffer, std::uint64_t offset,
                        const Access& reader) {
  while (!data.empty()) {
    const auto piece = data.first(std::min<std::size_t>(data.size(), kStagingBytes));
    std::memcpy(staging_.mapped(), piece.data(), piece.size());
    submitter_.run("upload", [&](VkCommandBuffer commands) {
      const VkBufferCopy copy{0, offset, piece.size()};
      vkCmdCopyBuffer(commands, staging_.get(), buffer.get(), 1, &copy);
      cmdMemoryBarrier(commands, kTransferWrite, reader); // this copy -> the caller's reader
    });
    offset += piece.size();
    data = data.subspan(piece.size());
  }
}

void Uploader::toImage(std::span<const std::byte> pixels, const GpuImage& image) {
  const VkExtent2D extent = image.info().extent;
  const std::uint64_t rowBytes =
      std::uint64_t{extent.width} * (image.info().format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 4);
  const auto rowsAtOnce = static_cast<std::uint32_t>(std::min<std::uint64_t>(kStagingBytes / rowBytes, extent.height));
  for (std::uint32_t row = 0; row < extent.height; row += rowsAtOnce) {
    const std::uint32_t rows = std::min(rowsAtOnce, extent.height - row);
    std::memcpy(staging_.mapped(), pixels.data() + row * rowBytes, rows * rowBytes);
    submitter_.run("texture upload", [&](VkCommandBuffer commands) {
      if (row == 0) {
        // A new image: nobody -> the copies and blits that write it.
        cmdImageBarrier(commands, image.get(), image.range(), VK_IMAGE_LAYOUT_UNDEFINED, kNothing,
                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kTransferWrite);
      }
      cmdCopyRows(commands, staging_.get(), image, row, rows);
      if (row + rows == extent.height) cmdFillMipmaps(commands, image);
    });
  }
}

} // namespace vitrail::tool
