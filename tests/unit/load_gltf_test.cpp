// The values that glTF files load to: one small file of the corpus a feature.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "load_good.h"
#include "scene/load.h"
#include "scene/mesh_build.h"
#include "scene/volume.h"

namespace vitrail::tool {
namespace {

using Indices = std::vector<std::uint32_t>;

// The corners of a mesh's triangles, in order.
std::vector<glm::vec3> corners(const Mesh& mesh) {
  std::vector<glm::vec3> positions;
  for (const std::uint32_t index : mesh.indices) positions.push_back(mesh.positions[index]);
  return positions;
}

TEST(LoadGltf, TriangleWithoutAnythingHasFlatNormalsAndTheDefaultMaterial) {
  for (const char* name : {"triangle.gltf", "triangle.glb"}) {
    const Scene scene = loadGood(name);
    EXPECT_EQ(scene.name, "triangle");
    ASSERT_EQ(scene.meshes.size(), 1U);
    ASSERT_EQ(scene.draws.size(), 1U);
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.meshes[0].indices, (Indices{0, 1, 2}));
    expectNear(scene.meshes[0].vertex(1).position, {1.0F, 0.0F, 0.0F});
    expectNear(scene.meshes[0].vertex(2).normal, {0.0F, 0.0F, 1.0F});
    expectNear(scene.meshes[0].vertex(0).color, glm::vec4(1.0F));
    EXPECT_EQ(scene.draws[0].transform, glm::mat4(1.0F));
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.alphaMode, AlphaMode::Opaque);
    EXPECT_EQ(material.metallic, 1.0F);
    EXPECT_EQ(material.roughness, 1.0F);
    EXPECT_FALSE(material.doubleSided);
    EXPECT_TRUE(scene.cameras.empty());
    EXPECT_FALSE(scene.background.has_value());
  }
}

TEST(LoadGltf, StripsKeepTheWindingAndDropRepeatedVertices) {
  const Mesh mesh = loadGood("strip.gltf").meshes.at(0);
  // 0 1 2 2 3 makes one triangle: the others name vertex 2 twice.
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2}));
  EXPECT_EQ(mesh.vertexCount(), 3U) << "vertices that no triangle uses are dropped";
}

TEST(TriangleList, EveryOtherTriangleOfAStripIsTurned) {
  const Indices strip{0, 1, 2, 3, 4};
  EXPECT_EQ(triangleList(strip, Topology::Strip), (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_TRUE(triangleList(Indices{0, 1}, Topology::Fan).empty());
}

TEST(LoadGltf, Fans) {
  const Mesh mesh = loadGood("fan.gltf").meshes.at(0);
  EXPECT_EQ(mesh.indices, (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(LoadGltf, IndicesThatFillNoLastTriangleAreDropped) {
  EXPECT_EQ(loadGood("list.gltf").meshes.at(0).indices, (Indices{0, 1, 2}));
}

TEST(LoadGltf, PointsAndLines) {
  const std::map<std::string, std::pair<Primitive, Indices>> expected{
      {"points.gltf", {Primitive::Points, {0, 1, 2, 2, 3, 2, 0}}},
      {"lines.gltf", {Primitive::Lines, {0, 1, 3, 2}}},
      {"line_strip.gltf", {Primitive::Lines, {0, 1, 1, 2, 2, 3, 3, 2, 2, 0}}},
      {"line_loop.gltf", {Primitive::Lines, {0, 1, 1, 2, 2, 3, 3, 2, 2, 0}}},
  };
  for (const auto& [name, content] : expected) {
    SCOPED_TRACE(name);
    const Scene scene = loadGood(name);
    EXPECT_TRUE(scene.warnings.empty());
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.primitive, content.first);
    EXPECT_EQ(mesh.indices, content.second);
    EXPECT_EQ(mesh.vertexCount(), 4U) << "vertices that nothing uses are dropped";
    EXPECT_TRUE(mesh.normals.empty()) << "they are not lit";
    EXPECT_EQ(triangleCount(scene), 0U);
    EXPECT_EQ(worldBounds(scene).max, glm::vec3(1, 1, 0));
  }
}

TEST(LineList, LoopsEndWhereTheyBegin) {
  EXPECT_EQ(lineList(Indices{0, 1, 2}, LineTopology::Loop), (Indices{0, 1, 1, 2, 2, 0}));
  EXPECT_EQ(lineList(Indices{0, 1}, LineTopology::Loop), (Indices{0, 1})) << "once there and not back";
  EXPECT_TRUE(lineList(Indices{0}, LineTopology::Strip).empty());
}

TEST(LoadGltf, PointsHaveTheNormalsOfTheFileOrNone) {
  const Scene scene = loadGood("points_with_normals.gltf");
  EXPECT_TRUE(scene.meshes.at(0).normals.empty());
  ASSERT_EQ(scene.meshes.at(1).normals.size(), 3U);
  expectNear(scene.meshes[1].vertex(2).normal, {0.0F, 0.0F, 1.0F});
}

TEST(LoadGltf, IndicesOf8And16And32Bits) {
  const Scene scene = loadGood("index_types.gltf");
  ASSERT_EQ(scene.meshes.size(), 3U);
  for (const Mesh& mesh : scene.meshes) {
    const std::vector<glm::vec3> positions = corners(mesh);
    ASSERT_EQ(positions.size(), 3U);
    expectNear(positions[0], {1.0F, 0.0F, 0.0F});
    expectNear(positions[1], {1.0F, 1.0F, 0.0F});
    expectNear(positions[2], {0.0F, 1.0F, 0.0F});
  }
}

TEST(LoadGltf, SparseAndZeroFilledAccessors) {
  const Mesh mesh = loadGood("sparse.gltf").meshes.at(0);
  const std::vector<glm::vec3> positions = corners(mesh);
  ASSERT_EQ(positions.size(), 3U);
  expectNear(positions[0], {0.0F, 0.0F, 0.0F});
  expectNear(positions[1], {1.0F, 0.0F, 0.0F});
  expectNear(positions[2], {0.0F, 5.0F, 0.0F});
  EXPECT_EQ(mesh.vertex(0).texCoord0, glm::vec2(0.0F));
}

TEST(LoadGltf, NormalizedIntegersAndQuantizedPositions) {
  const Scene scene = loadGood("normalized.gltf");
  const std::vector<Vertex> vertices = scene.meshes.at(0).vertices();
  expectNear(placed(scene, 0, vertices[1].position), {2.0F, 0.0F, 0.0F});
  expectNear(vertices[2].position, {0.0F, -1.0F, 0.0F});
  expectNear(vertices[0].normal, {0.0F, 0.0F, -1.0F});
  EXPECT_NEAR(vertices[1].texCoord0.x, 1.0F, 1e-6F);
  EXPECT_NEAR(vertices[2].texCoord0.y, 0.2F, 1e-6F);
  EXPECT_NEAR(vertices[1].texCoord1.x, 1.0F, 1e-6F);
  EXPECT_NEAR(vertices[2].texCoord1.y, 0.2F, 1e-6F);
  expectNear(vertices[0].color, {1.0F, 0.0F, 0.0F, 0.2F});
}

TEST(LoadGltf, InterleavedAttributesAndColorsWithoutAlpha) {
  const std::vector<Vertex> vertices = loadGood("interleaved.gltf").meshes.at(0).vertices();
  ASSERT_EQ(vertices.size(), 3U);
  expectNear(vertices[2].position, {0.0F, 1.0F, 0.0F});
  expectNear(vertices[2].normal, {0.0F, 0.0F, 1.0F});
  EXPECT_EQ(vertices[2].texCoord0, glm::vec2(0.5F, 1.0F));
  expectNear(vertices[1].color, {0.5F, 0.25F, 1.0F, 1.0F});
}

TEST(LoadGltf, NormalsThatAreZeroOrNoNumbersBecomeTheFaces) {
  const Scene scene = loadGood("broken_normals.gltf");
  for (const Vertex& vertex : scene.meshes.at(0).vertices()) expectNear(vertex.normal, {0.0F, 0.0F, 1.0F});
}

TEST(LoadGltf, SkinsStandInTheirRestPoseAndIgnoreTheNode) {
  const Scene scene = loadGood("skin.gltf");
  ASSERT_EQ(scene.draws.size(), 1U);
  EXPECT_EQ(scene.draws[0].transform, glm::mat4(1.0F));
  const std::vector<Vertex> vertices = scene.meshes.at(0).vertices();
  ASSERT_EQ(vertices.size(), 3U);
  // Joint 0 moves by (0, 1, 0). Joint 1 takes 1 from z, doubles, and adds 3 to z.
  expectNear(vertices[0].position, {0.0F, 1.0F, 0.0F});
  expectNear(vertices[1].position, {2.0F, 0.0F, 1.0F});
  // Half of each: (0, 2, 0) and (0, 2, 1).
  expectNear(vertices[2].position, {0.0F, 2.0F, 0.5F});
  for (const Vertex& vertex : vertices) EXPECT_NEAR(glm::length(vertex.normal), 1.0F, 1e-5F);
  expectNear(vertices[1].normal, {0.0F, 0.0F, 1.0F});
}

TEST(LoadGltf, MorphTargetsStandAtTheMeshsWeightsOrTheNodes) {
  const Scene scene = loadGood("morph.gltf");
  ASSERT_EQ(scene.draws.size(), 2U);
  ASSERT_EQ(scene.meshes.size(), 2U);
  expectNear(scene.meshes[scene.draws[0].mesh].vertex(0).position, {0.0F, 0.0F, 0.5F});
  expectNear(scene.meshes[scene.draws[1].mesh].vertex(0).position, {2.0F, 0.0F, 0.0F});
}

TEST(LoadGltf, TheDefaultSceneIsDrawnThroughItsHierarchy) {
  const Scene scene = loadGood("two_scenes.gltf");
  ASSERT_EQ(scene.draws.size(), 1U);
  // The child moves by 10 along x; its parent doubles, turns x to y, and moves by (1, 2, 3).
  expectNear(placed(scene, 0, {0.0F, 0.0F, 0.0F}), {1.0F, 22.0F, 3.0F}, 1e-4F);
  expectNear(placed(scene, 0, {1.0F, 0.0F, 0.0F}), {1.0F, 24.0F, 3.0F}, 1e-4F);
}

TEST(LoadGltf, WithoutADefaultTheFirstSceneIsDrawn) {
  const Scene scene = loadGood("unnamed_scene.gltf");
  ASSERT_EQ(scene.draws.size(), 1U);
  EXPECT_EQ(scene.draws[0].transform, glm::mat4(1.0F));
}

TEST(LoadGltf, WithoutScenesAllNodesAreDrawnAndShareTheirMesh) {
  const Scene scene = loadGood("no_scenes.gltf");
  EXPECT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(scene.materials.size(), 1U);
  ASSERT_EQ(scene.draws.size(), 2U);
  EXPECT_EQ(scene.draws[0].mesh, scene.draws[1].mesh);
}

TEST(LoadGltf, CamerasComeInTheOrderOfTheNodesWithoutScale) {
  const std::vector<SceneCamera> cameras = loadGood("cameras.gltf").cameras;
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_TRUE(cameras[0].orthographic);
  EXPECT_EQ(cameras[0].halfHeight, 2.0F);
  EXPECT_EQ(cameras[0].nearPlane, 1.0F);
  EXPECT_EQ(cameras[0].farPlane, 9.0F);
  EXPECT_EQ(cameras[0].cameraToWorld[0], glm::vec4(1.0F, 0.0F, 0.0F, 0.0F));
  EXPECT_EQ(cameras[0].cameraToWorld[3], glm::vec4(0.0F, 0.0F, 5.0F, 1.0F));
  EXPECT_FALSE(cameras[1].orthographic);
  EXPECT_EQ(cameras[1].name, "eye");
  EXPECT_EQ(cameras[1].verticalFov, 0.5F);
  EXPECT_EQ(cameras[1].nearPlane, 0.25F);
  EXPECT_FALSE(cameras[1].farPlane.has_value());
  // Turned by 90 degrees about y, it looks along -x.
  expectNear(glm::vec3(cameras[1].cameraToWorld[2]), {1.0F, 0.0F, 0.0F});
}

TEST(LoadGltf, MaterialsTexturesAndSamplers) {
  const Scene scene = loadGood("material.gltf");
  ASSERT_EQ(scene.materials.size(), 2U);
  const Material& glass = scene.materials[0];
  EXPECT_EQ(glass.name, "glass");
  EXPECT_EQ(glass.alphaMode, AlphaMode::Blend);
  EXPECT_TRUE(glass.doubleSided);
  EXPECT_TRUE(glass.unlit);
  expectNear(glass.baseColor, {1.0F, 0.5F, 0.25F, 0.125F});
  EXPECT_EQ(glass.metallic, 0.75F);
  EXPECT_EQ(glass.roughness, 0.5F);
  expectNear(glass.emissive, {2.0F, 0.0F, 4.0F});
  EXPECT_EQ(glass.normalTexture.image, -1);
  EXPECT_EQ(scene.materials[1].alphaMode, AlphaMode::Mask);
  EXPECT_EQ(scene.materials[1].alphaCutoff, 0.75F);

  ASSERT_EQ(scene.images.size(), 1U) << "both slots share the image";
  EXPECT_EQ(scene.images[0].width, 2U);
  EXPECT_EQ(scene.images[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 128}));
  const Sampler& sampler = glass.emissiveTexture.sampler;
  EXPECT_EQ(sampler.wrapU, Wrap::ClampToEdge);
  EXPECT_EQ(sampler.wrapV, Wrap::MirroredRepeat);
  EXPECT_FALSE(sampler.magLinear);
  EXPECT_FALSE(sampler.minLinear);
  EXPECT_TRUE(sampler.mipLinear);
  EXPECT_TRUE(sampler.mipmaps);
}

TEST(LoadGltf, Transmission) {
  const Scene scene = loadGood("transmission.gltf");
  const auto named = [&](const std::string& name) {
    return *std::ranges::find(scene.materials, name, &Material::name);
  };
  EXPECT_EQ(named("clear").transmission, 1.0F);
  EXPECT_EQ(named("clear").transmissionTexture.image, -1);
  EXPECT_TRUE(isTransparent(named("clear"))) << "in any alphaMode";
  EXPECT_EQ(named("clear").alphaMode, AlphaMode::Opaque);
  EXPECT_EQ(named("half").transmission, 0.5F);
  EXPECT_EQ(named("textured").transmission, 0.9F);
  EXPECT_EQ(named("textured").transmissionTexture.image, 1);
  EXPECT_TRUE(isTransparent(named("cut")));
  EXPECT_EQ(named("cut").alphaMode, AlphaMode::Mask);
  EXPECT_EQ(named("wall").transmission, 0.0F);
  EXPECT_FALSE(isTransparent(named("wall")));
  Material unlit = named("clear");
  unlit.unlit = true;
  EXPECT_FALSE(isTransparent(unlit)) << "KHR_materials_unlit leaves only the base colour";
}

TEST(LoadGltf, ExtensionsOfMaterials) {
  const Scene scene = loadGood("material_extensions.gltf");
  const Material& all = scene.materials.at(0);
  EXPECT_EQ(all.ior, 1.8F);
  EXPECT_EQ(all.thickness, 2.0F);
  EXPECT_EQ(all.attenuationDistance, 3.0F);
  EXPECT_EQ(all.attenuationColor, glm::vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(all.specular, 0.5F);
  EXPECT_EQ(all.specularColor, glm::vec3(2.0F, 0.5F, 0.0F));
  EXPECT_EQ(all.clearcoat, 0.6F);
  EXPECT_EQ(all.clearcoatRoughness, 0.2F);
  EXPECT_EQ(all.sheenColor, glm::vec3(0.1F, 0.2F, 0.9F));
  EXPECT_EQ(all.sheenRoughness, 0.3F);
  EXPECT_EQ(all.anisotropy, 0.7F);
  EXPECT_EQ(all.anisotropyRotation, 1.5F);
  EXPECT_EQ(all.anisotropyTexture.transform[1][1], 3.0F);
  EXPECT_EQ(all.iridescence, 0.8F);
  EXPECT_EQ(all.iridescenceIor, 1.4F);
  EXPECT_EQ(all.iridescenceThickness, glm::vec2(200.0F, 500.0F));
  EXPECT_EQ(all.diffuseTransmission, 0.25F);
  EXPECT_EQ(all.diffuseTransmissionColor, glm::vec3(0.5F, 0.75F, 1.0F));
  for (const TextureSlot* slot :
       {&all.thicknessTexture, &all.specularTexture, &all.specularColorTexture, &all.clearcoatTexture,
        &all.clearcoatRoughnessTexture, &all.sheenColorTexture, &all.sheenRoughnessTexture, &all.anisotropyTexture,
        &all.iridescenceTexture, &all.iridescenceThicknessTexture}) {
    EXPECT_EQ(slot->image, 0);
  }
  EXPECT_FALSE(all.specularGlossiness);
  const auto warned = [&](const std::string& line) { return std::ranges::count(scene.warnings, line) == 1; };
  EXPECT_TRUE(warned("the clearcoatNormalTexture of materials is not drawn: coats are smooth"));
  EXPECT_TRUE(
      warned("the diffuseTransmissionTexture of materials is not drawn: light comes through the same everywhere"));
}

// The textures of a third set are left out, and those of the first two stay.
TEST(LoadGltf, TwoSetsOfTextureCoordinates) {
  const Scene scene = loadGood("material_extensions.gltf");
  const Material& material = scene.materials.at(2);
  EXPECT_EQ(material.baseColorTexture.image, 0);
  EXPECT_EQ(material.metallicRoughnessTexture.texCoord, 1U);
  EXPECT_EQ(material.clearcoat, 1.0F);
  EXPECT_EQ(material.clearcoatTexture.image, -1);
  EXPECT_EQ(std::ranges::count(scene.warnings,
                               "material 2: a texture with TEXCOORD_2 is left out: at most 2 sets of "
                               "texture coordinates can be drawn"),
            1);
}

// In place of the metallic-roughness material that is there for others.
TEST(LoadGltf, SpecularGlossiness) {
  const Material gloss = loadGood("material_extensions.gltf").materials.at(1);
  EXPECT_TRUE(gloss.specularGlossiness);
  EXPECT_EQ(gloss.baseColor, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
  EXPECT_EQ(gloss.baseColorTexture.image, 0);
  EXPECT_EQ(gloss.specularColor, glm::vec3(0.5F, 0.6F, 0.7F));
  EXPECT_EQ(gloss.roughness, 0.25F);
  EXPECT_EQ(gloss.metallic, 0.0F);
  EXPECT_EQ(gloss.metallicRoughnessTexture.image, 0);
  EXPECT_EQ(gloss.alphaMode, AlphaMode::Blend);
}

TEST(LoadGltf, Volume) {
  const Scene scene = loadGood("volume.gltf");
  const auto named = [&](const std::string& name) {
    return *std::ranges::find(scene.materials, name, &Material::name);
  };
  EXPECT_EQ(named("pane").thickness, 1.0F);
  EXPECT_EQ(named("pane").attenuationDistance, 1.0F);
  EXPECT_EQ(named("pane").attenuationColor, glm::vec3(1.0F, 0.5F, 0.5F));
  EXPECT_EQ(named("textured").thickness, 2.0F);
  EXPECT_EQ(named("textured").thicknessTexture.image, 0);
  EXPECT_EQ(named("thin").thickness, 0.0F);
  EXPECT_EQ(named("clear").attenuationDistance, 0.0F) << "none is an infinite one";
  const glm::vec3 perLength = absorption(named("pane"));
  EXPECT_EQ(perLength.r, 0.0F);
  EXPECT_FLOAT_EQ(perLength.g, std::log(2.0F));
  for (const char* name : {"thin", "clear", "opaque"}) {
    EXPECT_EQ(absorption(named(name)), glm::vec3(0.0F)) << name;
  }
}

TEST(LoadGltf, TextureTransformsScaleThenTurnThenMove) {
  const Scene scene = loadGood("material.gltf");
  const TextureSlot& slot = scene.materials.at(0).baseColorTexture;
  EXPECT_EQ(slot.texCoord, 1U) << "the extension's set overrides the texture's own";
  // (1, 0) is scaled to (2, 0); a quarter turn counter-clockwise, with v downwards, makes it (0, -2).
  expectNear(slot.transform * glm::vec3(1.0F, 0.0F, 1.0F), {0.5F, -1.75F, 1.0F});
  expectNear(slot.transform * glm::vec3(0.0F, 1.0F, 1.0F), {3.5F, 0.25F, 1.0F});
  EXPECT_EQ(scene.materials.at(0).emissiveTexture.transform, glm::mat3(1.0F));
}

TEST(LoadGltf, ImagesInBufferViewsAndBesideTheModel) {
  for (const char* name : {"texture.glb", "external.gltf"}) {
    const Scene scene = loadGood(name);
    ASSERT_EQ(scene.images.size(), 1U) << name;
    EXPECT_EQ(scene.images[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 128})) << name;
    EXPECT_EQ(scene.materials.at(0).baseColorTexture.image, 0);
    EXPECT_EQ(scene.materials.at(0).baseColorTexture.sampler, Sampler{});
    EXPECT_EQ(scene.meshes.at(0).vertex(1).texCoord0, glm::vec2(1.0F, 1.0F));
  }
}

TEST(LoadGltf, SixteenBitImagesAreRoundedToEight) {
  const std::vector<std::uint8_t> pixel = loadGood("sixteen_bit.gltf").images.at(0).rgba;
  EXPECT_EQ(pixel, (std::vector<std::uint8_t>{255, 128, 1, 0}));
}

TEST(LoadGltf, TangentsFollowTheNormalTexturesCoordinates) {
  const Scene scene = loadGood("tangents.gltf");
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.normalTexture.texCoord, 0U) << "TEXCOORD_3 is the only set and becomes the first";
  EXPECT_EQ(material.normalScale, 0.5F);
  const Mesh& mesh = scene.meshes.at(0);
  // The middle edge is shared by the plain and the mirrored quad, so its two vertices are split.
  EXPECT_EQ(mesh.vertexCount(), 8U);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const Vertex vertex = mesh.vertex(mesh.indices[i]);
    const bool mirrored = i >= 6;
    expectNear(vertex.tangent, mirrored ? glm::vec4(-1.0F, 0.0F, 0.0F, -1.0F) : glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
  }
}

TEST(LoadGltf, FromMemoryExternalFilesAreRefused) {
  const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1,"uri":"/etc/hostname"}]})";
  try {
    loadGltf(std::as_bytes(std::span(text)), {});
    FAIL() << "it loaded";
  } catch (const LoadError& error) {
    EXPECT_STREQ(error.what(), "buffer 0: /etc/hostname: external files are not read here");
  }
}

} // namespace
} // namespace vitrail::tool
