#include "cpu_scene.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <glm/gtc/type_ptr.hpp>

#include "../scene/message.h"
#include "../scene/srgb.h"
#include "../scene/threads.h"
#include "../scene/volume.h"
#include "../stage/draw_groups.h"
#include "../stage/frame_data.h"
#include "../stage/light_data.h"
#include "../stage/material_data.h"
#include "../stage/placement.h"
#include "../stage/texels.h"
#include "brightest.h"
#include "cpu_texture.h"
#include "shade.h"

namespace vitrail::tool {

namespace {

std::vector<std::string> volumeWarnings(const Scene& scene) {
  const Solids solids(scene, false);
  if (!solids.any()) {
    if (!solids.open() || !scene.clipPlanes.empty()) return {};
    const std::uint32_t material = *solids.open();
    return {objectName("material", material, scene.materials[material].name) +
            ": an object of it is not closed, so that light is absorbed there by the file's thickness, not by its true "
            "way"};
  }
  if (!scene.clipPlanes.empty()) {
    return {"volumes are attenuated by the file's thickness, not by the true path: --clip-plane cuts them open"};
  }
  return {"volumes are attenuated by the file's thickness, not by the true path: use --method linked-list"};
}

// The meshes that are drawn; the others are left empty, so that all keep their numbers.
std::vector<Mesh> copyDrawn(const Scene& scene) {
  std::vector<Mesh> meshes(scene.meshes.size());
  std::vector<bool> known(meshes.size());
  for (const Draw& draw : scene.draws) {
    if (!known[draw.mesh]) meshes[draw.mesh] = scene.meshes[draw.mesh];
    known[draw.mesh] = true;
  }
  return meshes;
}

template <typename Value>
const Value* dataOf(const std::vector<Value>& values) {
  return values.empty() ? nullptr : values.data();
}

VitrailCpuTopology topologyOf(Primitive primitive) {
  if (primitive == Primitive::Lines) return VITRAIL_CPU_LINES;
  return primitive == Primitive::Points ? VITRAIL_CPU_POINTS : VITRAIL_CPU_TRIANGLES;
}

VitrailCpuCull cullOf(const Material& material, bool transparent, bool mirrored) {
  if (transparent || material.doubleSided) return VITRAIL_CPU_CULL_NONE;
  // A mirror turns the triangles round, and glTF means the side that was outside before.
  return mirrored ? VITRAIL_CPU_CULL_FRONT : VITRAIL_CPU_CULL_BACK;
}

VitrailBlend blendOf(std::uint32_t features) {
  if ((features & shaders::FEATURE_TRANSMISSION) != 0) return VITRAIL_BLEND_PREMULTIPLIED;
  return (features & shaders::FEATURE_ADDITIVE) != 0 ? VITRAIL_BLEND_ADDITIVE : VITRAIL_BLEND_OVER;
}

glm::vec4 largestColor(const Mesh& mesh) {
  if (mesh.colors.empty()) return glm::vec4(1.0F);
  glm::vec4 largest(0.0F);
  for (const std::uint64_t color : mesh.colors) largest = glm::max(largest, unpackColor(color));
  return largest;
}

// What a picture draws with: to clip space. Along the edge between two rows or columns of pixels a line is drawn in the
// lower or right one, as surface.vert has it.
glm::dmat4 clipMatrix(const shaders::FrameData& frame, bool lines) {
  glm::dmat4 matrix{frame.viewProjection};
  if (!lines) return matrix;
  for (int column = 0; column < 4; ++column) {
    matrix[column][0] += matrix[column][3] * double{frame.depth.z};
    matrix[column][1] += matrix[column][3] * double{frame.depth.w};
  }
  return matrix;
}

} // namespace

class CpuScene::Impl {
 public:
  Impl(const Scene& scene, std::optional<float> opacity, DrawOrder order, VitrailCpuInstructions instructions,
       Scene* released);

  std::span<const VitrailCpuDraw> draws(const View& view, std::uint32_t width, std::uint32_t height);
  bool hasTransparent() const;
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  // One draw of a mesh with a material, and all its instances.
  struct Group {
    DrawGroup source;
    bool isTransparent = false;
    glm::vec4 largestVertex{1.0F}; // the largest vertex colour, per channel
    ShadeSurface surface;
    VitrailCpuDraw prototype{}; // without what the view and the instance say
  };

  void listGroups(const Scene& scene, std::optional<float> opacity, DrawOrder order);
  void takeMeshes(const Scene& scene, DrawOrder order, Scene* released);
  void linkMesh(Group& group) const;
  void describe(Group& group, const Scene& scene, VitrailCpuInstructions instructions) const;
  void placeInstances(const Scene& scene);

  glm::dvec3 origin_;
  std::vector<std::string> warnings_;
  CpuTextures textures_;
  ShadeFrame frame_;
  std::vector<Group> groups_; // in the order in which they are drawn
  std::vector<Mesh> meshes_;
  std::vector<std::vector<std::uint32_t>> reordered_; // by mesh: indices in the order of transparent draws
  // By instance of a group: the group, and what draws point to.
  std::vector<std::uint32_t> groupOf_;
  std::vector<ShadeDraw> shades_;
  glm::mat4 transform_{1.0F};
  glm::mat4 lineTransform_{1.0F};
  std::vector<glm::vec4> clipPlanes_; // in the world
  std::vector<VitrailCpuDraw> draws_;
};

CpuScene::Impl::Impl(const Scene& scene, std::optional<float> opacity, DrawOrder order,
                     VitrailCpuInstructions instructions, Scene* released)
    : origin_(drawnOrigin(scene)),
      warnings_(volumeWarnings(scene)),
      textures_(scene, usedMaterials(scene), nullptr),
      frame_(makeShadeFrame({}, makeLightData(scene, origin_))) {
  listGroups(scene, opacity, order);
  takeMeshes(scene, order, released);
  for (Group& group : groups_) describe(group, scene, instructions);
  std::erase_if(groups_, [](const Group& group) { return isMaskedAway(group.surface); });
  placeInstances(scene);
}

void CpuScene::Impl::listGroups(const Scene& scene, std::optional<float> opacity, DrawOrder order) {
  const auto add = [&](const DrawGroup& source, bool transparent) {
    const Material& material = scene.materials[source.material];
    const Mesh& mesh = scene.meshes[source.mesh];
    Group group;
    group.source = source;
    group.isTransparent = transparent;
    group.surface.features = featuresOf(scene, material, mesh, textures_.isPremultiplied(source.material));
    group.surface.isOpaque = !transparent;
    group.surface.material = makeMaterialData(material, opacity);
    group.surface.plain = makePlainSurface(group.surface.material);
    group.surface.slots = textures_.slots(scene, source.material, group.surface.features);
    group.surface.mesh.corners = static_cast<std::uint32_t>(cornersOf(mesh.primitive));
    group.largestVertex = largestColor(mesh);
    groups_.push_back(std::move(group));
  };
  for (const DrawGroup& source : groupDraws(scene, false, opacity.has_value())) add(source, false);
  orderOpaque(groups_, [](const Group& group) { return std::pair(group.surface.features, group.source.material); });
  std::vector<DrawGroup> transparent = groupDraws(scene, true, opacity.has_value());
  reorderGroups(transparent, order);
  for (const DrawGroup& source : transparent) add(source, true);
}

void CpuScene::Impl::takeMeshes(const Scene& scene, DrawOrder order, Scene* released) {
  reordered_.resize(scene.meshes.size());
  for (const Group& group : groups_) {
    std::vector<std::uint32_t>& indices = reordered_[group.source.mesh];
    if (!group.isTransparent || order == DrawOrder::Forward || !indices.empty()) continue;
    indices = reorderPrimitives(scene.meshes[group.source.mesh], order, group.source.mesh + 1);
  }
  if (released != nullptr) {
    for (Image& image : released->images) image.rgba = std::vector<std::uint8_t>();
    meshes_ = std::exchange(released->meshes, std::vector<Mesh>(scene.meshes.size()));
  } else {
    meshes_ = copyDrawn(scene);
  }
}

void CpuScene::Impl::linkMesh(Group& group) const {
  const Mesh& mesh = meshes_[group.source.mesh];
  const std::vector<std::uint32_t>& reordered = reordered_[group.source.mesh];
  ShadeMesh& to = group.surface.mesh;
  to.indices = group.isTransparent && !reordered.empty() ? reordered.data() : mesh.indices.data();
  to.positions = mesh.positions.data();
  to.normals = dataOf(mesh.normals);
  to.tangents = dataOf(mesh.tangents);
  to.texCoords0 = dataOf(mesh.texCoords0);
  to.texCoords1 = dataOf(mesh.texCoords1);
  to.colors = dataOf(mesh.colors);
}

void CpuScene::Impl::describe(Group& group, const Scene& scene, VitrailCpuInstructions instructions) const {
  linkMesh(group);
  const Mesh& mesh = meshes_[group.source.mesh];
  VitrailCpuDraw& draw = group.prototype;
  draw.surface = group.isTransparent ? VITRAIL_CPU_TRANSPARENT : VITRAIL_CPU_OPAQUE;
  draw.topology = topologyOf(mesh.primitive);
  const bool hasSides = mesh.primitive == Primitive::Triangles;
  draw.cull = hasSides ? cullOf(scene.materials[group.source.material], group.isTransparent, group.source.mirrored)
                       : VITRAIL_CPU_CULL_NONE;
  draw.blend = blendOf(group.surface.features);
  draw.positions = &mesh.positions.data()->x;
  draw.components = 3;
  draw.vertexCount = static_cast<std::uint32_t>(mesh.vertexCount());
  draw.indices = group.surface.mesh.indices;
  draw.indexCount = static_cast<std::uint32_t>(mesh.indices.size());
  draw.clipPlaneCount = static_cast<std::uint32_t>(scene.clipPlanes.size());
  draw.pointSize = cpuPointSize(scene);
  const ShadeFunction function = shadeFunction(group.surface, instructions);
  draw.shade = function.shade;
  draw.shadeFlags = function.flags;
  if (group.isTransparent) draw.leastAlpha = leastAlphaOf(group.surface);
  const glm::vec4 color = constantColor(group.surface);
  if (function.shade == nullptr) std::copy_n(glm::value_ptr(color), 4, draw.color);
}

void CpuScene::Impl::placeInstances(const Scene& scene) {
  std::size_t count = 0;
  for (const Group& group : groups_) count += group.source.draws.size();
  groupOf_.reserve(count);
  shades_.reserve(count);
  draws_.reserve(count);
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& group = groups_[i];
    for (const std::uint32_t source : group.source.draws) {
      const glm::mat4 place = placed(scene.draws[source].transform, origin_);
      groupOf_.push_back(static_cast<std::uint32_t>(i));
      shades_.push_back(makeShadeDraw(frame_, group.surface, place, group.source.mirrored));
      draws_.push_back(group.prototype);
      draws_.back().word = source;
    }
  }
  for (const glm::dvec4& plane : scene.clipPlanes) clipPlanes_.emplace_back(placedClipPlane(plane, origin_));
  for (std::size_t i = 0; i < draws_.size(); ++i) {
    draws_[i].model = &shades_[i].rows[0].x;
    const bool isLine = draws_[i].topology == VITRAIL_CPU_LINES;
    draws_[i].transform = glm::value_ptr(isLine ? lineTransform_ : transform_);
    if (draws_[i].shade != nullptr) draws_[i].shadeUser = &shades_[i];
    if (!clipPlanes_.empty()) draws_[i].clipPlanes = &clipPlanes_[0].x;
  }
}

std::span<const VitrailCpuDraw> CpuScene::Impl::draws(const View& view, std::uint32_t width, std::uint32_t height) {
  shaders::FrameData data = makeFrameData(view, width, height, origin_);
  data.toLight.w = static_cast<float>(frame_.lights.size());
  frame_ = makeShadeFrame(data, std::move(frame_.lights));
  LightBounds lights = lightBoundsOf(frame_);
  std::vector<float> brightest(groups_.size());
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& group = groups_[i];
    if (group.prototype.shade == nullptr) continue;
    brightest[i] = brightestOf(group.surface, group.largestVertex, lights);
    const bool isWeighted = group.isTransparent && group.prototype.blend == VITRAIL_BLEND_PREMULTIPLIED;
    if (isWeighted) brightest[i] *= largestAlphaOf(group.surface, group.largestVertex);
    brightest[i] = std::max(brightest[i], 1e-6F); // 0 would stand for the default
  }
  transform_ = data.viewProjection;
  lineTransform_ = glm::mat4(clipMatrix(data, true));
  for (std::size_t i = 0; i < draws_.size(); ++i) draws_[i].brightest = brightest[groupOf_[i]];
  return draws_;
}

float cpuPointSize(const Scene& scene) { return std::min(scene.pointSize, float{VITRAIL_CPU_MAX_POINT_SIZE}); }

bool CpuScene::Impl::hasTransparent() const { return !groups_.empty() && groups_.back().isTransparent; }

CpuScene::CpuScene(const Scene& scene, std::optional<float> opacity, DrawOrder order,
                   VitrailCpuInstructions instructions)
    : impl_(std::make_unique<Impl>(scene, opacity, order, instructions, nullptr)) {}

CpuScene::CpuScene(Scene&& scene, std::optional<float> opacity, DrawOrder order, VitrailCpuInstructions instructions)
    : impl_(std::make_unique<Impl>(scene, opacity, order, instructions, &scene)) {}

CpuScene::~CpuScene() = default;
CpuScene::CpuScene(CpuScene&& other) noexcept = default;
CpuScene& CpuScene::operator=(CpuScene&& other) noexcept = default;

std::span<const VitrailCpuDraw> CpuScene::draws(const View& view, std::uint32_t width, std::uint32_t height) {
  return impl_->draws(view, width, height);
}

bool CpuScene::hasTransparent() const { return impl_->hasTransparent(); }

const std::vector<std::string>& CpuScene::warnings() const { return impl_->warnings(); }

void drawBackground(const Background& background, const View& view, std::uint32_t width, std::uint32_t height,
                    std::uint32_t firstRow, std::uint32_t rows, float* rgba) {
  const std::size_t floats = std::size_t{width} * 4;
  if (background.kind == Background::Kind::Sky) {
    const shaders::FrameData frame = makeFrameData(view, width, height, glm::dvec3(0.0));
    for (std::uint32_t row = 0; row < rows; ++row) shadeSky(frame, firstRow + row, {rgba + row * floats, floats});
    return;
  }
  const bool isColor = background.kind == Background::Kind::Color;
  const glm::vec4 color = isColor ? glm::vec4(linearFromSrgb(background.srgb), 1.0F) : glm::vec4(0.0F);
  if (rows == 0) return;
  for (std::size_t i = 0; i < floats; ++i) rgba[i] = color[static_cast<int>(i % 4)];
  for (std::uint32_t row = 1; row < rows; ++row) std::copy_n(rgba, floats, rgba + row * floats);
}

} // namespace vitrail::tool
