// Reads accessors (glTF 2.0, section 3.6.2).
#include "accessor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "../load.h"
#include "../message.h"

namespace vitrail::tool {
namespace {

// An accessor without a buffer view takes no space in the file, so its count is bounded here instead.
constexpr std::size_t mostZeroFilled = 1'000'000;

std::size_t componentSize(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    default:
      return 4;
  }
}

std::size_t componentCount(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
    case TINYGLTF_TYPE_MAT2:
      return 4;
    case TINYGLTF_TYPE_MAT3:
      return 9;
    default:
      return 16;
  }
}

// Elements in memory: element i starts at bytes[i * stride], and all of them lie inside `bytes`.
struct Elements {
  std::span<const std::byte> bytes;
  std::size_t stride = 0;
  std::size_t count = 0;
};

// `what` begins the message: "accessor 3", "accessor 3: sparse.values".
Elements elementsIn(const GltfDocument& document, std::size_t bufferView, std::size_t byteOffset, std::size_t count,
                    std::size_t elementSize, bool strided, const std::string& what) {
  const tinygltf::BufferView& view = document.model.bufferViews[bufferView];
  const std::span<const std::byte> bytes = bufferViewBytes(document, bufferView);
  const std::size_t stride = strided && view.byteStride != 0 ? view.byteStride : elementSize;
  if (count == 0) return {{}, stride, 0};
  if (stride < elementSize)
    throw LoadError(fmt::format("{}: its elements have {} bytes, but the stride of buffer view {} is {}", what,
                                elementSize, bufferView, stride));
  // Divides where a product could overflow.
  const bool fits = byteOffset <= bytes.size() && elementSize <= bytes.size() - byteOffset &&
                    count - 1 <= (bytes.size() - byteOffset - elementSize) / stride;
  if (!fits)
    throw LoadError(
        fmt::format("{}: {} elements of {} bytes at offset {}, {} bytes apart, reach past the end of "
                    "buffer view {}, which has {} bytes",
                    what, count, elementSize, byteOffset, stride, bufferView, bytes.size()));
  return {bytes.subspan(byteOffset), stride, count};
}

template <typename Component>
Component load(const std::byte* from) {
  Component value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// One component, as a float or an unsigned integer. Signed integers are never asked for as the latter.
template <typename Value>
Value component(const std::byte* from, int type, bool normalized) {
  const auto scaled = [=]<typename Raw>(Raw raw, [[maybe_unused]] float largest) {
    if constexpr (std::is_same_v<Value, float>) {
      if (normalized) return std::max(static_cast<float>(raw) / largest, -1.0F);
    }
    return static_cast<Value>(raw);
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(load<std::int8_t>(from), 127.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(load<std::uint8_t>(from), 255.0F);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(load<std::int16_t>(from), 32767.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(load<std::uint16_t>(from), 65535.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return scaled(load<std::uint32_t>(from), 4294967295.0F);
    default:
      if constexpr (std::is_same_v<Value, float>) return load<float>(from);
      return Value{};
  }
}

// Widens elements of floats, or of integers, to four components; those that they lack are the fill's already.
template <typename Raw>
void widen(const Elements& elements, std::size_t first, std::size_t components, float scale,
           std::span<glm::vec4> target) {
  for (std::size_t i = 0; i < target.size(); ++i) {
    const std::byte* from = elements.bytes.data() + (first + i) * elements.stride;
    float values[4] = {target[i].x, target[i].y, target[i].z, target[i].w};
    for (std::size_t c = 0; c < components; ++c) {
      const auto value = static_cast<float>(load<Raw>(from + c * sizeof(Raw)));
      values[c] = scale == 0.0F ? value : std::max(value / scale, -1.0F);
    }
    target[i] = {values[0], values[1], values[2], values[3]};
  }
}

void widen(const Elements& elements, std::size_t first, std::size_t components, int type, bool normalized,
           std::span<glm::vec4> target) {
  const auto scale = [normalized](float largest) { return normalized ? largest : 0.0F; };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return widen<std::int8_t>(elements, first, components, scale(127.0F), target);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return widen<std::uint8_t>(elements, first, components, scale(255.0F), target);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return widen<std::int16_t>(elements, first, components, scale(32767.0F), target);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return widen<std::uint16_t>(elements, first, components, scale(65535.0F), target);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return widen<std::uint32_t>(elements, first, components, scale(4294967295.0F), target);
    default:
      return widen<float>(elements, first, components, 0.0F, target);
  }
}

// Reads elements part by part. Of a mapped file the memory holds one part at a time.
template <typename Read>
void inChunks(const GltfDocument& document, const Elements& elements, std::size_t size, Read read) {
  constexpr std::size_t stretch = std::size_t{1} << 22U; // bytes that are released at once
  std::size_t released = 0;
  for (std::size_t first = 0; first < elements.count; first += size) {
    read(first, std::min(size, elements.count - first));
    const std::size_t done = std::min((first + size) * elements.stride, elements.bytes.size());
    if (done - released < stretch) continue;
    releaseBytes(document, elements.bytes.subspan(released, done - released));
    released = done;
  }
}

// Reads accessors into arrays of `width` components an element; those that the accessor lacks keep the fill value.
template <typename Value>
class Reader {
 public:
  Reader(const GltfDocument& document, std::size_t index)
      : document_(document),
        accessor_(document.model.accessors[index]),
        where_(accessorName(document, index)),
        components_(componentCount(accessor_.type)),
        elementSize_(components_ * componentSize(accessor_.componentType)) {}

  // `fill` has `width` values.
  std::vector<Value> read(std::span<const Value> fill) {
    const std::size_t width = fill.size();
    if (accessor_.bufferView < 0) {
      if (accessor_.count > mostZeroFilled)
        throw LoadError(fmt::format("{}: counts {} elements without a buffer view, more than {}", where_,
                                    accessor_.count, mostZeroFilled));
      std::vector<Value> zeros(accessor_.count * width, Value{});
      for (std::size_t i = 0; i < zeros.size(); ++i)
        if (i % width >= components_) zeros[i] = fill[i % width];
      return readSparse(std::move(zeros), width);
    }
    const Elements elements = elementsIn(document_, static_cast<std::size_t>(accessor_.bufferView),
                                         accessor_.byteOffset, accessor_.count, elementSize_, true, where_);
    std::vector<Value> values(elements.count * width);
    for (std::size_t i = 0; i < elements.count; ++i) {
      const std::span<Value> target = std::span(values).subspan(i * width, width);
      std::ranges::copy(fill, target.begin());
      readElement(elements.bytes.data() + i * elements.stride, target);
    }
    return readSparse(std::move(values), width);
  }

 private:
  void readElement(const std::byte* from, std::span<Value> target) const {
    const std::size_t size = componentSize(accessor_.componentType);
    for (std::size_t c = 0; c < components_; ++c)
      target[c] = component<Value>(from + c * size, accessor_.componentType, accessor_.normalized);
  }

  std::vector<Value> readSparse(std::vector<Value> values, std::size_t width) const {
    if (!accessor_.sparse.isSparse) return values;
    const auto& sparse = accessor_.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    if (count > accessor_.count)
      throw LoadError(fmt::format("{}: sparse.count is {}, more than the {} elements that there are", where_, count,
                                  accessor_.count));
    const int type = sparse.indices.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
      throw LoadError(fmt::format("{}: sparse.indices have component type {}, not an unsigned one", where_, type));
    const Elements indices = elementsIn(document_, static_cast<std::size_t>(sparse.indices.bufferView),
                                        static_cast<std::size_t>(sparse.indices.byteOffset), count, componentSize(type),
                                        false, where_ + ": sparse.indices");
    const Elements replacements = elementsIn(document_, static_cast<std::size_t>(sparse.values.bufferView),
                                             static_cast<std::size_t>(sparse.values.byteOffset), count, elementSize_,
                                             false, where_ + ": sparse.values");
    for (std::size_t i = 0; i < count; ++i) {
      const auto target = component<std::uint32_t>(indices.bytes.data() + i * indices.stride, type, false);
      if (target >= accessor_.count)
        throw LoadError(
            fmt::format("{}: sparse index {} is {}, but there are {} elements", where_, i, target, accessor_.count));
      readElement(replacements.bytes.data() + i * replacements.stride,
                  std::span(values).subspan(target * width, width));
    }
    return values;
  }

  const GltfDocument& document_;
  const tinygltf::Accessor& accessor_;
  std::string where_;
  std::size_t components_;
  std::size_t elementSize_;
};

[[noreturn]] void failType(const GltfDocument& document, std::size_t accessor, std::string_view use,
                           std::string_view wanted) {
  throw LoadError(
      fmt::format("{}: is used as {}, but does not hold {}", accessorName(document, accessor), oneLine(use), wanted));
}

bool holdsUnsigned(const tinygltf::Accessor& accessor) {
  return !accessor.normalized && (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                  accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                                  accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
}

// Those that are neither sparse nor without data.
std::vector<std::uint32_t> plainIndices(const GltfDocument& document, std::size_t accessor) {
  const tinygltf::Accessor& source = document.model.accessors[accessor];
  const Elements elements =
      elementsIn(document, static_cast<std::size_t>(source.bufferView), source.byteOffset, source.count,
                 componentSize(source.componentType), true, accessorName(document, accessor));
  std::vector<std::uint32_t> indices(elements.count);
  const auto read = [&]<typename Raw>(Raw) {
    inChunks(document, elements, 4096, [&](std::size_t first, std::size_t count) {
      for (std::size_t i = first; i < first + count; ++i)
        indices[i] = load<Raw>(elements.bytes.data() + i * elements.stride);
    });
  };
  if (source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE)
    read(std::uint8_t{});
  else if (source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
    read(std::uint16_t{});
  else
    read(std::uint32_t{});
  return indices;
}

} // namespace

void visitVectors(const GltfDocument& document, std::size_t accessor, int least, int most, std::string_view use,
                  const std::function<void(std::size_t, std::span<const glm::vec4>)>& visit, const glm::vec4& fill) {
  const tinygltf::Accessor& source = document.model.accessors[accessor];
  const std::size_t components = componentCount(source.type);
  if (source.type == TINYGLTF_TYPE_MAT2 || components < static_cast<std::size_t>(least) ||
      components > static_cast<std::size_t>(most))
    failType(document, accessor, use,
             least == most ? fmt::format("vectors of {} components", least)
                           : fmt::format("vectors of {} to {} components", least, most));
  if (source.sparse.isSparse || source.bufferView < 0) {
    const std::vector<float> values = Reader<float>(document, accessor).read(std::span<const float>(&fill.x, 4));
    std::vector<glm::vec4> vectors(values.size() / 4);
    for (std::size_t i = 0; i < vectors.size(); ++i)
      vectors[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
    return visit(0, vectors);
  }
  const Elements elements =
      elementsIn(document, static_cast<std::size_t>(source.bufferView), source.byteOffset, source.count,
                 components * componentSize(source.componentType), true, accessorName(document, accessor));
  std::array<glm::vec4, 1024> part;
  inChunks(document, elements, part.size(), [&](std::size_t first, std::size_t count) {
    const std::span<glm::vec4> target = std::span(part).first(count);
    std::ranges::fill(target, fill);
    widen(elements, first, components, source.componentType, source.normalized, target);
    visit(first, target);
  });
}

std::vector<glm::vec4> readVectors(const GltfDocument& document, std::size_t accessor, int least, int most,
                                   std::string_view use, const glm::vec4& fill) {
  std::vector<glm::vec4> vectors;
  visitVectors(
      document, accessor, least, most, use,
      [&](std::size_t first, std::span<const glm::vec4> part) {
        if (first == 0) vectors.reserve(std::max(part.size(), accessorCount(document, accessor)));
        vectors.insert(vectors.end(), part.begin(), part.end());
      },
      fill);
  return vectors;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, std::size_t accessor) {
  const tinygltf::Accessor& source = document.model.accessors[accessor];
  if (source.type != TINYGLTF_TYPE_SCALAR || !holdsUnsigned(source))
    failType(document, accessor, "indices", "unsigned integers");
  if (!source.sparse.isSparse && source.bufferView >= 0) return plainIndices(document, accessor);
  constexpr std::uint32_t fill = 0;
  return Reader<std::uint32_t>(document, accessor).read(std::span(&fill, 1));
}

std::vector<glm::uvec4> readJoints(const GltfDocument& document, std::size_t accessor, std::string_view use) {
  const tinygltf::Accessor& source = document.model.accessors[accessor];
  if (source.type != TINYGLTF_TYPE_VEC4 || !holdsUnsigned(source))
    failType(document, accessor, use, "vectors of 4 unsigned integers");
  const std::uint32_t fill[4] = {};
  const std::vector<std::uint32_t> values = Reader<std::uint32_t>(document, accessor).read(fill);
  std::vector<glm::uvec4> joints(values.size() / 4);
  for (std::size_t i = 0; i < joints.size(); ++i)
    joints[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
  return joints;
}

std::vector<glm::mat4> readMatrices(const GltfDocument& document, std::size_t accessor, std::string_view use) {
  const tinygltf::Accessor& source = document.model.accessors[accessor];
  if (source.type != TINYGLTF_TYPE_MAT4 || source.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    failType(document, accessor, use, "4x4 matrices of floats");
  const float fill[16] = {};
  const std::vector<float> values = Reader<float>(document, accessor).read(fill);
  std::vector<glm::mat4> matrices(values.size() / 16);
  for (std::size_t i = 0; i < matrices.size(); ++i) matrices[i] = glm::make_mat4(values.data() + 16 * i);
  return matrices;
}

std::size_t accessorCount(const GltfDocument& document, std::size_t accessor) {
  return document.model.accessors[accessor].count;
}

std::string accessorName(const GltfDocument& document, std::size_t accessor) {
  return objectName("accessor", accessor, document.model.accessors[accessor].name);
}

} // namespace vitrail::tool
