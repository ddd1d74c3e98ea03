// What is drawn: scenes as the tool makes them, as buffers of vertices and instances.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "tool/stage/frame_data.h"

namespace vitrail::tests::figures {

struct Vertex {
  glm::vec3 position;
  glm::vec3 normal;
};

struct Instance {
  std::array<glm::vec4, 3> rows; // of its transform to the world
  glm::vec4 color;               // linear, straight alpha
  float roughness;               // below 0: unlit
};

// All instances of one mesh that are opaque, or transparent.
struct Group {
  bool transparent;
  std::uint32_t firstIndex;
  std::uint32_t indices;
  std::int32_t firstVertex;
  std::uint32_t firstInstance;
  std::uint32_t instances;
};

struct Geometry {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Instance> instances;
  std::vector<Group> groups;
  tool::shaders::FrameData frame; // of the tool's usual camera
  bool sky;
};

// `mannequins`, the tool's scene of 36 figures; or `pane`, one unlit sheet of many triangles.
Geometry makeGeometry(std::string_view scene, std::uint32_t width, std::uint32_t height);

} // namespace vitrail::tests::figures
