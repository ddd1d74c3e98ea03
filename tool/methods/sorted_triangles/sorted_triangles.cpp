// Every triangle of every object back to front by the distance of its centroid from the camera, across objects, blended
// by fixed function with the depth test on and depth writes off: the painter's algorithm of Newell, Newell and Sancha,
// "A solution to the hidden surface problem" (ACM 1972), on triangles and without its splitting. Neighbours in the
// sorted order that belong to one draw go together; where they do not, the material changes between two triangles.
//
// Cost: a sort of all transparent triangles on the host and an index buffer of 12 bytes a triangle written anew, once a
// frame, n log n in their number, as the pass `sort`; then a draw of the surfaces as in `unsorted`, but with a draw
// call wherever the object changes, up to one a triangle. The host keeps 44 bytes a triangle, and 20 a draw call.
//
// What it gets wrong: triangles that pass through each other or overlap in a cycle, which have no order; and a triangle
// whose centroid is nearer than another's while the part that is seen is farther, which large triangles beside small
// ones make common: splitting would mend both, at a cost that has no bound. A camera that moves makes triangles change
// places from one frame to the next: they pop.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "../method.h"
#include "../methods.h"
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

class SortedTriangles final : public Method {
 public:
  SortedTriangles(const MethodHost& host, const MethodOptions& options);

  ImageNeeds needs() const override { return {.perSample = true}; }
  void draw(Frame& frame) override;
  FrameStats stats() const override;

 private:
  void addTriangles(const MethodHost& host);
  void addObject(const Mesh& mesh, const std::vector<std::uint32_t>& indices, const glm::dmat4& place);
  void sortTriangles(const shaders::FrameData& view);
  void writeIndices();
  void blend(Frame& frame, std::span<const SurfaceRun> runs);

  SurfacePipelines surfaces_;
  // By triangle, in the order of submission:
  std::vector<glm::vec3> centroids_;   // in the GPU's space
  std::vector<std::uint32_t> parents_; // index into objects_
  std::vector<std::uint32_t> firsts_;  // index into indices_: where its own begin
  std::vector<std::uint32_t> indices_; // of the objects' vertices
  std::vector<SurfaceRun> objects_;    // the instances of the transparent draws
  // Of the present frame:
  std::vector<std::uint64_t> order_; // a key that sorts farthest first, above the triangle's number
  std::vector<SurfaceRun> runs_;
  GpuBuffer sorted_; // indices in that order
};

SortedTriangles::SortedTriangles(const MethodHost& host, const MethodOptions& options)
    : surfaces_(makeBlendedSurfaces(host, options, "sorted-triangles")) {
  addTriangles(host);
  if (indices_.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw GpuError(fmt::format("the method sorted-triangles sorts at most {} triangles, not {}: use linked-list",
                               std::numeric_limits<std::uint32_t>::max() / 3, parents_.size()));
  }
  sorted_ = GpuBuffer(host.gpu, indices_.size() * sizeof(std::uint32_t), VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                      MemoryKind::Upload, "sorted indices");
}

void SortedTriangles::addTriangles(const MethodHost& host) {
  const GpuScene& scene = host.surfaces.scene();
  for (std::uint32_t i = 0; i < scene.transparentDraws().size(); ++i) {
    const GpuDraw& draw = scene.transparentDraws()[i];
    const Mesh& mesh = host.scene.meshes[draw.mesh];
    const std::vector<std::uint32_t> indices = scene.transparentIndices(host.scene, i);
    for (std::uint32_t k = draw.firstInstance; k < draw.firstInstance + draw.instanceCount; ++k) {
      addObject(mesh, indices, glm::dmat4(scene.placeOf(host.scene, k)));
      objects_.push_back({i, 0, 0, k, 1});
    }
  }
}

// Adds the triangles of the object that comes next.
void SortedTriangles::addObject(const Mesh& mesh, const std::vector<std::uint32_t>& indices, const glm::dmat4& place) {
  const std::size_t corners = cornersOf(mesh.primitive);
  for (std::size_t first = 0; first < indices.size(); first += corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < corners; ++i) sum += glm::dvec3(mesh.positions[indices[first + i]]);
    centroids_.emplace_back(place * glm::dvec4(sum / static_cast<double>(corners), 1.0));
    parents_.push_back(static_cast<std::uint32_t>(objects_.size()));
    firsts_.push_back(static_cast<std::uint32_t>(indices_.size() + first));
  }
  indices_.insert(indices_.end(), indices.begin(), indices.end());
}

// Equal distances stay in the order of submission.
void SortedTriangles::sortTriangles(const shaders::FrameData& view) {
  order_.resize(parents_.size());
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
    const SurfaceRun& object = objects_[parents_[triangle]];
    if (runs_.empty() || runs_.back().firstInstance != object.firstInstance) {
      runs_.push_back({object.draw, written, 0, object.firstInstance, 1});
    }
    const std::uint32_t next =
        triangle + 1 < firsts_.size() ? firsts_[triangle + 1] : static_cast<std::uint32_t>(indices_.size());
    const std::uint32_t corners = next - firsts_[triangle];
    std::copy_n(&indices_[firsts_[triangle]], corners, to + written);
    runs_.back().indexCount += corners;
    written += corners;
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

FrameStats SortedTriangles::stats() const {
  FrameStats stats;
  stats.totalBytes = sorted_.size();
  return stats;
}

} // namespace

std::unique_ptr<Method> makeSortedTriangles(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<SortedTriangles>(host, options);
}

} // namespace vitrail::tool
