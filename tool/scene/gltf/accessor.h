// Reads accessors: strided, interleaved, normalised, sparse and zero-filled ones. Every range is checked against the
// data before it is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "document.h"

namespace vitrail::tool {

// All functions throw LoadError where the accessor reaches past its data, or its type is not what its use asks for.
// `use` says in messages what it is used for, as in "POSITION".

// Elements of 1 to 4 components, integers normalised where the accessor says so. The components that an element lacks
// are taken from `fill`. The accessor's type has `least` to `most` components.
std::vector<glm::vec4> readVectors(const GltfDocument& document, std::size_t accessor, int least, int most,
                                   std::string_view use, const glm::vec4& fill = glm::vec4(0.0F));

// The same, a few at a time, so that nobody needs room for all: `visit` is given the place of the first of them.
void visitVectors(const GltfDocument& document, std::size_t accessor, int least, int most, std::string_view use,
                  const std::function<void(std::size_t, std::span<const glm::vec4>)>& visit,
                  const glm::vec4& fill = glm::vec4(0.0F));

// Unsigned integers of one component.
std::vector<std::uint32_t> readIndices(const GltfDocument& document, std::size_t accessor);

// Unsigned integers of four components.
std::vector<glm::uvec4> readJoints(const GltfDocument& document, std::size_t accessor, std::string_view use);

// 4x4 matrices of floats.
std::vector<glm::mat4> readMatrices(const GltfDocument& document, std::size_t accessor, std::string_view use);

// The number of elements, and how a message names the accessor.
std::size_t accessorCount(const GltfDocument& document, std::size_t accessor);
std::string accessorName(const GltfDocument& document, std::size_t accessor);

} // namespace vitrail::tool
