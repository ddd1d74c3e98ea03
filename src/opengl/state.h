// Puts back what a call changes of the host's state.
#pragma once

#include <array>

#include "functions.h"
#include "vitrail/bindings.h"

namespace vitrail {

// The two generic bindings that copies and clears go through.
class SavedCopies {
 public:
  explicit SavedCopies(const GlFunctions& gl);
  ~SavedCopies();
  SavedCopies(const SavedCopies&) = delete;
  SavedCopies& operator=(const SavedCopies&) = delete;

 private:
  const GlFunctions& gl_;
  GLint read_ = 0;
  GLint write_ = 0;
};

// How pixels are unpacked, which drivers (Mesa) heed for the value of a clear.
class SavedUnpacking {
 public:
  explicit SavedUnpacking(const GlFunctions& gl);
  ~SavedUnpacking();
  SavedUnpacking(const SavedUnpacking&) = delete;
  SavedUnpacking& operator=(const SavedUnpacking&) = delete;

 private:
  const GlFunctions& gl_;
  GLint buffer_ = 0;
  GLint skipPixels_ = 0;
  GLint skipRows_ = 0;
};

// Program, buffer and indirect bindings of a pass that runs shaders, and with `images` those of a resolve's pictures.
class SavedShaders {
 public:
  SavedShaders(const GlFunctions& gl, GLenum indirect, bool images);
  ~SavedShaders();
  SavedShaders(const SavedShaders&) = delete;
  SavedShaders& operator=(const SavedShaders&) = delete;

 private:
  // An indexed binding of a buffer.
  struct Range {
    GLint buffer = 0;
    GLint64 offset = 0;
    GLint64 size = 0;
  };
  void saveRange(GLenum target, GLuint index, Range& range);
  void restoreRange(GLenum target, GLuint index, const Range& range);

  const GlFunctions& gl_;
  GLenum indirectTarget_;
  bool images_;
  GLint program_ = 0;
  GLint indirect_ = 0;
  GLint uniform_ = 0;
  GLint storage_ = 0;
  std::array<Range, VITRAIL_BINDINGS> ranges_;
  struct Image {
    GLint name = 0;
    GLint level = 0;
    GLboolean layered = GL_FALSE;
    GLint layer = 0;
    GLint access = 0;
    GLint format = 0;
  } image_;
  GLint activeTexture_ = 0;
  std::array<GLint, VITRAIL_VIEW_BINDINGS> textures_{}; // GL_TEXTURE_BINDING_2D_MULTISAMPLE of the units
  std::array<GLint, VITRAIL_VIEW_BINDINGS> samplers_{}; // which say how others would be read
};

// What a full-screen triangle sets beside those.
class SavedDraw {
 public:
  explicit SavedDraw(const GlFunctions& gl);
  ~SavedDraw();
  SavedDraw(const SavedDraw&) = delete;
  SavedDraw& operator=(const SavedDraw&) = delete;

  // What is off while the triangle is drawn. (Blending, scissor and stencil test are set by the draw.)
  static constexpr std::array kOff = {
      GLenum{GL_DEPTH_TEST},       GLenum{GL_CULL_FACE},           GLenum{GL_RASTERIZER_DISCARD},
      GLenum{GL_COLOR_LOGIC_OP},   GLenum{GL_SAMPLE_MASK},         GLenum{GL_SAMPLE_COVERAGE},
      GLenum{GL_SAMPLE_SHADING},   GLenum{GL_CLIP_DISTANCE0},      GLenum{GL_CLIP_DISTANCE1},
      GLenum{GL_CLIP_DISTANCE2},   GLenum{GL_CLIP_DISTANCE3},      GLenum{GL_CLIP_DISTANCE4},
      GLenum{GL_CLIP_DISTANCE5},   GLenum{GL_CLIP_DISTANCE6},      GLenum{GL_CLIP_DISTANCE7},
      GLenum{GL_STENCIL_TEST},     GLenum{GL_SAMPLE_ALPHA_TO_ONE}, GLenum{GL_SAMPLE_ALPHA_TO_COVERAGE},
      GLenum{GL_PRIMITIVE_RESTART}}; // which some drivers heed without indices, too

 private:
  struct Stencil {
    GLint func = 0;
    GLint reference = 0;
    GLint mask = 0;
    GLint fail = 0;
    GLint depthFail = 0;
    GLint pass = 0;
  };

  const GlFunctions& gl_;
  GLint vertexArray_ = 0;
  GLuint ownVertexArray_ = 0; // core profiles draw with none; contexts do not share them
  std::array<GLboolean, kOff.size()> enabled_{};
  GLboolean multisample_ = GL_TRUE;
  GLboolean blend_ = GL_FALSE;
  GLboolean scissor_ = GL_FALSE;
  std::array<GLint, 4> blendFunctions_{};
  std::array<GLint, 2> blendEquations_{};
  std::array<GLboolean, 4> colorMask_{};
  std::array<GLfloat, 4> viewport_{};
  std::array<GLint, 4> scissorBox_{};
  std::array<GLint, 2> polygonMode_{};
  std::array<Stencil, 2> stencil_; // front, back
};

} // namespace vitrail
