// Feeds model loading with whatever libFuzzer makes up. The first byte selects the reader (glTF, OBJ, PLY, STL, images,
// material libraries of OBJ files, and what glTF holds compressed: Draco's and meshoptimizer's data), the rest is the
// file. A file either loads and keeps the promises of scene.h, or is refused with a LoadError of one line: anything
// else is a finding.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "scene/image_decode.h"
#include "scene/load.h"
#include "scene/plain/mtl.h"
#include "scene/plain/text_encoding.h"

namespace {

using namespace vitrail::tool;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "a loaded scene breaks its promise: %s\n", what);
  std::abort();
}

// glm::length() of what may be NaN must not pass, so the comparison is written this way round.
bool isUnit(const glm::vec3& v) { return glm::length(v) > 0.99F && glm::length(v) < 1.01F; }

void checkImage(const Image& image) {
  require(image.rgba.size() == std::size_t{image.width} * image.height * 4 && !image.rgba.empty(), "image sizes");
}

void checkScene(const Scene& scene) {
  bool anything = false;
  for (const Mesh& mesh : scene.meshes) {
    require(mesh.indices.size() % cornersOf(mesh.primitive) == 0, "whole triangles and lines");
    for (const std::uint32_t index : mesh.indices) require(index < mesh.vertexCount(), "indices in range");
    for (const Vertex& vertex : mesh.vertices()) {
      require(isUnit(vertex.normal), "unit normals");
      require(isUnit(glm::vec3(vertex.tangent)) && (vertex.tangent.w == 1.0F || vertex.tangent.w == -1.0F),
              "unit tangents with a sign");
      require(vertex.color.a >= 0.0F && vertex.color.a <= 1.0F, "alpha from 0 to 1");
    }
  }
  for (const Image& image : scene.images) checkImage(image);
  for (const Draw& draw : scene.draws) {
    require(draw.mesh < scene.meshes.size() && draw.material < scene.materials.size(), "draws in range");
    anything = anything || !scene.meshes[draw.mesh].indices.empty();
  }
  require(anything, "at least one triangle, line or point");
}

// A GLB of a JSON text and a binary chunk.
std::vector<std::byte> glb(std::string json, std::span<const std::byte> binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::vector<std::byte> file;
  const auto text = [&file](const std::string& part) {
    for (const char c : part) file.push_back(static_cast<std::byte>(c));
  };
  const auto number = [&file](std::size_t value) {
    for (unsigned i = 0; i < 4; ++i) file.push_back(static_cast<std::byte>(value >> 8 * i & 0xffU));
  };
  text("glTF");
  number(2);
  number(28 + json.size() + binary.size());
  number(json.size());
  text("JSON" + json);
  number(binary.size());
  text(std::string("BIN\0", 4));
  file.insert(file.end(), binary.begin(), binary.end());
  return file;
}

std::string bufferOf(std::size_t size) { return R"("buffers":[{"byteLength":)" + std::to_string(size) + "}]"; }

// A primitive of those bytes, compressed by Draco.
std::vector<std::byte> dracoModel(std::span<const std::byte> data) {
  return glb(
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],)"
      R"("accessors":[{"componentType":5126,"count":4,"type":"VEC3"},{"componentType":5126,"count":4,"type":"VEC3"},)"
      R"({"componentType":5126,"count":4,"type":"VEC2"},)"
      R"({"componentType":5121,"count":4,"type":"VEC4","normalized":true}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3},)"
      R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,)"
      R"("attributes":{"POSITION":7,"NORMAL":2,"TEXCOORD_0":5,"COLOR_0":3}}}}]}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":)" +
          std::to_string(data.size()) + "}]," + bufferOf(data.size()) + "}",
      data);
}

// Points at what meshoptimizer makes of those bytes. The first three choose mode and filter, stride and count.
std::vector<std::byte> meshoptModel(std::span<const std::byte> data) {
  if (data.size() < 3) return {};
  const auto choice = std::to_integer<unsigned>(data[0]);
  const std::array modes{"ATTRIBUTES", "TRIANGLES", "INDICES"};
  const std::array filters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
  const auto stride = std::to_string(std::to_integer<unsigned>(data[1]));
  const auto count = std::to_string(std::to_integer<unsigned>(data[2]));
  const std::span<const std::byte> stream = data.subspan(3);
  return glb(
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}],)"
      R"("meshes":[{"primitives":[{"mode":0,"attributes":{"POSITION":0}}]}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":12,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteLength":)" +
          std::to_string(stream.size()) + R"(,"byteStride":)" + stride + R"(,"count":)" + count + R"(,"mode":")" +
          modes.at(choice % 3) + R"(","filter":")" + filters.at(choice / 3 % 4) + R"("}}}],)" +
          bufferOf(stream.size()) + "}",
      stream);
}

// In its rest pose, and in the middle of each animation.
void loadAnimated(std::span<const std::byte> file) {
  const Scene scene = loadGltf(file, {});
  checkScene(scene);
  for (std::size_t i = 0; i < std::min<std::size_t>(scene.file.animations.size(), 4); ++i) {
    LoadOptions options;
    options.animation = std::to_string(i);
    options.time = scene.file.animations[i].seconds / 2.0;
    try {
      checkScene(loadGltf(file, {}, options));
    } catch (const LoadError&) {
      // An animation may be wrong where the rest is not.
    }
  }
}

void checkLibrary(std::span<const std::byte> file) {
  const MtlLibrary library = readMtl(PlainText(file).view());
  for (const auto& [name, material] : library.materials) {
    const float opacity = opacityOf(material, library);
    require(opacity >= 0.0F && opacity <= 1.0F, "opacity from 0 to 1");
    require(library.find(name) == &material, "materials are found by their names");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto file = std::as_bytes(std::span(data + 1, size - 1));
  try {
    switch (data[0] % 8) {
      case 0:
        loadAnimated(file);
        break;
      case 1:
        checkScene(loadObj(file, {}));
        break;
      case 2:
        checkScene(loadPly(file, {}));
        break;
      case 3:
        checkScene(loadStl(file));
        break;
      case 4:
        checkImage(decodeImage(file));
        break;
      case 5:
        checkLibrary(file);
        break;
      case 6:
        checkScene(loadGltf(dracoModel(file), {}));
        break;
      default:
        checkScene(loadGltf(meshoptModel(file), {}));
        break;
    }
  } catch (const LoadError& error) {
    const std::string text = error.what();
    require(!text.empty() && text.find('\n') == std::string::npos, "messages of one line");
  }
  return 0;
}
