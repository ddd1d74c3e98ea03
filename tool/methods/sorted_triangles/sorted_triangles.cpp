#include "sorted_triangles.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <fmt/format.h>

#include "../shared/camera_distance.h"
#include "../shared/fixed_blending.h"
#include "../shared/host_clock.h"

namespace vitrail::tool {

namespace {

// In one submission: each takes a few hundred bytes of the driver's memory, and there may be as many as triangles.
constexpr std::size_t kMostRuns = std::size_t{1} << 16U;

// Bits that rise where the distance falls.
std::uint32_t farthestFirst(float distance) {
  const auto bits = std::bit_cast<std::uint32_t>(distance);
  constexpr std::uint32_t kSign = 0x80000000U;
  const std::uint32_t rising = (bits & kSign) != 0 ? ~bits : bits | kSign;
  return ~rising;
}

} // namespace

SortedTriangles::SortedTriangles(const MethodHost& host, const MethodOptions& options)
    : surfaces_(makeBlendedSurfaces(host, options, "sorted-triangles")) {
  addTriangles(host);
  if (indices_.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw GpuError(fmt::format("the method sorted-triangles sorts at most {} triangles, not {}: use linked-list",
                               std::numeric_limits<std::uint32_t>::max() / 3, draws_.size()));
  }
  sorted_ = GpuBuffer(host.gpu, indices_.size() * sizeof(std::uint32_t), VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                      MemoryKind::Upload, "sorted indices");
}

void SortedTriangles::addTriangles(const MethodHost& host) {
  const GpuScene& scene = host.surfaces.scene();
  for (std::uint32_t i = 0; i < scene.transparentDraws().size(); ++i) {
    const Mesh& mesh = host.scene.meshes[host.scene.draws[scene.transparentDraws()[i].source].mesh];
    const std::vector<std::uint32_t> indices = scene.transparentIndices(host.scene, i);
    const glm::dmat4 model(scene.transparentBoxes()[i].model);
    for (std::size_t first = 0; first < indices.size(); first += 3) {
      glm::dvec3 sum(0.0);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        sum += glm::dvec3(mesh.vertices[indices[first + corner]].position);
      }
      centroids_.emplace_back(model * glm::dvec4(sum / 3.0, 1.0));
      draws_.push_back(i);
    }
    indices_.insert(indices_.end(), indices.begin(), indices.end());
  }
}

// Equal distances stay in the order of submission.
void SortedTriangles::sortTriangles(const shaders::FrameData& view) {
  order_.resize(draws_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto distance = static_cast<float>(distanceFromCamera(view, centroids_[i]));
    order_[i] = std::uint64_t{farthestFirst(distance)} << 32U | i;
  }
  std::ranges::sort(order_);
}

void SortedTriangles::writeIndices() {
  runs_.clear();
  auto* to = static_cast<std::uint32_t*>(sorted_.mapped());
  std::uint32_t written = 0;
  for (const std::uint64_t key : order_) {
    const auto triangle = static_cast<std::uint32_t>(key);
    if (runs_.empty() || runs_.back().draw != draws_[triangle]) runs_.push_back({draws_[triangle], written, 0});
    std::copy_n(&indices_[std::size_t{triangle} * 3], 3, to + written);
    runs_.back().indexCount += 3;
    written += 3;
  }
}

void SortedTriangles::draw(Frame& frame) {
  const HostClock clock;
  sortTriangles(frame.surfaces().view());
  writeIndices();
  frame.addHostPass("sort", clock.milliseconds());
  for (std::size_t first = 0; first == 0 || first < runs_.size(); first += kMostRuns) {
    if (first > 0) frame.submitAndWait();
    blend(frame, std::span(runs_).subspan(first, std::min(kMostRuns, runs_.size() - first)));
  }
}

void SortedTriangles::blend(Frame& frame, std::span<const SurfaceRun> runs) {
  cmdBeginBlending(frame);
  frame.drawSurfaces(surfaces_, VK_NULL_HANDLE, runs, sorted_.get());
  vkCmdEndRendering(frame.commands());
  frame.endPass("blend");
}

MethodStats SortedTriangles::stats() const {
  MethodStats stats;
  stats.counted = false;
  stats.totalBytes = sorted_.size();
  return stats;
}

} // namespace vitrail::tool
