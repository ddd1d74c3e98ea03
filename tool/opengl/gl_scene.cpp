#include "gl_scene.h"

#include <algorithm>
#include <cstring>
#include <span>

#include <fmt/format.h>

#include "../cpu/cpu_texture.h"
#include "../stage/light_data.h"
#include "../stage/material_data.h"
#include "bindings.h"

namespace vitrail::tool {

namespace {

GLint wrapOf(Wrap wrap) {
  switch (wrap) {
    case Wrap::MirroredRepeat:
      return GL_MIRRORED_REPEAT;
    case Wrap::ClampToEdge:
      return GL_CLAMP_TO_EDGE;
    default:
      return GL_REPEAT;
  }
}

GLint minFilterOf(const Sampler& sampler) {
  if (!sampler.mipmaps || !sampler.mipLinear) {
    return sampler.minLinear ? GL_LINEAR_MIPMAP_NEAREST : GL_NEAREST_MIPMAP_NEAREST;
  }
  return sampler.minLinear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_LINEAR;
}

void write(const GlBuffer& buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  glNamedBufferSubData(buffer.get(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()),
                       bytes.data());
}

} // namespace

GlScene::GlScene(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released)
    : SceneDraws(scene, opacity, order, gl.limits().vertices), gl_(gl), places_(placeVertices(scene, *this)) {
  uploadMaterials(scene, opacity);
  uploadTextures(scene);
  if (released != nullptr) {
    for (Image& image : released->images) image.rgba = std::vector<std::uint8_t>();
  }
  instances_ = GlBuffer(gl_, std::max<std::uint64_t>(instanceBytes(), kInstanceBytes), "instances");
  giveInstances(scene,
                [&](std::uint64_t offset, std::span<const std::byte> bytes) { write(instances_, offset, bytes); });
  uploadMeshes(scene, released); // last: all else has been asked of them
  makeVertexArray();
  gl_.check("a scene");
}

void GlScene::uploadMaterials(const Scene& scene, std::optional<float> opacity) {
  GLint alignment = 1;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  const auto step = static_cast<std::uint32_t>(alignment);
  materialStride_ = (static_cast<std::uint32_t>(sizeof(shaders::MaterialData)) + step - 1) / step * step;
  materials_ = GlBuffer(gl_, std::max<std::size_t>(scene.materials.size(), 1) * materialStride_, "materials");
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const shaders::MaterialData data = makeMaterialData(scene.materials[i], opacity);
    write(materials_, i * materialStride_, std::as_bytes(std::span(&data, 1)));
  }
  std::vector<shaders::LightData> lights = makeLightData(scene, origin());
  lightCount_ = lights.size();
  if (lights.empty()) lights.emplace_back(); // something to bind
  lights_ = GlBuffer(gl_, lights.size() * sizeof(shaders::LightData), "lights");
  write(lights_, 0, std::as_bytes(std::span(lights)));
}

// The levels are those of the processor's textures, which are what Vulkan's blits make (cpu/cpu_texture.h).
GLuint GlScene::texture(const Scene& scene, std::uint32_t image, Texels texels) {
  const auto found = textures_.find({image, texels});
  if (found != textures_.end()) return found->second.get();
  const Image& original = scene.images.at(image);
  if (const std::uint32_t side = gl_.limits().textureSide; std::max(original.width, original.height) > side) {
    throw GpuError(fmt::format("the texture {} would be {}x{} pixels; a side can be at most {} on {}", image,
                               original.width, original.height, side, gl_.name()));
  }
  const CpuTexture source = makeCpuTexture(original, texels);
  const bool halves = texels == Texels::Premultiplied;
  GlTextureInfo info;
  info.width = static_cast<std::uint32_t>(source.width[0]);
  info.height = static_cast<std::uint32_t>(source.height[0]);
  info.format = halves ? GL_RGBA16F : texels == Texels::Srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
  info.pixelBytes = halves ? 8 : 4;
  info.levels = static_cast<std::uint32_t>(source.levels);
  GlTexture texture(gl_, info, "textures");
  for (std::uint32_t i = 0; i < info.levels; ++i) {
    const std::size_t first = static_cast<std::size_t>(source.offset[i]) * (halves ? 2 : 1);
    glTextureSubImage2D(texture.get(), static_cast<GLint>(i), 0, 0, source.width[i], source.height[i], GL_RGBA,
                        halves ? GL_HALF_FLOAT : GL_UNSIGNED_BYTE, &source.texels[first]);
  }
  return textures_.emplace(std::pair{image, texels}, std::move(texture)).first->second.get();
}

GLuint GlScene::sampler(const Sampler& sampler) {
  for (const auto& [known, object] : samplers_) {
    if (known == sampler) return object.get();
  }
  GLuint name = 0;
  glCreateSamplers(1, &name);
  samplers_.emplace_back(sampler, GlObject(GlKind::Sampler, name));
  glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, sampler.magLinear ? GL_LINEAR : GL_NEAREST);
  glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, minFilterOf(sampler));
  glSamplerParameteri(name, GL_TEXTURE_WRAP_S, wrapOf(sampler.wrapU));
  glSamplerParameteri(name, GL_TEXTURE_WRAP_T, wrapOf(sampler.wrapV));
  // A quarter level: rounds to the base level and still lets the device tell minification from magnification.
  if (!sampler.mipmaps) glSamplerParameterf(name, GL_TEXTURE_MAX_LOD, 0.25F);
  return name;
}

void GlScene::uploadTextures(const Scene& scene) {
  for (const std::uint32_t material : materials()) {
    const Material& source = scene.materials.at(material);
    const auto slots = slotsOf(source);
    Slots& names = slots_[material];
    for (std::uint32_t i = 0; i < shaders::SLOT_COUNT; ++i) {
      const TextureSlot& slot = *slots.at(i);
      if (!isFilled(scene, slot)) continue;
      const Texels texels = texelsOf(source, i, isPremultiplied(material));
      names.at(i) = {texture(scene, static_cast<std::uint32_t>(slot.image), texels), sampler(slot.sampler)};
    }
  }
}

void GlScene::uploadMeshes(const Scene& scene, Scene* released) {
  const Mesh values = defaultVertex();
  const auto defaults = vertexArrays(values);
  for (std::size_t stream = 0; stream < kStreamCount; ++stream) {
    streams_.at(stream) = GlBuffer(gl_, places_.bytes.at(stream), kStreamNames.at(stream));
    write(streams_.at(stream), 0, defaults.at(stream));
  }
  indices_ = GlBuffer(gl_, indexBytes(), "indices");
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    if (!usesMesh(i)) continue;
    const Mesh& mesh = scene.meshes[i];
    const auto arrays = vertexArrays(mesh);
    for (std::size_t stream = 0; stream < kStreamCount; ++stream) {
      write(streams_.at(stream), places_.meshes[i].offsets.at(stream), arrays.at(stream));
      if (released != nullptr) releaseArray(released->meshes[i], stream);
    }
    giveIndices(scene, i,
                [&](std::uint64_t offset, std::span<const std::byte> bytes) { write(indices_, offset, bytes); });
    if (released != nullptr) released->meshes[i].indices = std::vector<std::uint32_t>();
  }
}

// What surface.vert reads.
void GlScene::makeVertexArray() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  vertexArray_ = {GlKind::VertexArray, name};
  glVertexArrayAttribFormat(name, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(name, 1, 2, GL_SHORT, GL_TRUE, 0);
  glVertexArrayAttribIFormat(name, 2, 2, GL_SHORT, 0);
  glVertexArrayAttribFormat(name, 3, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(name, 4, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(name, 5, 4, GL_HALF_FLOAT, GL_FALSE, 0);
  for (GLuint i = 0; i < kStreamCount; ++i) glVertexArrayAttribBinding(name, i, i);
  for (GLuint i = 0; i < 3; ++i) {
    glVertexArrayAttribFormat(name, kStreamCount + i, 4, GL_FLOAT, GL_FALSE, 16 * i);
    glVertexArrayAttribBinding(name, kStreamCount + i, kInstanceBinding);
  }
  for (GLuint i = 0; i < kStreamCount + 3; ++i) glEnableVertexArrayAttrib(name, i);
  glVertexArrayBindingDivisor(name, kInstanceBinding, 1);
  glVertexArrayVertexBuffer(name, kInstanceBinding, instances_.get(), 0, kInstanceBytes);
  glVertexArrayElementBuffer(name, indices_.get());
}

void GlScene::bind() const {
  glBindVertexArray(vertexArray_.get());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLightsBlock, lights_.get());
}

void GlScene::bind(const GpuDraw& draw, const GpuDraw* before) const {
  if (before == nullptr || before->material != draw.material) {
    glBindBufferRange(GL_UNIFORM_BUFFER, kMaterialBlock, materials_.get(),
                      static_cast<GLintptr>(draw.material) * materialStride_, sizeof(shaders::MaterialData));
    const Slots& slots = slots_.at(draw.material);
    for (GLuint i = 0; i < slots.size(); ++i) {
      if (slots[i].first == 0) continue;
      glBindTextureUnit(i, slots[i].first);
      glBindSampler(i, slots[i].second);
    }
  }
  if (before == nullptr || before->mesh != draw.mesh) {
    const VertexPlace& place = places_.meshes[draw.mesh];
    for (GLuint i = 0; i < kStreamCount; ++i) {
      glVertexArrayVertexBuffer(vertexArray_.get(), i, streams_.at(i).get(), static_cast<GLintptr>(place.offsets.at(i)),
                                static_cast<GLsizei>(place.strides.at(i)));
    }
  }
  // Rows of pixels count as with Vulkan, downwards, and OpenGL takes them to go up: triangles are turned round for it.
  // A mirror turns them too, and glTF means the side that was outside before.
  if (before == nullptr || before->mirrored != draw.mirrored) glFrontFace(draw.mirrored ? GL_CCW : GL_CW);
  if (before == nullptr || before->backFaceCulled != draw.backFaceCulled) {
    draw.backFaceCulled ? glEnable(GL_CULL_FACE) : glDisable(GL_CULL_FACE);
  }
}

} // namespace vitrail::tool
