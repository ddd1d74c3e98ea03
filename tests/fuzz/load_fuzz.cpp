// Feeds model loading with whatever libFuzzer makes up. The first byte selects the reader (glTF, OBJ, PLY,
// STL, images, material libraries of OBJ files), the rest is the file. A file
// either loads and keeps the promises of scene.h, or is refused with a LoadError of one line: anything else is a
// finding.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

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
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) {
    require(mesh.indices.size() % 3 == 0, "whole triangles");
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
    triangles += scene.meshes[draw.mesh].indices.size() / 3;
  }
  require(triangles > 0, "at least one triangle");
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
    switch (data[0] % 6) {
      case 0:
        checkScene(loadGltf(file, {}));
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
      default:
        checkLibrary(file);
        break;
    }
  } catch (const LoadError& error) {
    const std::string text = error.what();
    require(!text.empty() && text.find('\n') == std::string::npos, "messages of one line");
  }
  return 0;
}
