// Good files of the corpus, and how their values are compared.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "scene/load.h"

namespace vitrail::tool {

inline Scene loadGood(const std::string& name, const LoadOptions& options = {}) {
  return loadModel(std::filesystem::path(VITRAIL_TEST_CORPUS) / "good" / name, options);
}

// What a good file is refused with under such options; empty where it loads.
inline std::string refusalOf(const std::string& name, const LoadOptions& options) {
  try {
    loadGood(name, options);
    return {};
  } catch (const LoadError& error) {
    return error.what();
  }
}

// Where a draw puts a position of its mesh, in the space of the file.
inline glm::dvec3 placed(const Scene& scene, std::size_t draw, const glm::vec3& position) {
  return scene.origin + glm::dvec3(glm::dmat4(scene.draws.at(draw).transform) * glm::dvec4(position, 1.0));
}

inline void expectNear(const glm::vec3& actual, const glm::vec3& expected, float tolerance = 1e-5F) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "component " << c;
}

// Vertex colours are kept as 16-bit floats.
constexpr float kColorTolerance = 2.5e-4F; // up to 1

inline void expectNear(const glm::vec4& actual, const glm::vec4& expected) {
  expectNear(glm::vec3(actual), glm::vec3(expected), kColorTolerance);
  EXPECT_NEAR(actual.w, expected.w, kColorTolerance);
}

} // namespace vitrail::tool
