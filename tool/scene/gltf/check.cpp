// Checks the JSON of a glTF file: tables of the properties that the loader uses, and the walk that applies them.
#include "check.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "../load.h"
#include "../message.h"
#include "extensions.h"

namespace vitrail::tool {
namespace {

using Json = nlohmann::json;

enum class Kind {
  Boolean,
  Text,
  Number,    // fits a 32-bit float
  Numbers,   // an array of those, `length` long (0: any length)
  Integer,   // 0 to 2^31 - 1
  Size,      // 0 to 2^53: a byte offset, length or count
  Index,     // into the top-level array `target`
  Indices,   // an array of those
  IndexMap,  // an object of those
  IndexMaps, // an array of such objects
  Object,    // with `fields`
  Objects    // an array of such objects
};

struct Field {
  std::string_view name;
  Kind kind;
  bool required = false;
  std::string_view target{};
  std::size_t length = 0;
  std::span<const Field> fields{};
};

constexpr Field index(std::string_view name, std::string_view target, Kind kind = Kind::Index) {
  return {name, kind, false, target, 0, {}};
}

constexpr Field numbers(std::string_view name, std::size_t length = 0) {
  return {name, Kind::Numbers, false, {}, length, {}};
}

constexpr Field object(std::string_view name, std::span<const Field> fields, Kind kind = Kind::Object) {
  return {name, kind, false, {}, 0, fields};
}

constexpr Field required(Field field) {
  field.required = true;
  return field;
}

constexpr Field nameField{"name", Kind::Text};

constexpr std::array assetFields{required({"version", Kind::Text}), Field{"minVersion", Kind::Text}};

constexpr std::array sparseIndicesFields{required(index("bufferView", "bufferViews")),
                                         Field{"byteOffset", Kind::Integer},
                                         required({"componentType", Kind::Integer})};
constexpr std::array sparseValuesFields{required(index("bufferView", "bufferViews")),
                                        Field{"byteOffset", Kind::Integer}};
constexpr std::array sparseFields{required({"count", Kind::Integer}), required(object("indices", sparseIndicesFields)),
                                  required(object("values", sparseValuesFields))};
constexpr std::array accessorFields{nameField,
                                    index("bufferView", "bufferViews"),
                                    Field{"byteOffset", Kind::Size},
                                    required({"componentType", Kind::Integer}),
                                    Field{"normalized", Kind::Boolean},
                                    required({"count", Kind::Size}),
                                    required({"type", Kind::Text}),
                                    object("sparse", sparseFields)};

constexpr std::array meshoptBufferFields{Field{"fallback", Kind::Boolean}};
constexpr std::array bufferExtensionFields{object("EXT_meshopt_compression", meshoptBufferFields),
                                           object("KHR_meshopt_compression", meshoptBufferFields)};
constexpr std::array bufferFields{nameField, required({"byteLength", Kind::Size}), Field{"uri", Kind::Text},
                                  object("extensions", bufferExtensionFields)};
// Integers where the specification allows more: the library that reads extensions keeps 32 bits of them.
constexpr std::array meshoptViewFields{required(index("buffer", "buffers")),
                                       Field{"byteOffset", Kind::Integer},
                                       required({"byteLength", Kind::Integer}),
                                       required({"byteStride", Kind::Integer}),
                                       required({"count", Kind::Integer}),
                                       required({"mode", Kind::Text}),
                                       Field{"filter", Kind::Text}};
constexpr std::array bufferViewExtensionFields{object("EXT_meshopt_compression", meshoptViewFields),
                                               object("KHR_meshopt_compression", meshoptViewFields)};
constexpr std::array bufferViewFields{nameField,
                                      required(index("buffer", "buffers")),
                                      Field{"byteOffset", Kind::Size},
                                      required({"byteLength", Kind::Size}),
                                      Field{"byteStride", Kind::Size},
                                      object("extensions", bufferViewExtensionFields)};

constexpr std::array perspectiveFields{required({"yfov", Kind::Number}), required({"znear", Kind::Number}),
                                       Field{"zfar", Kind::Number}};
constexpr std::array orthographicFields{required({"xmag", Kind::Number}), required({"ymag", Kind::Number}),
                                        required({"znear", Kind::Number}), required({"zfar", Kind::Number})};
constexpr std::array cameraFields{nameField, required({"type", Kind::Text}), object("perspective", perspectiveFields),
                                  object("orthographic", orthographicFields)};

constexpr std::array imageFields{nameField, Field{"uri", Kind::Text}, Field{"mimeType", Kind::Text},
                                 index("bufferView", "bufferViews")};
constexpr std::array samplerFields{nameField, Field{"magFilter", Kind::Integer}, Field{"minFilter", Kind::Integer},
                                   Field{"wrapS", Kind::Integer}, Field{"wrapT", Kind::Integer}};
constexpr std::array textureSourceFields{index("source", "images")};
constexpr std::array textureSourceExtensionFields{
    object("EXT_texture_webp", textureSourceFields), object("KHR_texture_basisu", textureSourceFields),
    object("EXT_texture_avif", textureSourceFields), object("MSFT_texture_dds", textureSourceFields)};
constexpr std::array textureFields{nameField, index("sampler", "samplers"), index("source", "images"),
                                   object("extensions", textureSourceExtensionFields)};

constexpr std::array textureTransformFields{numbers("offset", 2), Field{"rotation", Kind::Number}, numbers("scale", 2),
                                            Field{"texCoord", Kind::Integer}};
constexpr std::array textureExtensionFields{object("KHR_texture_transform", textureTransformFields)};
constexpr std::array textureInfoFields{required(index("index", "textures")), Field{"texCoord", Kind::Integer},
                                       Field{"scale", Kind::Number}, Field{"strength", Kind::Number},
                                       object("extensions", textureExtensionFields)};
constexpr std::array pbrFields{numbers("baseColorFactor", 4), object("baseColorTexture", textureInfoFields),
                               Field{"metallicFactor", Kind::Number}, Field{"roughnessFactor", Kind::Number},
                               object("metallicRoughnessTexture", textureInfoFields)};
constexpr std::array emissiveStrengthFields{Field{"emissiveStrength", Kind::Number}};
constexpr std::array transmissionFields{Field{"transmissionFactor", Kind::Number},
                                        object("transmissionTexture", textureInfoFields)};
constexpr std::array volumeFields{Field{"thicknessFactor", Kind::Number}, object("thicknessTexture", textureInfoFields),
                                  Field{"attenuationDistance", Kind::Number}, numbers("attenuationColor", 3)};
constexpr std::array iorFields{Field{"ior", Kind::Number}};
constexpr std::array specularFields{Field{"specularFactor", Kind::Number}, object("specularTexture", textureInfoFields),
                                    numbers("specularColorFactor", 3),
                                    object("specularColorTexture", textureInfoFields)};
constexpr std::array specularGlossinessFields{numbers("diffuseFactor", 4), object("diffuseTexture", textureInfoFields),
                                              numbers("specularFactor", 3), Field{"glossinessFactor", Kind::Number},
                                              object("specularGlossinessTexture", textureInfoFields)};
constexpr std::array clearcoatFields{
    Field{"clearcoatFactor", Kind::Number}, object("clearcoatTexture", textureInfoFields),
    Field{"clearcoatRoughnessFactor", Kind::Number}, object("clearcoatRoughnessTexture", textureInfoFields)};
constexpr std::array sheenFields{numbers("sheenColorFactor", 3), object("sheenColorTexture", textureInfoFields),
                                 Field{"sheenRoughnessFactor", Kind::Number},
                                 object("sheenRoughnessTexture", textureInfoFields)};
constexpr std::array anisotropyFields{Field{"anisotropyStrength", Kind::Number},
                                      Field{"anisotropyRotation", Kind::Number},
                                      object("anisotropyTexture", textureInfoFields)};
constexpr std::array iridescenceFields{Field{"iridescenceFactor", Kind::Number},
                                       object("iridescenceTexture", textureInfoFields),
                                       Field{"iridescenceIor", Kind::Number},
                                       Field{"iridescenceThicknessMinimum", Kind::Number},
                                       Field{"iridescenceThicknessMaximum", Kind::Number},
                                       object("iridescenceThicknessTexture", textureInfoFields)};
constexpr std::array diffuseTransmissionFields{Field{"diffuseTransmissionFactor", Kind::Number},
                                               numbers("diffuseTransmissionColorFactor", 3)};
constexpr std::array materialExtensionFields{object("KHR_materials_unlit", {}),
                                             object("KHR_materials_emissive_strength", emissiveStrengthFields),
                                             object("KHR_materials_transmission", transmissionFields),
                                             object("KHR_materials_volume", volumeFields),
                                             object("KHR_materials_ior", iorFields),
                                             object("KHR_materials_specular", specularFields),
                                             object("KHR_materials_pbrSpecularGlossiness", specularGlossinessFields),
                                             object("KHR_materials_clearcoat", clearcoatFields),
                                             object("KHR_materials_sheen", sheenFields),
                                             object("KHR_materials_anisotropy", anisotropyFields),
                                             object("KHR_materials_iridescence", iridescenceFields),
                                             object("KHR_materials_diffuse_transmission", diffuseTransmissionFields)};
constexpr std::array materialFields{nameField,
                                    object("pbrMetallicRoughness", pbrFields),
                                    object("normalTexture", textureInfoFields),
                                    object("occlusionTexture", textureInfoFields),
                                    object("emissiveTexture", textureInfoFields),
                                    numbers("emissiveFactor", 3),
                                    Field{"alphaMode", Kind::Text},
                                    Field{"alphaCutoff", Kind::Number},
                                    Field{"doubleSided", Kind::Boolean},
                                    object("extensions", materialExtensionFields)};

// Indices of any size: only the chosen variant has to be there.
constexpr std::array variantMappingFields{required(index("material", "")),
                                          required(index("variants", "", Kind::Indices))};
constexpr std::array primitiveVariantsFields{required(object("mappings", variantMappingFields, Kind::Objects))};
constexpr std::array dracoFields{required(index("bufferView", "bufferViews"))};
constexpr std::array primitiveExtensionFields{object("KHR_draco_mesh_compression", dracoFields),
                                              object("KHR_materials_variants", primitiveVariantsFields)};
constexpr std::array primitiveFields{required(index("attributes", "accessors", Kind::IndexMap)),
                                     index("indices", "accessors"),
                                     index("material", "materials"),
                                     Field{"mode", Kind::Integer},
                                     index("targets", "accessors", Kind::IndexMaps),
                                     object("extensions", primitiveExtensionFields)};
constexpr std::array meshFields{nameField, required(object("primitives", primitiveFields, Kind::Objects)),
                                numbers("weights")};

constexpr std::array instancingFields{required(index("attributes", "accessors", Kind::IndexMap))};
constexpr std::array nodeLightFields{required(index("light", "lights"))};
constexpr std::array visibilityFields{Field{"visible", Kind::Boolean}};
constexpr std::array nodeExtensionFields{object("EXT_mesh_gpu_instancing", instancingFields),
                                         object("KHR_lights_punctual", nodeLightFields),
                                         object("KHR_node_visibility", visibilityFields)};
constexpr std::array nodeFields{nameField,
                                index("mesh", "meshes"),
                                index("skin", "skins"),
                                index("camera", "cameras"),
                                index("children", "nodes", Kind::Indices),
                                numbers("matrix", 16),
                                numbers("translation", 3),
                                numbers("rotation", 4),
                                numbers("scale", 3),
                                numbers("weights"),
                                object("extensions", nodeExtensionFields)};
constexpr std::array sceneFields{nameField, index("nodes", "nodes", Kind::Indices)};
constexpr std::array skinFields{nameField, required(index("joints", "nodes", Kind::Indices)),
                                index("inverseBindMatrices", "accessors"), index("skeleton", "nodes")};

constexpr std::array animationTargetFields{index("node", "nodes"), required({"path", Kind::Text})};
constexpr std::array animationChannelFields{required({"sampler", Kind::Integer}),
                                            required(object("target", animationTargetFields))};
constexpr std::array animationSamplerFields{required(index("input", "accessors")),
                                            required(index("output", "accessors")), Field{"interpolation", Kind::Text}};
constexpr std::array animationFields{nameField, required(object("channels", animationChannelFields, Kind::Objects)),
                                     required(object("samplers", animationSamplerFields, Kind::Objects))};

constexpr std::array spotFields{Field{"innerConeAngle", Kind::Number}, Field{"outerConeAngle", Kind::Number}};
constexpr std::array lightFields{nameField,
                                 required({"type", Kind::Text}),
                                 numbers("color", 3),
                                 Field{"intensity", Kind::Number},
                                 Field{"range", Kind::Number},
                                 object("spot", spotFields)};
constexpr std::array lightsFields{required(object("lights", lightFields, Kind::Objects))};
constexpr std::array variantFields{required({"name", Kind::Text})};
constexpr std::array variantsFields{required(object("variants", variantFields, Kind::Objects))};
constexpr std::array documentExtensionFields{object("KHR_lights_punctual", lightsFields),
                                             object("KHR_materials_variants", variantsFields)};

struct Section {
  std::string_view array;    // the top-level array
  std::string_view singular; // what one of its objects is called in messages
  std::span<const Field> fields;
};

constexpr std::array<Section, 13> sections{{{"accessors", "accessor", accessorFields},
                                            {"animations", "animation", animationFields},
                                            {"buffers", "buffer", bufferFields},
                                            {"bufferViews", "buffer view", bufferViewFields},
                                            {"cameras", "camera", cameraFields},
                                            {"images", "image", imageFields},
                                            {"materials", "material", materialFields},
                                            {"meshes", "mesh", meshFields},
                                            {"nodes", "node", nodeFields},
                                            {"samplers", "sampler", samplerFields},
                                            {"scenes", "scene", sceneFields},
                                            {"skins", "skin", skinFields},
                                            {"textures", "texture", textureFields}}};

// Applies the tables to one document. `where` names the object that is looked at, `path` the property inside it.
class Checker {
 public:
  Checker(const Json& document, std::size_t nodeCount) : document_(&document), nodeCount_(nodeCount) {}
  // One that does not know the document yet: indices are of any size.
  Checker() = default;

  void fields(const Json& value, std::span<const Field> fields, const std::string& where, const std::string& path) {
    if (!value.is_object()) fail(where, path, "is not a JSON object");
    for (const Field& field : fields) {
      const std::string inner = path.empty() ? std::string(field.name) : fmt::format("{}.{}", path, field.name);
      const auto member = value.find(field.name);
      if (member != value.end())
        check(*member, field, where, inner);
      else if (field.required)
        fail(where, inner, "is missing");
    }
  }

  void index(const Json& value, std::string_view target, const std::string& where, const std::string& path) {
    range(unsignedNumber(value, std::numeric_limits<std::int32_t>::max(), where, path), target, where, path);
  }

  void range(std::uint64_t number, std::string_view target, const std::string& where, const std::string& path) const {
    if (document_ == nullptr || target.empty()) return;
    const std::size_t size = sizeOf(target);
    if (number >= size)
      fail(where, path, fmt::format("is {}, but {} has {} element{}", number, target, size, size == 1 ? "" : "s"));
  }

  // The number of elements of a top-level array, or of one that an extension adds.
  [[nodiscard]] std::size_t sizeOf(std::string_view target) const {
    if (target == "nodes") return nodeCount_;
    if (target == "lights") return sizeOf(Json::json_pointer("/extensions/KHR_lights_punctual/lights"));
    if (target == "variants") return sizeOf(Json::json_pointer("/extensions/KHR_materials_variants/variants"));
    const auto array = document_->find(target);
    return array != document_->end() && array->is_array() ? array->size() : 0;
  }

  [[noreturn]] static void fail(const std::string& where, const std::string& path, std::string_view problem) {
    const std::string object = where.empty() ? "" : where + ": ";
    throw LoadError(path.empty() ? fmt::format("{} {}", where, problem)
                                 : fmt::format("{}{} {}", object, oneLine(path), problem));
  }

 private:
  [[nodiscard]] std::size_t sizeOf(const Json::json_pointer& path) const {
    return document_->contains(path) && document_->at(path).is_array() ? document_->at(path).size() : 0;
  }

  void check(const Json& value, const Field& field, const std::string& where, const std::string& path) {
    switch (field.kind) {
      case Kind::Boolean:
        if (!value.is_boolean()) fail(where, path, "is neither true nor false");
        break;
      case Kind::Text:
        if (!value.is_string()) fail(where, path, "is not a string");
        break;
      case Kind::Number:
        number(value, where, path);
        break;
      case Kind::Numbers:
        checkNumbers(value, field.length, where, path);
        break;
      case Kind::Integer:
        unsignedNumber(value, std::numeric_limits<std::int32_t>::max(), where, path);
        break;
      case Kind::Size:
        unsignedNumber(value, std::uint64_t{1} << 53U, where, path);
        break;
      case Kind::Index:
        index(value, field.target, where, path);
        break;
      case Kind::IndexMap:
        checkIndexMap(value, field.target, where, path);
        break;
      case Kind::Object:
        fields(value, field.fields, where, path);
        break;
      case Kind::Indices:
      case Kind::IndexMaps:
      case Kind::Objects:
        checkElements(value, field, where, path);
        break;
    }
  }

  void checkNumbers(const Json& value, std::size_t length, const std::string& where, const std::string& path) {
    if (!value.is_array()) fail(where, path, "is not an array");
    if (length != 0 && value.size() != length)
      fail(where, path, fmt::format("has {} numbers where {} belong", value.size(), length));
    for (std::size_t i = 0; i < value.size(); ++i)
      if (!isFloat(value[i])) number(value[i], where, fmt::format("{}[{}]", path, i));
  }

  void checkIndexMap(const Json& value, std::string_view target, const std::string& where, const std::string& path) {
    if (!value.is_object()) fail(where, path, "is not a JSON object");
    for (const auto& [key, entry] : value.items()) index(entry, target, where, fmt::format("{}.{}", path, key));
  }

  void checkElements(const Json& value, const Field& field, const std::string& where, const std::string& path) {
    if (!value.is_array()) fail(where, path, "is not an array");
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string inner = fmt::format("{}[{}]", path, i);
      if (field.kind == Kind::Indices)
        index(value[i], field.target, where, inner);
      else if (field.kind == Kind::IndexMaps)
        checkIndexMap(value[i], field.target, where, inner);
      else
        fields(value[i], field.fields, where, inner);
    }
  }

  static bool isFloat(const Json& value) {
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    // Written so that a NaN fails too.
    return number >= std::numeric_limits<float>::lowest() && number <= std::numeric_limits<float>::max();
  }

  static void number(const Json& value, const std::string& where, const std::string& path) {
    if (!value.is_number()) fail(where, path, "is not a number");
    if (!isFloat(value)) fail(where, path, fmt::format("is {}, which a 32-bit float cannot hold", value.get<double>()));
  }

  static std::uint64_t unsignedNumber(const Json& value, std::uint64_t largest, const std::string& where,
                                      const std::string& path) {
    if (!value.is_number()) fail(where, path, "is not a number");
    if (value.is_number_float()) fail(where, path, fmt::format("is {}, not a whole number", value.get<double>()));
    if (!value.is_number_unsigned()) fail(where, path, fmt::format("is {}, below zero", value.get<std::int64_t>()));
    const auto number = value.get<std::uint64_t>();
    if (number > largest) fail(where, path, fmt::format("is {}, more than {}", number, largest));
    return number;
  }

  const Json* document_ = nullptr;
  std::size_t nodeCount_ = 0;
};

void checkAsset(Checker& checker, const Json& document) {
  const auto asset = document.find("asset");
  if (asset == document.end()) throw LoadError("the JSON has no asset, so it is not glTF");
  checker.fields(*asset, assetFields, "asset", "");
  const auto version = asset->at("version").get<std::string>();
  if (!version.starts_with("2."))
    throw LoadError(fmt::format("it is glTF {}, but only glTF 2.0 can be read", oneLine(version)));
  const auto minVersion = asset->find("minVersion");
  if (minVersion != asset->end() && minVersion->get<std::string>() != "2.0")
    throw LoadError(fmt::format("it asks for glTF {} or later, but only glTF 2.0 can be read",
                                oneLine(minVersion->get<std::string>())));
}

void checkExtensions(Checker& checker, const Json& document) {
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    const auto extensions = document.find(key);
    if (extensions == document.end()) continue;
    if (!extensions->is_array()) throw LoadError(fmt::format("{} is not an array", key));
    for (const Json& extension : *extensions) {
      if (!extension.is_string()) throw LoadError(fmt::format("{} holds something else than a string", key));
      const auto name = extension.get<std::string>();
      if (key == std::string_view("extensionsRequired") && gltfExtension(name).support == GltfSupport::Unreadable)
        throw LoadError(fmt::format("it requires the extension {}, which Vitrail does not implement", oneLine(name)));
    }
  }
  const auto used = document.find("extensions");
  if (used != document.end()) checker.fields(*used, documentExtensionFields, "", "extensions");
}

// What the tables cannot say.
void checkChoices(const Json& value, std::string_view section, const std::string& where) {
  if (section == "accessors") {
    constexpr std::array<std::string_view, 7> types{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    constexpr std::array<int, 6> components{5120, 5121, 5122, 5123, 5125, 5126};
    if (std::ranges::find(types, value.at("type").get<std::string>()) == types.end())
      throw LoadError(
          fmt::format("{}: type is \"{}\", not an accessor type", where, oneLine(value.at("type").get<std::string>())));
    if (std::ranges::find(components, value.at("componentType").get<int>()) == components.end())
      throw LoadError(
          fmt::format("{}: componentType is {}, not a component type", where, value.at("componentType").get<int>()));
  } else if (section == "bufferViews" && value.contains("byteStride")) {
    const auto stride = value.at("byteStride").get<std::uint64_t>();
    if (stride > 252 || stride % 4 != 0)
      throw LoadError(fmt::format("{}: byteStride is {}, not a multiple of 4 up to 252", where, stride));
  } else if (section == "cameras") {
    const auto type = value.at("type").get<std::string>();
    if (type != "perspective" && type != "orthographic")
      throw LoadError(fmt::format("{}: type is \"{}\", neither perspective nor orthographic", where, oneLine(type)));
    if (!value.contains(type)) throw LoadError(fmt::format("{}: {} is missing", where, type));
  }
}

std::string nameIn(const Json& object) {
  const auto name = object.is_object() ? object.find("name") : object.end();
  return name != object.end() && name->is_string() ? name->get<std::string>() : std::string{};
}

void checkSection(Checker& checker, const Json& document, const Section& section) {
  const auto array = document.find(section.array);
  if (array == document.end()) return;
  if (!array->is_array()) throw LoadError(fmt::format("{} is not an array", section.array));
  for (std::size_t i = 0; i < array->size(); ++i) {
    const Json& value = (*array)[i];
    const std::string where = objectName(section.singular, i, nameIn(value));
    checker.fields(value, section.fields, where, "");
    checkChoices(value, section.array, where);
  }
}

// The indices of nodes, which have passed all other checks already.
void checkNodeRanges(const Checker& checker, const GltfNodes& nodes) {
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const GltfRareParts& rare = nodes.rare(i);
    const auto check = [&](std::optional<std::uint32_t> index, std::string_view target, std::string_view path) {
      if (index && *index >= checker.sizeOf(target)) checker.range(*index, target, nodes.name(i), std::string(path));
    };
    if (nodes.mesh(i) != GltfNodes::none) check(nodes.mesh(i), "meshes", "mesh");
    check(rare.skin, "skins", "skin");
    check(rare.camera, "cameras", "camera");
    check(rare.light, "lights", "extensions.KHR_lights_punctual.light");
    check(rare.translations, "accessors", "extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION");
    check(rare.rotations, "accessors", "extensions.EXT_mesh_gpu_instancing.attributes.ROTATION");
    check(rare.scales, "accessors", "extensions.EXT_mesh_gpu_instancing.attributes.SCALE");
    for (std::uint32_t child = 0; child < nodes.childCount(i); ++child)
      if (nodes.child(i, child) >= nodes.size())
        checker.range(nodes.child(i, child), "nodes", nodes.name(i), fmt::format("children[{}]", child));
  }
}

} // namespace

void checkGltfNode(const nlohmann::json& node, std::size_t index) {
  Checker checker;
  try {
    checker.fields(node, nodeFields, {}, {});
  } catch (const LoadError&) {
    // Once more with its name, which takes its time where there are millions.
    checker.fields(node, nodeFields, objectName("node", index, nameIn(node)), {});
  }
}

std::map<std::size_t, std::string> repairGltfCameras(nlohmann::json& document) {
  std::map<std::size_t, std::string> wrong;
  if (!document.is_object()) return wrong;
  const auto cameras = document.find("cameras");
  if (cameras == document.end() || !cameras->is_array()) return wrong;
  Checker checker(document, 0);
  for (std::size_t i = 0; i < cameras->size(); ++i) {
    Json& camera = (*cameras)[i];
    const std::string where = objectName("camera", i, nameIn(camera));
    try {
      checker.fields(camera, cameraFields, where, "");
      checkChoices(camera, "cameras", where);
    } catch (const LoadError& error) {
      wrong.emplace(i, error.what());
      camera = {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 1.0}}}};
    }
  }
  return wrong;
}

void checkGltfJson(const nlohmann::json& document, const GltfNodes& nodes, const std::optional<LoadError>& nodeError) {
  if (!document.is_object()) throw LoadError("the JSON is not an object, so it is not glTF");
  Checker checker(document, nodes.size());
  checkAsset(checker, document);
  checkExtensions(checker, document);
  for (const Section& section : sections) {
    if (section.array == "nodes" && nodeError) throw *nodeError;
    checkSection(checker, document, section);
    if (section.array == "nodes") checkNodeRanges(checker, nodes);
  }
  const auto scene = document.find("scene");
  if (scene != document.end()) checker.index(*scene, "scenes", "", "scene");
}

} // namespace vitrail::tool
