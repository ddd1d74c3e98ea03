// The method depth-peeling (depth_peeling.cpp) with OpenGL. The surfaces of a pixel are counted in 32 bits at once: a
// stencil and a depth of one texture are not sampled side by side.
#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "../../gpu/pixel_pass_shared.h"
#include "../../opengl/bindings.h"
#include "../gl_method.h"
#include "../methods.h"
#include "../shared/complexity_steps.h"
#include "../shared/peeling_shared.h"
#include "files/gl_complexity_count_wide.frag.h"
#include "files/gl_complexity_reduce.comp.h"
#include "files/gl_depth_peeling.frag.h"
#include "files/gl_depth_peeling_blend.comp.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kLayerBytes = 4 * 8 + 2 * 16 + 4 + 4; // of the textures below, and of the counts
// Layers after which the device is waited for, so that it is not kept too long.
constexpr std::uint32_t kLayersAtOnce = 64;

class GlDepthPeeling final : public GlMethod {
 public:
  GlDepthPeeling(const GlMethodHost& host, const MethodOptions& options);

  void setTarget(const GlMethodTarget& target) override;
  void releaseTarget() override;
  void draw(GlFrame& frame) override;
  FrameStats stats() const override;

 private:
  void measure(GlFrame& frame);
  void clear();
  void peel(GlFrame& frame);
  void blend(std::uint32_t step);

  Gl& gl_;
  std::uint32_t layers_; // 0: all
  GlSurfacePrograms count_;
  GlSurfacePrograms peel_;
  GlObject reduce_;
  GlObject blend_;
  GlPushed pushed_;
  const GlImages* images_ = nullptr;
  GlTexture counts_;
  GlTexture depth_; // of the layer that a pass takes
  GlTexture color_;
  GlTexture opacity_;
  GlTexture layerTaken_;
  GlTexture frontColor_; // of the layers before it
  GlTexture frontThrough_;
  GlTexture taken_;
  GlObject framebuffer_; // of a layer
  GlBuffer parts_;       // shaders::Complexity; the result first
  shaders::Complexity measured_{};
};

GlDepthPeeling::GlDepthPeeling(const GlMethodHost& host, const MethodOptions& options)
    : gl_(host.gl),
      layers_(options.maxLayers),
      count_(host.surfaces, host.surfaces.scene().transparentDraws(), "count",
             [](std::uint32_t /*features*/) { return ShaderText{files::gl_complexity_count_wide_frag}; }),
      peel_(host.surfaces, host.surfaces.scene().transparentDraws(), "depth-peeling",
            [](std::uint32_t /*features*/) { return ShaderText{files::gl_depth_peeling_frag}; }),
      reduce_(makeComputeProgram({files::gl_complexity_reduce_comp}, "depth complexity")),
      blend_(makeComputeProgram({files::gl_depth_peeling_blend_comp}, "depth-peeling blend")),
      pushed_(host.gl, sizeof(shaders::ComplexityReduction)) {}

void GlDepthPeeling::setTarget(const GlMethodTarget& target) {
  if (images_ != nullptr) return; // the images are the same until releaseTarget()
  const GlImagesInfo& picture = target.images->info();
  const auto make = [&](GLenum format, std::uint32_t bytes, const char* what) {
    return GlTexture(gl_, {.width = picture.width, .height = picture.height, .format = format, .pixelBytes = bytes},
                     what);
  };
  counts_ = make(GL_R32UI, 4, "counts of surfaces");
  depth_ = make(GL_DEPTH_COMPONENT32F, 4, "layer depth");
  color_ = make(GL_RGBA16F, 8, "layer colour");
  opacity_ = make(GL_RGBA16F, 8, "layer opacity");
  layerTaken_ = make(GL_RG32UI, 8, "layer depth and triangle");
  frontColor_ = make(GL_RGBA32F, 16, "colour of nearer layers"); // many layers would add up the rounding of 16 bits
  frontThrough_ = make(GL_RGBA32F, 16, "transmittance of nearer layers");
  taken_ = make(GL_RG32UI, 8, "last depth and triangle");
  parts_ =
      GlBuffer(gl_, complexityParts(picture.width * picture.height) * sizeof(shaders::Complexity), "depth complexity");
  framebuffer_ = makeFramebuffer();
  GLenum point = GL_COLOR_ATTACHMENT0;
  for (const GlTexture* texture : {&color_, &opacity_, &layerTaken_}) {
    glNamedFramebufferTexture(framebuffer_.get(), point++, texture->get(), 0);
  }
  glNamedFramebufferTexture(framebuffer_.get(), GL_DEPTH_ATTACHMENT, depth_.get(), 0);
  constexpr std::array<GLenum, 3> kPoints{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glNamedFramebufferDrawBuffers(framebuffer_.get(), kPoints.size(), kPoints.data());
  images_ = target.images;
}

void GlDepthPeeling::releaseTarget() {
  images_ = nullptr;
  framebuffer_ = GlObject();
  for (GlTexture* texture :
       {&counts_, &depth_, &color_, &opacity_, &layerTaken_, &frontColor_, &frontThrough_, &taken_}) {
    *texture = GlTexture();
  }
}

void GlDepthPeeling::draw(GlFrame& frame) {
  measure(frame);
  const std::uint32_t passes = layers_ > 0 ? std::min(layers_, measured_.deepest) : measured_.deepest;
  if (passes == 0) return;
  clear();
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    peel(frame);
    frame.endPass("peel");
    blend(shaders::PEELING_NEXT);
    frame.endPass("compose");
    if ((pass + 1) % kLayersAtOnce == 0) frame.wait();
  }
  blend(shaders::PEELING_LAST);
  frame.endPass("compose");
}

// Counts the surfaces of each pixel in front of the opaque scene, and waits for the most and the sums.
void GlDepthPeeling::measure(GlFrame& frame) {
  const GLuint zero = 0;
  glClearTexImage(counts_.get(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT); // the clear wrote -> surfaces are counted
  glBindImageTexture(0, counts_.get(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  images_->bindDepthAlone();
  frame.drawSurfaces(count_);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT); // the draws counted -> the first step reads
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kMethodBlock, parts_.get());
  glUseProgram(reduce_.get());
  const GlImagesInfo& picture = images_->info();
  for (const ComplexityStep& step :
       complexitySteps(picture.width, picture.height, shaders::COMPLEXITY_IMAGE, layers_)) {
    pushed_.set(step.constants);
    glDispatchCompute(step.columns, step.rows, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT); // a step wrote parts -> the next one reads them
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // the last step wrote the result -> it is read
  frame.endPass("count");
  frame.wait();
  glGetNamedBufferSubData(parts_.get(), 0, sizeof(measured_), &measured_);
}

void GlDepthPeeling::clear() {
  const std::array<float, 4> none{};
  const std::array<float, 4> all{1.0F, 1.0F, 1.0F, 1.0F};
  const std::array<GLuint, 2> nearest{UINT32_MAX, UINT32_MAX}; // nearer than all
  glClearTexImage(frontColor_.get(), 0, GL_RGBA, GL_FLOAT, none.data());
  glClearTexImage(frontThrough_.get(), 0, GL_RGBA, GL_FLOAT, all.data());
  glClearTexImage(taken_.get(), 0, GL_RG_INTEGER, GL_UNSIGNED_INT, nearest.data());
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT); // the clears wrote -> shaders read
}

void GlDepthPeeling::peel(GlFrame& frame) {
  const std::array<float, 4> none{};
  const std::array<GLuint, 4> nothing{};
  const float farPlane = 0.0F;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_GREATER); // of surfaces at one depth the first remains, the others' turns come later
  glClearBufferfv(GL_COLOR, 0, none.data());
  glClearBufferfv(GL_COLOR, 1, none.data());
  glClearBufferuiv(GL_COLOR, 2, nothing.data());
  glClearBufferfv(GL_DEPTH, 0, &farPlane);
  glBindTextureUnit(kDepthTexture, images_->depth());
  glBindSampler(kDepthTexture, 0);
  glBindImageTexture(5, taken_.get(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_RG32UI);
  std::uint32_t firstTriangle = 0;
  frame.drawSurfaces(peel_, [&](const SurfaceRun& run) {
    pushed_.set(firstTriangle);
    firstTriangle += run.indexCount / 3;
  });
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
}

void GlDepthPeeling::blend(std::uint32_t step) {
  // The pass drew a layer, or the opaque scene the picture -> they are read.
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
  const std::array<std::pair<GLuint, GLenum>, 7> images{{{color_.get(), GL_RGBA16F},
                                                         {opacity_.get(), GL_RGBA16F},
                                                         {layerTaken_.get(), GL_RG32UI},
                                                         {frontColor_.get(), GL_RGBA32F},
                                                         {frontThrough_.get(), GL_RGBA32F},
                                                         {taken_.get(), GL_RG32UI},
                                                         {images_->color(), GL_RGBA16F}}};
  for (GLuint i = 0; i < images.size(); ++i) {
    glBindImageTexture(i, images.at(i).first, 0, GL_FALSE, 0, GL_READ_WRITE, images.at(i).second);
  }
  pushed_.set(step);
  glUseProgram(blend_.get());
  glDispatchCompute(shaders::pixelGroups(images_->info().width), shaders::pixelGroups(images_->info().height), 1);
  // The layer was blended -> the next pass reads what was taken, and draws over what was read; the picture is read.
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

FrameStats GlDepthPeeling::stats() const {
  FrameStats stats = complexityStats(measured_);
  stats.totalBytes = parts_.size() + std::uint64_t{kLayerBytes} * images_->info().width * images_->info().height;
  return stats;
}

} // namespace

std::unique_ptr<GlMethod> makeGlDepthPeeling(const GlMethodHost& host, const MethodOptions& options) {
  return std::make_unique<GlDepthPeeling>(host, options);
}

} // namespace vitrail::tool
