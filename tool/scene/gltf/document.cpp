// Takes a glTF or GLB file apart: GLB chunks, JSON, buffers.
#include "document.h"

#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "../bytes.h"
#include "../load.h"
#include "../message.h"
#include "check.h"
#include "draco.h"
#include "meshopt.h"
#include "uri.h"

namespace vitrail::tool {
namespace {

using Json = nlohmann::json;

struct Container {
  std::string_view json;
  std::optional<std::span<const std::byte>> binary; // GLB's BIN chunk
};

std::string_view asText(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

constexpr std::string_view glbMagic = "glTF";

// The GLB layout: a header of 12 bytes (magic, version, length), then chunks of a length, a type and data. The first is
// JSON, the second may be BIN, others are skipped.
Container splitGlb(std::span<const std::byte> file) {
  constexpr std::uint32_t jsonType = 0x4e4f534a;
  constexpr std::uint32_t binaryType = 0x004e4942;
  if (file.size() < 20) throw LoadError(fmt::format("the GLB file ends after {} bytes, in its header", file.size()));
  const std::uint32_t version = littleEndian(file, 4);
  if (version != 2) throw LoadError(fmt::format("it is GLB version {}, but only version 2 can be read", version));
  const std::uint32_t length = littleEndian(file, 8);
  if (length > file.size())
    throw LoadError(fmt::format("the GLB file is cut off: it states {} bytes and has {}", length, file.size()));
  if (length < 20)
    throw LoadError(fmt::format("the GLB header states a length of {} bytes, less than a header", length));

  Container container;
  std::size_t offset = 12;
  for (std::size_t chunk = 0; offset < length; ++chunk) {
    const std::size_t left = length - offset;
    if (left < 8) throw LoadError(fmt::format("GLB chunk {} is cut off in its header", chunk));
    const std::uint32_t size = littleEndian(file, offset);
    const std::uint32_t type = littleEndian(file, offset + 4);
    if (size > left - 8)
      throw LoadError(fmt::format("GLB chunk {} states {} bytes, but only {} are left", chunk, size, left - 8));
    const auto data = file.subspan(offset + 8, size);
    if (chunk == 0) {
      if (type != jsonType) throw LoadError("the first GLB chunk is not JSON");
      container.json = asText(data);
    } else if (chunk == 1 && type == binaryType) {
      container.binary = data;
    }
    offset += 8 + std::size_t{size};
  }
  return container;
}

// Whether the text begins with an object or an array.
bool looksLikeJson(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && (text[begin] == '{' || text[begin] == '[');
}

// The parsers behind this one call themselves for each level of nesting.
void checkNesting(std::string_view json) {
  constexpr std::size_t deepest = 100;
  std::size_t depth = 0;
  bool inString = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (inString) {
      if (c == '\\') ++i;
      if (c == '"') inString = false;
    } else if (c == '"') {
      inString = true;
    } else if (c == '{' || c == '[') {
      if (++depth > deepest) throw LoadError(fmt::format("the JSON is nested more than {} levels deep", deepest));
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
}

Json parseJson(std::string_view text) {
  checkNesting(text);
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    // Drops the library's own prefix, "[json.exception.parse_error.101] ".
    const std::string_view reason = error.what();
    const std::size_t prefix = reason.find("] ");
    throw LoadError(fmt::format("the JSON is not valid: {}",
                                oneLine(prefix == std::string_view::npos ? reason : reason.substr(prefix + 2))));
  }
}

// Whether a buffer only says where the decoded bytes of compressed buffer views would lie.
bool isFallback(const Json& buffer) {
  const auto extensions = buffer.find("extensions");
  if (extensions == buffer.end()) return false;
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const auto extension = extensions->find(name);
    if (extension != extensions->end() && extension->value("fallback", false)) return true;
  }
  return false;
}

std::vector<std::vector<std::byte>> readBuffers(const Json& json, const Container& container,
                                                const std::filesystem::path& base) {
  std::vector<std::vector<std::byte>> buffers;
  const auto array = json.find("buffers");
  if (array == json.end()) return buffers;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const Json& buffer = (*array)[i];
    const std::string where = objectName("buffer", i, buffer.value("name", std::string{}));
    const auto byteLength = buffer.at("byteLength").get<std::uint64_t>();
    if (isFallback(buffer) && !(i == 0 && container.binary)) {
      buffers.emplace_back();
      continue;
    }
    if (buffer.contains("uri")) {
      try {
        buffers.push_back(readUri(buffer.at("uri").get_ref<const std::string&>(), base));
      } catch (const LoadError& error) {
        throw LoadError(fmt::format("{}: {}", where, error.what()));
      }
    } else if (i == 0 && container.binary) {
      buffers.emplace_back(container.binary->begin(), container.binary->end());
    } else {
      throw LoadError(fmt::format("{}: has no uri, and the file has no binary chunk for it", where));
    }
    if (buffers.back().size() < byteLength)
      throw LoadError(
          fmt::format("{}: byteLength is {}, but it has {} bytes", where, byteLength, buffers.back().size()));
    buffers.back().resize(static_cast<std::size_t>(byteLength));
  }
  return buffers;
}

std::vector<GltfImageSource> listImages(const Json& json) {
  std::vector<GltfImageSource> images;
  const auto array = json.find("images");
  if (array == json.end()) return images;
  for (const Json& image : *array) {
    GltfImageSource source;
    source.name = image.value("name", std::string{});
    source.uri = image.value("uri", std::string{});
    if (image.contains("bufferView")) source.bufferView = image.at("bufferView").get<std::size_t>();
    images.push_back(std::move(source));
  }
  return images;
}

// Lets tinygltf read everything but the bytes.
tinygltf::Model parseModel(Json json) {
  for (const char* unread : {"animations", "buffers", "images", "extras"}) json.erase(unread);
  // tinygltf refuses an index accessor without a buffer view, which the specification allows. Accessors without one get
  // a view that stands for none while it reads.
  Json& views = json["bufferViews"];
  const std::size_t none = views.size();
  views.push_back({{"buffer", 0}, {"byteLength", 1}});
  if (json.contains("accessors"))
    for (Json& accessor : json["accessors"])
      if (!accessor.contains("bufferView")) accessor["bufferView"] = none;

  const std::string text = json.dump();
  if (text.size() > std::numeric_limits<unsigned>::max()) throw LoadError("the JSON is larger than 4 GiB");
  tinygltf::Model model;
  tinygltf::TinyGLTF parser;
  std::string errors;
  std::string warnings;
  const bool read = parser.LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                               static_cast<unsigned>(text.size()), std::string{});
  if (!read) throw LoadError(fmt::format("the glTF document cannot be read: {}", oneLine(errors)));

  model.bufferViews.pop_back();
  for (tinygltf::Accessor& accessor : model.accessors)
    if (static_cast<std::size_t>(accessor.bufferView) == none) accessor.bufferView = -1;
  return model;
}

} // namespace

GltfDocument openGltf(std::span<const std::byte> file, const std::filesystem::path& base) {
  Container container;
  const bool isGlb = asText(file).starts_with(glbMagic);
  if (isGlb)
    container = splitGlb(file);
  else
    container.json = asText(file);
  // A byte order mark is not JSON, but some editors write it.
  if (container.json.starts_with("\xef\xbb\xbf")) container.json.remove_prefix(3);
  if (!isGlb && !looksLikeJson(container.json)) {
    throw LoadError(
        "begins neither with \"glTF\", as a .glb file does, nor with {, as a .gltf file does: it is damaged or of "
        "another kind");
  }

  Json json = parseJson(container.json);
  checkGltfJson(json);
  GltfDocument document;
  document.base = base;
  document.buffers = readBuffers(json, container, base);
  document.images = listImages(json);
  document.model = parseModel(std::move(json));
  document.totalBytes = file.size();
  for (const auto& buffer : document.buffers) document.totalBytes += buffer.size();
  decodeMeshopt(document);
  decodeDraco(document);
  return document;
}

std::span<const std::byte> bufferBytes(const GltfDocument& document, std::size_t buffer, std::size_t byteOffset,
                                       std::size_t byteLength) {
  const std::span<const std::byte> bytes = document.buffers[buffer];
  if (byteOffset > bytes.size() || byteLength > bytes.size() - byteOffset)
    throw LoadError(fmt::format("{} bytes at offset {} reach past the end of buffer {}, which has {}", byteLength,
                                byteOffset, buffer, bytes.size()));
  return bytes.subspan(byteOffset, byteLength);
}

void keepDecoded(GltfDocument& document, std::size_t bufferView, std::vector<std::byte> bytes) {
  constexpr std::uint64_t alwaysAllowed = std::uint64_t{256} << 20U;
  constexpr std::uint64_t perByte = 256;
  document.decodedBytes += bytes.size();
  if (document.decodedBytes > alwaysAllowed + perByte * document.totalBytes)
    throw LoadError(fmt::format("the file's {} bytes hold too much compressed data", document.totalBytes));
  document.decodedViews[bufferView] = std::move(bytes);
}

std::span<const std::byte> bufferViewBytes(const GltfDocument& document, std::size_t bufferView) {
  const auto decoded = document.decodedViews.find(bufferView);
  if (decoded != document.decodedViews.end()) return decoded->second;
  const tinygltf::BufferView& view = document.model.bufferViews[bufferView];
  try {
    return bufferBytes(document, static_cast<std::size_t>(view.buffer), view.byteOffset, view.byteLength);
  } catch (const LoadError& error) {
    throw LoadError(fmt::format("{}: {}", objectName("buffer view", bufferView, view.name), error.what()));
  }
}

} // namespace vitrail::tool
