// Copies data into the GPU's own memory through a small staging buffer, piece by piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "barrier.h"
#include "resources.h"
#include "submit.h"

namespace vitrail::tool {

class Uploader {
 public:
  explicit Uploader(Gpu& gpu);

  // Copies `data` to a buffer at `offset` and returns when it is there, visible to `reader` of later submissions.
  void toBuffer(std::span<const std::byte> data, const GpuBuffer& buffer, std::uint64_t offset, const Access& reader);

  // Copies pixels, 4 bytes each or 8 in a format of 16-bit floats, rows top to bottom without padding, to the base
  // level of an image and fills its smaller levels, each from the one above it with a linear filter: what the image's
  // format calls linear (an sRGB one averages light, not codes). Afterwards the image is in SHADER_READ_ONLY_OPTIMAL,
  // visible to fragment and compute shaders. The image has transfer source and destination usage.
  void toImage(std::span<const std::byte> pixels, const GpuImage& image);

 private:
  Submitter submitter_;
  GpuBuffer staging_;
};

} // namespace vitrail::tool
