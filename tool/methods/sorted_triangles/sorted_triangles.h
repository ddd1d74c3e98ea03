// Every triangle of every object back to front by the distance of its centroid from the camera, across objects, blended
// by fixed function with the depth test on and depth writes off: the painter's algorithm of Newell, Newell and Sancha,
// "A solution to the hidden surface problem" (ACM 1972), on triangles and without its splitting. Neighbours in the
// sorted order that belong to one draw go together; where they do not, the material changes between two triangles.
//
// Cost: a sort of all transparent triangles on the host and an index buffer of 12 bytes a triangle written anew, once a
// frame, n log n in their number, as the pass `sort`; then a draw of the surfaces as in `unsorted`, but with a draw
// call wherever the object changes, up to one a triangle. The host keeps 36 bytes a triangle, and 12 a draw call.
//
// What it gets wrong: triangles that pass through each other or overlap in a cycle, which have no order; and a triangle
// whose centroid is nearer than another's while the part that is seen is farther, which large triangles beside small
// ones make common: splitting would mend both, at a cost that has no bound. A camera that moves makes triangles change
// places from one frame to the next: they pop.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../method.h"

namespace vitrail::tool {

class SortedTriangles final : public Method {
 public:
  // Throws GpuError.
  SortedTriangles(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "sorted-triangles"; }
  MethodNeeds needs() const override { return {.perSample = true}; }
  void draw(Frame& frame) override;
  MethodStats stats() const override;

 private:
  void addTriangles(const MethodHost& host);
  void sortTriangles(const shaders::FrameData& view);
  void writeIndices();
  void blend(Frame& frame, std::span<const SurfaceRun> runs);

  SurfacePipelines surfaces_;
  // By triangle, in the order of submission:
  std::vector<glm::vec3> centroids_;   // in the GPU's space
  std::vector<std::uint32_t> draws_;   // index into the transparent draws
  std::vector<std::uint32_t> indices_; // three each, of the draw's vertices
  // Of the present frame:
  std::vector<std::uint64_t> order_; // a key that sorts farthest first, above the triangle's number
  std::vector<SurfaceRun> runs_;
  GpuBuffer sorted_; // indices in that order
};

} // namespace vitrail::tool
