// Light through objects that absorb it (docs/shading.md, "Volume"): what passes follows from lengths alone. A glass
// also reflects, so that each picture is taken over white and over black: white adds exp(-absorption * length) to
// black.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "../../tool/scene/builtin/shapes.h"
#include "../reference/compare.h"
#include "../reference/shading.h"
#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::Comparison;
using reference::decodeSrgb;
using reference::encodeSrgb;
using reference::quantize8;
using reference::Reference;
using reference::ReferenceOptions;
using reference::straightView;
using reference::unlitMaterial;
using reference::wideView;

constexpr std::uint32_t kSide = 17; // pixels of a picture: there is one in its very middle

const glm::vec3 kGreen(0.25F, 0.8F, 0.4F);
const glm::vec3 kAmber(0.9F, 0.6F, 0.2F);

// Clear glass of which `color` is left after 1.
Material glass(const glm::vec3& color, float thickness = 1.0F) {
  Material material;
  material.metallic = 0.0F;
  material.transmission = 1.0F;
  material.thickness = thickness;
  material.attenuationDistance = 1.0F;
  material.attenuationColor = color;
  return material;
}

// A box without vertex normals, whose 8 corners its triangles share.
Mesh box(const glm::vec3& low, const glm::vec3& high) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y,
                                (i & 4U) != 0 ? high.z : low.z);
  }
  mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 4, 6, 0, 6, 2,
                  1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3};
  return mesh;
}

void add(Scene& scene, Mesh mesh, const Material& material, const glm::mat4& place = glm::mat4(1.0F)) {
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(material);
  scene.draws.push_back({static_cast<std::uint32_t>(scene.meshes.size() - 1),
                         static_cast<std::uint32_t>(scene.materials.size() - 1), place});
}

// A box over the whole picture of straightView() between two heights.
Mesh slab(float low, float high) { return box({-3.0F, -3.0F, low}, {3.0F, 3.0F, high}); }

glm::dvec3 left(const glm::vec3& color, double length) { return glm::pow(glm::dvec3(color), glm::dvec3(length)); }

constexpr std::array<DrawOrder, 3> kVolumeOrders{DrawOrder::Forward, DrawOrder::Reversed, DrawOrder::Shuffled};

class VolumeTest : public GpuTest {
 protected:
  using Make = std::function<Scene(const glm::vec3& behind)>; // a scene before a background, or something of its own

  RenderOptions pictureOf(const View& view, const glm::vec3& background) const {
    RenderOptions options;
    options.width = kSide;
    options.height = kSide;
    options.view = view;
    options.background.srgb = background;
    return options;
  }

  std::array<int, 3> middle(const Picture& picture) const {
    const std::size_t at = (std::size_t{kSide} * (kSide / 2) + kSide / 2) * 4;
    return {picture.rgba[at], picture.rgba[at + 1], picture.rgba[at + 2]};
  }

  std::vector<MethodOptions> ways() {
    std::vector<MethodOptions> ways(2);
    ways[1].nodes = VITRAIL_NODE_STANDARD;
    ways[1].listBuild = VITRAIL_LIST_BUILD_COMPUTE;
    if ((gpu().features().sampleCounts & 4U) != 0) ways.emplace_back().samples = 4;
    return ways;
  }

  // In the middle, `share` of the light behind passes.
  void expectPasses(const Make& make, const View& view, const glm::dvec3& share) {
    for (const MethodOptions& method : ways()) {
      SCOPED_TRACE(describe(method));
      const std::array<int, 3> dark = middleOf(make(kBlack), view, kBlack, DrawOrder::Forward, method);
      for (const DrawOrder order : ordersOf(method)) {
        expectBrighter(dark, middleOf(make(kWhite), view, kWhite, order, method), share);
      }
    }
  }

  void expectPasses(const Scene& scene, const View& view, const glm::dvec3& share) {
    for (const MethodOptions& method : ways()) expectPasses(scene, view, share, method);
  }

  // The same by the default options alone.
  void expectPassesUsually(const Scene& scene, const View& view, const glm::dvec3& share) {
    expectPasses(scene, view, share, MethodOptions());
  }

  void expectLikeReference(const Scene& scene, const RenderOptions& options, const MethodOptions& method,
                           double edgeShare) {
    SCOPED_TRACE(describe(method));
    const RenderResult result = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, method);
    ReferenceOptions same;
    same.width = options.width;
    same.height = options.height;
    same.view = options.view;
    same.background = options.background;
    same.samples = method.samples;
    same.nodeFormat = static_cast<std::uint32_t>(method.nodes);
    const Reference reference = renderReference(scene, same);
    const Comparison exact = compare(result.picture, reference.exact, reference, 2);
    const Comparison rounded = compare(result.picture, reference.rounded, reference, 2);
    const std::size_t beyond = method.samples > 1 ? reference.edge.size() / 10000 : 0;
    for (const Comparison& comparison : {exact, rounded}) {
      EXPECT_LE(comparison.beyond, beyond) << comparison;
      EXPECT_LE(comparison.edgeShare, edgeShare) << comparison;
      EXPECT_LE(comparison.edgeOver, 0.1 * edgeShare) << comparison;
    }
    EXPECT_TRUE(result.report.complete);
  }

 private:
  static constexpr glm::vec3 kBlack{0.0F};
  static constexpr glm::vec3 kWhite{1.0F};

  // All orders by the default options, else one.
  static std::span<const DrawOrder> ordersOf(const MethodOptions& method) {
    const bool usual = method.samples == 1 && method.nodes == MethodOptions().nodes;
    return usual ? std::span(kVolumeOrders) : std::span(kVolumeOrders).first(1);
  }

  std::array<int, 3> middleOf(const RenderResult& result) const {
    EXPECT_TRUE(result.report.complete);
    return middle(result.picture);
  }
  std::array<int, 3> middleOf(const Scene& scene, const View& view, const glm::vec3& background, DrawOrder order,
                              const MethodOptions& method) const {
    return middleOf(renderOnce(gpu(), scene, pictureOf(view, background), {}, order, method));
  }

  // One renderer for both backgrounds.
  void expectPasses(const Scene& scene, const View& view, const glm::dvec3& share, const MethodOptions& method) {
    SCOPED_TRACE(describe(method));
    for (const DrawOrder order : ordersOf(method)) {
      StillRenderer renderer(gpu(), scene, {}, order, method);
      const std::array<int, 3> dark = middleOf(renderer.render(pictureOf(view, kBlack)));
      expectBrighter(dark, middleOf(renderer.render(pictureOf(view, kWhite))), share);
    }
  }

  static void expectBrighter(const std::array<int, 3>& dark, const std::array<int, 3>& light, const glm::dvec3& share) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double expected = decodeSrgb(dark[c] / 255.0) + share[static_cast<int>(c)];
      EXPECT_NEAR(light[c], quantize8(encodeSrgb(std::min(expected, 1.0))), 1) << "channel " << c;
    }
  }
};

TEST_F(VolumeTest, ACubeAbsorbsByItsDepth) {
  Scene scene;
  add(scene, slab(-0.7F, 0.8F), glass(kGreen));
  expectPasses(scene, straightView(), left(kGreen, 1.5));
}

TEST_F(VolumeTest, InPerspectiveToo) {
  Scene scene;
  add(scene, box({-1.0F, -1.0F, -5.0F}, {1.0F, 1.0F, -2.75F}), glass(kGreen));
  expectPasses(scene, wideView(), left(kGreen, 2.25));
}

// Off the middle rays are longer: at the picture's left edge by the square root of 2, nearly.
TEST_F(VolumeTest, ObliqueRaysAreLonger) {
  Scene scene;
  add(scene, box({-20.0F, -20.0F, -3.0F}, {20.0F, 20.0F, -2.0F}), glass(kGreen));
  const Picture white = renderOnce(gpu(), scene, pictureOf(wideView(), glm::vec3(1.0F))).picture;
  const Picture black = renderOnce(gpu(), scene, pictureOf(wideView(), glm::vec3(0.0F))).picture;
  const double slope = 16.0 / 17.0;
  const std::size_t at = std::size_t{kSide} * (kSide / 2) * 4;
  const glm::dvec3 share = left(kGreen, std::sqrt(1.0 + slope * slope));
  for (std::size_t c = 0; c < 3; ++c) {
    const double expected = decodeSrgb(black.rgba[at + c] / 255.0) + share[static_cast<int>(c)];
    EXPECT_NEAR(white.rgba[at + c], quantize8(encodeSrgb(expected)), 1) << "channel " << c;
  }
}

TEST_F(VolumeTest, NestedObjectsAddUp) {
  Scene scene;
  add(scene, slab(-1.0F, 1.0F), glass(kGreen));
  add(scene, slab(-0.25F, 0.5F), glass(kAmber));
  expectPasses(scene, straightView(), left(kGreen, 2.0) * left(kAmber, 0.75));
}

TEST_F(VolumeTest, ObjectsThatCutIntoEachOtherAddUp) {
  Scene scene;
  add(scene, slab(-1.0F, 0.25F), glass(kGreen));
  add(scene, slab(-0.5F, 1.5F), glass(kAmber));
  expectPasses(scene, straightView(), left(kGreen, 1.25) * left(kAmber, 2.0));
}

// One mesh may be several bodies, and bodies within bodies: a cavity is outside.
TEST_F(VolumeTest, CavitiesAbsorbNothing) {
  Mesh mesh = slab(-1.0F, 1.0F);
  Mesh cavity = slab(-0.5F, 0.25F);
  for (std::size_t i = 0; i < cavity.indices.size(); i += 3) std::swap(cavity.indices[i], cavity.indices[i + 1]);
  append(mesh, cavity);
  Scene scene;
  add(scene, mesh, glass(kGreen));
  expectPasses(scene, straightView(), left(kGreen, 1.25));
}

// What is inside is weakened by what is before it only.
TEST_F(VolumeTest, AnOpaqueThingInsideEndsTheWay) {
  const auto make = [](const glm::vec3& behind) {
    Scene scene;
    add(scene, slab(-1.0F, 1.0F), glass(kGreen));
    addRectangle(scene, {glm::vec2(-3.0F), glm::vec2(3.0F), 0.25F},
                 unlitMaterial(glm::vec4(behind, 1.0F), AlphaMode::Opaque));
    return scene;
  };
  expectPasses(make, straightView(), left(kGreen, 0.75));
}

// A translucent one is, too, and what is behind it by the whole way: half of the light comes from it.
TEST_F(VolumeTest, ATranslucentThingInsideIsWeakenedByWhatIsBeforeIt) {
  const auto make = [](const glm::vec3& behind) {
    Scene scene;
    add(scene, slab(-1.0F, 1.0F), glass(kGreen));
    addRectangle(scene, {glm::vec2(-3.0F), glm::vec2(3.0F), 0.25F}, unlitMaterial(glm::vec4(behind, 128.0F / 255.0F)));
    return scene;
  };
  const double half = 128.0 / 255.0;
  expectPasses(make, straightView(), half * left(kGreen, 0.75) + (1.0 - half) * left(kGreen, 2.0));
}

// The near plane is at 0.5, the back of the box at 2.
TEST_F(VolumeTest, ACameraInsideSeesFromItsNearPlaneOn) {
  Scene scene;
  add(scene, box(glm::vec3(-2.0F), glm::vec3(2.0F)), glass(kGreen));
  expectPasses(scene, wideView(), left(kGreen, 1.5));
}

// The near plane is inside of one instance of a box, and an opaque surface inside of another one: the back of the
// first and the front of the second are all that is seen of both.
TEST_F(VolumeTest, InstancesAreObjectsOfTheirOwn) {
  const auto make = [](const glm::vec3& behind) {
    Scene scene;
    add(scene, box(glm::vec3(-1.0F), glm::vec3(1.0F)), glass(kGreen));
    scene.draws.push_back(scene.draws[0]);
    scene.draws[1].transform = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.0F, -4.0F));
    addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -4.25F},
                 unlitMaterial(glm::vec4(behind, 1.0F), AlphaMode::Opaque));
    return scene;
  };
  expectPasses(make, wideView(), left(kGreen, 0.5 + 1.25));
}

// The same with boxes that overlap, so that the first surface is a front.
TEST_F(VolumeTest, OverlappingInstancesAreTold) {
  const auto make = [](const glm::vec3& behind) {
    Scene scene;
    add(scene, box(glm::vec3(-2.0F), glm::vec3(2.0F)), glass(kGreen));
    scene.draws.push_back(scene.draws[0]);
    scene.draws[1].transform = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.0F, -3.0F));
    addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -3.0F},
                 unlitMaterial(glm::vec4(behind, 1.0F), AlphaMode::Opaque));
    return scene;
  };
  expectPasses(make, wideView(), left(kGreen, 1.5 + 2.0));
}

// From inside a body out and into it again, to an opaque surface in there: as many fronts as backs.
TEST_F(VolumeTest, ACameraInsideABodyOfTwoParts) {
  const auto make = [](const glm::vec3& behind) {
    Mesh mesh = box(glm::vec3(-1.0F), glm::vec3(1.0F));
    append(mesh, box({-2.0F, -2.0F, -4.0F}, {2.0F, 2.0F, -2.0F}));
    Scene scene;
    add(scene, mesh, glass(kGreen));
    addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -3.0F},
                 unlitMaterial(glm::vec4(behind, 1.0F), AlphaMode::Opaque));
    return scene;
  };
  expectPasses(make, wideView(), left(kGreen, 0.5 + 1.0));
}

// Camera and opaque surface are inside of one body, of which no surface is seen.
TEST_F(VolumeTest, AnOpaqueThingInsideTogetherWithTheCamera) {
  const auto make = [](const glm::vec3& behind) {
    Scene scene;
    add(scene, box(glm::vec3(-4.0F), glm::vec3(4.0F)), glass(kGreen));
    add(scene, slab(-9.0F, -8.0F), glass(kAmber)); // behind the opaque surface
    addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -2.0F},
                 unlitMaterial(glm::vec4(behind, 1.0F), AlphaMode::Opaque));
    return scene;
  };
  expectPasses(make, wideView(), left(kGreen, 1.5));
}

// Light does not care which way a mesh is wound or mirrored, as long as it is closed.
TEST_F(VolumeTest, InsideOutAndMirroredBodies) {
  Mesh inside = slab(-0.7F, 0.8F);
  for (std::size_t i = 0; i < inside.indices.size(); i += 3) std::swap(inside.indices[i], inside.indices[i + 1]);
  for (const glm::vec3 scale : {glm::vec3(1.0F), glm::vec3(-1.0F, 1.0F, 1.0F)}) {
    Scene scene;
    add(scene, inside, glass(kGreen), glm::scale(glm::mat4(1.0F), scale));
    expectPassesUsually(scene, straightView(), left(kGreen, 1.5));
    scene.meshes[0] = slab(-0.7F, 0.8F);
    expectPassesUsually(scene, straightView(), left(kGreen, 1.5));
  }
}

// Lists beyond the 16 fragments that are sorted in registers: 40 plates of two surfaces and two fragments each.
TEST_F(VolumeTest, ManyPlates) {
  Scene scene;
  for (int i = 0; i < 40; ++i) {
    const float z = -4.0F + 0.2F * static_cast<float>(i * 7 % 40);
    add(scene, slab(z, z + 0.0625F), glass(kGreen));
  }
  Scene few = scene;
  few.draws.resize(3);
  expectPasses(few, straightView(), left(kGreen, 3 * 0.0625));
  expectPasses(scene, straightView(), left(kGreen, 40 * 0.0625));
}

// A surface that encloses nothing is as thick as its file says, scaled by its place; its back adds nothing.
TEST_F(VolumeTest, OpenSurfacesAreAsThickAsTheyAreSaidToBe) {
  const glm::vec3 rose(1.0F, 0.5F, 0.5F);
  Scene scene;
  addRectangle(scene, {glm::vec2(-3.0F), glm::vec2(3.0F), 0.0F}, glass(rose, 0.75F));
  expectPassesUsually(scene, straightView(), left(rose, 0.75));
  scene.draws[0].transform = glm::scale(glm::mat4(1.0F), glm::vec3(2.0F));
  expectPassesUsually(scene, straightView(), left(rose, 1.5));
  scene.draws[0].transform = glm::scale(glm::mat4(1.0F), glm::vec3(2.0F, -2.0F, 2.0F));
  expectPassesUsually(scene, straightView(), left(rose, 1.5));
  scene.draws[0].transform = glm::rotate(glm::mat4(1.0F), 3.14159265F, glm::vec3(0.0F, 1.0F, 0.0F));
  expectPassesUsually(scene, straightView(), glm::dvec3(1.0));
}

TEST_F(VolumeTest, TheThicknessTextureIsRead) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-3.0F), glm::vec2(3.0F), 0.0F}, glass(kGreen, 2.0F));
  scene.images.push_back({1, 1, {255, 51, 0, 255}}); // g: a fifth
  scene.materials[0].thicknessTexture.image = 0;
  expectPassesUsually(scene, straightView(), left(kGreen, 0.4));
}

// A box without its front is open, so its fronts are as thick as they are said to be: here there is none.
TEST_F(VolumeTest, AMeshWithAHoleIsOpen) {
  Scene scene;
  add(scene, slab(-0.7F, 0.8F), glass(kGreen));
  std::vector<std::uint32_t>& indices = scene.meshes[0].indices;
  indices.erase(indices.begin() + 6, indices.begin() + 12); // the face at +z
  expectPassesUsually(scene, straightView(), glm::dvec3(1.0));
}

// Without a thickness there is no volume, and behind what lets nothing through none is seen.
TEST_F(VolumeTest, ThinWallsAbsorbNothing) {
  Scene scene;
  add(scene, slab(-0.7F, 0.8F), glass(kGreen, 0.0F));
  expectPassesUsually(scene, straightView(), glm::dvec3(1.0));
}

// An X-ray view of half the opacity absorbs half as strongly.
TEST_F(VolumeTest, XRayViewsAbsorbLess) {
  Scene scene;
  add(scene, slab(-0.7F, 0.8F), glass(kGreen));
  const auto draw = [&](float background, float opacity) {
    return middle(renderOnce(gpu(), scene, pictureOf(straightView(), glm::vec3(background)), opacity).picture);
  };
  const std::array<int, 3> dark = draw(0.0F, 0.5F);
  const std::array<int, 3> light = draw(1.0F, 0.5F);
  for (std::size_t c = 0; c < 3; ++c) {
    const double expected = decodeSrgb(dark[c] / 255.0) + left(kGreen, 0.75)[static_cast<int>(c)];
    EXPECT_NEAR(light[c], quantize8(encodeSrgb(expected)), 1) << "channel " << c;
  }
}

// Spheres and boxes that contain and cut each other, with opaque things in and behind them.
Scene manyBodies() {
  Scene scene;
  const auto at = [](const glm::vec3& place, float size) {
    return glm::scale(glm::translate(glm::mat4(1.0F), place), glm::vec3(size));
  };
  Material opaque;
  opaque.metallic = 0.0F;
  opaque.baseColor = {0.9F, 0.5F, 0.2F, 1.0F};
  add(scene, uvSphere(32, 16), glass(kGreen), at({-0.8F, 0.0F, 0.0F}, 0.8F));
  add(scene, uvSphere(24, 12), opaque, at({-0.8F, 0.0F, 0.0F}, 0.3F));
  add(scene, box(glm::vec3(-0.7F), glm::vec3(0.7F)), glass(kAmber), at({0.3F, 0.1F, -0.2F}, 0.8F));
  add(scene, uvSphere(32, 16), glass({0.3F, 0.4F, 0.9F}), at({0.4F, 0.1F, -0.1F}, 0.4F));
  add(scene, torus(0.5F, 0.2F, 32, 16), glass({0.8F, 0.3F, 0.3F}), at({0.9F, -0.3F, 0.2F}, 1.0F));
  add(scene, uvSphere(24, 12), opaque, at({0.0F, -0.2F, -1.4F}, 0.5F));
  Material pane = unlitMaterial({0.2F, 0.3F, 0.8F, 0.4F});
  addRectangle(scene, {glm::vec2(-1.2F, -0.3F), glm::vec2(1.2F, 0.2F), 0.1F}, pane);
  return scene;
}

TEST_F(VolumeTest, ASphereIsDarkerInItsMiddle) {
  Scene scene;
  add(scene, uvSphere(48, 24), glass(kGreen));
  const RenderOptions options = usualOptions(scene, 160, 160);
  const Picture picture = renderOnce(gpu(), scene, options).picture;
  const auto red = [&](std::uint32_t x) { return int{picture.rgba[(std::size_t{80} * 160 + x) * 4]}; };
  EXPECT_LT(red(80) + 20, red(30));
  EXPECT_LT(red(30) + 20, red(8));
  expectLikeReference(scene, options, {}, 0.02);
}

TEST_F(VolumeTest, ManyBodiesAreAsTheReferenceHasThem) {
  const Scene scene = manyBodies();
  const RenderOptions options = usualOptions(scene, 240, 135);
  for (const MethodOptions& method : ways()) {
    expectLikeReference(scene, options, method, 0.02 * method.samples + 0.02);
  }
}

TEST_F(VolumeTest, FromAmongThemAndOrthographic) {
  const Scene scene = manyBodies();
  RenderOptions options = usualOptions(scene, 160, 90);
  options.view.orthographic = true;
  options.view.halfHeight = 1.2F;
  expectLikeReference(scene, options, {}, 0.03);
  options.view.orthographic = false;
  options.view.cameraToWorld = glm::translate(glm::mat4(1.0F), glm::vec3(-0.7F, 0.1F, 0.6F));
  options.view.verticalFov = 1.5F;
  options.view.nearPlane = 0.01F;
  options.view.farPlane = 0.0F;
  expectLikeReference(scene, options, {}, 0.03);
}

TEST_F(VolumeTest, OrdersAndTilesAndResolvesMakeNoDifference) {
  const Scene scene = manyBodies();
  RenderOptions options = usualOptions(scene, 240, 135);
  for (MethodOptions method : ways()) {
    SCOPED_TRACE(describe(method));
    StillRenderer renderer(gpu(), scene, {}, DrawOrder::Forward, method);
    const RenderResult whole = renderer.render(options);
    EXPECT_EQ(whole.report.tiles, 1U);
    for (const DrawOrder order : {DrawOrder::Reversed, DrawOrder::Shuffled}) {
      EXPECT_TRUE(renderOnce(gpu(), scene, options, {}, order, method).picture.rgba == whole.picture.rgba);
    }
    RenderOptions bounded = options;
    bounded.memoryBudget = 1 << 18;
    const RenderResult tiled = renderer.render(bounded);
    EXPECT_GT(tiled.report.tiles, 1U);
    EXPECT_TRUE(tiled.picture.rgba == whole.picture.rgba);
    EXPECT_LE(tiled.report.totalBytes, *bounded.memoryBudget + 4096);
    method.resolve = VITRAIL_RESOLVE_FRAGMENT;
    const RenderResult drawn = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, method);
    EXPECT_TRUE(drawn.picture.rgba == whole.picture.rgba);
    EXPECT_EQ(drawn.report.resolve, "compute"); // there is no other
  }
}

// Methods without lists, and lists of which only the nearest layers are kept, take the thickness that is stated.
TEST_F(VolumeTest, OtherMethodsTakeTheStatedThickness) {
  Scene scene;
  add(scene, slab(-0.7F, 0.8F), glass(kGreen, 0.5F));
  MethodOptions sorted;
  sorted.name = "sorted";
  MethodOptions nearest;
  nearest.maxLayers = 8;
  for (const MethodOptions& method : {sorted, nearest}) {
    const auto draw = [&](float background) {
      const RenderOptions options = pictureOf(straightView(), glm::vec3(background));
      return renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, method);
    };
    const std::array<int, 3> dark = middle(draw(0.0F).picture);
    const RenderResult result = draw(1.0F);
    const std::array<int, 3> light = middle(result.picture);
    for (std::size_t c = 0; c < 3; ++c) {
      const double expected = decodeSrgb(dark[c] / 255.0) + left(kGreen, 0.5)[static_cast<int>(c)];
      EXPECT_NEAR(light[c], quantize8(encodeSrgb(std::min(expected, 1.0))), 2) << "channel " << c;
    }
    ASSERT_EQ(result.report.warnings.size(), 1U);
    const char* advice = method.maxLayers > 0 ? "leave --layers out" : "use --method linked-list";
    EXPECT_NE(result.report.warnings[0].find(advice), std::string::npos) << result.report.warnings[0];
  }
  EXPECT_TRUE(renderOnce(gpu(), scene, pictureOf(straightView(), glm::vec3(1.0F))).report.warnings.empty());
}

} // namespace
} // namespace vitrail::tool::test
