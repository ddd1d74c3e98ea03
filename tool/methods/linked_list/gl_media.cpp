#include "gl_media.h"

#include "../../gpu/pixel_pass_shared.h"
#include "../../opengl/bindings.h"
#include "files/gl_media_resolve.comp.h"
#include "files/gl_media_resolve_samples.comp.h"

namespace vitrail::tool {

GlMedia::GlMedia(const GlMethodHost& host, const char* lists, std::uint32_t samples)
    : gl_(host.gl),
      lists_(std::string("#define VITRAIL_SORTED_LISTS\n") + lists),
      samples_(samples),
      list_(host.surfaces.scene(), host.scene),
      buffer_(gl_, list_.table().size() * sizeof(shaders::MediaObject), "objects that absorb"),
      view_(gl_, sizeof(shaders::MediaView)) {}

GlObject GlMedia::makeProgram(bool anyNear, bool tested) const {
  ShaderText text{files::gl_media_resolve_comp, lists_, ""};
  if (samples_ > 1) text.file = files::gl_media_resolve_samples_comp;
  text.constants = constantLine("uint kSamples", samples_) + constantLine("bool kTestDepth", !tested) +
                   constantLine("bool kAnyNear", anyNear);
  return makeComputeProgram(text, "media resolve");
}

void GlMedia::setView(const shaders::FrameData& view, bool tested) {
  list_.setView(view);
  glNamedBufferSubData(buffer_.get(), 0, static_cast<GLsizeiptr>(list_.table().size() * sizeof(shaders::MediaObject)),
                       list_.table().data());
  GlObject& program = programs_.at(list_.anyNear() ? 1 : 0);
  if (program.get() == 0) program = makeProgram(list_.anyNear(), tested);
}

void GlMedia::resolve(const GlImages& images, std::uint32_t width, std::uint32_t height) const {
  // The opaque draws wrote the picture -> it is read and written.
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kMethodBlock, buffer_.get());
  glBindImageTexture(0, images.color(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA16F);
  glBindTextureUnit(kDepthTexture, images.depth());
  glBindSampler(kDepthTexture, 0);
  if (samples_ > 1) glBindTextureUnit(kOpaqueTexture, images.multisampled());
  if (samples_ > 1) glBindSampler(kOpaqueTexture, 0);
  view_.set(list_.view());
  glUseProgram(programs_.at(list_.anyNear() ? 1 : 0).get());
  glDispatchCompute(shaders::pixelGroups(width), shaders::pixelGroups(height), 1);
  // The resolve wrote the picture, and counted -> it is drawn over, read, and the counters are copied.
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

} // namespace vitrail::tool
