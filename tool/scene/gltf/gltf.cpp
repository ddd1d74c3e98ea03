// Loads glTF 2.0 and GLB: walks the nodes of the scene and collects draws, cameras and lights.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <numbers>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "../visibility.h"
#include "animation.h"
#include "document.h"
#include "extension_use.h"
#include "geometry_key.h"
#include "instances.h"
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

// The box around all that is drawn, in double precision.
struct WorldBox {
  glm::dvec3 min{std::numeric_limits<double>::infinity()};
  glm::dvec3 max{-std::numeric_limits<double>::infinity()};

  void add(const glm::dmat4& transform, const Bounds& box) {
    const glm::dvec3 middle(transform * glm::dvec4(0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max)), 1.0));
    const glm::dvec3 half = 0.5 * (glm::dvec3(box.max) - glm::dvec3(box.min));
    glm::dvec3 reach(0.0);
    for (int axis = 0; axis < 3; ++axis) reach += glm::abs(glm::dvec3(transform[axis])) * half[axis];
    requireReach(middle - reach);
    requireReach(middle + reach);
    min = glm::min(min, middle - reach);
    max = glm::max(max, middle + reach);
  }

  // The middle of what is far away compared with its size, else 0: most files keep their own numbers.
  [[nodiscard]] glm::dvec3 farMiddle() const {
    const glm::dvec3 middle = 0.5 * (min + max);
    return glm::length(middle) > 8.0 * glm::length(max - min) ? middle : glm::dvec3(0.0);
  }
};

// Collects what the nodes of a scene show, in two walks: the first one makes meshes and materials where a node asks for
// them, and finds out how much there is and where it lies; the second one places it.
class SceneBuilder {
 public:
  SceneBuilder(const GltfDocument& document, Scene scene, const LoadOptions& options)
      : document_(document),
        scene_(std::move(scene)),
        hierarchy_(document, scene_),
        use_(document),
        materials_(document, scene_),
        meshes_(document) {
    for (const std::string& line : document.warnings) warn(scene_, line);
    if (options.variant && (!options.optional || hasVariant(scene_.file, options)))
      variant_ = variantNamed(*options.variant);
    for (const std::string& name : document.extensions)
      if (name != "KHR_lights_punctual" && name != "KHR_materials_variants") use_.note(name);
    if (!document.scenes.empty())
      for (const std::string& name : document.scenes[document.defaultScene].extensions) use_.note(name);
  }

  Scene build() {
    hierarchy_.visit([this](const GltfPlacedNode& node) { survey(node); });
    requireAny();
    if (drawCount_ > 0) scene_.origin = box_.farMiddle();
    scene_.draws.reserve(drawCount_);
    objectOf_.assign(document_.nodes.size(), ObjectTree::none);
    hierarchy_.visit([this](const GltfPlacedNode& node) { place(node); });
    dropEmptyObjects(scene_);
    use_.report(scene_);
    if (drawCount_ > 0)
      requireDrawable(scene_);
    else
      warn(scene_, nothingDrawnWarning());
    return std::move(scene_);
  }

 private:
  // What a node shows: a mesh of the scene and a material.
  struct Shown {
    std::optional<std::uint32_t> mesh; // none where the primitive has nothing to draw
    std::uint32_t material = 0;
    bool skinned = false;
  };

  [[nodiscard]] int variantNamed(const std::string& name) const {
    const auto found = std::ranges::find(document_.variants, name);
    if (found != document_.variants.end()) return static_cast<int>(found - document_.variants.begin());
    if (document_.variants.empty()) throw LoadError("has no variants of its materials");
    std::vector<std::string> names;
    for (const std::string& variant : document_.variants) {
      names.push_back(fmt::format("\"{}\"", oneLine(variant)));
      if (names.size() == 20 && document_.variants.size() > 20) {
        names.emplace_back("...");
        break;
      }
    }
    throw LoadError(fmt::format("has no variant \"{}\"; it has {}", oneLine(name), fmt::join(names, ", ")));
  }

  void survey(const GltfPlacedNode& placed) {
    const GltfRareParts& rare = document_.nodes.rare(placed.node);
    const std::uint32_t mesh = document_.nodes.mesh(placed.node);
    if (!placed.visible) {
      use_.note("KHR_node_visibility");
      hidden_ = hidden_ || mesh != GltfNodes::none;
      return;
    }
    for (const std::string& name : rare.extensions) use_.note(name);
    if (mesh == GltfNodes::none) return;
    const std::vector<glm::dmat4> instances = instancesOf(document_, placed, scene_);
    if (rare.instanceColors) use_.noteLoss("EXT_mesh_gpu_instancing", "the colours of copies are missing");
    const std::size_t primitives = document_.model.meshes[mesh].primitives.size();
    for (std::size_t i = 0; i < primitives; ++i) {
      const Shown shown = shownBy(placed.node, i);
      if (!shown.mesh) continue;
      if (shown.skinned && rare.instanced)
        use_.noteLoss("EXT_mesh_gpu_instancing", "a mesh that follows a skin is drawn once");
      forEachPlace(placed, shown, instances, [&](const glm::dmat4& transform) {
        if (drawCount_++ == mostDraws())
          throw LoadError(
              fmt::format("the file's {} bytes make more than {} instances", document_.totalBytes, mostDraws()));
        box_.add(transform, boxes_[*shown.mesh]);
      });
    }
  }

  // Accessors of instances may be used by many nodes, and a small file could fill the memory.
  [[nodiscard]] std::uint64_t mostDraws() const {
    return std::min<std::uint64_t>(4'000'000 + document_.totalBytes / 4, 0xffffffff);
  }

  template <typename Take>
  void forEachPlace(const GltfPlacedNode& placed, const Shown& shown, const std::vector<glm::dmat4>& instances,
                    Take take) const {
    if (shown.skinned) {
      glm::dmat4 transform(1.0);
      transform[3] = glm::dvec4(origins_[*shown.mesh], 1.0);
      take(transform);
    } else if (!document_.nodes.rare(placed.node).instanced) {
      take(placed.world);
    } else {
      for (const glm::dmat4& instance : instances) take(placed.world * instance);
    }
  }

  // A file that hides all that it holds is an empty picture; one that holds nothing is refused.
  void requireAny() const {
    if (drawCount_ > 0 || hidden_) return;
    const std::string unreadable = use_.unreadable();
    if (!unreadable.empty())
      throw LoadError(
          fmt::format("it has no mesh that can be read without the extension {}, which Vitrail does not "
                      "implement",
                      oneLine(unreadable)));
    throw LoadError("the file holds no triangles, lines or points");
  }

  // Nodes come depth first, so that the last object of a node above this one is the one that it is placed below.
  std::uint32_t objectFor(const GltfPlacedNode& placed) {
    const std::uint32_t parent = placed.parent == GltfNodes::none ? ObjectTree::none : objectOf_[placed.parent];
    const std::uint32_t mesh = document_.nodes.mesh(placed.node);
    std::string name(document_.nodes.ownName(placed.node));
    if (name.empty() && mesh != GltfNodes::none) name = document_.model.meshes[mesh].name;
    if (name.empty()) name = fmt::format("node {}", placed.node);
    return objectOf_[placed.node] = scene_.objects.add(name, parent);
  }

  void place(const GltfPlacedNode& placed) {
    const std::uint32_t object = objectFor(placed);
    const GltfRareParts& rare = document_.nodes.rare(placed.node);
    if (rare.camera) addCamera(placed, *rare.camera);
    if (!placed.visible) return;
    if (rare.light) addLight(placed, *rare.light);
    const std::uint32_t mesh = document_.nodes.mesh(placed.node);
    if (mesh == GltfNodes::none) return;
    const std::vector<glm::dmat4> instances = instancesOf(document_, placed, scene_);
    const std::size_t primitives = document_.model.meshes[mesh].primitives.size();
    for (std::size_t i = 0; i < primitives; ++i) {
      const Shown shown = shownBy(placed.node, i);
      if (!shown.mesh) continue;
      forEachPlace(placed, shown, instances, [&](const glm::dmat4& transform) {
        scene_.draws.push_back({*shown.mesh, shown.material, matrixOf(placed.node, transform), object});
      });
    }
  }

  [[nodiscard]] glm::mat4 matrixOf(std::uint32_t node, const glm::dmat4& world) const {
    return nodeMatrix(document_, node, world, scene_.origin);
  }

  void addCamera(const GltfPlacedNode& placed, std::size_t index) {
    const tinygltf::Camera& camera = document_.model.cameras[index];
    try {
      const auto wrong = document_.wrongCameras.find(index);
      if (wrong != document_.wrongCameras.end()) throw LoadError(wrong->second);
      scene_.cameras.push_back(
          convertCamera(camera, objectName("camera", index, camera.name), matrixOf(placed.node, placed.world)));
    } catch (const LoadError& error) {
      warn(scene_, fmt::format("{}; the camera is left out", error.what()));
    }
  }

  void addLight(const GltfPlacedNode& placed, std::size_t index) {
    const std::optional<Light>& source = document_.lights[index];
    if (!source) {
      warn(scene_, fmt::format("light {} is neither directional nor a point nor a spot: it does not shine", index));
      return;
    }
    const glm::mat4 world = matrixOf(placed.node, placed.world);
    Light light = *source;
    light.position = glm::vec3(world[3]);
    const glm::dvec3 forward = -glm::dvec3(world[2]);
    const double length = glm::length(forward);
    if (length > 0.0) light.direction = glm::vec3(forward / length);
    scene_.lights.push_back(std::move(light));
  }

  // What one primitive of a node's mesh is drawn with.
  Shown shownBy(std::uint32_t node, std::size_t index) {
    const GltfRareParts& rare = document_.nodes.rare(node);
    const std::uint32_t meshIndex = document_.nodes.mesh(node);
    const tinygltf::Mesh& mesh = document_.model.meshes[meshIndex];
    const tinygltf::Primitive& primitive = mesh.primitives[index];
    const bool skinned = rare.skin && canFollowJoints(primitive);
    const bool own = skinned || (!rare.weights.empty() && !primitive.targets.empty());
    const std::pair<std::uint32_t, std::size_t> place(meshIndex, index);
    if (!own) {
      const auto known = plain_.find(place);
      if (known != plain_.end()) return known->second;
    }
    use_.notePrimitive(primitive);
    const auto [material, source] = materialFor(materialOf(primitive));
    const GltfPose pose{rare.weights.empty() ? mesh.weights : rare.weights, nullptr};
    Shown shown{std::nullopt, material, skinned};
    shown.mesh = meshFor(meshIndex, index, *source, pose, skinned ? rare.skin : std::nullopt);
    if (!own) plain_.emplace(place, shown);
    return shown;
  }

  // The primitive's material, or that of the chosen variant. What other variants name need not be there.
  int materialOf(const tinygltf::Primitive& primitive) {
    const auto extension = primitive.extensions.find("KHR_materials_variants");
    if (extension == primitive.extensions.end()) return primitive.material;
    const auto materials = static_cast<int>(document_.model.materials.size());
    const auto variants = static_cast<int>(document_.variants.size());
    std::optional<int> chosen;
    for (const tinygltf::Value& mapping : extension->second.Get("mappings").Get<tinygltf::Value::Array>()) {
      const int material = mapping.Get("material").GetNumberAsInt();
      bool wrong = material >= materials;
      for (const tinygltf::Value& value : mapping.Get("variants").Get<tinygltf::Value::Array>()) {
        const int variant = value.GetNumberAsInt();
        wrong = wrong || variant >= variants;
        if (variant == variant_ && !chosen) chosen = material;
      }
      if (wrong) warn(scene_, "KHR_materials_variants: names a material or a variant that is not there");
    }
    if (chosen && *chosen >= materials)
      throw LoadError(fmt::format("KHR_materials_variants: the variant has material {}, but materials has {} element{}",
                                  *chosen, materials, materials == 1 ? "" : "s"));
    return chosen.value_or(primitive.material);
  }

  // None where the primitive has nothing to draw.
  std::optional<std::uint32_t> meshFor(std::size_t meshIndex, std::size_t primitive, const GltfMaterial& material,
                                       GltfPose pose, std::optional<std::uint32_t> skin) {
    std::string key =
        geometryKey(document_.model.meshes[meshIndex].primitives[primitive], material, pose.weights, skin);
    const auto known = geometries_.find(key);
    if (known != geometries_.end()) return known->second;
    if (skin && skin != posedSkin_) {
      skinPose_ = poseSkin(document_, hierarchy_, *skin);
      posedSkin_ = skin;
    }
    if (skin) pose.skin = &skinPose_;
    Mesh mesh = meshes_.read(meshIndex, primitive, material, pose);
    std::optional<std::uint32_t> index;
    if (!mesh.indices.empty()) {
      index = static_cast<std::uint32_t>(scene_.meshes.size());
      boxes_.push_back(boundsOf(mesh));
      origins_.push_back(skin ? skinPose_.origin : glm::dvec3(0.0));
      scene_.meshes.push_back(std::move(mesh));
    }
    return geometries_.emplace(std::move(key), index).first->second;
  }

  std::pair<std::uint32_t, const GltfMaterial*> materialFor(int index) {
    auto known = knownMaterials_.find(index);
    if (known == knownMaterials_.end()) {
      // A primitive without a material has the specification's default one.
      GltfMaterial material = index < 0 ? GltfMaterial{} : materials_.read(static_cast<std::size_t>(index));
      if (index >= 0) use_.noteMaterial(static_cast<std::size_t>(index));
      scene_.materials.push_back(material.material);
      const auto place = static_cast<std::uint32_t>(scene_.materials.size() - 1);
      known = knownMaterials_.emplace(index, std::pair(place, std::move(material))).first;
    }
    return {known->second.first, &known->second.second};
  }

  const GltfDocument& document_;
  std::vector<std::uint32_t> objectOf_; // of each node, where it was placed last
  Scene scene_;
  GltfHierarchy hierarchy_;
  GltfExtensionUse use_;
  GltfMaterialReader materials_;
  GltfMeshReader meshes_;
  int variant_ = -1; // of document_.variants; -1: the default materials
  bool hidden_ = false;
  std::uint64_t drawCount_ = 0;
  WorldBox box_;
  std::vector<Bounds> boxes_;       // of the scene's meshes
  std::vector<glm::dvec3> origins_; // of those that follow a skin
  std::optional<std::uint32_t> posedSkin_;
  GltfSkinPose skinPose_;
  std::map<std::pair<std::uint32_t, std::size_t>, Shown> plain_; // of primitives that no node changes
  std::unordered_map<std::string, std::optional<std::uint32_t>> geometries_;
  std::map<int, std::pair<std::uint32_t, GltfMaterial>> knownMaterials_;
};

Scene loadDocument(MappedFile file, const std::filesystem::path& base, const LoadOptions& options) {
  try {
    GltfDocument document = openGltf(std::move(file), base);
    Scene scene;
    scene.file.format = document.binary ? "glTF 2.0 (binary)" : "glTF 2.0";
    scene.file.generator = document.generator;
    scene.file.animations = listAnimations(document);
    scene.file.variants = document.variants;
    poseAt(document, options, scene);
    return SceneBuilder(document, std::move(scene), options).build();
  } catch (const LoadError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw LoadError("there is not enough memory to load it");
  } catch (const std::exception& error) {
    throw LoadError(fmt::format("it cannot be read: {}", oneLine(error.what())));
  }
}

} // namespace

Scene loadGltf(std::span<const std::byte> file, const std::filesystem::path& base, const LoadOptions& options) {
  return loadDocument(MappedFile(file), base, options);
}

Scene loadGltf(MappedFile file, const std::filesystem::path& base, const LoadOptions& options) {
  return loadDocument(std::move(file), base, options);
}

} // namespace vitrail::tool
