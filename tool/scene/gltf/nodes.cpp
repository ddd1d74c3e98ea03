// The node hierarchy of a glTF file. Nothing here calls itself: a file may nest nodes thousands deep.
#include "nodes.h"

#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "../load.h"
#include "../message.h"

namespace vitrail::tool {
namespace {

constexpr std::size_t noNode = std::numeric_limits<std::size_t>::max();

std::vector<std::size_t> findParents(const GltfDocument& document) {
  const auto& nodes = document.model.nodes;
  std::vector<std::size_t> parents(nodes.size(), noNode);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const int child : nodes[i].children) {
      std::size_t& parent = parents[static_cast<std::size_t>(child)];
      if (parent != noNode)
        throw LoadError(fmt::format("{} is a child of node {} and of node {}, but may have one parent only",
                                    nodeName(document, static_cast<std::size_t>(child)), parent, i));
      parent = i;
    }
  return parents;
}

glm::dvec3 vectorOr(const std::vector<double>& values, double otherwise) {
  return values.size() == 3 ? glm::dvec3(values[0], values[1], values[2]) : glm::dvec3(otherwise);
}

// Translation * rotation * scale, with the rotation as the quaternion x, y, z, w.
glm::dmat4 localMatrix(const GltfDocument& document, std::size_t index) {
  const tinygltf::Node& node = document.model.nodes[index];
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  glm::dvec4 q(0.0, 0.0, 0.0, 1.0);
  if (node.rotation.size() == 4) q = glm::make_vec4(node.rotation.data());
  const double length = glm::length(q);
  if (!(length > 0.0))
    throw LoadError(fmt::format("{}: rotation is zero, not a quaternion", nodeName(document, index)));
  q /= length;
  const glm::dvec3 t = vectorOr(node.translation, 0.0);
  const glm::dvec3 s = vectorOr(node.scale, 1.0);
  const glm::dvec3 x(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
  const glm::dvec3 y(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
  const glm::dvec3 z(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
  return {glm::dvec4(x * s.x, 0.0), glm::dvec4(y * s.y, 0.0), glm::dvec4(z * s.z, 0.0), glm::dvec4(t, 1.0)};
}

// All nodes that can be reached from the roots, parents first and children in order.
std::vector<std::size_t> depthFirst(const GltfDocument& document, const std::vector<std::size_t>& roots) {
  std::vector<std::size_t> order;
  std::vector<std::size_t> waiting(roots.rbegin(), roots.rend());
  while (!waiting.empty()) {
    const std::size_t node = waiting.back();
    waiting.pop_back();
    order.push_back(node);
    const std::vector<int>& children = document.model.nodes[node].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      waiting.push_back(static_cast<std::size_t>(*child));
  }
  return order;
}

std::vector<std::size_t> forestRoots(const std::vector<std::size_t>& parents) {
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < parents.size(); ++i)
    if (parents[i] == noNode) roots.push_back(i);
  return roots;
}

} // namespace

std::vector<glm::dmat4> placeNodes(const GltfDocument& document) {
  const std::vector<std::size_t> parents = findParents(document);
  std::vector<glm::dmat4> world(parents.size());
  std::vector<bool> placed(parents.size(), false);
  for (const std::size_t node : depthFirst(document, forestRoots(parents))) {
    const glm::dmat4 local = localMatrix(document, node);
    world[node] = parents[node] == noNode ? local : world[parents[node]] * local;
    placed[node] = true;
  }
  // With one parent each, the nodes that no root leads to are those on a ring and below it.
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (!placed[i])
      throw LoadError(fmt::format("{} is its own ancestor, or below a node that is", nodeName(document, i)));
  return world;
}

std::vector<std::size_t> sceneNodes(const GltfDocument& document) {
  const std::vector<std::size_t> parents = findParents(document);
  const tinygltf::Model& model = document.model;
  if (model.scenes.empty()) return depthFirst(document, forestRoots(parents));
  const std::size_t scene = model.defaultScene < 0 ? 0 : static_cast<std::size_t>(model.defaultScene);
  std::vector<std::size_t> roots;
  std::vector<bool> listed(model.nodes.size(), false);
  for (const int root : model.scenes[scene].nodes) {
    const auto node = static_cast<std::size_t>(root);
    const std::string where = objectName("scene", scene, model.scenes[scene].name);
    if (parents[node] != noNode)
      throw LoadError(fmt::format("{}: lists {} as a root, but that is a child of node {}", where,
                                  nodeName(document, node), parents[node]));
    if (listed[node]) throw LoadError(fmt::format("{}: lists {} twice", where, nodeName(document, node)));
    listed[node] = true;
    roots.push_back(node);
  }
  return depthFirst(document, roots);
}

glm::mat4 nodeMatrix(const GltfDocument& document, std::size_t node, const glm::dmat4& world) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!(std::abs(world[column][row]) <= static_cast<double>(std::numeric_limits<float>::max())))
        throw LoadError(fmt::format("{}: its place in the world is beyond 32-bit floats", nodeName(document, node)));
  return glm::mat4(world);
}

std::string nodeName(const GltfDocument& document, std::size_t node) {
  return objectName("node", node, document.model.nodes[node].name);
}

} // namespace vitrail::tool
