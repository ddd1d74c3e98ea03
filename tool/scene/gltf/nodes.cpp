// The node hierarchy of a glTF file. Nothing here calls itself: a file may nest nodes thousands deep.
#include "nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"

namespace vitrail::tool {
namespace {

constexpr std::uint32_t none = GltfNodes::none;

// " (and 3 more)", after the first of several.
std::string andMore(std::uint64_t count) { return count > 1 ? fmt::format(" (and {} more)", count - 1) : ""; }

} // namespace

GltfHierarchy::GltfHierarchy(const GltfDocument& document, Scene& scene) : document_(document) {
  sortNodes();
  chooseRoots(scene);
  warnOfParents(scene);
}

// Depth first, with the nodes marked that are on the way: meeting one of them closes a ring.
void GltfHierarchy::sortNodes() {
  enum : std::uint8_t { Unseen, OnTheWay, Done };
  struct Step {
    std::uint32_t node;
    std::uint32_t next; // of its children
  };
  const GltfNodes& nodes = document_.nodes;
  parents_.assign(nodes.size(), none);
  order_.reserve(nodes.size());
  std::vector<std::uint8_t> states(nodes.size(), Unseen);
  std::vector<Step> way;
  for (std::uint32_t start = 0; start < nodes.size(); ++start) {
    if (states[start] == Unseen) way.push_back({start, 0});
    while (!way.empty()) {
      Step& step = way.back();
      const std::uint32_t node = step.node;
      states[node] = OnTheWay;
      if (step.next == nodes.childCount(node)) {
        states[node] = Done;
        order_.push_back(node);
        way.pop_back();
        continue;
      }
      const std::uint32_t child = nodes.child(node, step.next++);
      if (states[child] == OnTheWay) throw LoadError(fmt::format("{} is its own ancestor", nodes.name(child)));
      if (parents_[child] != none && shared_++ == 0) {
        firstShared_ = child;
        sharing_[0] = parents_[child];
        sharing_[1] = node;
      }
      if (parents_[child] == none) parents_[child] = node;
      if (states[child] == Unseen) way.push_back({child, 0});
    }
  }
  std::ranges::reverse(order_);
}

// Which nodes have an ancestor that is listed, along their first parents.
std::vector<bool> GltfHierarchy::belowListed(const std::vector<bool>& listed) const {
  std::vector<bool> below(parents_.size(), false);
  for (const std::uint32_t node : order_)
    for (std::uint32_t i = 0; i < document_.nodes.childCount(node); ++i)
      if (below[node] || listed[node]) below[document_.nodes.child(node, i)] = true;
  return below;
}

void GltfHierarchy::chooseRoots(Scene& scene) {
  if (document_.scenes.empty()) {
    for (std::uint32_t i = 0; i < parents_.size(); ++i)
      if (parents_[i] == none) roots_.push_back(i);
    return;
  }
  const std::size_t index = document_.defaultScene;
  const GltfScene& source = document_.scenes[index];
  const std::string where = objectName("scene", index, source.name);
  std::vector<bool> listed(parents_.size(), false);
  std::uint64_t repeated = 0;
  std::uint32_t firstRepeated = none;
  bool children = false;
  roots_.reserve(source.nodes.size());
  for (const std::uint32_t node : source.nodes) {
    if (listed[node]) {
      if (repeated++ == 0) firstRepeated = node;
      continue;
    }
    listed[node] = true;
    children = children || parents_[node] != none;
    roots_.push_back(node);
  }
  if (repeated > 0)
    warn(scene, fmt::format("{}: lists {}{} twice: it is drawn once", where, document_.nodes.name(firstRepeated),
                            andMore(repeated)));
  if (!children) return;
  const std::vector<bool> below = belowListed(listed);
  std::uint64_t drawnBelow = 0;
  std::uint64_t cutOff = 0;
  std::uint32_t first[2] = {};
  for (const std::uint32_t root : roots_) {
    if (parents_[root] == none) continue;
    if (below[root]) {
      if (drawnBelow++ == 0) first[0] = root;
    } else if (placeOf(parents_[root]) != glm::dmat4(1.0)) {
      if (cutOff++ == 0) first[1] = root;
    }
  }
  places_.clear();
  if (drawnBelow > 0)
    warn(scene, fmt::format("{}: lists {}{} as a root, which is below another one: it is drawn there alone", where,
                            document_.nodes.name(first[0]), andMore(drawnBelow)));
  if (cutOff > 0)
    warn(scene,
         fmt::format("{}: lists {}{} as a root, but not its parent, {}: it is drawn without the parent's "
                     "transform",
                     where, document_.nodes.name(first[1]), andMore(cutOff), document_.nodes.name(parents_[first[1]])));
  std::erase_if(roots_, [&](std::uint32_t root) { return below[root]; });
  for (const std::uint32_t root : roots_) parents_[root] = none;
}

void GltfHierarchy::warnOfParents(Scene& scene) const {
  const GltfNodes& nodes = document_.nodes;
  if (shared_ > 0)
    warn(scene, fmt::format("{} is a child of node {} and of node {}{}: it is drawn below each",
                            nodes.name(firstShared_), sharing_[0], sharing_[1], andMore(shared_)));
  if (nodes.repeatedChildren() > 0)
    warn(scene, fmt::format("{} lists a child twice{}: it is drawn once", nodes.name(nodes.firstRepeating()),
                            andMore(nodes.repeatedChildren())));
  if (nodes.zeroRotations() > 0)
    warn(scene, fmt::format("{}: rotation is zero, not a quaternion{}: it is not rotated",
                            nodes.name(nodes.firstZeroRotation()), andMore(nodes.zeroRotations())));
}

void GltfHierarchy::visit(const std::function<void(const GltfPlacedNode&)>& visit) const {
  struct Step {
    GltfPlacedNode placed;
    std::uint32_t next; // of its children
  };
  const GltfNodes& nodes = document_.nodes;
  constexpr std::uint64_t mostCopies = 1'000'000;
  std::uint64_t left = nodes.size() + mostCopies;
  const auto arrive = [&](std::uint32_t node, std::uint32_t above, const glm::dmat4& parent, bool visible) {
    if (left-- == 0)
      throw LoadError(fmt::format("nodes with several parents make more than {} copies of others", mostCopies));
    const GltfPlacedNode placed{node, parent * nodes.matrix(node), above, visible && !nodes.hidden(node)};
    visit(placed);
    return placed;
  };
  std::vector<Step> way;
  for (const std::uint32_t root : roots_) {
    way.push_back({arrive(root, none, glm::dmat4(1.0), true), 0});
    while (!way.empty()) {
      Step& step = way.back();
      if (step.next == nodes.childCount(step.placed.node)) {
        way.pop_back();
        continue;
      }
      const std::uint32_t child = nodes.child(step.placed.node, step.next++);
      const GltfPlacedNode placed = arrive(child, step.placed.node, step.placed.world, step.placed.visible);
      if (nodes.childCount(child) > 0) way.push_back({placed, 0});
    }
  }
}

glm::dmat4 GltfHierarchy::placeOf(std::uint32_t node) const {
  std::vector<std::uint32_t> way;
  auto known = places_.end();
  for (std::uint32_t at = node; at != none && known == places_.end(); at = parents_[at]) {
    known = places_.find(at);
    if (known == places_.end()) way.push_back(at);
  }
  glm::dmat4 world = known == places_.end() ? glm::dmat4(1.0) : known->second;
  for (; !way.empty(); way.pop_back()) {
    world = world * document_.nodes.matrix(way.back());
    places_.emplace(way.back(), world);
  }
  return world;
}

std::vector<glm::dmat4> GltfHierarchy::worldOf(std::span<const int> nodes) const {
  std::vector<glm::dmat4> places;
  places.reserve(nodes.size());
  for (const int node : nodes) places.push_back(placeOf(static_cast<std::uint32_t>(node)));
  return places;
}

glm::mat4 nodeMatrix(const GltfDocument& document, std::uint32_t node, glm::dmat4 world, const glm::dvec3& origin) {
  world[3] -= glm::dvec4(origin, 0.0);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!(std::abs(world[column][row]) <= static_cast<double>(std::numeric_limits<float>::max())))
        throw LoadError(fmt::format("{}: its place in the world is beyond 32-bit floats", document.nodes.name(node)));
  return glm::mat4(world);
}

} // namespace vitrail::tool
