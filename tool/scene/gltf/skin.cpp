// Poses a skinned mesh (glTF 2.0, section 3.7.3).
#include "skin.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"
#include "accessor.h"

namespace vitrail::tool {
namespace {

// One set of influences, JOINTS_n and WEIGHTS_n.
struct InfluenceSet {
  std::vector<glm::uvec4> joints;
  std::vector<glm::vec4> weights;
};

std::vector<InfluenceSet> readInfluences(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                         const std::string& where, std::size_t vertexCount) {
  std::vector<InfluenceSet> sets;
  for (int set = 0; set < 2; ++set) {
    const std::string jointsName = fmt::format("JOINTS_{}", set);
    const std::string weightsName = fmt::format("WEIGHTS_{}", set);
    const auto joints = primitive.attributes.find(jointsName);
    const auto weights = primitive.attributes.find(weightsName);
    if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) continue;
    InfluenceSet influences{readJoints(document, static_cast<std::size_t>(joints->second), jointsName),
                            readVectors(document, static_cast<std::size_t>(weights->second), 4, 4, weightsName)};
    if (influences.joints.size() != vertexCount || influences.weights.size() != vertexCount)
      throw LoadError(fmt::format("{}: has {} positions, but {} {} and {} {}", where, vertexCount,
                                  influences.joints.size(), jointsName, influences.weights.size(), weightsName));
    sets.push_back(std::move(influences));
  }
  return sets;
}

// The weighted mean of the joint matrices of one vertex; identity where no joint has a weight.
glm::dmat4 blendedMatrix(std::span<const InfluenceSet> sets, std::span<const glm::dmat4> joints, std::size_t vertex,
                         const std::string& where) {
  glm::dmat4 sum(0.0);
  double total = 0.0;
  for (const InfluenceSet& set : sets)
    for (int i = 0; i < 4; ++i) {
      const auto weight = static_cast<double>(set.weights[vertex][i]);
      // A joint that weighs nothing may be any number. So may a weight that is not a number: it weighs nothing.
      if (!(weight > 0.0)) continue;
      const std::uint32_t joint = set.joints[vertex][i];
      if (joint >= joints.size())
        throw LoadError(fmt::format("{}: vertex {} follows joint {}, but the skin has {} joints", where, vertex, joint,
                                    joints.size()));
      sum += joints[joint] * weight;
      total += weight;
    }
  return total > 0.0 ? sum / total : glm::dmat4(1.0);
}

// The matrix that carries area vectors, and so the normals of any surface, even where `m` has no inverse.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

} // namespace

GltfSkinPose poseSkin(const GltfDocument& document, const GltfHierarchy& hierarchy, std::size_t index) {
  const tinygltf::Skin& skin = document.model.skins[index];
  GltfSkinPose pose;
  pose.joints = hierarchy.worldOf(skin.joints);
  if (skin.inverseBindMatrices >= 0) {
    const std::vector<glm::mat4> inverseBinds =
        readMatrices(document, static_cast<std::size_t>(skin.inverseBindMatrices), "inverseBindMatrices");
    if (inverseBinds.size() < skin.joints.size())
      throw LoadError(fmt::format("{}: has {} joints, but {} inverse bind matrices",
                                  objectName("skin", index, skin.name), skin.joints.size(), inverseBinds.size()));
    for (std::size_t i = 0; i < pose.joints.size(); ++i) pose.joints[i] = pose.joints[i] * glm::dmat4(inverseBinds[i]);
  }
  // A float keeps a place at this distance to half a millimetre.
  constexpr double near = 4096.0;
  if (pose.joints.empty() || !(glm::length(glm::dvec3(pose.joints[0][3])) > near)) return pose;
  pose.origin = glm::dvec3(pose.joints[0][3]);
  for (glm::dmat4& joint : pose.joints) joint[3] -= glm::dvec4(pose.origin, 0.0);
  return pose;
}

void applySkin(const GltfDocument& document, const GltfSkinPose& pose, const tinygltf::Primitive& primitive,
               const std::string& where, std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices) {
  const std::vector<InfluenceSet> sets = readInfluences(document, primitive, where, vertices.size());
  std::vector<bool> mirrored(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vertex& vertex = vertices[i];
    const glm::dmat4 matrix = blendedMatrix(sets, pose.joints, i, where);
    const glm::dmat3 linear(matrix);
    const double sign = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
    mirrored[i] = sign < 0.0;
    vertex.position = glm::vec3(matrix * glm::dvec4(vertex.position, 1.0));
    vertex.normal = glm::vec3(glm::normalize(cofactors(linear) * glm::dvec3(vertex.normal)) * sign);
    vertex.tangent = glm::vec4(glm::vec3(glm::normalize(linear * glm::dvec3(vertex.tangent))),
                               vertex.tangent.w * static_cast<float>(sign));
  }
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    if (mirrored[indices[i]]) std::swap(indices[i + 1], indices[i + 2]);
}

} // namespace vitrail::tool
