// The nodes of a glTF file, kept small: a file may have millions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

namespace vitrail::tool {

// A place as translation * rotation * scale.
struct GltfPlace {
  glm::dvec3 translation{0.0};
  glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0}; // the quaternion x, y, z, w
  glm::dvec3 scale{1.0};
};

glm::dmat4 matrixOf(const GltfPlace& place); // the rotation has unit length

// What few nodes have.
struct GltfRareParts {
  std::optional<std::uint32_t> skin;
  std::optional<std::uint32_t> camera;
  std::optional<std::uint32_t> light;        // KHR_lights_punctual
  std::vector<double> weights;               // of morph targets
  bool instanced = false;                    // EXT_mesh_gpu_instancing
  std::optional<std::uint32_t> translations; // its accessors
  std::optional<std::uint32_t> rotations;
  std::optional<std::uint32_t> scales;
  bool instanceColors = false;
  std::vector<std::string> extensions; // the names of all that it has
};

class GltfNodes {
 public:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  // Adds one that checkGltfNode() has passed. Throws LoadError where there are too many.
  void add(const nlohmann::json& node);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  [[nodiscard]] std::uint32_t mesh(std::uint32_t node) const { return nodes_[node].mesh; } // or none
  [[nodiscard]] std::uint32_t childCount(std::uint32_t node) const { return nodes_[node].childCount; }
  [[nodiscard]] std::uint32_t child(std::uint32_t node, std::uint32_t i) const {
    return children_[nodes_[node].firstChild + i];
  }
  [[nodiscard]] bool hidden(std::uint32_t node) const { return (nodes_[node].parts & Hidden) != 0; }
  [[nodiscard]] const GltfRareParts& rare(std::uint32_t node) const;
  [[nodiscard]] std::string name(std::uint32_t node) const;         // how a message names it
  [[nodiscard]] std::string_view ownName(std::uint32_t node) const; // empty where it has none

  // Its own transform.
  [[nodiscard]] glm::dmat4 matrix(std::uint32_t node) const;
  // The same as a place; a matrix is decomposed, its shear left out.
  [[nodiscard]] GltfPlace place(std::uint32_t node) const;

  // Moves it, or changes the weights of its morph targets.
  void setPlace(std::uint32_t node, const GltfPlace& place);
  void setWeights(std::uint32_t node, std::vector<double> weights);

  // How many of the children that nodes list were left out, since the node lists them twice, and which one is first.
  [[nodiscard]] std::uint64_t repeatedChildren() const { return repeated_; }
  [[nodiscard]] std::uint32_t firstRepeating() const { return firstRepeating_; }

  // How many rotations of nodes are zero, which turn nothing, and which node has the first.
  [[nodiscard]] std::uint64_t zeroRotations() const { return zeroRotations_; }
  [[nodiscard]] std::uint32_t firstZeroRotation() const { return firstZeroRotation_; }

 private:
  enum Parts : std::uint8_t { Matrix = 1, Translation = 2, Rotation = 4, Scale = 8, Hidden = 16 };

  struct Node {
    std::uint32_t mesh = none;
    std::uint32_t firstChild = 0; // in children_
    std::uint32_t childCount = 0;
    std::uint32_t firstNumber = 0; // in numbers_: those of the parts that there are, in their order
    std::uint32_t rare = none;     // in rare_
    std::uint32_t name = none;     // in names_, where it ends with a 0
    std::uint8_t parts = 0;
  };

  GltfRareParts& makeRare(std::uint32_t node);
  void addChildren(const nlohmann::json& children);
  void addExtensions(const nlohmann::json& extensions);
  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(std::uint32_t first) const;

  // Queues, since vectors are twice as large while they grow.
  std::deque<Node> nodes_;
  std::deque<double> numbers_;
  std::deque<std::uint32_t> children_;
  std::deque<GltfRareParts> rare_;
  std::string names_;
  std::uint64_t repeated_ = 0;
  std::uint32_t firstRepeating_ = none;
  std::uint64_t zeroRotations_ = 0;
  std::uint32_t firstZeroRotation_ = none;
};

} // namespace vitrail::tool
