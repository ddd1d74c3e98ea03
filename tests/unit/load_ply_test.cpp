// The values that PLY files load to.
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load_good.h"
#include "plain_checks.h"
#include "scene/load.h"

namespace vitrail::tool::test {
namespace {

using Lines = std::vector<std::string>;

constexpr float linearHalf = 0.21404114F; // 0.5 on the sRGB curve, in linear light

// A file of one triangle: what stands behind the three places of each vertex, and behind the face.
std::string triangle(const std::string& properties, const Lines& values, const std::string& faceProperties = "",
                     const std::string& faceValues = "") {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
         properties + "element face 1\nproperty list uchar int vertex_indices\n" + faceProperties +
         "end_header\n0 0 0 " + values.at(0) + "\n1 0 0 " + values.at(1) + "\n0 1 0 " + values.at(2) + "\n3 0 1 2 " +
         faceValues + "\n";
}

std::string rgb(const std::string& type) {
  return "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
}

TEST(LoadPly, ColorsNamedByOneLetterAreSrgbAndTheirAlphaBlends) {
  const Scene scene = loadGood("colors.ply");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.indices.size(), 6U) << "the quad becomes two triangles";
  expectNear(glm::vec3(vertexAt(mesh, 0).color), {1.0F, linearHalf, 0.0F}, 1e-3F);
  EXPECT_EQ(vertexAt(mesh, 0).color.a, 1.0F);
  EXPECT_NEAR(vertexAt(mesh, 1).color.a, 0.2F, 1e-3F);
  expectNear(vertexAt(mesh, 2).normal, {0.0F, 0.0F, 1.0F});
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.alphaMode, AlphaMode::Blend);
  EXPECT_TRUE(material.doubleSided);
  EXPECT_EQ(material.metallic, 0.0F);
  EXPECT_EQ(material.roughness, 0.5F);
  EXPECT_EQ(material.baseColor, glm::vec4(1.0F));
  EXPECT_EQ(scene.file.format, "PLY (text)");
  EXPECT_EQ(scene.file.generator, "made by make_corpus.py");
  EXPECT_EQ(scene.warnings, Lines{});
}

TEST(LoadPly, BigEndianStripsTurnToTheirNormals) {
  const Scene scene = loadGood("strips_big_endian.ply");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 9U) << "two triangles before the restart, one after it";
  expectNear(vertexAt(mesh, 3).position, {1.0F, 1.0F, 0.0F});
  expectNear(glm::vec3(vertexAt(mesh, 0).color), {1.0F, 0.50288649F, 0.0F}, 1e-3F);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(triangleArea(mesh, i).z, 0.0F);
  EXPECT_EQ(scene.materials.at(0).alphaMode, AlphaMode::Opaque);
}

TEST(LoadPly, ConcavePolygonsAreFilledOnce) {
  const Scene scene = loadGood("concave.ply");
  const Mesh& mesh = scene.meshes.at(0);
  float area = 0.0F;
  for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i) area += glm::length(triangleArea(mesh, i));
  EXPECT_NEAR(area, 10.0F, 1e-4F);
  expectNear(glm::vec3(scene.materials.at(0).baseColor), glm::vec3(0.8F));
}

TEST(LoadPly, FacesHaveTheirOwnColorsAndShareTheirNormals) {
  const Scene scene = loadGood("face_colors.ply");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const Vertex vertex = cornerAt(mesh, i);
    expectNear(glm::vec3(vertex.color), i < 3 ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 0.0F, 1.0F), 1e-3F);
    EXPECT_NEAR(vertex.color.a, i < 3 ? 0.50196F : 1.0F, 1e-3F);
    expectNear(vertex.normal, {0.0F, 0.0F, 1.0F});
  }
  EXPECT_EQ(scene.materials.at(0).alphaMode, AlphaMode::Blend);
  EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec4(1.0F));
  EXPECT_EQ(scene.warnings, Lines{});
}

TEST(LoadPly, FacesOfOneColorShareTheirVertices) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
      "property list uchar int vertex_indices\n" +
      rgb("uchar") + "end_header\n0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n";
  const auto vertexCount = [](const Scene& scene) {
    const auto& indices = scene.meshes.at(0).indices;
    return *std::ranges::max_element(indices) + 1;
  };
  const Scene same = plyOf(header + "3 0 1 2 9 9 9\n3 0 2 3 9 9 9\n");
  EXPECT_EQ(vertexCount(same), 4U);
  const Scene different = plyOf(header + "3 0 1 2 9 9 9\n3 0 2 3 9 9 8\n");
  EXPECT_EQ(vertexCount(different), 6U);
  expectNear(cornerAt(different.meshes.at(0), 0).normal, cornerAt(different.meshes.at(0), 3).normal);
}

TEST(LoadPly, FacesNameOneOfSeveralTextures) {
  const Scene scene = loadGood("face_textures.ply");
  ASSERT_EQ(scene.draws.size(), 4U) << "two textures, one that is missing, and none";
  EXPECT_EQ(scene.images.size(), 2U);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("not there.png"), std::string::npos) << scene.warnings[0];
  std::vector<std::size_t> trianglesOf(3, 0);
  for (const Draw& draw : scene.draws) {
    const std::int32_t image = scene.materials.at(draw.material).baseColorTexture.image;
    trianglesOf.at(static_cast<std::size_t>(image + 1)) += scene.meshes.at(draw.mesh).indices.size() / 3;
    if (image == 1) {
      EXPECT_EQ(cornerAt(scene.meshes.at(draw.mesh), 0).texCoord0, glm::vec2(0.0F, 1.0F));
      EXPECT_EQ(cornerAt(scene.meshes.at(draw.mesh), 2).texCoord0, glm::vec2(1.0F, 0.75F)) << "v grows upwards";
    }
    if (image < 0) expectNear(glm::vec3(scene.materials.at(draw.material).baseColor), glm::vec3(0.8F));
  }
  EXPECT_EQ(trianglesOf, (std::vector<std::size_t>{2, 2, 1}));
}

TEST(LoadPly, TheTextureHidesColorsAndAFileWithoutCoordinatesShowsNone) {
  const std::string body = "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n";
  const auto file = [&](const std::string& lists, const std::string& values) {
    return "ply\nformat ascii 1.0\ncomment TextureFile leaf.png\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\n" +
           rgb("uchar") + "element face 1\nproperty list uchar int vertex_indices\n" + lists + "end_header\n" + body +
           "3 0 1 2" + values + "\n";
  };
  const auto load = [](const std::string& text) {
    return loadPly(std::as_bytes(std::span(text)), std::filesystem::path(VITRAIL_TEST_CORPUS) / "good");
  };
  const std::string texCoords = "property list uchar float texcoord\n";
  const Scene textured = load(file(texCoords, " 6 0 0 1 0 1 1"));
  EXPECT_EQ(textured.materials.at(0).baseColorTexture.image, 0);
  EXPECT_EQ(vertexAt(textured.meshes.at(0), 0).color, glm::vec4(1.0F));
  EXPECT_EQ(textured.warnings, Lines{"the colours of vertices and faces are not drawn: the texture is"});
  const Scene plain = load(file("", ""));
  EXPECT_EQ(plain.materials.at(0).baseColorTexture.image, -1);
  expectNear(glm::vec3(vertexAt(plain.meshes.at(0), 0).color), {1.0F, 0.0F, 0.0F}, 1e-3F);
  EXPECT_EQ(plain.warnings, Lines{"TextureFile leaf.png: is not drawn, since the file has no texture coordinates"});
  const Scene odd = load(file(texCoords, " 5 0 0 1 0 1"));
  EXPECT_EQ(odd.warnings.back(),
            "passed over, since they do not have two numbers a corner: the texture coordinates of 1 of 1 faces");
  const std::string missing = file(texCoords, " 6 0 0 1 0 1 1");
  const Scene alone = loadPly(std::as_bytes(std::span(missing)), {});
  expectNear(glm::vec3(vertexAt(alone.meshes.at(0), 0).color), {1.0F, 0.0F, 0.0F}, 1e-3F);
  ASSERT_EQ(alone.warnings.size(), 1U);
  EXPECT_NE(alone.warnings[0].find("leaf.png"), std::string::npos) << alone.warnings[0];
}

TEST(LoadPly, ArtecsTexturesOfFaces) {
  const Scene scene = loadGood("artec.ply");
  ASSERT_EQ(scene.draws.size(), 2U);
  EXPECT_EQ(scene.warnings, Lines{});
  for (const Draw& draw : scene.draws) {
    const Mesh& mesh = scene.meshes.at(draw.mesh);
    ASSERT_EQ(mesh.indices.size(), 3U);
    const bool second = scene.materials.at(draw.material).baseColorTexture.image == 1;
    EXPECT_EQ(cornerAt(mesh, 1).texCoord0, second ? glm::vec2(1.0F, 0.75F) : glm::vec2(1.0F, 1.0F));
  }
}

TEST(LoadPly, CornersHaveTheirOwnColors) {
  const Scene scene = loadGood("corner_colors.ply");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 6U);
  expectNear(glm::vec3(cornerAt(mesh, 0).color), {1.0F, 0.0F, 0.0F}, 1e-3F);
  expectNear(glm::vec3(cornerAt(mesh, 1).color), {0.0F, 1.0F, 0.0F}, 1e-3F);
  expectNear(glm::vec3(cornerAt(mesh, 2).color), {0.0F, 0.0F, 1.0F}, 1e-3F);
}

TEST(LoadPly, ColorsOfVerticesComeBeforeThoseOfFaces) {
  const Scene scene = plyOf(triangle(rgb("uchar"), {"255 0 0", "255 0 0", "255 0 0"}, rgb("uchar"), "0 0 255"));
  expectNear(glm::vec3(vertexAt(scene.meshes.at(0), 0).color), {1.0F, 0.0F, 0.0F}, 1e-3F);
  EXPECT_EQ(scene.warnings, Lines{"the colours of faces are not drawn: those of vertices are"});
}

// Whatever type a program chose, the colour that it meant is seen.
TEST(LoadPly, ColorsOfEveryTypeHaveTheirScale) {
  const auto green = [](const std::string& type, const std::string& full, const std::string& half) {
    const std::string value = full + " " + half + " 0";
    const Scene scene = plyOf(triangle(rgb(type), {value, value, value}));
    const glm::vec4 color = vertexAt(scene.meshes.at(0), 0).color;
    EXPECT_NEAR(color.r, 1.0F, 1e-3F) << type;
    return color.g;
  };
  EXPECT_NEAR(green("uchar", "255", "188"), 0.50288649F, 1e-3F);
  EXPECT_NEAR(green("float", "1", "0.5"), linearHalf, 1e-3F);
  EXPECT_NEAR(green("double", "255", "188"), 0.50288649F, 1e-3F) << "floats that run to 255";
  EXPECT_NEAR(green("ushort", "65535", "32768"), linearHalf, 1e-3F);
  EXPECT_NEAR(green("ushort", "255", "188"), 0.50288649F, 1e-3F) << "bytes in a wider type";
  EXPECT_NEAR(green("int", "255", "188"), 0.50288649F, 1e-3F);
  EXPECT_NEAR(green("uint", "4294967295", "2147483648"), linearHalf, 1e-3F);
  EXPECT_NEAR(green("char", "-1", "-68"), 0.50288649F, 1e-3F) << "bytes that were meant without a sign";
}

TEST(LoadPly, PointsAreDrawnWithoutThoseThatAreNotFinite) {
  const Scene scene = loadGood("points.ply");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.primitive, Primitive::Points);
  ASSERT_EQ(mesh.indices.size(), 3U);
  expectNear(cornerAt(mesh, 2).position, {1.0F, 2.0F, 0.0F});
  expectNear(glm::vec3(cornerAt(mesh, 0).color), {1.0F, 0.0F, linearHalf}, 1e-3F);
  EXPECT_EQ(scene.warnings, Lines{"left out, since they are not finite: 1 of 4 points"});
  EXPECT_EQ(scene.file.format, "PLY (binary)");
}

TEST(LoadPly, FacesAtAVertexThatIsNotFiniteAreLeftOut) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
      "property list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  for (const std::string& wrong : Lines{"nan 0 0", "0 -inf 0", "0 0 -nan(ind)", "-1.#IND00 0 0", "0 1e999 0"}) {
    const Scene scene = plyOf(header + wrong + "\n3 0 1 2\n3 0 1 3\n");
    EXPECT_EQ(scene.meshes.at(0).indices.size(), 3U) << wrong;
    EXPECT_EQ(scene.warnings, Lines{"left out, since a vertex is not finite: 1 of 2 faces"}) << wrong;
  }
}

TEST(LoadPly, GaussianSplatsArePointsInTheirFirstColor) {
  const Scene scene = loadGood("splats.ply");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.primitive, Primitive::Points);
  ASSERT_EQ(mesh.indices.size(), 2U);
  expectNear(glm::vec3(cornerAt(mesh, 0).color), {1.0F, linearHalf, 0.0F}, 1e-3F);
  EXPECT_NEAR(cornerAt(mesh, 0).color.a, 0.5F, 1e-3F) << "opacity is stated as a logit";
  EXPECT_NEAR(cornerAt(mesh, 1).color.a, 1.0F, 1e-3F);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.warnings[0],
            "the vertices are Gaussian splats: their centres are drawn as points in their first colour; their extent "
            "(scale, rot) and what depends on the view (f_rest) are not drawn");
}

TEST(LoadPly, EdgesAreLinesInTheirColors) {
  const Scene scene = loadGood("edges.ply");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.primitive, Primitive::Lines);
  ASSERT_EQ(mesh.indices.size(), 4U);
  expectNear(glm::vec3(cornerAt(mesh, 1).color), {1.0F, 0.0F, 0.0F}, 1e-3F);
  expectNear(glm::vec3(cornerAt(mesh, 2).color), {0.0F, 0.0F, 1.0F}, 1e-3F);
  expectNear(cornerAt(mesh, 1).position, cornerAt(mesh, 2).position);
}

TEST(LoadPly, WhatIsFarAwayIsCentredInDoublePrecision) {
  const Scene scene = loadGood("far_away.ply");
  EXPECT_EQ(scene.origin, glm::dvec3(500000.75, 4649776.625, 10.5));
  expectNear(cornerAt(scene.meshes.at(0), 0).position, {-0.5F, -0.5F, 0.0F});
  expectNear(cornerAt(scene.meshes.at(0), 2).position, {-0.5F, 0.5F, 0.0F});
  EXPECT_EQ(loadGood("colors.ply").origin, glm::dvec3(0.0));
}

TEST(LoadPly, WindowsLineEndsAndPropertiesOfNoMeaning) {
  const Scene scene = loadGood("windows.ply");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 6U) << "the range grid's list is no face";
  EXPECT_NEAR(glm::length(triangleArea(mesh, 0) + triangleArea(mesh, 1)), 1.0F, 1e-5F);
  EXPECT_EQ(*std::ranges::max_element(mesh.indices), 3U) << "the vertex of no face is not part of the model";
  EXPECT_EQ(scene.warnings, Lines{});
}

TEST(LoadPly, OldMacLineEndsAndByteOrderMarks) {
  std::string text = triangle("", {"", "", ""});
  const Scene marked = plyOf("\xef\xbb\xbf" + text);
  EXPECT_EQ(marked.meshes.at(0).indices.size(), 3U);
  std::ranges::replace(text, '\n', '\r');
  EXPECT_EQ(plyOf(text).meshes.at(0).indices.size(), 3U);
}

TEST(LoadPly, NormalsThatAreAllZeroAreMadeFromTheFaces) {
  const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
  const Scene scene = plyOf(triangle(normals, {"0 0 0", "0 0 0", "0 0 0"}));
  expectNear(vertexAt(scene.meshes.at(0), 0).normal, {0.0F, 0.0F, 1.0F});
}

// Text keeps every digit, since float and double both hold them.
TEST(LoadPly, NumbersOfText) {
  const auto x = [](const std::string& word) {
    const Scene scene = plyOf(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
        "property double z\nend_header\n0 0 0\n" +
        word + " 0 0\n");
    return cornerAt(scene.meshes.at(0), 1).position.x;
  };
  EXPECT_EQ(x("+1.5"), 1.5F);
  EXPECT_EQ(x("-.25E1"), -2.5F);
  EXPECT_EQ(x("1."), 1.0F);
  EXPECT_EQ(x("1e-400"), 0.0F);
  EXPECT_EQ(x("0.1000000014901161193847656250000001"), 0.1F);
  EXPECT_EQ(x("123456789012345678901234567890e-29"), 1.2345679F);
  EXPECT_EQ(x("16777217.0000001"), 16777218.0F) << "rounded once";
  EXPECT_THROW(x("1,5"), LoadError);
  EXPECT_THROW(x("0x10"), LoadError);
  EXPECT_THROW(x("1e"), LoadError);
  EXPECT_THROW(x("+-1"), LoadError);
}

std::string withoutLast(const std::string& text, std::size_t bytes) { return text.substr(0, text.size() - bytes); }

const std::string places = "property float x\nproperty float y\nproperty float z\n";

TEST(LoadPly, CornersOfFacesHaveManyNames) {
  const auto file = [](const std::string& element, const std::string& lists, const std::string& values) {
    return "ply\nformat ASCII 1.0\nelement vertex 3\n" + places + "element " + element + " 1\n" + lists +
           "end_header\n0 0 0\n1 0 0\n0 1 0\n" + values + "\n";
  };
  for (const std::string& name : Lines{"vertex_indexes", "indices", "corners"}) {
    const Scene scene = plyOf(file("Polygons", "property list uchar int " + name + "\n", "3 0 1 2"));
    EXPECT_EQ(scene.meshes.at(0).primitive, Primitive::Triangles) << name;
    EXPECT_EQ(scene.warnings, Lines{}) << name;
  }
  const std::string several = "property list uchar int one\nproperty list uchar int other\n";
  EXPECT_EQ(plyOf(file("face", several, "3 0 1 2 3 0 1 2")).warnings,
            Lines{"left out: 1 elements named face, since none of their lists is known to hold their vertices"});
  EXPECT_EQ(plyOf(file("patch", several, "3 0 1 2 3 0 1 2")).warnings,
            Lines{"left out: 1 elements named patch, since it is not known what their lists are"});
  const std::string indices = "property list uchar int other\nproperty list uchar int indices\n";
  EXPECT_EQ(plyOf(file("face", indices, "1 9 3 0 1 2")).meshes.at(0).indices.size(), 3U);
}

TEST(LoadPly, FilesThatAreCutOffAreDrawnAsFarAsTheyGo) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\n" + places +
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  const Scene faces = plyOf(header + "3 0 1 2\n3 0 1");
  EXPECT_EQ(faces.meshes.at(0).indices.size(), 3U);
  EXPECT_EQ(faces.warnings, Lines{"the file ends in face 2 of 2: what is there before is drawn"});
  EXPECT_THROW(plyOf(header + "3 0 1"), LoadError) << "vertices alone do not show a model of faces";

  const auto points = [](const std::string& count) {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + count + "\n" + places + "end_header\n" +
           std::string(36, '\0');
  };
  const Scene cut = plyOf(withoutLast(points("3"), 1));
  EXPECT_EQ(cut.meshes.at(0).indices.size(), 2U);
  EXPECT_EQ(cut.warnings, Lines{"the file ends in vertex 3 of 3: what is there before is drawn"});
  EXPECT_EQ(plyOf(points("4000000000")).meshes.at(0).indices.size(), 3U);

  std::string damaged = withoutLast(points("3"), 1);
  damaged.replace(damaged.size() - 35, 4, "\x7e\x7e\x7e\x7e");
  try {
    plyOf(damaged);
    ADD_FAILURE();
  } catch (const LoadError& error) {
    EXPECT_EQ(std::string(error.what()),
              "the file ends in vertex 3 of 3, and what is there before reaches farther than 1e+15: it is damaged");
  }

  const Scene number = plyOf("ply\nformat ascii 1.0\nelement vertex 2\n" + places + "end_header\n0 0 0\n1 0 -");
  EXPECT_EQ(number.meshes.at(0).indices.size(), 1U);
  const std::string facesFirst =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 3\n" +
      places + "end_header\n3 0 1 2\n0 0 0\n1 0 0\n";
  EXPECT_THROW(plyOf(facesFirst), LoadError);
  EXPECT_EQ(plyOf(facesFirst + "0 1 0\n").meshes.at(0).indices.size(), 3U);
}

TEST(LoadPly, AlphaWithoutColorsIsThatOfThePlainColor) {
  const Scene vertices = plyOf(triangle("property uchar alpha\n", {"51", "51", "51"}));
  const glm::vec4 color = cornerAt(vertices.meshes.at(0), 0).color;
  expectNear(glm::vec3(color), glm::vec3(0.8F), 2e-3F);
  EXPECT_NEAR(color.a, 0.2F, 1e-3F);
  EXPECT_EQ(vertices.materials.at(0).alphaMode, AlphaMode::Blend);
  const Scene faces = plyOf(triangle("", {"", "", ""}, "property float alpha\n", "0.25"));
  EXPECT_NEAR(cornerAt(faces.meshes.at(0), 0).color.a, 0.25F, 1e-3F);
  const Scene both = plyOf(triangle("property uchar alpha\n", {"51", "51", "51"}, rgb("uchar"), "255 0 0"));
  expectNear(glm::vec3(cornerAt(both.meshes.at(0), 0).color), {1.0F, 0.0F, 0.0F}, 1e-3F);
  EXPECT_EQ(both.warnings, Lines{"the alpha of vertices is not drawn: the colours of faces are"});
}

TEST(LoadPly, LinesOfTextMayHoldMoreThanIsStated) {
  const Scene scene = plyOf(triangle("", {"7 7", "7 7", "7 7"}, "", "255 0 0"));
  expectNear(cornerAt(scene.meshes.at(0), 1).position, {1.0F, 0.0F, 0.0F});
  EXPECT_EQ(scene.warnings, Lines{"passed over: what 4 lines hold behind the values that the header states"});
  std::string oneLine = triangle("", {"", "", ""});
  std::replace(oneLine.begin() + static_cast<std::ptrdiff_t>(oneLine.find("end_header") + 11), oneLine.end(), '\n',
               ' ');
  const Scene joined = plyOf(oneLine);
  expectNear(cornerAt(joined.meshes.at(0), 1).position, {1.0F, 0.0F, 0.0F});
  EXPECT_EQ(joined.warnings, Lines{});
}

} // namespace
} // namespace vitrail::tool::test
