// What OBJ files and their libraries load to, as other programs write them.
#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "load_good.h"
#include "scene/load.h"
#include "scene/plain/mtl.h"
#include "scene/plain/number.h"
#include "scene/plain/obj_text.h"
#include "scene/plain/origin.h"
#include "scene/plain/text_encoding.h"

namespace vitrail::tool::obj_test {
namespace {

constexpr float linearHalf = 0.21404114F; // 0.5 on the sRGB curve, in linear light
const std::string quad = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";

Scene load(std::string_view text) { return loadObj(std::as_bytes(std::span(text)), {}); }

std::string failureOf(std::string_view text) {
  try {
    load(text);
  } catch (const LoadError& error) {
    return error.what();
  }
  return {};
}

const Material& materialNamed(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.materials, name, &Material::name);
  if (found == scene.materials.end()) throw std::out_of_range(name);
  return *found;
}

const Mesh& meshOf(const Scene& scene, const std::string& material) {
  for (const Draw& draw : scene.draws)
    if (scene.materials[draw.material].name == material) return scene.meshes[draw.mesh];
  throw std::out_of_range(material);
}

float opacityIn(std::string_view library, std::string_view name = "a") {
  const MtlLibrary read = readMtl(library);
  const MtlMaterial* material = read.find(name);
  return material == nullptr ? -1.0F : opacityOf(*material, read);
}

using Lines = std::vector<std::string>;

// ---- Numbers

TEST(ParseNumber, RoundsAsTheStandardLibraryDoes) {
  for (const char* word :
       {"0", "-0", "+1.5", "1.", ".5", "-12.345678", "4649780.9238", "1e5", "1E-5", "123456789012345678",
        "0.1234567890123456789012345", "9007199254740993", "1e22", "1e23", "3.4028235e38", "1e-320", "2.5e-8",
        "179769313486231570000000000000000000000", "0.000000000000000000000000000000000000001"}) {
    const std::string text(word);
    double value = -1.0;
    EXPECT_EQ(parseNumber(text.data(), text.data() + text.size(), value), text.data() + text.size()) << word;
    EXPECT_EQ(value, std::stod(text == "1e-320" ? "0x1.fap-1064" : text)) << word;
  }
}

TEST(ParseNumber, StopsWhereTheNumberDoes) {
  double value = 0.0;
  const std::string_view text = "1.5e3x";
  EXPECT_EQ(parseNumber(text.data(), text.data() + text.size(), value), text.data() + 5);
  EXPECT_EQ(value, 1500.0);
  for (const std::string_view none : {"", "-", ".", "nan", "inf", "1e", "x", "1e999", "-1e400"})
    EXPECT_EQ(parseNumber(none.data(), none.data() + none.size(), value), nullptr) << none;
  const std::string_view small = "1e-999";
  EXPECT_NE(parseNumber(small.data(), small.data() + small.size(), value), nullptr);
  EXPECT_EQ(value, 0.0);
}

// ---- Texts

TEST(PlainText, Utf16OfBothOrdersAndMarks) {
  const std::u16string text = u"v\u00e9 \u20ac \U0001f600\n";
  const std::string expected = "v\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80\n";
  for (const bool bigEndian : {false, true})
    for (const bool marked : {false, true}) {
      std::string bytes = !marked ? "" : bigEndian ? "\xfe\xff" : "\xff\xfe";
      for (const char16_t unit : text) {
        const char high = static_cast<char>(unit >> 8U);
        const char low = static_cast<char>(unit & 0xffU);
        bytes += bigEndian ? std::string{high, low} : std::string{low, high};
      }
      // Without a mark the first characters tell.
      if (!marked && text[1] > 0xff) continue;
      EXPECT_EQ(PlainText(std::as_bytes(std::span(bytes))).view(), expected) << bigEndian << marked;
    }
}

TEST(PlainText, Utf8MarksAndLinesThatEndInReturns) {
  const auto viewOf = [](std::string_view text) {
    return std::string(PlainText(std::as_bytes(std::span(text))).view());
  };
  EXPECT_EQ(viewOf("\xef\xbb\xbfv 1"), "v 1");
  EXPECT_EQ(viewOf("v 1\rf 2\r"), "v 1\nf 2\n");
  EXPECT_EQ(viewOf("v 1\r\nf 2\r\n"), "v 1\r\nf 2\r\n");
  EXPECT_EQ(viewOf(""), "");
}

TEST(LoadObj, ReturnsUtf16AndMarksAreRead) {
  std::string returns = quad + "f 1 2 3 4\n";
  std::ranges::replace(returns, '\n', '\r');
  EXPECT_EQ(load(returns).meshes.at(0).indices.size(), 6U);
  std::string wide = "\xff\xfe";
  for (const char c : quad + "f 1 2 3 4\n") wide += {c, '\0'};
  EXPECT_EQ(load(wide).meshes.at(0).indices.size(), 6U);
  EXPECT_EQ(load("\xef\xbb\xbf" + quad + "f 1 2 3 4\n").meshes.at(0).indices.size(), 6U);
}

TEST(LoadObj, CommentsMayFollowData) {
  const Scene scene = load("v 0 0 0 # first\nv 1 0 0#second\nv 0 1 0 1 0.5 0 #\nf 1 2 3 # face\n");
  EXPECT_EQ(scene.meshes.at(0).indices.size(), 3U);
  expectNear(glm::vec3(scene.meshes[0].vertex(2).color), {1.0F, linearHalf, 0.0F}, 1e-3F);
  EXPECT_EQ(scene.warnings, Lines{});
}

TEST(LoadObj, StatementsMayBeInUpperCase) {
  const Scene scene = load("V 0 0 0\nV 1 0 0\nV 0 1 0\nVN 0 0 1\nUSEMTL Red\nF 1//1 2//1 3//1\n");
  EXPECT_EQ(scene.meshes.at(0).indices.size(), 3U);
  EXPECT_EQ(scene.materials.at(0).name, "Red");
  EXPECT_EQ(failureOf("V 0 0 0\nF 1 1 2\n"), "line 2: a face names vertex 2, but there are 1");
}

// Corners of one position that all differ must not take time with the square of their number.
TEST(LoadObj, ThousandsOfVerticesAtOnePosition) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 1; i <= 200000; ++i) {
    const std::string number = std::to_string(i);
    text += "vt 0 " + number + "\nf 1/" + number + " 2/1 3/1\n";
  }
  const Scene scene = load(text);
  EXPECT_EQ(scene.meshes.at(0).indices.size(), 600000U);
}

TEST(LoadObj, ErrorsNameTheirLineInLargeFilesToo) {
  // Large enough for several threads, whose parts do not begin at line 1.
  std::string text;
  for (int i = 0; i < 200000; ++i) text += "v 0.25 0.5 0.75\n";
  EXPECT_EQ(failureOf(text + "f 1 2 \\\n3\nv 1 x 2\n"), "line 200003: x is not a finite number");
  EXPECT_EQ(failureOf(text + "f 1 2 \\\n3\nf 1 2 -200001\n"),
            "line 200003: a face names vertex -200001, but there are 200000");
  EXPECT_EQ(failureOf(text + "l 1 200001"), "line 200001: a line names vertex 200001, but there are 200000");
  EXPECT_EQ(failureOf(text + "f 1 2 0"), "line 200001: a face names vertex 0, but there are 200000");
}

TEST(LoadObj, IndicesCountAcrossTheThreadsParts) {
  std::string text;
  std::string faces;
  constexpr int count = 60000;
  for (int i = 0; i < count; ++i) {
    const std::string x = std::to_string(i);
    text += "v " + x + " 0 0\nv " + x + " 1 0\nv " + x + " 1 1\nvn 1 0 0\nf -3//-1 -2//-1 -1//-1\n";
  }
  const Scene scene = load(text);
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 3U * count);
  ASSERT_EQ(mesh.vertexCount(), 3U * count);
  for (int i = 0; i < count; i += 7) {
    EXPECT_EQ(mesh.positions[mesh.indices[static_cast<std::size_t>(3 * i)]].x, static_cast<float>(i));
    EXPECT_EQ(mesh.positions[mesh.indices[static_cast<std::size_t>(3 * i + 2)]].x, static_cast<float>(i));
  }
  expectNear(mesh.vertex(5).normal, {1.0F, 0.0F, 0.0F});
}

TEST(LoadObj, CornersShareVerticesWhereAllTheyNameIsTheSame) {
  const Scene scene =
      load(quad + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 2/1 4/1\nvn 0 0 1\nf 1/1/1 2/1/1 4/1/1\n");
  EXPECT_EQ(scene.meshes.at(0).vertexCount(), 4U + 1U + 3U);
}

TEST(LoadObj, NormalsAndCoordinatesThatAreNotThereAreLeftOut) {
  const Scene scene = load(quad + "vt 0.5 0.25\nf 1/1/1 2/1/1 3/2/1 4/-2/1\nf 1/0/0 2/0/0 3/0/0\n");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.indices.size(), 9U);
  EXPECT_EQ(scene.warnings,
            (Lines{"line 6: a face names texture coordinate 2, but there are 1; it is drawn without, and so are others "
                   "like it",
                   "line 6: a face names normal 1, but there are 0; it is drawn without, and so are others like it"}));
  expectNear(mesh.vertex(0).normal, {0.0F, 0.0F, 1.0F});
}

TEST(LoadObj, NumbersThatProgramsWriteWrongly) {
  const Scene scene = load("v 0, 0, 0\nv 1,5 0 0\nv 0 1 0\nvn nan 0 0\nvn -1.#IND00 0 0\nf 1//1 2//1 3//1\n");
  expectNear(scene.meshes.at(0).positions[1], {1.5F, 0.0F, 0.0F});
  expectNear(scene.meshes[0].vertex(0).normal, {0.0F, 0.0F, 1.0F});
  EXPECT_EQ(scene.warnings, Lines{"line 4: a normal is not a finite number and is left out"});
}

TEST(LoadObj, StatementsThatAreLeftOutAreNamed) {
  const Scene scene = load("o box\ng a b\nlod 1\nvp 0.5 0.5\ncstype bezier\n" + quad +
                           "curv 0 1 1 2 3 4\nsurf 0 1 0 1 1 2 3 4\nfoo\nbar\ncall other.obj\nf 1 2\nf 1 2 3 4\n");
  EXPECT_EQ(scene.warnings, (Lines{"line 10: curves and free-form surfaces are left out",
                                   "line 12: \"foo\" is no statement of OBJ and is passed over",
                                   "line 14: \"call\" is not followed: what it would add is left out",
                                   "faces of fewer than three corners are left out"}));
}

// ---- Shapes

TEST(LoadObj, VerticesThatAreNotFiniteAreLeftOutWithWhatTheyAreOf) {
  for (const std::string word : {"nan", "-inf", "1.#QNAN", "1e999", "1e39"}) {
    SCOPED_TRACE(word);
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 " + word + " 0\n";
    const Scene scene = load(vertices + "f 1 2 3\nf 2 3 4\nl 1 4\nl 1 2\np 1 4\n");
    EXPECT_EQ(scene.meshes.at(0).indices.size(), 3U);
    EXPECT_EQ(scene.warnings,
              Lines{"left out, since a vertex is not finite: 1 of 2 faces, 1 of 2 lines, 1 of 2 points"});
    const Scene cloud = load(vertices);
    EXPECT_EQ(cloud.meshes.at(0).indices.size(), 3U);
    EXPECT_EQ(cloud.warnings, Lines{"left out, since a vertex is not finite: 1 of 4 points"});
  }
  EXPECT_EQ(load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\n").warnings, Lines{}) << "of nothing";
}

TEST(LoadObj, ZerosAtTheEndAreNoStatement) {
  EXPECT_EQ(load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + std::string(9, '\0')).warnings, Lines{});
}

TEST(LoadObj, LinesAndPointsBecomeMeshesOfTheirKind) {
  const Scene scene = load(quad + "usemtl a\nf 1 2 3\nl 1 2 3\nl -1 -2\np 1 4\nusemtl b\nl 2/1 3/1\n");
  ASSERT_EQ(scene.meshes.size(), 4U);
  EXPECT_EQ(scene.meshes[0].primitive, Primitive::Triangles);
  EXPECT_EQ(scene.meshes[1].primitive, Primitive::Lines);
  ASSERT_EQ(scene.meshes[1].indices.size(), 6U);
  EXPECT_EQ(scene.meshes[1].vertexCount(), 4U);
  EXPECT_TRUE(scene.meshes[1].normals.empty()) << "not lit";
  expectNear(scene.meshes[1].positions[scene.meshes[1].indices[4]], {-1.0F, 1.0F, 0.0F});
  EXPECT_EQ(scene.meshes[2].primitive, Primitive::Points);
  EXPECT_EQ(scene.meshes[2].indices.size(), 2U);
  EXPECT_EQ(scene.materials[scene.draws[3].material].name, "b");
}

TEST(LoadObj, VerticesAloneAreACloudOfPoints) {
  const Scene scene = load("v 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\nv 0 1 0 1 0.5 0\n");
  ASSERT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(scene.meshes[0].primitive, Primitive::Points);
  EXPECT_EQ(scene.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
  expectNear(glm::vec3(scene.meshes[0].vertex(1).color), {1.0F, linearHalf, 0.0F}, 1e-3F);
}

// A roof whose two sides meet at 90 degrees, in files without normals.
TEST(LoadObj, SmoothingGroupsSayWhatIsSmooth) {
  const std::string roof = "v 0 0 -1\nv 0 0 1\nv -1 -1 0\nv 1 -1 0\n";
  const std::string left = "f 1 3 2\n";
  const std::string right = "f 1 2 4\n";
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  const float half = 0.70710678F;
  const auto ridge = [&](const std::string& text) {
    const Scene scene = load(roof + text);
    const Mesh& mesh = scene.meshes.at(0);
    // Of the left side, whose plane faces (-1, 1, 0).
    if (mesh.normals.empty()) return glm::vec3(-half, half, 0.0F);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
      for (std::size_t c = 0; c < 3; ++c)
        if (mesh.positions[mesh.indices[i + c]].x == -1.0F) return mesh.vertex(mesh.indices[i + (c + 1) % 3]).normal;
    return glm::vec3(0.0F);
  };
  expectNear(ridge(left + right), {-half, half, 0.0F}, 1e-4F);
  expectNear(ridge("s 1\n" + left + right), up, 1e-4F);
  expectNear(ridge("s off\n" + left + right), {-half, half, 0.0F}, 1e-4F);
  EXPECT_TRUE(load(roof + "s 0\n" + left + right).meshes[0].normals.empty()) << "flat as it is";
  expectNear(ridge("s 1\n" + left + "s 2\n" + right), {-half, half, 0.0F}, 1e-4F);
  expectNear(ridge("s 1\n" + left + "s off\n" + right), {-half, half, 0.0F}, 1e-4F);
  const Scene mixed = load(roof + "s off\n" + left + "s 3\n" + right);
  ASSERT_EQ(mixed.meshes.size(), 1U);
  EXPECT_EQ(mixed.meshes[0].indices.size(), 6U);
  // Normals of the file come first.
  expectNear(ridge("vn 0 0 1\ns off\nf 1//1 3//1 2//1\n"), {0.0F, 0.0F, 1.0F}, 1e-4F);
}

TEST(LoadObj, ZBrushPolypaintAndColoursTo255) {
  const Scene painted = load("v 0 0 0\nv 1 0 0\nv 0 1 0\n#MRGB ff00ff00ff0000ff\n#MRGB ffff0000\nf 1 2 3\n");
  const Mesh& mesh = painted.meshes.at(0);
  expectNear(glm::vec3(mesh.vertex(0).color), {0.0F, 1.0F, 0.0F});
  expectNear(glm::vec3(mesh.vertex(1).color), {0.0F, 0.0F, 1.0F});
  expectNear(glm::vec3(mesh.vertex(2).color), {1.0F, 0.0F, 0.0F});
  expectNear(glm::vec3(painted.materials[0].baseColor), glm::vec3(1.0F));
  const Scene bytes = load("v 0 0 0 255 128 0\nv 1 0 0 0 0 255\nv 0 1 0 255 255 255\nf 1 2 3\n");
  expectNear(glm::vec3(bytes.meshes.at(0).vertex(0).color), {1.0F, 0.2158605F, 0.0F}, 1e-3F);
  EXPECT_EQ(bytes.materials[0].alphaMode, AlphaMode::Opaque);
}

TEST(LoadObj, AFileTellsItsProgram) {
  const Scene scene = load("##\n# Blender 4.1 OBJ File\n# other\n" + quad + "f 1 2 3\n");
  EXPECT_EQ(scene.file.format, "OBJ");
  EXPECT_EQ(scene.file.generator, "Blender 4.1 OBJ File");
}

// ---- Large coordinates

TEST(OriginOf, IsTheMiddleOfWhatLiesFarAwayOnly) {
  EXPECT_EQ(originOf({-1.0, -2.0, -3.0}, {4.0, 5.0, 6.0}), glm::dvec3(0.0));
  EXPECT_EQ(originOf({150.0, 0.0, 0.0}, {160.0, 1.0, 1.0}), glm::dvec3(0.0));
  EXPECT_EQ(originOf({499995.0, 4649776.0, 115.2}, {500005.0, 4649786.0, 124.8}),
            glm::dvec3(500000.0, 4649781.0, 120.0));
  EXPECT_EQ(originOf({1e6, 0.0, 0.0}, {1e6 + 0.25, 0.25, 0.25}), glm::dvec3(1e6 + 0.125, 0.125, 0.125));
}

TEST(LoadObj, MapCoordinatesKeepTheirPrecision) {
  const Scene scene = load(
      "v 500000.01 4649781.02 120.03\nv 500001.01 4649781.02 120.03\nv 500000.01 4649782.06 120.03\n"
      "v 0 0 0\nf 1 2 3\n");
  // The stray vertex at the origin does not count.
  EXPECT_NEAR(glm::distance(scene.origin, glm::dvec3(500000.51, 4649781.54, 120.03)), 0.0, 1e-8);
  const Mesh& mesh = scene.meshes.at(0);
  expectNear(mesh.positions[0], {-0.5F, -0.52F, 0.0F}, 1e-7F);
  expectNear(mesh.positions[2], {-0.5F, 0.52F, 0.0F}, 1e-7F);
  EXPECT_EQ(load(quad + "f 1 2 3 4\n").origin, glm::dvec3(0.0));
}

// ---- Libraries

TEST(LoadObj, FilesAreFoundInAnotherLetterCase) {
  const Scene scene = loadGood("obj/letter_case/model.obj");
  EXPECT_EQ(scene.materials.at(0).baseColorTexture.image, 0);
  EXPECT_EQ(scene.materials[0].alphaMode, AlphaMode::Blend);
  EXPECT_EQ(scene.warnings, Lines{});
}

TEST(LoadObj, PicturesAreRelativeToTheirLibrary) {
  const Scene scene = loadGood("obj/library_below/model.obj");
  EXPECT_EQ(scene.materials.at(0).baseColorTexture.image, 0);
  EXPECT_EQ(scene.warnings, Lines{});
}

TEST(LoadObj, PathsOfAnotherMachineAreFoundByTheirLastPart) {
  const Scene scene = loadGood("obj/windows_paths/model.obj");
  EXPECT_EQ(scene.materials.at(0).baseColorTexture.image, 0);
  EXPECT_EQ(scene.warnings, Lines{});
}

TEST(LoadObj, SeveralLibrariesInALineAndTheFirstCounts) {
  const Scene scene = loadGood("obj/several_libraries/model.obj");
  EXPECT_EQ(materialNamed(scene, "a").baseColor.a, 0.25F);
  EXPECT_EQ(materialNamed(scene, "b").baseColor.a, 0.5F) << "used before its library is named, with comments";
  EXPECT_EQ(materialNamed(scene, "c").baseColor.a, 1.0F);
  EXPECT_EQ(scene.warnings, (Lines{"material library gone.mtl: no such file; its materials are drawn plain",
                                   "material library gone too.mtl: no such file; its materials are drawn plain"}))
      << "the material c may be in those";
}

TEST(LoadObj, TheLastLibraryStatementBeforeCounts) {
  const Scene scene = loadGood("obj/same_names/model.obj");
  ASSERT_EQ(scene.materials.size(), 4U);
  EXPECT_EQ(scene.materials[0].baseColor.a, 0.25F);
  EXPECT_EQ(scene.materials[1].baseColor.a, 0.75F);
  EXPECT_EQ(scene.warnings, Lines{"material \"none\": it is in no library; it is drawn plain, and so is 1 more"});
}

TEST(LoadObj, MaterialsWithoutALibraryAreNamed) {
  EXPECT_EQ(load(quad + "usemtl red\nf 1 2 3 4\n").warnings,
            Lines{"material \"red\": the file names no material library; it is drawn plain"});
  EXPECT_EQ(load("mtllib a b.mtl\n" + quad + "f 1 2 3 4\n").warnings,
            Lines{"material library a b.mtl: external files are not read here; its materials are drawn plain"});
}

TEST(ReadMtl, DecidesBetweenDAndTr) {
  EXPECT_EQ(opacityIn("newmtl a\nTr 1.000000\n"), 1.0F) << "MeshLab, OpenMVS";
  EXPECT_EQ(opacityIn("newmtl a\nTr 0\n"), 1.0F);
  EXPECT_EQ(opacityIn("newmtl a\nTr 0.25\n"), 0.75F);
  EXPECT_EQ(opacityIn("newmtl a\nd 0.75\nTr 0.25\n"), 0.75F) << "3ds Max";
  EXPECT_EQ(opacityIn("newmtl a\nTr 0.25\nd 0.75\n"), 0.75F);
  EXPECT_EQ(opacityIn("newmtl a\nd 1.0\nTr 1.0\n"), 1.0F) << "Gazebo";
  EXPECT_EQ(opacityIn("newmtl a\nd 0\n"), 0.0F);
  EXPECT_EQ(opacityIn("newmtl a\nTr 0.25\nnewmtl b\nTr 1\n"), 0.25F) << "the other material tells what Tr means";
  EXPECT_EQ(opacityIn("newmtl a\nTr 0.25\nnewmtl b\nTr 0\n"), 0.75F);
  EXPECT_EQ(opacityIn("newmtl a\nTr 0.25\nnewmtl b\nTr 1\nnewmtl c\nTr 0\n"), 0.75F);
  EXPECT_EQ(opacityIn("newmtl a\nTr 0.25\nnewmtl b\nd 1\nTr 1\n"), 0.75F) << "with a d beside it Tr tells nothing";
  EXPECT_EQ(opacityIn("#\n# Wavefront material file\n# Converted by Meshlab Group\n#\nnewmtl a\nTr 0.25\n"), 0.25F);
  EXPECT_EQ(opacityIn("newmtl a\nTf 1 1 1\n"), 1.0F);
  EXPECT_EQ(opacityIn("newmtl a\nTf 0.25 0.25 0.25\n"), 0.25F) << "Maya";
  EXPECT_EQ(opacityIn("newmtl a\nTf 0 0 0\n"), 1.0F);
  EXPECT_EQ(opacityIn("newmtl a\nd 1\nTf 0.25 0.25 0.25\n"), 1.0F);
  EXPECT_EQ(opacityIn("newmtl a\nd 7\n"), 1.0F);
  EXPECT_EQ(opacityIn("NEWMTL a\nD 0.5\n"), 0.5F) << "in any letter case";
}

TEST(ReadMtl, NamesMayHoldANumberSignAndCommentsMayFollow) {
  const char* const text = "newmtl Material #25\nd .25\nnewmtl Material #26\nd .5\nnewmtl red # shiny\nd .75\n";
  EXPECT_EQ(opacityIn(text, "Material #25"), 0.25F);
  EXPECT_EQ(opacityIn(text, "Material #26"), 0.5F);
  EXPECT_EQ(opacityIn(text, "red"), 0.75F);
  EXPECT_EQ(opacityIn(text, "blue"), -1.0F);
}

TEST(ReadMtl, SaysWhatIsNotDrawn) {
  const MtlLibrary library = readMtl(
      "newmtl a\nd -halo 0.5\nmap_Ns n.png\nnewmtl b\nd -halo 0.25\nmap_Ns o.png\n"
      "disp d.png\nKa 1 1 1\nsharpness 60\naniso 0\nanisor 0.5\n");
  EXPECT_EQ(library.find("b")->dissolve, 0.25F);
  EXPECT_EQ(library.warnings,
            (Lines{"d -halo is drawn as d: what should fade towards its edges is equally opaque everywhere",
                   "map_Ns of the material \"a\" is not drawn: its surfaces are equally rough everywhere",
                   "disp of the material \"b\" is not drawn: its surfaces lack that relief"}));
}

TEST(ReadMtl, NumbersMayHaveDecimalCommas) {
  EXPECT_EQ(opacityIn("newmtl a\nd 0,5\n"), 0.5F);
  const MtlLibrary library = readMtl("newmtl a\nKd 0,25, 0.5, 1\n");
  EXPECT_EQ(library.find("a")->diffuse, glm::vec3(0.25F, 0.5F, 1.0F));
}

TEST(ReadMtl, SaysWhichColorsAreNotRead) {
  const MtlLibrary library =
      readMtl("newmtl a\nKd xyz 0.5 0.5 0.5\nmap_Ka a.png\nnewmtl b\nKd spectral b.rfl\nmap_Ka b.png\nKa xyz 1 1 1\n");
  EXPECT_EQ(library.warnings,
            (Lines{"a colour stated as xyz is not read: material \"a\" has the default one",
                   "map_Ka of the material \"a\" is not drawn: its surfaces are lit by their surroundings without that "
                   "picture"}));
}

TEST(ReadMtl, OptionsOfPicturesAndNamesWithSpaces) {
  const MtlLibrary library =
      readMtl("newmtl a\nmap_Kd -s 2 -o 0.5 0.25 -mm 0.1 0.9 -clamp on -imfchan G -boost 2 -blendu off my tex.png\n");
  const MtlMap& map = library.find("a")->diffuseMap;
  EXPECT_EQ(map.name, "my tex.png");
  EXPECT_EQ(map.scale, glm::vec2(2.0F, 1.0F));
  EXPECT_EQ(map.offset, glm::vec2(0.5F, 0.25F));
  EXPECT_EQ(map.base, 0.1F);
  EXPECT_EQ(map.gain, 0.9F);
  EXPECT_TRUE(map.clamp);
  EXPECT_EQ(map.channel, 'g');
}

// ---- Pictures

class ObjMaps : public testing::Test {
 protected:
  const Material& material(const char* name) const { return materialNamed(scene_, name); }
  const Image& imageOf(const TextureSlot& slot) const { return scene_.images.at(static_cast<std::size_t>(slot.image)); }
  std::vector<int> colors(const char* name) const {
    const Image& image = imageOf(material(name).baseColorTexture);
    return {image.rgba.begin(), image.rgba.end()};
  }
  const Scene scene_ = loadGood("obj/maps/model.obj");
};

TEST_F(ObjMaps, OpacityComesFromAlphaOrElseFromLuminance) {
  EXPECT_EQ(colors("grey"), (std::vector<int>{255, 255, 255, 128}));
  EXPECT_EQ(material("grey").alphaMode, AlphaMode::Blend);
  expectNear(material("grey").baseColor, {1.0F, 0.0F, 0.0F, 1.0F});
  EXPECT_EQ(colors("alpha"), (std::vector<int>{255, 255, 255, 255, 255, 255, 255, 128}));
  EXPECT_EQ(colors("channel"), (std::vector<int>{255, 255, 255, 255, 255, 255, 255, 0}));
  EXPECT_EQ(material("channel").baseColor.a, 1.0F) << "d 0 beside a map_d";
  EXPECT_EQ(colors("both"), (std::vector<int>{255, 0, 0, 128, 0, 255, 0, 128}));
  EXPECT_EQ(colors("only"), (std::vector<int>{255, 0, 0, 255, 0, 255, 0, 128})) << "not squared";
  EXPECT_EQ(material("only").baseColor.a, 0.5F);
}

TEST_F(ObjMaps, APictureOfColoursIsNeitherOpacityNorTintedByVertices) {
  EXPECT_EQ(colors("same"), (std::vector<int>{128, 128, 128, 255}));
  EXPECT_EQ(material("same").alphaMode, AlphaMode::Opaque);
  EXPECT_TRUE(meshOf(scene_, "same").colors.empty());
  expectNear(glm::vec3(meshOf(scene_, "grey").vertex(0).color), glm::vec3(linearHalf), 1e-3F);
}

TEST_F(ObjMaps, PicturesArePlacedAndScaled) {
  const TextureSlot& placed = material("placed").baseColorTexture;
  EXPECT_EQ(placed.sampler.wrapU, Wrap::ClampToEdge);
  EXPECT_EQ(placed.sampler.wrapV, Wrap::ClampToEdge);
  // OBJ's (0, 0) becomes (0.25, 0.5) and its (1, 1) becomes (2.25, 4.5), with v upwards.
  expectNear(placed.transform * glm::vec3(0.0F, 1.0F, 1.0F), {0.25F, 0.5F, 1.0F});
  expectNear(placed.transform * glm::vec3(1.0F, 0.0F, 1.0F), {2.25F, -3.5F, 1.0F});
  EXPECT_EQ(colors("scaled"), (std::vector<int>{204, 51, 51, 255, 51, 204, 51, 128})) << "0.2 + 0.6 * value";
}

TEST_F(ObjMaps, PhysicalMaterials) {
  const Material& pbr = material("pbr");
  EXPECT_EQ(pbr.roughness, 1.0F) << "the picture has the values";
  EXPECT_EQ(pbr.metallic, 0.2F);
  const Image& image = imageOf(pbr.metallicRoughnessTexture);
  EXPECT_EQ(image.rgba.at(1), 128);
  EXPECT_EQ(image.rgba.at(2), 255);
  EXPECT_EQ(pbr.emissive, glm::vec3(1.0F)) << "a picture of light is not darkened by Ke 0";
  EXPECT_GE(pbr.emissiveTexture.image, 0);
  EXPECT_EQ(pbr.clearcoat, 0.5F);
  EXPECT_EQ(pbr.clearcoatRoughness, 0.25F);
}

TEST_F(ObjMaps, BumpsAreNormalMapsOrHeights) {
  EXPECT_EQ(material("normals").normalScale, 0.5F);
  EXPECT_EQ(imageOf(material("normals").normalTexture).rgba, (std::vector<std::uint8_t>{128, 128, 255, 255}));
  EXPECT_FALSE(meshOf(scene_, "normals").tangents.empty());
  // From 0 to 0.4 over two texels of four, at a quarter of the width: a slope of 0.2.
  const Image& bumps = imageOf(material("bumps").normalTexture);
  ASSERT_EQ(bumps.rgba.size(), 16U);
  EXPECT_EQ(bumps.rgba[0], 128);
  EXPECT_EQ(bumps.rgba[2], 255);
  EXPECT_EQ(bumps.rgba[4], 102) << "0.5 - 0.5 * 0.2 / sqrt(1.04)";
  EXPECT_EQ(bumps.rgba[5], 128);
  EXPECT_EQ(bumps.rgba[12], 153);
}

TEST_F(ObjMaps, MissingOnesAreNamed) {
  EXPECT_EQ(material("missing").baseColorTexture.image, -1);
  EXPECT_EQ(scene_.warnings, (Lines{"map_Ks of the material \"missing\" is not drawn: the highlights of its surfaces "
                                    "are the same everywhere",
                                    "map_Kd gone.png of the material \"missing\": no such file; it is drawn without"}));
}

// Two corners of a face in one place leave a group of smoothing without any triangle, and its vertices without normals.
TEST(ObjSmoothingGroups, MayHaveNoTriangleAtAll) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\ns 1\nf 1 1 2\ns 2\nf 1 2 3\n";
  const Scene scene = loadObj(std::as_bytes(std::span(text)), {});
  ASSERT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(scene.meshes[0].indices.size(), 3U);
  EXPECT_EQ(scene.meshes[0].normals.size(), scene.meshes[0].vertexCount());
}

} // namespace
} // namespace vitrail::tool::obj_test
