// Takes a glTF or GLB file apart: GLB chunks, JSON, buffers.
#include "document.h"

#include <algorithm>
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
#include "json_stream.h"
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

// Whether a member of the outermost object says anything to us. What others hold may be large.
bool isRead(std::string_view member) {
  constexpr std::string_view members[] = {
      "accessors",  "animations",         "asset",          "bufferViews", "buffers",   "cameras",
      "extensions", "extensionsRequired", "extensionsUsed", "images",      "materials", "meshes",
      "nodes",      "samplers",           "scene",          "scenes",      "skins",     "textures"};
  return std::ranges::find(members, member) != std::end(members);
}

// The document without its nodes, which it keeps in a smaller form.
Json readJson(std::string_view text, GltfDocument& document) {
  std::optional<LoadError> nodeError;
  std::size_t count = 0;
  JsonStream stream;
  stream.array = "nodes";
  stream.wanted = isRead;
  stream.restart = [&] {
    document.nodes = {};
    nodeError.reset();
    count = 0;
  };
  stream.element = [&](Json&& node) {
    if (nodeError) return;
    try {
      checkGltfNode(node, count);
      document.nodes.add(node);
      ++count;
    } catch (const LoadError& error) {
      nodeError = error;
    }
  };
  stream.parsed = [&](const char* begin, const char* end) {
    releaseBytes(document, std::as_bytes(std::span(begin, end)));
  };
  Json json = parseJson(text, stream);
  document.wrongCameras = repairGltfCameras(json);
  checkGltfJson(json, document.nodes, nodeError);
  return json;
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

void readBuffers(const Json& json, const Container& container, GltfDocument& document) {
  const auto array = json.find("buffers");
  if (array == json.end()) return;
  document.files.reserve(array->size() + 1);
  for (std::size_t i = 0; i < array->size(); ++i) {
    const Json& buffer = (*array)[i];
    const std::string where = objectName("buffer", i, buffer.value("name", std::string{}));
    const auto byteLength = buffer.at("byteLength").get<std::uint64_t>();
    if (isFallback(buffer) && !(i == 0 && container.binary)) {
      document.buffers.emplace_back();
      continue;
    }
    std::span<const std::byte> bytes;
    if (buffer.contains("uri")) {
      try {
        document.files.push_back(mapUri(buffer.at("uri").get_ref<const std::string&>(), document.base));
      } catch (const LoadError& error) {
        throw LoadError(fmt::format("{}: {}", where, error.what()));
      }
      bytes = document.files.back().bytes();
      document.totalBytes += bytes.size();
    } else if (i == 0 && container.binary) {
      bytes = *container.binary;
    } else {
      throw LoadError(fmt::format("{}: has no uri, and the file has no binary chunk for it", where));
    }
    if (bytes.size() < byteLength)
      throw LoadError(fmt::format("{}: byteLength is {}, but it has {} bytes", where, byteLength, bytes.size()));
    document.buffers.push_back(bytes.first(static_cast<std::size_t>(byteLength)));
  }
}

std::vector<std::string> memberNames(const Json& object) {
  std::vector<std::string> names;
  const auto extensions = object.find("extensions");
  if (extensions == object.end() || !extensions->is_object()) return names;
  for (const auto& [name, value] : extensions->items()) names.push_back(name);
  return names;
}

void readScenes(const Json& json, GltfDocument& document) {
  document.defaultScene = json.value("scene", std::size_t{0});
  const auto array = json.find("scenes");
  if (array == json.end()) return;
  for (const Json& scene : *array) {
    GltfScene& result = document.scenes.emplace_back();
    result.name = scene.value("name", std::string{});
    result.extensions = memberNames(scene);
    const auto nodes = scene.find("nodes");
    if (nodes == scene.end()) continue;
    result.nodes.reserve(nodes->size());
    for (const Json& node : *nodes) result.nodes.push_back(node.get<std::uint32_t>());
  }
}

void readAnimations(const Json& json, GltfDocument& document) {
  const auto array = json.find("animations");
  if (array == json.end()) return;
  for (const Json& animation : *array) {
    GltfAnimation& result = document.animations.emplace_back();
    result.name = animation.value("name", std::string{});
    for (const Json& sampler : animation.at("samplers"))
      result.samplers.push_back({sampler.at("input").get<std::size_t>(), sampler.at("output").get<std::size_t>(),
                                 sampler.value("interpolation", std::string("LINEAR"))});
    for (const Json& channel : animation.at("channels")) {
      const Json& target = channel.at("target");
      GltfAnimation::Channel& place = result.channels.emplace_back();
      place.sampler = channel.at("sampler").get<std::size_t>();
      place.path = target.at("path").get<std::string>();
      if (target.contains("node")) place.node = target.at("node").get<std::uint32_t>();
    }
  }
}

std::optional<Light> readLight(const Json& json) {
  Light light;
  const auto type = json.at("type").get<std::string>();
  if (type == "directional")
    light.kind = Light::Kind::Directional;
  else if (type == "spot")
    light.kind = Light::Kind::Spot;
  else if (type != "point")
    return std::nullopt;
  light.name = json.value("name", std::string{});
  const double intensity = std::max(json.value("intensity", 1.0), 0.0);
  const auto color = json.find("color");
  for (int c = 0; c < 3; ++c) {
    const double share = color == json.end() ? 1.0 : std::max((*color)[static_cast<std::size_t>(c)].get<double>(), 0.0);
    // The product of two numbers that a float holds may be one that it does not.
    light.intensity[c] =
        static_cast<float>(std::min(share * intensity, static_cast<double>(std::numeric_limits<float>::max())));
  }
  light.range = std::max(json.value("range", 0.0F), 0.0F);
  const auto spot = json.find("spot");
  if (spot != json.end()) {
    constexpr float rightAngle = 1.57079633F;
    light.outerConeAngle = std::clamp(spot->value("outerConeAngle", light.outerConeAngle), 0.0F, rightAngle);
    light.innerConeAngle = std::clamp(spot->value("innerConeAngle", 0.0F), 0.0F, light.outerConeAngle);
  }
  return light;
}

void readDocumentExtensions(const Json& json, GltfDocument& document) {
  for (const Json& name : json.value("extensionsRequired", Json::array()))
    document.extensionsRequired.push_back(name.get<std::string>());
  for (const Json& name : json.value("extensionsUsed", Json::array()))
    document.extensionsUsed.push_back(name.get<std::string>());
  for (const std::string& name : document.extensionsRequired)
    if (std::ranges::find(document.extensionsUsed, name) == document.extensionsUsed.end())
      document.extensionsUsed.push_back(name);
  document.extensions = memberNames(json);
  const auto extensions = json.find("extensions");
  if (extensions == json.end()) return;
  const auto lights = extensions->find("KHR_lights_punctual");
  if (lights != extensions->end())
    for (const Json& light : lights->at("lights")) document.lights.push_back(readLight(light));
  const auto variants = extensions->find("KHR_materials_variants");
  if (variants != extensions->end())
    for (const Json& variant : variants->at("variants"))
      document.variants.push_back(variant.at("name").get<std::string>());
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
  for (const char* unread : {"animations", "buffers", "extensions", "images", "nodes", "scene", "scenes"})
    json.erase(unread);
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

GltfDocument openGltf(MappedFile file, const std::filesystem::path& base) {
  GltfDocument document;
  document.base = base;
  document.totalBytes = file.bytes().size();
  document.files.push_back(std::move(file));
  const std::span<const std::byte> bytes = document.files.front().bytes();
  Container container;
  document.binary = asText(bytes).starts_with(glbMagic);
  if (document.binary)
    container = splitGlb(bytes);
  else
    container.json = asText(bytes);
  // A byte order mark is not JSON, but some editors write it.
  if (container.json.starts_with("\xef\xbb\xbf")) container.json.remove_prefix(3);
  if (!document.binary && !looksLikeJson(container.json)) {
    throw LoadError(
        "begins neither with \"glTF\", as a .glb file does, nor with {, as a .gltf file does: it is damaged or of "
        "another kind");
  }

  Json json = readJson(container.json, document);
  readBuffers(json, container, document);
  document.images = listImages(json);
  readScenes(json, document);
  readAnimations(json, document);
  readDocumentExtensions(json, document);
  const auto generator = json.at("asset").find("generator");
  if (generator != json.at("asset").end() && generator->is_string()) document.generator = generator->get<std::string>();
  document.model = parseModel(std::move(json));
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

void releaseBytes(const GltfDocument& document, std::span<const std::byte> bytes) {
  for (const MappedFile& file : document.files) file.release(bytes);
}

} // namespace vitrail::tool
