// Whole pictures against the double-precision reference.
//
// Away from edge pixels (reference.h says which those are) every channel of the 8-bit sRGB picture agrees within 2/255,
// with the reference that rounds nothing as well as with the one that rounds each fragment as the node format states.
// How many edge pixels a scene may have is stated with the scene, as a share of the picture; no more than a tenth of
// that may differ by more than 2/255.
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "../../tool/scene/builtin/builtin.h"
#include "../../tool/scene/builtin/shapes.h"
#include "../reference/compare.h"
#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::Comparison;
using reference::LayerBounds;
using reference::Reference;
using reference::ReferenceOptions;
using reference::straightView;
using reference::unlitMaterial;

constexpr int kBound = 2; // 1/255

Reference referenceOf(const Scene& scene, const RenderOptions& options, std::optional<float> opacity = {},
                      const MethodOptions& method = {}) {
  ReferenceOptions same;
  same.width = options.width;
  same.height = options.height;
  same.view = options.view;
  same.background = options.background;
  same.opacity = opacity;
  same.samples = method.samples;
  same.nodeFormat = static_cast<std::uint32_t>(method.nodes);
  return renderReference(scene, same);
}

// With several samples surfaces are shaded at pixel centres that may lie far outside of a thin triangle, where the grid
// that a driver snaps corners to moves a colour by much: one pixel in 10,000 may differ by that.
constexpr double kExtrapolatedShare = 1e-4;

void expectAgreement(const Comparison& comparison, int bound, double edgeShare, std::size_t beyond = 0) {
  EXPECT_TRUE(beyond > 0 || comparison.away <= bound) << comparison;
  EXPECT_LE(comparison.beyond, beyond) << comparison;
  EXPECT_LE(comparison.edgeShare, edgeShare) << comparison;
  EXPECT_LE(comparison.edgeOver, 0.1 * edgeShare) << comparison;
}

// The counts that a frame reports lie between those of the reference's least and most covered rays.
void expectCounts(const FrameReport& report, const Reference& reference) {
  const LayerBounds bounds = layerBounds(reference);
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.fragmentsMissing, 0U);
  EXPECT_EQ(report.fragmentsStored, report.fragmentsRequested);
  EXPECT_GE(report.fragmentsRequested, bounds.fragmentsLeast);
  EXPECT_LE(report.fragmentsRequested, bounds.fragmentsMost);
  EXPECT_GE(report.layersMax, bounds.deepestLeast);
  EXPECT_LE(report.layersMax, bounds.deepestMost);
}

class ScenesTest : public GpuTest {
 protected:
  void expectLikeReference(const Scene& scene, const RenderOptions& options, double edgeShare,
                           std::optional<float> opacity = {}) {
    const RenderResult result = renderOnce(gpu(), scene, options, opacity);
    const Reference reference = referenceOf(scene, options, opacity);
    expectAgreement(compare(result.picture, reference.exact, reference, kBound), kBound, edgeShare);
    expectAgreement(compare(result.picture, reference.rounded, reference, kBound), kBound, edgeShare);
    expectCounts(result.report, reference);
  }

  // A scene drawn by some method, against the reference that rounds as its nodes do. The exact one may be `exactBound`
  // away.
  void expectMethod(const Scene& scene, const RenderOptions& options, const MethodOptions& method, double edgeShare,
                    int exactBound = kBound) {
    SCOPED_TRACE(describe(method));
    const RenderResult result = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, method);
    const Reference reference = referenceOf(scene, options, {}, method);
    const double pixels = static_cast<double>(reference.edge.size());
    const auto beyond = method.samples > 1 ? static_cast<std::size_t>(kExtrapolatedShare * pixels) : 0;
    expectAgreement(compare(result.picture, reference.rounded, reference, kBound), kBound, edgeShare, beyond);
    expectAgreement(compare(result.picture, reference.exact, reference, exactBound), exactBound, edgeShare, beyond);
    expectCounts(result.report, reference);
  }

  void expectBuiltin(const std::string& name, std::uint32_t width, std::uint32_t height, double edgeShare,
                     std::optional<std::uint32_t> count = {}) {
    BuiltinOptions options;
    options.count = count;
    const Scene scene = makeBuiltinScene(name, options);
    expectLikeReference(scene, usualOptions(scene, width, height), edgeShare);
  }

  // With mipmaps off, both filter the base level. Over 50 faint layers are blended over a dark background: rounding
  // each one's alpha to 1/255 moves a few pixels by 3/255, so the picture is held to the reference that rounds
  // likewise, and to the exact one a little less closely.
  void expectWithoutMipmaps(const std::string& name, std::uint32_t width, std::uint32_t height) {
    Scene scene = makeBuiltinScene(name, {});
    for (Material& material : scene.materials) material.baseColorTexture.sampler.mipmaps = false;
    expectMethod(scene, usualOptions(scene, width, height), {}, 0.001, 4);
  }
};

TEST_F(ScenesTest, Spheres) { expectBuiltin("spheres", 480, 270, 0.003); }
TEST_F(ScenesTest, Planes) { expectBuiltin("planes", 160, 90, 0.0); }
TEST_F(ScenesTest, ManyPlanes) { expectBuiltin("planes", 64, 36, 0.0, 300); }
TEST_F(ScenesTest, Interlocked) { expectBuiltin("interlocked", 480, 270, 0.004); }
TEST_F(ScenesTest, Mannequins) { expectBuiltin("mannequins", 480, 270, 0.02); }

// A tube is about a pixel wide here, so a ray passes near many silhouettes on its way.
TEST_F(ScenesTest, Hairball) { expectBuiltin("hairball", 320, 180, 0.2); }
TEST_F(ScenesTest, SparseHairball) { expectBuiltin("hairball", 320, 180, 0.15, 1000); }

TEST_F(ScenesTest, SmokeWithoutMipmaps) { expectWithoutMipmaps("smoke", 480, 270); }

// The reference knows no mipmaps, and the puffs are drawn at down to an eighth of their textures' size: at the foot of
// the plume, where they are smallest, the pictures differ.
TEST_F(ScenesTest, Smoke) {
  const Scene scene = makeBuiltinScene("smoke", {});
  const RenderOptions options = usualOptions(scene, 480, 270);
  const RenderResult result = renderOnce(gpu(), scene, options);
  const Reference reference = referenceOf(scene, options);
  const Comparison comparison = compare(result.picture, reference.rounded, reference, kBound);
  EXPECT_LE(comparison.away, 16) << comparison;
  EXPECT_LE(comparison.beyond, reference.edge.size() / 100) << comparison;
  EXPECT_TRUE(result.report.complete);
}

TEST_F(ScenesTest, XRay) {
  const Scene scene = makeBuiltinScene("mannequins", {});
  expectLikeReference(scene, usualOptions(scene, 480, 270), 0.01, 0.35F);
}

TEST_F(ScenesTest, TransparentBackground) {
  const Scene scene = makeBuiltinScene("spheres", {});
  RenderOptions options = usualOptions(scene, 480, 270);
  options.background.kind = Background::Kind::Transparent;
  expectLikeReference(scene, options, 0.004);
}

TEST_F(ScenesTest, Orthographic) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  RenderOptions options = usualOptions(scene, 480, 270);
  options.view.orthographic = true;
  options.view.halfHeight = 1.7F;
  expectLikeReference(scene, options, 0.005);
}

// The near and the far plane cut through spheres.
TEST_F(ScenesTest, ClippedByBothPlanes) {
  const Scene scene = makeBuiltinScene("spheres", {});
  RenderOptions options = usualOptions(scene, 480, 270);
  const float near = options.view.nearPlane;
  const float far = options.view.farPlane;
  options.view.nearPlane = 0.6F * near + 0.4F * far;
  options.view.farPlane = 0.3F * near + 0.7F * far;
  expectLikeReference(scene, options, 0.005);
}

// Without a far plane, from among the spheres.
TEST_F(ScenesTest, InsideTheScene) {
  const Scene scene = makeBuiltinScene("spheres", {});
  RenderOptions options = usualOptions(scene, 320, 180);
  options.view.cameraToWorld[3] = glm::vec4(0.1F, 0.05F, 0.15F, 1.0F);
  options.view.verticalFov = 1.5F;
  options.view.nearPlane = 0.01F;
  options.view.farPlane = 0.0F;
  expectLikeReference(scene, options, 0.002);
}

// Mirroring transforms turn triangles round but not their sides; lit from one side only, so a wrong normal shows.
TEST_F(ScenesTest, MirroredAndStretched) {
  Scene scene;
  scene.meshes.push_back(uvSphere(32, 16));
  Material opaque; // single-sided
  opaque.baseColor = {0.8F, 0.3F, 0.2F, 1.0F};
  opaque.metallic = 0.3F;
  opaque.roughness = 0.4F;
  Material glass = opaque;
  glass.alphaMode = AlphaMode::Blend;
  glass.baseColor = {0.2F, 0.6F, 0.9F, 0.4F};
  scene.materials = {opaque, glass};
  const auto place = [](glm::vec3 at, glm::vec3 scale) {
    return glm::scale(glm::translate(glm::mat4(1.0F), at), scale);
  };
  scene.draws.push_back({0, 0, place({-0.6F, 0.4F, 0.0F}, {-0.4F, 0.3F, 0.3F})});
  scene.draws.push_back({0, 0, place({-0.6F, -0.4F, 0.0F}, {0.5F, 0.2F, 0.3F})});
  scene.draws.push_back({0, 1, place({0.5F, 0.4F, 0.0F}, {0.3F, -0.4F, 0.5F})});
  scene.draws.push_back({0, 1, place({0.4F, -0.3F, 0.2F}, {-0.8F, -0.4F, -0.3F})});
  const RenderOptions options = usualOptions(scene, 480, 270);
  expectLikeReference(scene, options, 0.001);
  expectLikeReference(scene, options, 0.001, 0.6F);
}

// Opaque sheets seen from behind: the single-sided one is not there, the double-sided one is lit on the side that
// shows.
TEST_F(ScenesTest, BackFaces) {
  Scene scene;
  Material sheet;
  sheet.metallic = 0.0F;
  sheet.baseColor = {0.7F, 0.7F, 0.2F, 1.0F};
  addRectangle(scene, {glm::vec2(-1.5F, -0.7F), glm::vec2(-0.1F, 0.7F), 0.0F}, sheet);
  sheet.doubleSided = true;
  addRectangle(scene, {glm::vec2(0.1F, -0.7F), glm::vec2(1.5F, 0.7F), 0.0F}, sheet);
  for (Draw& draw : scene.draws) draw.transform = glm::rotate(glm::mat4(1.0F), 2.8F, glm::vec3(0.2F, 1.0F, 0.0F));
  RenderOptions options = usualOptions(scene, 320, 180);
  expectLikeReference(scene, options, 0.001);
}

// Vertex alpha runs from 0 at the left to 1 at the right: MASK cuts it at its cutoff and is opaque beyond, BLEND fades.
TEST_F(ScenesTest, MaskAndBlendByVertexAlpha) {
  Scene scene;
  const auto fade = [&](const reference::Rectangle& rectangle, Material material, AlphaMode mode) {
    material.alphaMode = mode;
    material.alphaCutoff = 0.4F;
    addRectangle(scene, rectangle, material);
    reference::changeVertices(scene.meshes.back(), [](Vertex& vertex) {
      vertex.color = glm::vec4(1.0F, 0.5F, vertex.texCoord0.y, vertex.texCoord0.x);
    });
  };
  Material lit;
  lit.roughness = 0.7F;
  lit.metallic = 0.0F;
  fade({glm::vec2(-0.9F, -0.9F), glm::vec2(0.8F, 0.1F), 0.0F}, lit, AlphaMode::Mask);
  fade({glm::vec2(-0.6F, -0.1F), glm::vec2(0.9F, 0.9F), 0.5F}, lit, AlphaMode::Blend);
  fade({glm::vec2(-0.7F, -0.6F), glm::vec2(0.7F, 0.6F), -0.5F}, unlitMaterial(glm::vec4(1.0F)), AlphaMode::Blend);
  fade({glm::vec2(-0.8F, -0.3F), glm::vec2(0.85F, 0.4F), 0.7F}, unlitMaterial(glm::vec4(1.0F)), AlphaMode::Mask);
  RenderOptions options = usualOptions(scene, 240, 240);
  options.view = straightView();
  expectLikeReference(scene, options, 0.001);
  expectLikeReference(scene, options, 0.001, 0.8F);
}

// Each sample is a ray of its own, so a silhouette passes near one more often than near a centre.
TEST_F(ScenesTest, SpheresWithSeveralSamples) {
  const Scene scene = makeBuiltinScene("spheres", {});
  const RenderOptions options = usualOptions(scene, 320, 180);
  for (const MethodOptions& method : methodVariety(gpu())) {
    if (method.samples > 1) expectMethod(scene, options, method, 0.004 * method.samples);
  }
}

TEST_F(ScenesTest, InterlockedWithSeveralSamples) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  const RenderOptions options = usualOptions(scene, 320, 180);
  for (const MethodOptions& method : methodVariety(gpu())) {
    if (method.samples > 1) expectMethod(scene, options, method, 0.006 * method.samples);
  }
}

// Opaque surfaces cut transparent ones here, within pixels too.
TEST_F(ScenesTest, MannequinsWithSeveralSamples) {
  const Scene scene = makeBuiltinScene("mannequins", {});
  const RenderOptions options = usualOptions(scene, 240, 135);
  for (const MethodOptions& method : methodVariety(gpu())) {
    if (method.samples > 1) expectMethod(scene, options, method, 0.03 * method.samples);
  }
}

// Panes that light passes through, tinted; each is two fragments.
Scene tintedGlass() {
  Scene scene;
  scene.meshes.push_back(uvSphere(32, 16));
  const auto place = [&](glm::vec3 at, float size, const glm::vec3& color, float transmission, float metallic) {
    Material material;
    material.baseColor = glm::vec4(color, 1.0F);
    material.transmission = transmission;
    material.metallic = metallic;
    material.roughness = 0.3F;
    scene.materials.push_back(material);
    const auto number = static_cast<std::uint32_t>(scene.materials.size() - 1);
    scene.draws.push_back({0, number, glm::scale(glm::translate(glm::mat4(1.0F), at), glm::vec3(size))});
  };
  place({-0.5F, 0.0F, 0.0F}, 0.6F, {0.9F, 0.3F, 0.2F}, 1.0F, 0.0F);
  place({0.4F, 0.2F, -0.4F}, 0.6F, {0.2F, 0.7F, 0.9F}, 0.8F, 0.0F);
  place({0.2F, -0.4F, 0.5F}, 0.4F, {0.9F, 0.9F, 0.3F}, 0.6F, 0.3F);
  place({0.0F, 0.0F, -1.2F}, 0.8F, {0.5F, 0.5F, 0.5F}, 0.0F, 0.0F); // opaque, behind them
  return scene;
}

TEST_F(ScenesTest, LightPassesThroughTintedGlass) {
  const Scene scene = tintedGlass();
  const RenderOptions options = usualOptions(scene, 320, 180);
  expectMethod(scene, options, {}, 0.01);
  for (const MethodOptions& method : methodVariety(gpu())) {
    if (method.nodes == VITRAIL_NODE_HDR || method.samples == 4) expectMethod(scene, options, method, 0.04);
  }
}

TEST_F(ScenesTest, FlamesWithoutMipmaps) { expectWithoutMipmaps("flames", 320, 180); }

// A lamp of brightness 16 behind smoked glass: clamped to 1 it would be far darker.
TEST_F(ScenesTest, HdrNodesKeepBrightSurfaces) {
  Scene scene;
  Material lamp;
  lamp.alphaMode = AlphaMode::Blend;
  lamp.metallic = 0.0F;
  lamp.baseColor = {0.0F, 0.0F, 0.0F, 0.9F};
  lamp.emissive = {16.0F, 4.0F, 1.0F};
  addRectangle(scene, {glm::vec2(-0.8F), glm::vec2(0.8F), 0.0F}, lamp);
  addRectangle(scene, {glm::vec2(-0.5F), glm::vec2(0.9F), 0.5F}, unlitMaterial({0.0F, 0.0F, 0.0F, 0.95F}));
  RenderOptions options = usualOptions(scene, 96, 96);
  options.view = straightView();
  MethodOptions hdr;
  hdr.nodes = VITRAIL_NODE_HDR;
  expectMethod(scene, options, hdr, 0.0);
  const auto middle = [&](const MethodOptions& method) {
    return int{renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, method).picture.rgba[(48 * 96 + 48) * 4]};
  };
  EXPECT_GT(middle(hdr), 200); // 0.05 * 0.9 * 16 = 0.72
  MethodOptions standard;
  standard.nodes = VITRAIL_NODE_STANDARD;
  EXPECT_LT(middle(standard), 80); // 0.05 * 0.9
}

// Low precision shows, but no more than is stated: alpha is up to 0.5/63 off, colours 0.5/31 on the curve. Where
// shading comes out next to the middle between two steps the device may store the other one.
TEST_F(ScenesTest, CompactNodesRoundAsStated) {
  const Scene scene = makeBuiltinScene("spheres", {});
  const RenderOptions options = usualOptions(scene, 320, 180);
  MethodOptions compact;
  compact.nodes = VITRAIL_NODE_COMPACT;
  const RenderResult result = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, compact);
  const Reference reference = referenceOf(scene, options, {}, compact);
  const Comparison rounded = compare(result.picture, reference.rounded, reference, kBound);
  EXPECT_LE(rounded.away, 12) << rounded; // a step of a colour is 8/255
  EXPECT_LE(rounded.beyond, reference.edge.size() / 2000) << rounded;
  const Comparison exact = compare(result.picture, reference.exact, reference, 8);
  EXPECT_LE(exact.away, 12) << exact;
  EXPECT_GT(exact.away, kBound) << "nothing was rounded";
  expectCounts(result.report, reference);
}

} // namespace
} // namespace vitrail::tool::test
