#include "raster/cpu/frame.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace vitrail::raster {

void Bins::append(Bin& bin) {
  const std::uint32_t lines =
      bin.last == nullptr ? kLeastLines : std::min((bin.last->room + kLine) / kLine * 2, kMostLines);
  if (used_ + lines > kSlabLines) {
    ++slab_;
    used_ = 0;
  }
  if (slab_ == slabs_.size()) slabs_.push_back(std::make_unique_for_overwrite<Slab>());
  const std::uint32_t room = lines * kLine - static_cast<std::uint32_t>(sizeof(Chunk) / sizeof(std::uint32_t));
  auto* const chunk = new ((*slabs_[slab_])[used_].numbers.data()) Chunk{nullptr, room};
  used_ += lines;
  (bin.last == nullptr ? bin.first : bin.last->next) = chunk;
  bin.last = chunk;
  bin.room += room;
  bin.next = chunk->numbers();
  bin.end = bin.next + room;
}

void Bins::copy(std::size_t tile, std::uint32_t* to) const {
  const Chunk* chunk = bins_[tile].first;
  for (std::uint32_t left = countOf(tile); left > 0; chunk = chunk->next) {
    const std::uint32_t count = std::min(left, chunk->room);
    std::memcpy(to, chunk->numbers(), count * sizeof(std::uint32_t));
    to += count;
    left -= count;
  }
}

void TileCounts::add(const TileCounts& other) {
  fragments += other.fragments;
  pixels += other.pixels;
  layersMax = std::max(layersMax, other.layersMax);
}

ClipVertex clipVertexOf(const DrawInfo& info, std::uint32_t vertex) {
  const VitrailCpuDraw& draw = info.draw;
  const auto* bytes =
      reinterpret_cast<const unsigned char*>(draw.positions) + std::uint64_t{vertex} * draw.vertexStride;
  std::array<float, 4> p{0.0F, 0.0F, 0.0F, 1.0F};
  std::memcpy(p.data(), bytes, draw.components * sizeof(float));
  // In the order in which the vectors of placeVertices() add.
  if (const float* m = draw.model) {
    const std::array<float, 4> q = p;
    for (std::size_t row = 0; row < 3; ++row, m += 4)
      p[row] = ((m[3] * q[3] + m[2] * q[2]) + m[1] * q[1]) + m[0] * q[0];
  }
  ClipVertex made;
  made.position = p;
  if (const float* m = draw.transform) {
    for (std::size_t row = 0; row < 4; ++row, ++m) {
      made.position[row] = ((m[12] * p[3] + m[8] * p[2]) + m[4] * p[1]) + m[0] * p[0];
    }
  }
  for (std::uint32_t i = 0; i < draw.clipPlaneCount; ++i) {
    const float* plane = draw.clipPlanes + std::size_t{4} * i;
    made.distances[i] = ((plane[3] * p[3] + plane[2] * p[2]) + plane[1] * p[1]) + plane[0] * p[0];
  }
  return made;
}

Pieces piecesOf(const Frame& frame, const DrawInfo& info, std::uint32_t primitive) {
  const VitrailCpuDraw& draw = info.draw;
  const auto corner = [&](std::uint32_t corners, std::uint32_t i) {
    return clipVertexOf(info, vertexOf(draw, std::uint64_t{primitive} * corners + i));
  };
  switch (draw.topology) {
    case VITRAIL_CPU_POINTS:
      return pointOf(frame.viewport, corner(1, 0), draw.clipPlaneCount, draw.pointSize);
    case VITRAIL_CPU_LINES: {
      std::array<ClipVertex, 2> line{corner(2, 0), corner(2, 1)};
      line[1].second = 1.0F;
      return lineOf(frame.viewport, line, draw.clipPlaneCount);
    }
    default: {
      std::array<ClipVertex, 3> triangle{corner(3, 0), corner(3, 1), corner(3, 2)};
      triangle[1].second = 1.0F;
      triangle[2].third = 1.0F;
      return clipped(frame.viewport, triangle, draw.clipPlaneCount);
    }
  }
}

} // namespace vitrail::raster
