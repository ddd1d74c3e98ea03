// Every transparency method, held to what it promises. A method is a row of the table below; the tests are the same for
// all: small scenes against the library's exact picture (linked-list, by default with hdr nodes) and against the
// double-precision reference, the order of submission, and the options that it has not.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "../../tool/methods/methods.h"
#include "../../tool/scene/builtin/builtin.h"
#include "../reference/compare.h"
#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::Comparison;
using reference::Reference;
using reference::ReferenceOptions;
using reference::straightView;
using reference::unlitMaterial;

// In which scenes a method's picture is the right one. Each has what the ones before it have.
enum class Exact {
  OneLayer,      // where no pixel has more than one transparent surface
  ParallelPanes, // where an order of whole objects by distance is right
  ParallelParts, // where an order of triangles by distance is right
  Everywhere
};

struct MethodRow {
  std::string name;
  Api api = Api::Vulkan;
  Exact exact = Exact::OneLayer;
  bool orderFree = false;           // the order of submission does not change a bit
  bool orderRounds = false;         // it changes how sums are rounded, by 2/255 at most
  int twoPanes = 255;               // how far a picture of two panes, one behind the other, may be off
  std::uint32_t layers = 0;         // the --layers that the tests choose
  std::uint32_t passes = 0;         // the --passes
  bool interlock = false;           // only devices with fragment shader interlock run it
  bool severalSamples = true;       // else one sample a pixel
  std::vector<std::string> options; // that it has
  // The nodes of the linked-list that an exact picture is within 1/255 of: hdr, unless fragments end at white as those
  // of 12-byte nodes do.
  VitrailNodeFormat nodes = VITRAIL_NODE_HDR;
  bool wrongWhereSurfacesCross = false; // visibly so in `interlocked`
};

void PrintTo(const MethodRow& row, std::ostream* out) { *out << nameOf(row.api) << " " << row.name; }

// Methods that keep the nearest layers exactly: as many as all scenes below have.
MethodRow nearestLayers(const std::string& name) {
  return {.name = name,
          .exact = Exact::Everywhere,
          .orderFree = true,
          .layers = 48,
          .interlock = name == "interlock",
          .severalSamples = false,
          .options = {"--layers"},
          .nodes = VITRAIL_NODE_STANDARD};
}

const std::vector<MethodRow>& vulkanRows() {
  static const std::vector<MethodRow> kRows = {
      {.name = "linked-list",
       .exact = Exact::Everywhere,
       .orderFree = true,
       .options = {"--nodes", "--resolve", "--msaa-resolve", "--layers", "--sorting", "--memory-budget", "--peel"}},
      {.name = "tiles", .exact = Exact::Everywhere, .orderFree = true, .options = {"--memory-budget"}},
      {.name = "cpu", .exact = Exact::Everywhere, .orderFree = true, .options = {"--memory-budget", "--peel"}},
      {.name = "unsorted", .options = {}, .wrongWhereSurfacesCross = true},
      {.name = "sorted", .exact = Exact::ParallelPanes, .options = {}, .wrongWhereSurfacesCross = true},
      {.name = "sorted-triangles", .exact = Exact::ParallelParts, .options = {}, .wrongWhereSurfacesCross = true},
      {.name = "depth-peeling",
       .exact = Exact::Everywhere,
       .orderFree = true, // but for surfaces at equal depths
       .severalSamples = false,
       .options = {"--layers"}},
      {.name = "reverse-depth-peeling",
       .exact = Exact::Everywhere,
       .orderFree = true, // but for surfaces at equal depths
       .severalSamples = false,
       .options = {}},
      {.name = "dual-depth-peeling",
       .exact = Exact::Everywhere, // but for different surfaces at equal depths
       .orderFree = true,
       .severalSamples = false,
       .options = {}},
      {.name = "a-buffer",
       .exact = Exact::Everywhere,
       .orderFree = true,
       .severalSamples = false,
       .options = {},
       .nodes = VITRAIL_NODE_STANDARD},
      {.name = "stencil-routed",
       .exact = Exact::ParallelParts, // several_passes_test.cpp has the rest
       .severalSamples = false,
       .options = {}},
      {.name = "insertion",
       .exact = Exact::Everywhere,
       .orderFree = true,
       .severalSamples = false,
       .options = {},
       .nodes = VITRAIL_NODE_STANDARD},
      {.name = "weighted", .orderRounds = true, .options = {}},
      {.name = "moment", .orderRounds = true, .twoPanes = 5, .severalSamples = false, .options = {}},
      {.name = "stochastic", .orderRounds = true, .passes = 4, .options = {"--passes"}},
      nearestLayers("loop"),
      nearestLayers("loop-64"),
      nearestLayers("interlock"),
      {.name = "multi-layer",
       .exact = Exact::ParallelParts,
       .layers = 32,
       .interlock = true,
       .severalSamples = false,
       .options = {"--layers"}},
  };
  return kRows;
}

// The rows, and after them those that are there with OpenGL as well: the same promises.
const std::vector<MethodRow>& rows() {
  static const std::vector<MethodRow> kRows = [] {
    std::vector<MethodRow> rows = vulkanRows();
    for (MethodRow row : vulkanRows()) {
      if (traitsOf(row.name).makeGl == nullptr) continue;
      row.api = Api::OpenGl;
      rows.push_back(std::move(row));
    }
    return rows;
  }();
  return kRows;
}

struct TestScene {
  std::string name; // no two have the same
  Scene scene;
  RenderOptions picture;
  std::optional<float> opacity{}; // of all materials
};

TestScene straightOn(const std::string& name, Scene scene) {
  TestScene result{name, std::move(scene), {}};
  result.picture.width = 96;
  result.picture.height = 64;
  result.picture.view = straightView();
  result.picture.background.srgb = {0.3F, 0.5F, 0.8F};
  return result;
}

TestScene builtin(const std::string& name, std::optional<std::uint32_t> count = {}) {
  BuiltinOptions options;
  options.count = count;
  TestScene result{name, makeBuiltinScene(name, options), {}};
  result.picture = usualOptions(result.scene, 112, 63);
  return result;
}

TestScene onePane() {
  Scene scene;
  addRectangle(scene, {glm::vec2(-0.9F, -0.7F), glm::vec2(0.8F, 0.6F), 0.0F}, unlitMaterial({0.8F, 0.3F, 0.1F, 0.4F}));
  return straightOn("one pane", std::move(scene));
}

// Beside each other at depths of their own; one covers all that is behind it, one nearly nothing, one adds light, one
// is tinted glass.
TestScene disjointPanes() {
  Scene scene;
  const std::array<glm::vec4, 5> colors{glm::vec4(0.9F, 0.1F, 0.2F, 0.5F), glm::vec4(0.1F, 0.8F, 0.3F, 1.0F),
                                        glm::vec4(0.2F, 0.3F, 0.9F, 0.02F), glm::vec4(0.4F, 0.3F, 0.2F, 0.7F),
                                        glm::vec4(0.7F, 0.5F, 0.9F, 1.0F)};
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const float left = -1.4F + 0.57F * static_cast<float>(i);
    Material material = unlitMaterial(colors[i]);
    if (i == 3) material.blend = BlendMode::Additive;
    if (i == 4) {
      material = {};
      material.baseColor = colors[i];
      material.metallic = 0.0F;
      material.roughness = 0.6F;
      material.transmission = 0.8F;
    }
    addRectangle(scene, {glm::vec2(left, -0.8F), glm::vec2(left + 0.5F, 0.7F), i % 2 == 0 ? 3.0F : -3.0F}, material);
  }
  return straightOn("disjoint panes", std::move(scene));
}

// Opaque: one sheet before the pane and one behind it, each over a part of it.
TestScene paneBetweenSheets() {
  TestScene result = onePane();
  result.name = "a pane between sheets";
  addRectangle(result.scene, {glm::vec2(-1.2F, -0.3F), glm::vec2(0.0F, 0.9F), 4.0F},
               unlitMaterial({0.2F, 0.2F, 0.2F, 1.0F}, AlphaMode::Opaque));
  addRectangle(result.scene, {glm::vec2(-0.5F, -0.9F), glm::vec2(1.2F, 0.2F), -4.0F},
               unlitMaterial({0.9F, 0.8F, 0.1F, 1.0F}, AlphaMode::Opaque));
  return result;
}

// Panes of several depths, cut in two by an opaque sheet that all but one are behind.
TestScene occludedStack() {
  Scene scene;
  for (int i = 0; i < 6; ++i) {
    const float t = static_cast<float>((i * 5) % 6) / 5.0F; // not in the order of their depths
    addRectangle(scene, {glm::vec2(-1.3F + 0.1F * t, -0.9F), glm::vec2(1.3F, 0.9F - 0.3F * t), -5.0F + 6.0F * t},
                 unlitMaterial({t, 1.0F - t, 0.4F, 0.3F + 0.3F * t}));
  }
  addRectangle(scene, {glm::vec2(-1.5F, -1.0F), glm::vec2(0.0F, 1.0F), 0.5F},
               unlitMaterial({0.5F, 0.5F, 0.5F, 1.0F}, AlphaMode::Opaque));
  return straightOn("a stack behind a sheet", std::move(scene));
}

// One behind the other, submitted the nearer one first.
TestScene twoPanes() {
  Scene scene;
  addRectangle(scene, {glm::vec2(-0.9F, -0.7F), glm::vec2(0.8F, 0.6F), 3.0F}, unlitMaterial({0.8F, 0.3F, 0.1F, 0.6F}));
  addRectangle(scene, {glm::vec2(-0.8F, -0.8F), glm::vec2(0.9F, 0.5F), -3.0F}, unlitMaterial({0.1F, 0.9F, 0.2F, 0.8F}));
  return straightOn("two panes", std::move(scene));
}

// Glass that tints what is behind it and reflects some light, `count` sheets of it.
TestScene tintedGlass(int count) {
  TestScene result = straightOn(std::to_string(count) + " of tinted glass", {});
  for (int i = 0; i < count; ++i) {
    Material glass;
    glass.baseColor = {0.9F - 0.3F * static_cast<float>(i), 0.5F, 0.3F + 0.3F * static_cast<float>(i), 1.0F};
    glass.metallic = 0.0F;
    glass.roughness = 0.6F;
    glass.transmission = 1.0F - 0.2F * static_cast<float>(i);
    const float z = i == 0 ? 0.0F : 3.0F - 2.0F * static_cast<float>(i);
    addRectangle(result.scene, {glm::vec2(-1.0F, -0.8F + 0.2F * z), glm::vec2(1.1F, 0.6F)}, glass);
    result.scene.draws.back().transform[3].z = z;
  }
  return result;
}

// Three objects of several panes each, one behind the other in turns: an unlit one, one that adds light, and a mirrored
// tinted one.
TestScene shuffledPanes() {
  TestScene result = tintedGlass(1);
  result.name = "shuffled panes";
  addRectangle(result.scene, {glm::vec2(-1.2F, -0.7F), glm::vec2(0.9F, 0.8F)}, unlitMaterial({0.2F, 0.7F, 0.4F, 0.4F}));
  addRectangle(result.scene, {glm::vec2(-0.8F, -0.9F), glm::vec2(1.3F, 0.7F)}, unlitMaterial({0.5F, 0.1F, 0.3F, 0.5F}));
  result.scene.materials[2].blend = BlendMode::Additive;
  result.scene.draws[0].transform[0].x = -1.0F;
  for (std::size_t object = 0; object < 3; ++object) {
    Mesh& mesh = result.scene.meshes[object];
    const Mesh first = mesh;
    for (const int step : {2, 1, 3}) { // not in the order of their depths
      const auto base = static_cast<std::uint32_t>(mesh.vertexCount());
      for (Vertex vertex : first.vertices()) {
        vertex.position.z = static_cast<float>(step) + 0.3F * static_cast<float>(object);
        mesh.add(vertex);
      }
      for (const std::uint32_t index : first.indices) mesh.indices.push_back(base + index);
    }
    for (std::size_t i = 0; i < first.vertexCount(); ++i) mesh.positions[i].z = 0.3F * static_cast<float>(object);
  }
  return result;
}

// Three rectangles of which a mask cuts parts away: by the alpha of corners, by that of a texture, and of tinted glass.
// All let light through, by the opacity or the transmission. `step` is from one to the next; they come in another
// order.
TestScene maskedPanes(const std::string& name, const glm::vec3& step) {
  TestScene result = straightOn(name, {});
  Scene& scene = result.scene;
  scene.images.push_back({4, 1, {255, 90, 30, 0, 200, 90, 30, 255, 90, 200, 30, 80, 30, 90, 255, 0}});
  for (const int place : {1, 2, 0}) {
    Material material = unlitMaterial(glm::vec4(1.0F), AlphaMode::Mask);
    material.alphaCutoff = 0.45F;
    if (place == 1) material.baseColorTexture.image = 0;
    if (place == 1) material.baseColorTexture.sampler.mipmaps = false;
    if (place == 2) {
      material.unlit = false;
      material.metallic = 0.0F;
      material.roughness = 0.6F;
      material.transmission = 0.7F;
    }
    const glm::vec3 low = glm::vec3(-1.37F, -0.81F, 0.0F) + step * static_cast<float>(place);
    addRectangle(scene, {glm::vec2(low), glm::vec2(low) + glm::vec2(0.83F, 1.31F), low.z}, material);
    if (place == 1) continue;
    reference::changeVertices(scene.meshes.back(), [&](Vertex& vertex) {
      vertex.color = glm::vec4(0.3F, 0.9F, 0.2F, vertex.texCoord0.x);
      if (place == 0) vertex.color = glm::vec4(0.8F, 0.9F, 0.6F, 1.0F - vertex.texCoord0.x);
    });
  }
  result.opacity = 0.6F;
  return result;
}

// A translucent decal on an opaque sheet, `above` it. `turned`: as both lie slanting.
TestScene decal(float above, float turned) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-0.9F, -0.7F), glm::vec2(0.8F, 0.6F), 0.0F},
               unlitMaterial({0.0F, 0.0F, 1.0F, 1.0F}, AlphaMode::Opaque));
  addRectangle(scene, {glm::vec2(-0.9F, -0.7F), glm::vec2(0.8F, 0.6F), 0.0F}, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  for (Draw& draw : scene.draws) draw.transform = glm::rotate(glm::mat4(1.0F), turned, glm::vec3(1.0F, 0.3F, 0.0F));
  scene.draws.back().transform[3].z = above;
  return straightOn("a decal", std::move(scene));
}

TestScene nothingTransparent() {
  Scene scene;
  addRectangle(scene, {glm::vec2(-0.7F), glm::vec2(0.6F), 0.0F},
               unlitMaterial({0.9F, 0.6F, 0.1F, 1.0F}, AlphaMode::Opaque));
  return straightOn("nothing transparent", std::move(scene));
}

// The picture of what no transparent surface is before: the same scene without them.
TestScene withoutTransparent(const TestScene& scene) {
  TestScene result = scene;
  result.name += " without what is transparent";
  std::erase_if(result.scene.draws,
                [&](const Draw& draw) { return isTransparent(scene.scene.materials[draw.material]); });
  return result;
}

// Pixels of which a channel differs by more than `bound`, as a share of all.
double shareBeyond(const Picture& a, const Picture& b, int bound) {
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    bool differs = false;
    for (std::size_t c = i; c < i + 4; ++c) differs |= std::abs(int{a.rgba[c]} - b.rgba[c]) > bound;
    beyond += differs ? 1 : 0;
  }
  return static_cast<double>(beyond) / static_cast<double>(a.rgba.size() / 4);
}

class MethodsTest : public GpuTest, public ::testing::WithParamInterface<MethodRow> {
 protected:
  void SetUp() override {
    if (GetParam().interlock && !gpu().features().fragmentInterlock) GTEST_SKIP() << "no fragment shader interlock";
    if (GetParam().name == "loop-64" && !gpu().features().int64Atomics) GTEST_SKIP() << "no 64-bit atomics";
  }

  static RenderResult draw(const TestScene& scene, const MethodOptions& method, DrawOrder order = DrawOrder::Forward) {
    return renderOnce(gpu(), scene.scene, scene.picture, scene.opacity, order, method);
  }

  static MethodOptions options(std::uint32_t samples = 1) {
    MethodOptions result;
    result.name = GetParam().name;
    result.api = GetParam().api;
    result.samples = samples;
    result.maxLayers = GetParam().layers;
    result.passes = GetParam().passes;
    return result;
  }

  // What several rows compare with is made once in a process.
  using Key = std::tuple<std::string, std::uint32_t, VitrailNodeFormat>;

  // The library's picture.
  static const Picture& exactPicture(const TestScene& scene, std::uint32_t samples = 1) {
    static std::map<Key, Picture> known;
    const auto [entry, isNew] = known.try_emplace({scene.name, samples, GetParam().nodes});
    if (!isNew) return entry->second;
    MethodOptions exact;
    exact.nodes = GetParam().nodes;
    exact.samples = samples;
    return entry->second = draw(scene, exact).picture;
  }

  static const Reference& exactReference(const TestScene& scene, std::uint32_t samples) {
    static std::map<Key, Reference> known;
    const auto [entry, isNew] = known.try_emplace({scene.name, samples, GetParam().nodes});
    if (!isNew) return entry->second;
    ReferenceOptions same;
    same.width = scene.picture.width;
    same.height = scene.picture.height;
    same.view = scene.picture.view;
    same.background = scene.picture.background;
    same.opacity = scene.opacity;
    same.samples = samples;
    same.nodeFormat = static_cast<std::uint32_t>(GetParam().nodes);
    return entry->second = renderReference(scene.scene, same);
  }

  // The method's picture is the right one: everywhere like the library's, away from edges like the reference.
  static void expectRight(const TestScene& scene, std::uint32_t samples = 1) {
    SCOPED_TRACE(scene.name + ", " + std::to_string(samples) + " samples");
    const RenderResult result = draw(scene, options(samples));
    EXPECT_LE(largestDifference(result.picture, exactPicture(scene, samples)), 1);
    const Reference& reference = exactReference(scene, samples);
    const Comparison comparison = compare(result.picture, reference.exact, reference, 2);
    EXPECT_LE(comparison.away, 2) << comparison;
    EXPECT_TRUE(result.report.complete || GetParam().exact != Exact::Everywhere);
  }
};

// Checks of the rows that promise something; the others are checks of all.
class NearMethods : public MethodsTest {};
class PanesMethods : public MethodsTest {};
class PartsMethods : public MethodsTest {};
class ExactMethods : public MethodsTest {};
class WrongMethods : public MethodsTest {};
class OrderFreeMethods : public MethodsTest {};
class OrderRoundsMethods : public MethodsTest {};

TEST_P(MethodsTest, OneLayerIsExact) {
  expectRight(onePane());
  expectRight(disjointPanes());
  expectRight(paneBetweenSheets());
  expectRight(tintedGlass(1));
  expectRight(maskedPanes("masked panes beside each other", {0.9F, 0.1F, 1.0F}));
}

// In the very plane of what it lies on it is seen as it is a little above that.
TEST_P(MethodsTest, DecalsInTheSamePlaneAreSeen) {
  for (const std::uint32_t samples : {1U, 4U}) {
    if (samples > 1 && !GetParam().severalSamples) continue;
    for (const float turned : {0.0F, 0.5F}) {
      // Where a device cannot move samples to the middle of a pixel, that method's depths are not those of the sheet.
      if (turned > 0.0F && GetParam().name == "stencil-routed") continue;
      SCOPED_TRACE(std::to_string(samples) + " samples, turned by " + std::to_string(turned));
      const Picture in = draw(decal(0.0F, turned), options(samples)).picture;
      EXPECT_LE(largestDifference(in, draw(decal(0.25F, turned), options(samples)).picture), 1);
      const std::size_t middle = (std::size_t{32} * in.width + 48) * 4;
      EXPECT_NEAR(in.rgba[middle], 188, 2);
      EXPECT_NEAR(in.rgba[middle + 2], 188, 2);
    }
  }
}

TEST_P(NearMethods, TwoPanesAreAsNearAsSaid) {
  const TestScene scene = twoPanes();
  EXPECT_LE(largestDifference(draw(scene, options()).picture, exactPicture(scene)), GetParam().twoPanes);
}

// Masks leave two panes of a pixel at most; where they leave the nearest alone, two were cut away that are no layers.
TEST_P(PanesMethods, ParallelPanesAreExact) {
  expectRight(builtin("planes"));
  expectRight(occludedStack());
  expectRight(tintedGlass(3));
  expectRight(maskedPanes("masked panes behind each other", {0.15F, 0.1F, 1.0F}));
}

TEST_P(PartsMethods, PanesOfSeveralObjectsAreExact) { expectRight(shuffledPanes()); }

// The scene above is one that an order of objects gets wrong.
TEST_F(GpuTest, ShuffledPanesHaveNoOrderOfObjects) {
  const TestScene scene = shuffledPanes();
  MethodOptions sorted;
  sorted.name = "sorted";
  const auto picture = [&](const MethodOptions& method) {
    return renderOnce(gpu(), scene.scene, scene.picture, {}, DrawOrder::Forward, method).picture;
  };
  EXPECT_GT(shareBeyond(picture(sorted), picture({}), 16), 0.1);
}

TEST_P(ExactMethods, EverySceneIsExact) {
  expectRight(builtin("interlocked"));
  expectRight(builtin("spheres", 16)); // fewer than usual: peeling draws all of them for each layer
}

// Else the rows that promise less than they could would go unseen, and so would the README's claim.
TEST_P(WrongMethods, CrossingSurfacesLookWrong) {
  const TestScene scene = builtin("interlocked");
  EXPECT_GT(shareBeyond(draw(scene, options()).picture, exactPicture(scene), 16), 0.02);
}

// The opaque scene stands as it was drawn: without anything before it, and where it hides what is transparent.
TEST_P(MethodsTest, OpaqueSurfacesStand) {
  const TestScene nothing = nothingTransparent();
  // On the processor the colour is not rounded to 16-bit floats before it is to 8 bits.
  EXPECT_LE(largestDifference(draw(nothing, options()).picture, exactPicture(nothing)),
            GetParam().name == "cpu" ? 1 : 0);
  const TestScene stack = occludedStack();
  const Picture drawn = draw(stack, options()).picture;
  const Picture bare = draw(withoutTransparent(stack), options()).picture;
  // A part of the sheet that panes are behind, and none before.
  for (std::uint32_t y = 5; y < 11; ++y) {
    for (std::uint32_t c = 13 * 4; c < 45 * 4; ++c) {
      const std::size_t i = std::size_t{y} * drawn.width * 4 + c;
      ASSERT_EQ(drawn.rgba[i], bare.rgba[i]) << "channel " << c % 4 << " of pixel " << c / 4 << ", " << y;
    }
  }
}

TEST_P(OrderFreeMethods, SubmissionOrderDoesNotMatter) {
  for (const TestScene& scene : {builtin("interlocked"), builtin("planes"), disjointPanes()}) {
    const RenderResult forward = draw(scene, options(), DrawOrder::Forward);
    EXPECT_TRUE(draw(scene, options(), DrawOrder::Reversed).picture.rgba == forward.picture.rgba);
    EXPECT_TRUE(draw(scene, options(), DrawOrder::Shuffled).picture.rgba == forward.picture.rgba);
  }
}

// Blending adds in the order of submission, so the last bits of sums differ.
TEST_P(OrderRoundsMethods, SubmissionOrderRounds) {
  for (const TestScene& scene : {builtin("interlocked"), builtin("planes"), shuffledPanes()}) {
    const Picture forward = draw(scene, options(), DrawOrder::Forward).picture;
    EXPECT_LE(largestDifference(draw(scene, options(), DrawOrder::Reversed).picture, forward), 2);
    EXPECT_LE(largestDifference(draw(scene, options(), DrawOrder::Shuffled).picture, forward), 2);
  }
}

TEST_P(MethodsTest, RunsAreOne) {
  const TestScene scene = builtin("interlocked");
  const std::unique_ptr<Renderer> renderer = rendererOf(gpu(), scene.scene, {}, DrawOrder::Forward, options());
  const RenderResult first = renderer->render(scene.picture);
  EXPECT_TRUE(renderer->render(scene.picture).picture.rgba == first.picture.rgba);
  RenderOptions other = scene.picture; // another size in between
  other.width = 75;
  renderer->render(other);
  EXPECT_TRUE(renderer->render(scene.picture).picture.rgba == first.picture.rgba);
}

TEST_P(MethodsTest, PassesAreNamed) {
  const FrameReport report = draw(builtin("planes"), options()).report;
  EXPECT_EQ(report.method, GetParam().name);
  std::set<std::string> names;
  for (const auto& [name, milliseconds] : report.passesMs) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_GE(milliseconds, 0.0) << name;
  }
  // The processor draws opaque and transparent surfaces in one pass.
  const std::size_t others = GetParam().name == tool::kCpuMethod ? 1 : 2;
  EXPECT_TRUE(names.empty() || names.size() > others) << "opaque, encode, and nothing between them";
}

TEST_P(MethodsTest, SeveralSamplesAreRightOrRefused) {
  for (const std::uint32_t samples : {2U, 4U, 8U}) {
    if (GetParam().severalSamples) {
      if ((gpu().features().sampleCounts & samples) == 0) continue;
      if (GetParam().api == Api::OpenGl && (gl().limits().sampleCounts & samples) == 0) continue;
      expectRight(onePane(), samples);
      if (GetParam().exact >= Exact::ParallelPanes) expectRight(occludedStack(), samples);
      continue;
    }
    try {
      checkMethodOptions(options(samples));
      ADD_FAILURE() << samples << " samples are taken";
    } catch (const std::invalid_argument& error) {
      const std::string reason = error.what();
      EXPECT_NE(reason.find(GetParam().name), std::string::npos) << reason;
      EXPECT_NE(reason.find("--samples"), std::string::npos) << reason;
      EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    }
  }
}

// An option that a method has is taken; one that it has not is refused in a line that names both.
TEST_P(MethodsTest, OptionsAreTakenOrRefused) {
  using Set = std::function<void(MethodOptions&)>;
  const std::vector<std::pair<std::string, Set>> choices = {
      {"--nodes", [](MethodOptions& o) { o.nodes = VITRAIL_NODE_STANDARD; }},
      {"--resolve", [](MethodOptions& o) { o.resolve = VITRAIL_RESOLVE_FRAGMENT; }},
      {"--msaa-resolve",
       [](MethodOptions& o) {
         o.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
         if (GetParam().severalSamples) o.samples = 4;
       }},
      {"--layers", [](MethodOptions& o) { o.maxLayers = 4; }},
      {"--passes", [](MethodOptions& o) { o.passes = 4; }},
      {"--sorting", [](MethodOptions& o) { o.sorted = false; }},
      {"--memory-budget", {}},
      {"--peel", {}},
  };
  for (const auto& [name, set] : choices) {
    const auto& has = GetParam().options;
    const bool walks = name == "--sorting" || name == "--peel"; // the tool's own resolve, which OpenGL has not
    const bool taken =
        std::find(has.begin(), has.end(), name) != has.end() && !(walks && GetParam().api == Api::OpenGl);
    std::string reason;
    try {
      MethodOptions chosen = options();
      if (set) set(chosen);
      checkMethodOptions(chosen);
      checkPictureOptions(chosen, name == "--memory-budget", name == "--peel");
    } catch (const std::invalid_argument& error) {
      reason = error.what();
    }
    EXPECT_EQ(reason.empty(), taken) << name << ": " << reason;
    if (taken) continue;
    EXPECT_NE(reason.find(GetParam().name), std::string::npos) << reason;
    EXPECT_NE(reason.find(name), std::string::npos) << reason;
    EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
  }
}

TEST(MethodRows, EveryMethodHasOne) {
  std::set<std::string> tested;
  for (const MethodRow& row : rows()) tested.insert(row.name);
  const auto names = methodNames();
  EXPECT_EQ(tested, std::set<std::string>(names.begin(), names.end()));
}

std::vector<MethodRow> rowsThat(const std::function<bool(const MethodRow&)>& promise) {
  std::vector<MethodRow> result;
  std::ranges::copy_if(rows(), std::back_inserter(result), promise);
  return result;
}

std::string nameOfRow(const ::testing::TestParamInfo<MethodRow>& row) {
  std::string name = (row.param.api == Api::OpenGl ? "opengl-" : "") + row.param.name;
  std::ranges::replace(name, '-', '_');
  return name;
}

auto exactIn(Exact least) {
  return ::testing::ValuesIn(rowsThat([=](const MethodRow& row) { return row.exact >= least; }));
}

auto that(bool MethodRow::*promise) {
  return ::testing::ValuesIn(rowsThat([=](const MethodRow& row) { return row.*promise; }));
}

INSTANTIATE_TEST_SUITE_P(Methods, MethodsTest, ::testing::ValuesIn(rows()), nameOfRow);
INSTANTIATE_TEST_SUITE_P(Methods, NearMethods,
                         ::testing::ValuesIn(rowsThat([](const MethodRow& row) { return row.twoPanes < 255; })),
                         nameOfRow);
INSTANTIATE_TEST_SUITE_P(Methods, PanesMethods, exactIn(Exact::ParallelPanes), nameOfRow);
INSTANTIATE_TEST_SUITE_P(Methods, PartsMethods, exactIn(Exact::ParallelParts), nameOfRow);
INSTANTIATE_TEST_SUITE_P(Methods, ExactMethods, exactIn(Exact::Everywhere), nameOfRow);
INSTANTIATE_TEST_SUITE_P(Methods, WrongMethods, that(&MethodRow::wrongWhereSurfacesCross), nameOfRow);
INSTANTIATE_TEST_SUITE_P(Methods, OrderFreeMethods, that(&MethodRow::orderFree), nameOfRow);
INSTANTIATE_TEST_SUITE_P(Methods, OrderRoundsMethods, that(&MethodRow::orderRounds), nameOfRow);

} // namespace
} // namespace vitrail::tool::test
