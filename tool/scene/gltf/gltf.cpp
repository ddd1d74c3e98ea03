// Loads glTF 2.0 and GLB: walks the nodes of the scene and collects draws and cameras.
#include <cmath>
#include <map>
#include <new>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "document.h"
#include "material.h"
#include "mesh.h"
#include "nodes.h"

namespace vitrail::tool {
namespace {

// The rotation and translation of a transform: it looks along the transform's -Z and keeps its +Y up.
glm::mat4 withoutScale(const glm::mat4& transform, const std::string& where) {
  const glm::dvec3 back(transform[2]);
  const glm::dvec3 right = glm::cross(glm::dvec3(transform[1]), back);
  if (!(glm::length(back) > 0.0) || !(glm::length(right) > 0.0))
    throw LoadError(fmt::format("{}: its node is scaled to nothing", where));
  const glm::dvec3 z = glm::normalize(back);
  const glm::dvec3 x = glm::normalize(right);
  return {glm::vec4(glm::vec3(x), 0.0F), glm::vec4(glm::vec3(glm::cross(z, x)), 0.0F), glm::vec4(glm::vec3(z), 0.0F),
          transform[3]};
}

SceneCamera convertCamera(const tinygltf::Camera& source, const std::string& where, const glm::mat4& transform) {
  const auto require = [&where](bool holds, const char* what) {
    if (!holds) throw LoadError(fmt::format("{}: {}", where, what));
  };
  SceneCamera camera;
  camera.name = source.name;
  camera.cameraToWorld = withoutScale(transform, where);
  camera.orthographic = source.type == "orthographic";
  if (camera.orthographic) {
    const tinygltf::OrthographicCamera& ortho = source.orthographic;
    require(ortho.ymag != 0.0, "ymag is zero");
    require(ortho.znear >= 0.0 && ortho.zfar > ortho.znear, "zfar is not beyond znear");
    camera.halfHeight = static_cast<float>(std::abs(ortho.ymag));
    camera.nearPlane = static_cast<float>(ortho.znear);
    camera.farPlane = static_cast<float>(ortho.zfar);
    return camera;
  }
  const tinygltf::PerspectiveCamera& perspective = source.perspective;
  require(perspective.yfov > 0.0 && perspective.yfov < std::numbers::pi, "yfov is not between 0 and pi");
  require(perspective.znear > 0.0, "znear is not above zero");
  camera.verticalFov = static_cast<float>(perspective.yfov);
  camera.nearPlane = static_cast<float>(perspective.znear);
  // tinygltf stands 0 for a far plane that the file does not have.
  if (perspective.zfar != 0.0) {
    require(perspective.zfar > perspective.znear, "zfar is not beyond znear");
    camera.farPlane = static_cast<float>(perspective.zfar);
  }
  return camera;
}

// Collects what the nodes of a scene show. Meshes and materials are made when the first node asks for them.
class SceneBuilder {
 public:
  explicit SceneBuilder(const GltfDocument& document)
      : document_(document), world_(placeNodes(document)), materials_(document, scene_), meshes_(document) {
    scene_.warnings = document.warnings;
  }

  Scene build() {
    for (const std::size_t index : sceneNodes(document_)) {
      const tinygltf::Node& node = document_.model.nodes[index];
      if (node.camera >= 0) addCamera(index, static_cast<std::size_t>(node.camera));
      if (node.mesh >= 0) addMesh(index, static_cast<std::size_t>(node.mesh));
    }
    requireDrawable(scene_);
    return std::move(scene_);
  }

 private:
  // Which mesh of the scene stands for a primitive. The last number is the node, where the mesh is posed for it alone.
  using MeshKey = std::tuple<std::size_t, std::size_t, int>;
  static constexpr int anyNode = -1;

  void addCamera(std::size_t node, std::size_t index) {
    const tinygltf::Camera& camera = document_.model.cameras[index];
    scene_.cameras.push_back(
        convertCamera(camera, objectName("camera", index, camera.name), nodeMatrix(document_, node, world_[node])));
  }

  void addMesh(std::size_t nodeIndex, std::size_t meshIndex) {
    const tinygltf::Node& node = document_.model.nodes[nodeIndex];
    const tinygltf::Mesh& mesh = document_.model.meshes[meshIndex];
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      const bool skinned = isSkinned(primitive, node);
      const auto [material, source] = materialFor(primitive.material);
      GltfPose pose{node.weights.empty() ? mesh.weights : node.weights, std::nullopt, world_};
      if (skinned) pose.skin = static_cast<std::size_t>(node.skin);
      const bool own = skinned || (!primitive.targets.empty() && !node.weights.empty());
      const auto key = MeshKey(meshIndex, i, own ? static_cast<int>(nodeIndex) : anyNode);
      const std::optional<std::uint32_t> shown = meshFor(key, *source, pose);
      if (!shown) continue;
      const glm::mat4 transform = skinned ? glm::mat4(1.0F) : nodeMatrix(document_, nodeIndex, world_[nodeIndex]);
      scene_.draws.push_back({*shown, material, transform});
    }
  }

  // None where the primitive shows nothing.
  std::optional<std::uint32_t> meshFor(const MeshKey& key, const GltfMaterial& material, const GltfPose& pose) {
    const auto known = meshIndices_.find(key);
    if (known != meshIndices_.end()) return known->second;
    Mesh mesh = meshes_.read(std::get<0>(key), std::get<1>(key), material, pose);
    std::optional<std::uint32_t> index;
    if (!mesh.indices.empty()) {
      index = static_cast<std::uint32_t>(scene_.meshes.size());
      scene_.meshes.push_back(std::move(mesh));
    }
    return meshIndices_.emplace(key, index).first->second;
  }

  std::pair<std::uint32_t, const GltfMaterial*> materialFor(int index) {
    auto known = knownMaterials_.find(index);
    if (known == knownMaterials_.end()) {
      // A primitive without a material has the specification's default one.
      GltfMaterial material = index < 0 ? GltfMaterial{} : materials_.read(static_cast<std::size_t>(index));
      scene_.materials.push_back(material.material);
      const auto place = static_cast<std::uint32_t>(scene_.materials.size() - 1);
      known = knownMaterials_.emplace(index, std::pair(place, std::move(material))).first;
    }
    return {known->second.first, &known->second.second};
  }

  const GltfDocument& document_;
  std::vector<glm::dmat4> world_;
  Scene scene_;
  GltfMaterialReader materials_;
  GltfMeshReader meshes_;
  std::map<MeshKey, std::optional<std::uint32_t>> meshIndices_;
  std::map<int, std::pair<std::uint32_t, GltfMaterial>> knownMaterials_;
};

} // namespace

Scene loadGltf(std::span<const std::byte> file, const std::filesystem::path& base, const LoadOptions& /*options*/) {
  try {
    const GltfDocument document = openGltf(file, base);
    return SceneBuilder(document).build();
  } catch (const LoadError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw LoadError("there is not enough memory to load it");
  } catch (const std::exception& error) {
    throw LoadError(fmt::format("it cannot be read: {}", oneLine(error.what())));
  }
}

} // namespace vitrail::tool
