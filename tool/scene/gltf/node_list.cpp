// The nodes of a glTF file.
#include "node_list.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include "../load.h"
#include "../message.h"

namespace vitrail::tool {
namespace {

using Json = nlohmann::json;

std::optional<std::uint32_t> indexIn(const Json& object, const char* key) {
  const auto member = object.find(key);
  if (member == object.end()) return std::nullopt;
  return member->get<std::uint32_t>();
}

// Which quaternion turns the axes to these columns, which are orthogonal and of unit length (Shepperd's method: the
// largest of its numbers is taken from the diagonal, so that none is divided by one near zero).
glm::dvec4 quaternionOf(const glm::dmat3& m) {
  const double trace = m[0][0] + m[1][1] + m[2][2];
  const glm::dvec4 squares(m[0][0], m[1][1], m[2][2], trace);
  int largest = 3;
  for (int i = 0; i < 3; ++i)
    if (squares[i] > squares[largest]) largest = i;
  glm::dvec4 q;
  if (largest == 3) {
    q = {m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0], 1.0 + trace};
  } else {
    const int i = largest;
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    q[i] = 1.0 + m[i][i] - m[j][j] - m[k][k];
    q[j] = m[i][j] + m[j][i];
    q[k] = m[i][k] + m[k][i];
    q.w = m[j][k] - m[k][j];
  }
  const double length = glm::length(q);
  return length > 0.0 ? q / length : glm::dvec4(0.0, 0.0, 0.0, 1.0);
}

// A matrix taken apart. A mirror becomes a negative scale along x, and shear is left out.
GltfPlace placeOf(const glm::dmat4& matrix) {
  GltfPlace place;
  place.translation = glm::dvec3(matrix[3]);
  glm::dmat3 axes(matrix);
  place.scale = {glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])};
  if (glm::determinant(axes) < 0.0) place.scale.x = -place.scale.x;
  for (int i = 0; i < 3; ++i)
    if (place.scale[i] != 0.0) axes[i] /= place.scale[i];
  place.rotation = quaternionOf(axes);
  return place;
}

// Whether a quaternion has no length.
bool isZero(const Json& numbers) {
  glm::dvec4 rotation(0.0);
  for (int i = 0; i < 4; ++i) rotation[i] = numbers[static_cast<std::size_t>(i)].get<double>();
  return !(glm::length(rotation) > 0.0);
}

} // namespace

glm::dmat4 matrixOf(const GltfPlace& place) {
  const glm::dvec4& q = place.rotation;
  const glm::dvec3 x(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
  const glm::dvec3 y(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
  const glm::dvec3 z(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
  return {glm::dvec4(x * place.scale.x, 0.0), glm::dvec4(y * place.scale.y, 0.0), glm::dvec4(z * place.scale.z, 0.0),
          glm::dvec4(place.translation, 1.0)};
}

GltfRareParts& GltfNodes::makeRare(std::uint32_t node) {
  std::uint32_t& place = nodes_[node].rare;
  if (place == none) {
    place = static_cast<std::uint32_t>(rare_.size());
    rare_.emplace_back();
  }
  return rare_[place];
}

void GltfNodes::addChildren(const Json& children) {
  Node& node = nodes_.back();
  node.firstChild = static_cast<std::uint32_t>(children_.size());
  std::unordered_set<std::uint32_t> listed;
  for (const Json& child : children) {
    const auto index = child.get<std::uint32_t>();
    if (children.size() > 1 && !listed.insert(index).second) {
      if (repeated_++ == 0) firstRepeating_ = size() - 1;
      continue;
    }
    children_.push_back(index);
  }
  if (children_.size() >= none) throw LoadError("its nodes have too many children");
  node.childCount = static_cast<std::uint32_t>(children_.size() - node.firstChild);
}

void GltfNodes::addExtensions(const Json& extensions) {
  if (extensions.empty()) return;
  Node& node = nodes_.back();
  GltfRareParts& rare = makeRare(size() - 1);
  for (const auto& [name, value] : extensions.items()) rare.extensions.push_back(name);
  const auto light = extensions.find("KHR_lights_punctual");
  if (light != extensions.end()) rare.light = indexIn(*light, "light");
  const auto visibility = extensions.find("KHR_node_visibility");
  if (visibility != extensions.end() && !visibility->value("visible", true)) node.parts |= Hidden;
  const auto instancing = extensions.find("EXT_mesh_gpu_instancing");
  if (instancing == extensions.end()) return;
  const Json& attributes = instancing->at("attributes");
  rare.translations = indexIn(attributes, "TRANSLATION");
  rare.rotations = indexIn(attributes, "ROTATION");
  rare.scales = indexIn(attributes, "SCALE");
  rare.instanceColors = attributes.contains("_COLOR_0") || attributes.contains("COLOR_0");
  rare.instanced = rare.translations || rare.rotations || rare.scales;
}

void GltfNodes::add(const Json& json) {
  if (nodes_.size() == none - 1 || numbers_.size() > none - 32U) throw LoadError("it has too many nodes");
  Node& node = nodes_.emplace_back();
  node.firstNumber = static_cast<std::uint32_t>(numbers_.size());
  constexpr std::pair<const char*, Parts> transforms[] = {
      {"matrix", Matrix}, {"translation", Translation}, {"rotation", Rotation}, {"scale", Scale}};
  for (const auto& [key, part] : transforms) {
    const auto member = json.find(key);
    // Where there is a matrix the others should not be there.
    if (member == json.end() || (node.parts & Matrix) != 0) continue;
    if (part == Rotation && isZero(*member)) {
      if (zeroRotations_++ == 0) firstZeroRotation_ = size() - 1;
      continue;
    }
    node.parts |= part;
    for (const Json& number : *member) numbers_.push_back(number.get<double>());
  }
  node.mesh = indexIn(json, "mesh").value_or(none);
  const auto name = json.find("name");
  if (name != json.end() && names_.size() < none / 2) {
    node.name = static_cast<std::uint32_t>(names_.size());
    names_ += name->get_ref<const std::string&>().c_str();
    names_ += '\0';
  }
  const std::uint32_t index = size() - 1;
  if (json.contains("skin")) makeRare(index).skin = indexIn(json, "skin");
  if (json.contains("camera")) makeRare(index).camera = indexIn(json, "camera");
  if (json.contains("weights")) makeRare(index).weights = json.at("weights").get<std::vector<double>>();
  if (json.contains("children")) addChildren(json.at("children"));
  if (json.contains("extensions")) addExtensions(json.at("extensions"));
}

const GltfRareParts& GltfNodes::rare(std::uint32_t node) const {
  static const GltfRareParts nothing;
  return nodes_[node].rare == none ? nothing : rare_[nodes_[node].rare];
}

std::string_view GltfNodes::ownName(std::uint32_t node) const {
  return nodes_[node].name == none ? std::string_view{} : std::string_view(names_.c_str() + nodes_[node].name);
}

std::string GltfNodes::name(std::uint32_t node) const { return objectName("node", node, ownName(node)); }

template <std::size_t N>
std::array<double, N> GltfNodes::numbers(std::uint32_t first) const {
  std::array<double, N> values;
  std::copy_n(numbers_.begin() + first, N, values.begin());
  return values;
}

glm::dmat4 GltfNodes::matrix(std::uint32_t index) const {
  const Node& node = nodes_[index];
  if ((node.parts & Matrix) != 0) return glm::make_mat4(numbers<16>(node.firstNumber).data());
  return matrixOf(place(index));
}

GltfPlace GltfNodes::place(std::uint32_t index) const {
  const Node& node = nodes_[index];
  GltfPlace place;
  std::uint32_t at = node.firstNumber;
  if ((node.parts & Matrix) != 0) {
    const glm::dmat4 matrix = glm::make_mat4(numbers<16>(at).data());
    return placeOf(matrix);
  }
  if ((node.parts & Translation) != 0) {
    place.translation = glm::make_vec3(numbers<3>(at).data());
    at += 3;
  }
  if ((node.parts & Rotation) != 0) {
    place.rotation = glm::make_vec4(numbers<4>(at).data());
    at += 4;
    place.rotation /= glm::length(place.rotation); // add() keeps none that is zero
  }
  if ((node.parts & Scale) != 0) place.scale = glm::make_vec3(numbers<3>(at).data());
  return place;
}

void GltfNodes::setPlace(std::uint32_t index, const GltfPlace& place) {
  Node& node = nodes_[index];
  node.parts = static_cast<std::uint8_t>((node.parts & Hidden) | Translation | Rotation | Scale);
  node.firstNumber = static_cast<std::uint32_t>(numbers_.size());
  for (int i = 0; i < 3; ++i) numbers_.push_back(place.translation[i]);
  for (int i = 0; i < 4; ++i) numbers_.push_back(place.rotation[i]);
  for (int i = 0; i < 3; ++i) numbers_.push_back(place.scale[i]);
}

void GltfNodes::setWeights(std::uint32_t node, std::vector<double> weights) {
  makeRare(node).weights = std::move(weights);
}

} // namespace vitrail::tool
