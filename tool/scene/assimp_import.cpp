// Loads OBJ with its material libraries, read by assimp, and turns the materials into metallic-roughness ones.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include "load.h"
#include "mesh_build.h"
#include "message.h"
#include "plain_model.h"
#include "polygon.h"
#include "read_file.h"

namespace vitrail::tool {
namespace {

// A file in memory, for assimp.
class MemoryStream final : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : bytes_(bytes) {}
  explicit MemoryStream(std::vector<std::byte> owned) : owned_(std::move(owned)), bytes_(owned_) {}

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - position_) / size);
    if (whole != 0) std::memcpy(buffer, bytes_.data() + position_, whole * size);
    position_ += whole * size;
    return whole;
  }
  std::size_t Write(const void* /*buffer*/, std::size_t /*size*/, std::size_t /*count*/) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? position_ : bytes_.size();
    if (offset > bytes_.size() - from) return aiReturn_FAILURE;
    position_ = from + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return position_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::vector<std::byte> owned_;
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

// Shows assimp the model, and of the disk only the files that the model names below or beside it.
class ModelFiles final : public Assimp::IOSystem {
 public:
  ModelFiles(std::string name, std::span<const std::byte> model, std::filesystem::path base)
      : name_(std::move(name)), model_(model), base_(std::move(base)) {}

  bool Exists(const char* file) const override { return file == name_ || read(file).has_value(); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (std::string_view(mode).find('r') == std::string_view::npos) return nullptr;
    if (file == name_) return new MemoryStream(model_);
    std::optional<std::vector<std::byte>> bytes = read(file);
    return bytes ? new MemoryStream(std::move(*bytes)) : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::optional<std::vector<std::byte>> read(const std::string& file) const {
    try {
      return readFileBeside(file, base_);
    } catch (const LoadError&) {
      return std::nullopt; // a missing material library leaves the default material
    }
  }

  std::string name_;
  std::span<const std::byte> model_;
  std::filesystem::path base_;
};

// The vertices of a mesh, and its polygons as triangles.
Mesh convertMesh(const aiMesh& source, const std::string& where) {
  Mesh mesh;
  mesh.vertices.resize(source.mNumVertices);
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    Vertex& vertex = mesh.vertices[i];
    const aiVector3D& position = source.mVertices[i];
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z))
      throw LoadError(fmt::format("{}: vertex {} is not finite", where, i));
    vertex.position = {position.x, position.y, position.z};
    if (source.HasNormals()) vertex.normal = {source.mNormals[i].x, source.mNormals[i].y, source.mNormals[i].z};
    if (source.HasTextureCoords(0)) {
      // v grows upwards in OBJ and downwards in glTF.
      const aiVector3D& uv = source.mTextureCoords[0][i];
      if (std::isfinite(uv.x) && std::isfinite(uv.y)) vertex.texCoord0 = {uv.x, 1.0F - uv.y};
    }
    if (source.HasVertexColors(0)) {
      const aiColor4D& color = source.mColors[0][i];
      vertex.color = glm::vec4(linearFromSrgb({color.r, color.g, color.b}), 1.0F);
    }
  }
  for (const aiFace& face : std::span(source.mFaces, source.mNumFaces)) {
    const std::span<const unsigned> corners(face.mIndices, face.mNumIndices);
    for (const unsigned corner : corners)
      if (corner >= source.mNumVertices)
        throw LoadError(
            fmt::format("{}: a face names vertex {}, but there are {}", where, corner, source.mNumVertices));
    addPolygon(corners, mesh.vertices, mesh.indices);
  }
  return mesh;
}

Material convertMaterial(const aiMaterial& source, bool colored, Scene& scene, TextureFiles& textures) {
  aiString name;
  source.Get(AI_MATKEY_NAME, name);
  if (std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME) return plainMaterial(colored);
  Material material = plainMaterial(true);
  material.name = name.C_Str();
  aiString texture;
  if (source.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS) {
    material.baseColorTexture = textures.read(scene, texture.C_Str());
    int mode = aiTextureMapMode_Wrap;
    if (source.Get(AI_MATKEY_MAPPINGMODE_U(aiTextureType_DIFFUSE, 0), mode) == aiReturn_SUCCESS &&
        mode == aiTextureMapMode_Clamp) {
      material.baseColorTexture.sampler.wrapU = Wrap::ClampToEdge;
      material.baseColorTexture.sampler.wrapV = Wrap::ClampToEdge;
    }
  }
  aiColor3D diffuse(1.0F, 1.0F, 1.0F);
  source.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
  glm::vec3 color = linearFromSrgb({diffuse.r, diffuse.g, diffuse.b});
  // Writers that rely on the texture alone leave its factor black.
  if (material.baseColorTexture.image >= 0 && color == glm::vec3(0.0F)) color = glm::vec3(1.0F);
  float opacity = 1.0F;
  source.Get(AI_MATKEY_OPACITY, opacity);
  material.baseColor = glm::vec4(color, std::isfinite(opacity) ? std::clamp(opacity, 0.0F, 1.0F) : 1.0F);
  aiColor3D emissive(0.0F, 0.0F, 0.0F);
  source.Get(AI_MATKEY_COLOR_EMISSIVE, emissive);
  material.emissive = linearFromSrgb({emissive.r, emissive.g, emissive.b});
  return material;
}

Scene importScene(std::span<const std::byte> file, const std::filesystem::path& base) {
  const std::string name = "model.obj";
  Assimp::Importer importer;
  importer.SetIOHandler(new ModelFiles(name, file, base)); // the importer owns it
  // No post-processing: it stops the program where it meets what it does not expect.
  const aiScene* source = importer.ReadFile(name, 0);
  if (source == nullptr) throw LoadError(fmt::format("it cannot be read: {}", oneLine(importer.GetErrorString())));
  Scene scene;
  TextureFiles textures(base);
  // The nodes of an OBJ are its groups, which move nothing: each mesh stands where its vertices say.
  for (unsigned i = 0; i < source->mNumMeshes; ++i) {
    const aiMesh& mesh = *source->mMeshes[i];
    Mesh converted = convertMesh(mesh, objectName("mesh", i, mesh.mName.C_Str()));
    if (mesh.mMaterialIndex >= source->mNumMaterials) throw LoadError("a mesh names a material that is not there");
    const bool colored = mesh.HasVertexColors(0);
    addPlainMesh(scene, std::move(converted), mesh.HasNormals() ? NormalsFrom::File : NormalsFrom::Places,
                 convertMaterial(*source->mMaterials[mesh.mMaterialIndex], colored, scene, textures));
  }
  requireDrawable(scene);
  return scene;
}

} // namespace

Scene loadObj(std::span<const std::byte> file, const std::filesystem::path& base) {
  try {
    return importScene(file, base);
  } catch (const LoadError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw LoadError("there is not enough memory to load it");
  } catch (const std::exception& error) {
    throw LoadError(fmt::format("it cannot be read: {}", oneLine(error.what())));
  }
}

} // namespace vitrail::tool
