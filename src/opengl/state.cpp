#include "state.h"

namespace vitrail {

// ---- Copies

SavedCopies::SavedCopies(const GlFunctions& gl) : gl_(gl) {
  gl.GetIntegerv(GL_COPY_READ_BUFFER_BINDING, &read_);
  gl.GetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &write_);
}

SavedCopies::~SavedCopies() {
  gl_.BindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(read_));
  gl_.BindBuffer(GL_COPY_WRITE_BUFFER, static_cast<GLuint>(write_));
}

// ---- Clears

SavedUnpacking::SavedUnpacking(const GlFunctions& gl) : gl_(gl) {
  gl.GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &buffer_);
  gl.GetIntegerv(GL_UNPACK_SKIP_PIXELS, &skipPixels_);
  gl.GetIntegerv(GL_UNPACK_SKIP_ROWS, &skipRows_);
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  gl.PixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
  gl.PixelStorei(GL_UNPACK_SKIP_ROWS, 0);
}

SavedUnpacking::~SavedUnpacking() {
  gl_.BindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(buffer_));
  gl_.PixelStorei(GL_UNPACK_SKIP_PIXELS, skipPixels_);
  gl_.PixelStorei(GL_UNPACK_SKIP_ROWS, skipRows_);
}

// ---- Shaders

namespace {

GLenum indexedTarget(std::size_t binding) {
  return binding == VITRAIL_BINDING_PARAMETERS ? GL_UNIFORM_BUFFER : GL_SHADER_STORAGE_BUFFER;
}

} // namespace

void SavedShaders::saveRange(GLenum target, GLuint index, Range& range) {
  const bool uniform = target == GL_UNIFORM_BUFFER;
  gl_.GetIntegeri_v(uniform ? GL_UNIFORM_BUFFER_BINDING : GL_SHADER_STORAGE_BUFFER_BINDING, index, &range.buffer);
  if (range.buffer == 0) return;
  gl_.GetInteger64i_v(uniform ? GL_UNIFORM_BUFFER_START : GL_SHADER_STORAGE_BUFFER_START, index, &range.offset);
  gl_.GetInteger64i_v(uniform ? GL_UNIFORM_BUFFER_SIZE : GL_SHADER_STORAGE_BUFFER_SIZE, index, &range.size);
}

void SavedShaders::restoreRange(GLenum target, GLuint index, const Range& range) {
  if (range.buffer == 0 || range.size == 0) { // a size of 0: all of the buffer, whatever its size
    gl_.BindBufferBase(target, index, static_cast<GLuint>(range.buffer));
  } else {
    gl_.BindBufferRange(target, index, static_cast<GLuint>(range.buffer), static_cast<GLintptr>(range.offset),
                        static_cast<GLsizeiptr>(range.size));
  }
}

SavedShaders::SavedShaders(const GlFunctions& gl, GLenum indirect, bool images)
    : gl_(gl), indirectTarget_(indirect), images_(images) {
  gl.GetIntegerv(GL_CURRENT_PROGRAM, &program_);
  gl.GetIntegerv(
      indirect == GL_DRAW_INDIRECT_BUFFER ? GL_DRAW_INDIRECT_BUFFER_BINDING : GL_DISPATCH_INDIRECT_BUFFER_BINDING,
      &indirect_);
  gl.GetIntegerv(GL_UNIFORM_BUFFER_BINDING, &uniform_);
  gl.GetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &storage_);
  for (std::size_t i = 0; i < ranges_.size(); ++i) saveRange(indexedTarget(i), static_cast<GLuint>(i), ranges_[i]);
  if (!images) return;
  gl.GetIntegeri_v(GL_IMAGE_BINDING_NAME, VITRAIL_VIEW_BINDING_COLOR, &image_.name);
  gl.GetIntegeri_v(GL_IMAGE_BINDING_LEVEL, VITRAIL_VIEW_BINDING_COLOR, &image_.level);
  gl.GetBooleani_v(GL_IMAGE_BINDING_LAYERED, VITRAIL_VIEW_BINDING_COLOR, &image_.layered);
  gl.GetIntegeri_v(GL_IMAGE_BINDING_LAYER, VITRAIL_VIEW_BINDING_COLOR, &image_.layer);
  gl.GetIntegeri_v(GL_IMAGE_BINDING_ACCESS, VITRAIL_VIEW_BINDING_COLOR, &image_.access);
  gl.GetIntegeri_v(GL_IMAGE_BINDING_FORMAT, VITRAIL_VIEW_BINDING_COLOR, &image_.format);
  gl.GetIntegerv(GL_ACTIVE_TEXTURE, &activeTexture_);
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    gl.GetIntegerv(GL_TEXTURE_BINDING_2D_MULTISAMPLE, &textures_[i]);
    gl.GetIntegerv(GL_SAMPLER_BINDING, &samplers_[i]);
    gl.BindSampler(static_cast<GLuint>(i), 0);
  }
  gl.ActiveTexture(static_cast<GLenum>(activeTexture_));
}

SavedShaders::~SavedShaders() {
  if (images_) {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
      gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
      gl_.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, static_cast<GLuint>(textures_[i]));
      gl_.BindSampler(static_cast<GLuint>(i), static_cast<GLuint>(samplers_[i]));
    }
    gl_.ActiveTexture(static_cast<GLenum>(activeTexture_));
    gl_.BindImageTexture(VITRAIL_VIEW_BINDING_COLOR, static_cast<GLuint>(image_.name), image_.level, image_.layered,
                         image_.layer, static_cast<GLenum>(image_.access), static_cast<GLenum>(image_.format));
  }
  for (std::size_t i = 0; i < ranges_.size(); ++i) restoreRange(indexedTarget(i), static_cast<GLuint>(i), ranges_[i]);
  gl_.BindBuffer(GL_UNIFORM_BUFFER, static_cast<GLuint>(uniform_));
  gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(storage_));
  gl_.BindBuffer(indirectTarget_, static_cast<GLuint>(indirect_));
  // One that the host had deleted while it was current is gone since another took its place.
  const auto program = static_cast<GLuint>(program_);
  gl_.UseProgram(program != 0 && gl_.IsProgram(program) != GL_FALSE ? program : 0);
}

// ---- Draws

namespace {

void set(const GlFunctions& gl, GLenum what, GLboolean enabled) {
  if (enabled != GL_FALSE) {
    gl.Enable(what);
  } else {
    gl.Disable(what);
  }
}

void setIndexed(const GlFunctions& gl, GLenum what, GLboolean enabled) {
  if (enabled != GL_FALSE) {
    gl.Enablei(what, 0);
  } else {
    gl.Disablei(what, 0);
  }
}

} // namespace

SavedDraw::SavedDraw(const GlFunctions& gl) : gl_(gl) {
  gl.GetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertexArray_);
  for (std::size_t i = 0; i < kOff.size(); ++i) enabled_[i] = gl.IsEnabled(kOff[i]);
  multisample_ = gl.IsEnabled(GL_MULTISAMPLE);
  blend_ = gl.IsEnabledi(GL_BLEND, 0);
  scissor_ = gl.IsEnabledi(GL_SCISSOR_TEST, 0);
  constexpr std::array<GLenum, 4> kFunctions = {GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA,
                                                GL_BLEND_DST_ALPHA};
  for (std::size_t i = 0; i < kFunctions.size(); ++i) gl.GetIntegeri_v(kFunctions[i], 0, &blendFunctions_[i]);
  gl.GetIntegeri_v(GL_BLEND_EQUATION_RGB, 0, &blendEquations_[0]);
  gl.GetIntegeri_v(GL_BLEND_EQUATION_ALPHA, 0, &blendEquations_[1]);
  gl.GetBooleani_v(GL_COLOR_WRITEMASK, 0, colorMask_.data());
  gl.GetFloati_v(GL_VIEWPORT, 0, viewport_.data());
  gl.GetIntegeri_v(GL_SCISSOR_BOX, 0, scissorBox_.data());
  gl.GetIntegerv(GL_POLYGON_MODE, polygonMode_.data());
  Stencil& front = stencil_[0];
  gl.GetIntegerv(GL_STENCIL_FUNC, &front.func);
  gl.GetIntegerv(GL_STENCIL_REF, &front.reference);
  gl.GetIntegerv(GL_STENCIL_VALUE_MASK, &front.mask);
  gl.GetIntegerv(GL_STENCIL_FAIL, &front.fail);
  gl.GetIntegerv(GL_STENCIL_PASS_DEPTH_FAIL, &front.depthFail);
  gl.GetIntegerv(GL_STENCIL_PASS_DEPTH_PASS, &front.pass);
  Stencil& back = stencil_[1];
  gl.GetIntegerv(GL_STENCIL_BACK_FUNC, &back.func);
  gl.GetIntegerv(GL_STENCIL_BACK_REF, &back.reference);
  gl.GetIntegerv(GL_STENCIL_BACK_VALUE_MASK, &back.mask);
  gl.GetIntegerv(GL_STENCIL_BACK_FAIL, &back.fail);
  gl.GetIntegerv(GL_STENCIL_BACK_PASS_DEPTH_FAIL, &back.depthFail);
  gl.GetIntegerv(GL_STENCIL_BACK_PASS_DEPTH_PASS, &back.pass);

  gl.GenVertexArrays(1, &ownVertexArray_);
  gl.BindVertexArray(ownVertexArray_);
  for (const GLenum what : kOff) gl.Disable(what);
  gl.Enable(GL_MULTISAMPLE);
  gl.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

SavedDraw::~SavedDraw() {
  gl_.BindVertexArray(static_cast<GLuint>(vertexArray_));
  gl_.DeleteVertexArrays(1, &ownVertexArray_);
  for (std::size_t i = 0; i < kOff.size(); ++i) set(gl_, kOff[i], enabled_[i]);
  set(gl_, GL_MULTISAMPLE, multisample_);
  setIndexed(gl_, GL_BLEND, blend_);
  setIndexed(gl_, GL_SCISSOR_TEST, scissor_);
  gl_.BlendFuncSeparatei(0, static_cast<GLenum>(blendFunctions_[0]), static_cast<GLenum>(blendFunctions_[1]),
                         static_cast<GLenum>(blendFunctions_[2]), static_cast<GLenum>(blendFunctions_[3]));
  gl_.BlendEquationSeparatei(0, static_cast<GLenum>(blendEquations_[0]), static_cast<GLenum>(blendEquations_[1]));
  gl_.ColorMaski(0, colorMask_[0], colorMask_[1], colorMask_[2], colorMask_[3]);
  gl_.ViewportIndexedf(0, viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  gl_.ScissorIndexed(0, scissorBox_[0], scissorBox_[1], scissorBox_[2], scissorBox_[3]);
  gl_.PolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygonMode_[0]));
  constexpr std::array<GLenum, 2> kFaces = {GL_FRONT, GL_BACK};
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    const Stencil& face = stencil_[i];
    gl_.StencilFuncSeparate(kFaces[i], static_cast<GLenum>(face.func), face.reference, static_cast<GLuint>(face.mask));
    gl_.StencilOpSeparate(kFaces[i], static_cast<GLenum>(face.fail), static_cast<GLenum>(face.depthFail),
                          static_cast<GLenum>(face.pass));
  }
}

} // namespace vitrail
