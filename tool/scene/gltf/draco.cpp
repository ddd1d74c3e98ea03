// Decodes primitives with the Draco library. Its decoders allocate what a stream states before they miss the data; here
// they are told to look at the counts first.
#include "draco.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include "../load.h"
#include "../message.h"

namespace vitrail::tool {
namespace {

constexpr const char* extensionName = "KHR_draco_mesh_compression";

// The counts at the front of both kinds of connectivity, which stay in proportion to the data: of a large plane, the
// best that the format can do, a triangle and its vertex take some hundredths of a byte.
bool countsArePlausible(draco::DecoderBuffer buffer, bool edgebreaker) {
  constexpr std::uint64_t alwaysAllowed = 300'000;
  constexpr std::uint64_t perByte = 128;
  constexpr std::uint8_t mostAttributeTables = 32;
  const auto size = static_cast<std::uint64_t>(buffer.remaining_size());
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  std::uint8_t tables = 0;
  if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer)) return false;
  if (edgebreaker && (!buffer.Decode(&tables) || tables > mostAttributeTables)) return false;
  const std::uint64_t faces = edgebreaker ? second : first;
  const std::uint64_t points = edgebreaker ? first : second;
  return 3 * faces + points <= alwaysAllowed + perByte * size;
}

// What the attributes of a mesh take for each of its points.
bool attributesArePlausible(const draco::PointCloud& cloud) {
  constexpr int mostAttributes = 64;
  constexpr std::int64_t mostBytes = 1024;
  if (cloud.num_attributes() > mostAttributes) return false;
  std::int64_t bytes = 0;
  for (int i = 0; i < cloud.num_attributes(); ++i) bytes += cloud.attribute(i)->byte_stride();
  return bytes <= mostBytes;
}

constexpr std::uint16_t firstVersion = DRACO_BITSTREAM_VERSION(2, 2); // that glTF allows

class SequentialDecoder : public draco::MeshSequentialDecoder {
 protected:
  bool DecodeConnectivity() override {
    return bitstream_version() >= firstVersion && countsArePlausible(*buffer(), false) &&
           draco::MeshSequentialDecoder::DecodeConnectivity();
  }
  bool DecodeAllAttributes() override {
    return attributesArePlausible(*point_cloud()) && draco::MeshSequentialDecoder::DecodeAllAttributes();
  }
};

class EdgebreakerDecoder : public draco::MeshEdgebreakerDecoder {
 protected:
  bool DecodeConnectivity() override {
    return bitstream_version() >= firstVersion && countsArePlausible(*buffer(), true) &&
           draco::MeshEdgebreakerDecoder::DecodeConnectivity();
  }
  bool DecodeAllAttributes() override {
    return attributesArePlausible(*point_cloud()) && draco::MeshEdgebreakerDecoder::DecodeAllAttributes();
  }
};

std::unique_ptr<draco::Mesh> decode(std::span<const std::byte> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DecoderBuffer start = buffer;
  draco::DracoHeader header{};
  if (!draco::PointCloudDecoder::DecodeHeader(&start, &header).ok()) throw LoadError("the data are not Draco's");
  if (header.encoder_type != draco::TRIANGULAR_MESH) throw LoadError("the data hold no mesh");
  std::unique_ptr<draco::MeshDecoder> decoder;
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) decoder = std::make_unique<SequentialDecoder>();
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) decoder = std::make_unique<EdgebreakerDecoder>();
  if (!decoder) throw LoadError(fmt::format("method {} is unknown", header.encoder_method));
  auto mesh = std::make_unique<draco::Mesh>();
  const draco::Status status = decoder->Decode(draco::DecoderOptions(), &buffer, mesh.get());
  if (!status.ok()) throw LoadError(fmt::format("the data are damaged ({})", oneLine(status.error_msg_string())));
  return mesh;
}

template <typename Component>
void append(std::vector<std::byte>& bytes, const Component* values, std::size_t count) {
  const auto* first = reinterpret_cast<const std::byte*>(values);
  bytes.insert(bytes.end(), first, first + count * sizeof(Component));
}

template <typename Component>
bool convert(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components,
             std::vector<std::byte>& bytes) {
  std::array<Component, 16> values{};
  bytes.reserve(mesh.num_points() * static_cast<std::size_t>(components) * sizeof(Component));
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex value = attribute.mapped_index(i);
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue<Component>(value, static_cast<std::int8_t>(components), values.data()))
      return false;
    append(bytes, values.data(), static_cast<std::size_t>(components));
  }
  return true;
}

// The attribute of each point, in the accessor's type.
std::vector<std::byte> attributeBytes(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                                      const tinygltf::Accessor& accessor) {
  // The library reads bytes as truth values, which damaged ones are not; glTF has no such attributes.
  if (attribute.data_type() == draco::DT_BOOL) throw LoadError("the data are damaged (an attribute of truth values)");
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  std::vector<std::byte> bytes;
  bool sound = false;
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      sound = convert<std::int8_t>(mesh, attribute, components, bytes);
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      sound = convert<std::uint8_t>(mesh, attribute, components, bytes);
      break;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      sound = convert<std::int16_t>(mesh, attribute, components, bytes);
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      sound = convert<std::uint16_t>(mesh, attribute, components, bytes);
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      sound = convert<std::uint32_t>(mesh, attribute, components, bytes);
      break;
    default:
      sound = convert<float>(mesh, attribute, components, bytes);
      break;
  }
  if (!sound) throw LoadError("the data are damaged (an attribute cannot be read)");
  return bytes;
}

std::vector<std::byte> indexBytes(const draco::Mesh& mesh) {
  std::vector<std::byte> bytes;
  bytes.reserve(std::size_t{12} * mesh.num_faces());
  for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i)
    for (const draco::PointIndex& corner : mesh.face(i)) {
      const std::uint32_t index = corner.value();
      append(bytes, &index, 1);
    }
  return bytes;
}

// What a primitive's accessors are replaced by.
struct Replacement {
  std::size_t accessor = 0;
  std::size_t count = 0;
  std::vector<std::byte> bytes;
};

class PrimitiveDecoder {
 public:
  explicit PrimitiveDecoder(GltfDocument& document) : document_(document) {}

  void decode(const tinygltf::Value& extension, tinygltf::Primitive& primitive) {
    const auto view = static_cast<std::size_t>(extension.Get("bufferView").GetNumberAsInt());
    const std::unique_ptr<draco::Mesh> mesh = tool::decode(bufferViewBytes(document_, view));
    std::vector<Replacement> replacements;
    for (const auto& [name, accessor] : primitive.attributes) {
      const std::optional<int> id = attributeId(extension, name);
      if (!id) continue; // it is not compressed
      const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(*id));
      if (attribute == nullptr) throw LoadError(fmt::format("{}: the data have no attribute {}", oneLine(name), *id));
      const auto index = static_cast<std::size_t>(accessor);
      replacements.push_back(
          {index, mesh->num_points(), attributeBytes(*mesh, *attribute, document_.model.accessors[index])});
    }
    if (primitive.indices < 0) {
      tinygltf::Accessor list;
      list.type = TINYGLTF_TYPE_SCALAR;
      document_.model.accessors.push_back(list);
      primitive.indices = static_cast<int>(document_.model.accessors.size() - 1);
    }
    const auto indices = static_cast<std::size_t>(primitive.indices);
    document_.model.accessors[indices].componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    document_.model.accessors[indices].normalized = false;
    replacements.push_back({indices, std::size_t{3} * mesh->num_faces(), indexBytes(*mesh)});
    for (Replacement& replacement : replacements) replace(std::move(replacement));
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
  }

 private:
  static std::optional<int> attributeId(const tinygltf::Value& extension, const std::string& name) {
    if (!extension.Has("attributes") || !extension.Get("attributes").Has(name)) return std::nullopt;
    const tinygltf::Value& id = extension.Get("attributes").Get(name);
    if (!id.IsInt() || id.GetNumberAsInt() < 0)
      throw LoadError(fmt::format("attributes.{} is not a whole number from 0", oneLine(name)));
    return id.GetNumberAsInt();
  }

  // Lets an accessor read bytes that are tightly packed.
  void replace(Replacement replacement) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteLength = replacement.bytes.size();
    const std::size_t index = document_.model.bufferViews.size();
    document_.model.bufferViews.push_back(view);
    keepDecoded(document_, index, std::move(replacement.bytes));
    tinygltf::Accessor& accessor = document_.model.accessors[replacement.accessor];
    accessor.bufferView = static_cast<int>(index);
    accessor.byteOffset = 0;
    accessor.count = replacement.count;
  }

  GltfDocument& document_;
};

// Whether the accessors of a primitive have data that need no decoder.
bool hasOwnData(const GltfDocument& document, const tinygltf::Primitive& primitive) {
  const auto hasData = [&document](int accessor) {
    return document.model.accessors[static_cast<std::size_t>(accessor)].bufferView >= 0;
  };
  const auto position = primitive.attributes.find("POSITION");
  return position != primitive.attributes.end() && hasData(position->second) &&
         (primitive.indices < 0 || hasData(primitive.indices));
}

} // namespace

void decodeDraco(GltfDocument& document) {
  PrimitiveDecoder decoder(document);
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
    tinygltf::Mesh& mesh = document.model.meshes[m];
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      tinygltf::Primitive& primitive = mesh.primitives[p];
      const auto extension = primitive.extensions.find(extensionName);
      if (extension == primitive.extensions.end()) continue;
      const std::string where = fmt::format("{} primitive {}: {}", objectName("mesh", m, mesh.name), p, extensionName);
      try {
        decoder.decode(extension->second, primitive);
      } catch (const LoadError& error) {
        if (!hasOwnData(document, primitive)) throw LoadError(fmt::format("{}: {}", where, error.what()));
        document.warnings.push_back(
            fmt::format("{}: {}; the uncompressed data beside it are drawn", where, error.what()));
      }
    }
  }
}

} // namespace vitrail::tool
