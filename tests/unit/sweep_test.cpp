// What the steps of `vitrail bench --sweep` are, and scenes of more triangles that show the same.
#include <gtest/gtest.h>

#include "bench/sweep.h"
#include "scene/builtin/builtin.h"
#include "scene/split.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

SweepStart startOn(bool isSlow) {
  SweepStart start;
  start.isSlow = isSlow;
  start.width = 320;
  start.height = 180;
  start.samples = 4;
  start.triangles = 10'000;
  return start;
}

std::vector<std::string> labelsOf(SweepKind kind, const SweepStart& start) {
  std::vector<std::string> labels;
  double before = 0.0;
  for (const SweepStep& step : planSweep(kind, start)) {
    const SweepPlace place = placeOf(kind, step, start.triangles << (2 * step.splits));
    EXPECT_GT(place.value, before); // they grow
    EXPECT_EQ(place.kind, kind);
    before = place.value;
    labels.push_back(place.label);
  }
  return labels;
}

using Labels = std::vector<std::string>;

TEST(Sweep, StepsByHand) {
  EXPECT_EQ(labelsOf(SweepKind::Layers, startOn(false)), (Labels{"1", "2", "4", "8", "16", "32", "64"}));
  EXPECT_EQ(labelsOf(SweepKind::Layers, startOn(true)), (Labels{"1", "2", "4", "8", "16", "32"}));
  EXPECT_EQ(labelsOf(SweepKind::Triangles, startOn(false)), (Labels{"10 k", "40 k", "160 k", "640 k", "2.6 M"}));
  EXPECT_EQ(labelsOf(SweepKind::Triangles, startOn(true)), (Labels{"10 k", "40 k", "160 k"}));
  EXPECT_EQ(labelsOf(SweepKind::Resolution, startOn(false)),
            (Labels{"320x180", "640x360", "1280x720", "1920x1080", "3840x2160"}));
  EXPECT_EQ(labelsOf(SweepKind::Resolution, startOn(true)), (Labels{"160x90", "320x180", "640x360", "960x540"}));
  EXPECT_EQ(labelsOf(SweepKind::Samples, startOn(true)), (Labels{"1", "2", "4", "8"}));
  EXPECT_EQ(labelsOf(SweepKind::Cap, startOn(false)), (Labels{"8", "16", "32"}));
  SweepStart start = startOn(true);
  start.caps = {2, 5};
  EXPECT_EQ(labelsOf(SweepKind::Cap, start), (Labels{"2", "5"}));
}

// A setting has one name at all steps.
TEST(Sweep, NamesOfSettingsLeaveTheStepOut) {
  MethodOptions options;
  options.samples = 4;
  options.maxLayers = 16;
  EXPECT_EQ(withoutStep(options, SweepKind::Layers), options);
  EXPECT_EQ(withoutStep(options, SweepKind::Cap).maxLayers, 0U);
  EXPECT_EQ(withoutStep(options, SweepKind::Cap).samples, 4U);
  EXPECT_EQ(withoutStep(options, SweepKind::Samples).samples, 1U);
}

// A step differs from the others in what is swept and in nothing else.
TEST(Sweep, AllElseStays) {
  for (const SweepKind kind : kSweepKinds) {
    for (const SweepStep& step : planSweep(kind, startOn(false))) {
      EXPECT_EQ(step.panes.has_value(), kind == SweepKind::Layers);
      if (kind != SweepKind::Triangles) {
        EXPECT_EQ(step.splits, 0U);
      }
      if (kind != SweepKind::Resolution) {
        EXPECT_EQ(step.width * 1000 + step.height, 320'180U);
      }
      EXPECT_EQ(step.cap > 0, kind == SweepKind::Cap);
      if (kind != SweepKind::Samples) {
        EXPECT_EQ(step.samples, 4U);
      }
    }
  }
}

TEST(Sweep, AModelOfManyTrianglesHasOneStep) {
  SweepStart start = startOn(false);
  start.triangles = 9'000'000;
  EXPECT_EQ(planSweep(SweepKind::Triangles, start).size(), 1U);
  start.triangles = 0;
  EXPECT_EQ(planSweep(SweepKind::Triangles, start).size(), 1U);
}

TEST(Sweep, Names) {
  for (const SweepKind kind : kSweepKinds) EXPECT_EQ(sweepNamed(nameOf(kind)), kind);
  EXPECT_FALSE(sweepNamed("layer").has_value());
}

double areaOf(const Mesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i]];
    const glm::vec3 b = mesh.positions[mesh.indices[i + 1]];
    const glm::vec3 c = mesh.positions[mesh.indices[i + 2]];
    area += 0.5 * static_cast<double>(glm::length(glm::cross(b - a, c - a)));
  }
  return area;
}

TEST(SplitTriangles, AreFourTimesAsManyOfTheSameSurface) {
  const Scene scene = makeBuiltinScene("spheres", {3, 1});
  const Scene split = splitTriangles(scene, 2);
  EXPECT_EQ(triangleCount(split), 16 * triangleCount(scene));
  EXPECT_NEAR(areaOf(split.meshes[0]), areaOf(scene.meshes[0]), 1e-4 * areaOf(scene.meshes[0]));
  for (const Vertex& vertex : split.meshes[0].vertices()) {
    EXPECT_NEAR(glm::length(vertex.normal), 1.0F, 1e-5F);
    EXPECT_NEAR(glm::length(glm::vec3(vertex.tangent)), 1.0F, 1e-5F);
    EXPECT_GT(glm::dot(vertex.normal, glm::normalize(vertex.position)), 0.99F); // outwards still
  }
  for (const std::uint32_t index : split.meshes[0].indices) ASSERT_LT(index, split.meshes[0].vertexCount());
}

TEST(SplitTriangles, OneTriangleByHand) {
  Scene scene;
  scene.meshes.resize(1);
  std::array<Vertex, 4> corners;
  corners[1].position = {2.0F, 0.0F, 0.0F};
  corners[2].position = {2.0F, 2.0F, 0.0F};
  corners[2].color = {0.0F, 0.5F, 1.0F, 0.0F};
  corners[3].position = {0.0F, 2.0F, 0.0F};
  for (const Vertex& corner : corners) scene.meshes[0].add(corner);
  scene.meshes[0].indices = {0, 1, 2, 0, 2, 3};
  const Mesh split = splitTriangles(scene, 1).meshes[0];
  EXPECT_EQ(split.indices.size(), 24U);
  EXPECT_EQ(split.vertexCount(), 9U); // 4, and the middles of 5 edges: the diagonal's is shared
  EXPECT_EQ(split.vertex(5).position, glm::vec3(2.0F, 1.0F, 0.0F));
  EXPECT_EQ(split.vertex(5).color, glm::vec4(0.5F, 0.75F, 1.0F, 0.5F));
  for (std::size_t i = 0; i < split.indices.size(); i += 3) { // none is turned around
    const glm::vec3 a = split.positions[split.indices[i]];
    const glm::vec3 b = split.positions[split.indices[i + 1]];
    const glm::vec3 c = split.positions[split.indices[i + 2]];
    EXPECT_GT(glm::cross(b - a, c - a).z, 0.0F);
  }
}

} // namespace
} // namespace vitrail::tests
