// Decodes buffer views with meshoptimizer, after checking what it would assert and what would be allocated for it.
#include "meshopt.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "../load.h"
#include "../message.h"

namespace vitrail::tool {
namespace {

constexpr std::array extensionNames{"EXT_meshopt_compression", "KHR_meshopt_compression"};

enum class Mode { Attributes, Triangles, Indices };
enum class Filter { None, Octahedral, Quaternion, Exponential };

// What the extension says of a buffer view.
struct Stream {
  std::span<const std::byte> bytes;
  std::size_t count = 0;
  std::size_t stride = 0;
  Mode mode = Mode::Attributes;
  Filter filter = Filter::None;
};

std::string textOf(const tinygltf::Value& extension, const char* key) {
  return extension.Has(key) ? extension.Get(key).Get<std::string>() : std::string{};
}

std::size_t sizeOf(const tinygltf::Value& extension, const char* key) {
  return extension.Has(key) ? static_cast<std::size_t>(extension.Get(key).GetNumberAsInt()) : 0;
}

Mode modeOf(const std::string& text) {
  if (text == "ATTRIBUTES") return Mode::Attributes;
  if (text == "TRIANGLES") return Mode::Triangles;
  if (text == "INDICES") return Mode::Indices;
  throw LoadError(fmt::format("mode is \"{}\", none of ATTRIBUTES, TRIANGLES and INDICES", oneLine(text)));
}

Filter filterOf(const std::string& text) {
  if (text.empty() || text == "NONE") return Filter::None;
  if (text == "OCTAHEDRAL") return Filter::Octahedral;
  if (text == "QUATERNION") return Filter::Quaternion;
  if (text == "EXPONENTIAL") return Filter::Exponential;
  throw LoadError(fmt::format("filter is \"{}\", none of NONE, OCTAHEDRAL, QUATERNION and EXPONENTIAL", oneLine(text)));
}

// The library asserts these.
void checkShape(const Stream& stream) {
  const auto require = [&stream](bool holds, const char* what) {
    if (!holds) throw LoadError(fmt::format("byteStride is {}, but {}", stream.stride, what));
  };
  if (stream.mode == Mode::Attributes) {
    require(stream.stride >= 4 && stream.stride <= 256 && stream.stride % 4 == 0,
            "attributes have a multiple of 4 bytes up to 256");
    if (stream.filter == Filter::Octahedral) require(stream.stride == 4 || stream.stride == 8, "OCTAHEDRAL has 4 or 8");
    if (stream.filter == Filter::Quaternion) require(stream.stride == 8, "QUATERNION has 8");
    return;
  }
  require(stream.stride == 2 || stream.stride == 4, "indices have 2 or 4 bytes");
  if (stream.filter != Filter::None) throw LoadError("has a filter, which indices do not have");
  if (stream.mode == Mode::Triangles && stream.count % 3 != 0)
    throw LoadError(fmt::format("count is {}, not a multiple of 3", stream.count));
}

// No stream packs more than this: of attributes, 16 bytes take 2 bits at least; a triangle takes a byte, an index too.
void checkCount(const Stream& stream) {
  const std::size_t size = stream.bytes.size();
  constexpr std::size_t tail = 256 * 256; // the last block of attributes may be short
  const std::size_t most = stream.mode == Mode::Attributes  ? (64 * size + tail) / stream.stride
                           : stream.mode == Mode::Triangles ? 3 * size
                                                            : size;
  if (stream.count > most)
    throw LoadError(fmt::format("{} elements of {} bytes are stated, but {} bytes cannot hold more than {}",
                                stream.count, stream.stride, size, most));
}

void applyFilter(const Stream& stream, std::vector<std::byte>& bytes) {
  if (stream.filter == Filter::Octahedral) meshopt_decodeFilterOct(bytes.data(), stream.count, stream.stride);
  if (stream.filter == Filter::Quaternion) meshopt_decodeFilterQuat(bytes.data(), stream.count, stream.stride);
  if (stream.filter == Filter::Exponential) meshopt_decodeFilterExp(bytes.data(), stream.count, stream.stride);
}

std::vector<std::byte> decode(const Stream& stream) {
  checkShape(stream);
  checkCount(stream);
  std::vector<std::byte> bytes(stream.count * stream.stride);
  if (stream.count == 0) return bytes;
  const auto* data = reinterpret_cast<const unsigned char*>(stream.bytes.data());
  int result = 0;
  if (stream.mode == Mode::Attributes) {
    if (!stream.bytes.empty() && (data[0] & 0xf0U) == 0xa0 && (data[0] & 0x0fU) > 0)
      throw LoadError(fmt::format("the stream is of version {}; meshoptimizer {}.{} reads version 0 only",
                                  data[0] & 0x0fU, MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION % 1000 / 10));
    result = meshopt_decodeVertexBuffer(bytes.data(), stream.count, stream.stride, data, stream.bytes.size());
  } else if (stream.mode == Mode::Triangles) {
    result = meshopt_decodeIndexBuffer(bytes.data(), stream.count, stream.stride, data, stream.bytes.size());
  } else {
    result = meshopt_decodeIndexSequence(bytes.data(), stream.count, stream.stride, data, stream.bytes.size());
  }
  if (result != 0) throw LoadError("the stream is damaged");
  applyFilter(stream, bytes);
  return bytes;
}

Stream streamOf(const GltfDocument& document, const tinygltf::Value& extension) {
  Stream stream;
  stream.bytes = bufferBytes(document, static_cast<std::size_t>(extension.Get("buffer").GetNumberAsInt()),
                             sizeOf(extension, "byteOffset"), sizeOf(extension, "byteLength"));
  stream.count = sizeOf(extension, "count");
  stream.stride = sizeOf(extension, "byteStride");
  stream.mode = modeOf(textOf(extension, "mode"));
  stream.filter = filterOf(textOf(extension, "filter"));
  return stream;
}

} // namespace

void decodeMeshopt(GltfDocument& document) {
  for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
    const tinygltf::BufferView& view = document.model.bufferViews[i];
    for (const char* name : extensionNames) {
      const auto extension = view.extensions.find(name);
      if (extension == view.extensions.end()) continue;
      try {
        keepDecoded(document, i, decode(streamOf(document, extension->second)));
      } catch (const LoadError& error) {
        throw LoadError(fmt::format("{}: {}: {}", objectName("buffer view", i, view.name), name, error.what()));
      }
      break;
    }
  }
}

} // namespace vitrail::tool
