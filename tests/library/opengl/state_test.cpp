// The state of the host's context: whatever it is before a call, it is the same after it, and the picture is right.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::opengl {
namespace {

// ---- What the state is

using Snapshot = std::map<std::string, std::vector<double>>;

struct Name {
  GLenum name;
  const char* text;
};
#define VITRAIL_NAMED(name) \
  Name { name, #name }

constexpr std::array kValues = {VITRAIL_NAMED(GL_CURRENT_PROGRAM),
                                VITRAIL_NAMED(GL_PROGRAM_PIPELINE_BINDING),
                                VITRAIL_NAMED(GL_VERTEX_ARRAY_BINDING),
                                VITRAIL_NAMED(GL_DRAW_INDIRECT_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_DISPATCH_INDIRECT_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_UNIFORM_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_SHADER_STORAGE_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_COPY_READ_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_COPY_WRITE_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_ARRAY_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_ELEMENT_ARRAY_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_PIXEL_PACK_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_PIXEL_UNPACK_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING),
                                VITRAIL_NAMED(GL_ACTIVE_TEXTURE),
                                VITRAIL_NAMED(GL_DRAW_FRAMEBUFFER_BINDING),
                                VITRAIL_NAMED(GL_READ_FRAMEBUFFER_BINDING),
                                VITRAIL_NAMED(GL_RENDERBUFFER_BINDING),
                                VITRAIL_NAMED(GL_DRAW_BUFFER),
                                VITRAIL_NAMED(GL_READ_BUFFER),
                                VITRAIL_NAMED(GL_DEPTH_FUNC),
                                VITRAIL_NAMED(GL_DEPTH_WRITEMASK),
                                VITRAIL_NAMED(GL_DEPTH_CLEAR_VALUE),
                                VITRAIL_NAMED(GL_COLOR_CLEAR_VALUE),
                                VITRAIL_NAMED(GL_STENCIL_CLEAR_VALUE),
                                VITRAIL_NAMED(GL_STENCIL_FUNC),
                                VITRAIL_NAMED(GL_STENCIL_REF),
                                VITRAIL_NAMED(GL_STENCIL_VALUE_MASK),
                                VITRAIL_NAMED(GL_STENCIL_FAIL),
                                VITRAIL_NAMED(GL_STENCIL_PASS_DEPTH_FAIL),
                                VITRAIL_NAMED(GL_STENCIL_PASS_DEPTH_PASS),
                                VITRAIL_NAMED(GL_STENCIL_WRITEMASK),
                                VITRAIL_NAMED(GL_STENCIL_BACK_FUNC),
                                VITRAIL_NAMED(GL_STENCIL_BACK_REF),
                                VITRAIL_NAMED(GL_STENCIL_BACK_VALUE_MASK),
                                VITRAIL_NAMED(GL_STENCIL_BACK_FAIL),
                                VITRAIL_NAMED(GL_STENCIL_BACK_PASS_DEPTH_FAIL),
                                VITRAIL_NAMED(GL_STENCIL_BACK_PASS_DEPTH_PASS),
                                VITRAIL_NAMED(GL_STENCIL_BACK_WRITEMASK),
                                VITRAIL_NAMED(GL_POLYGON_MODE),
                                VITRAIL_NAMED(GL_POLYGON_OFFSET_FACTOR),
                                VITRAIL_NAMED(GL_POLYGON_OFFSET_UNITS),
                                VITRAIL_NAMED(GL_CULL_FACE_MODE),
                                VITRAIL_NAMED(GL_FRONT_FACE),
                                VITRAIL_NAMED(GL_LOGIC_OP_MODE),
                                VITRAIL_NAMED(GL_SAMPLE_COVERAGE_VALUE),
                                VITRAIL_NAMED(GL_SAMPLE_COVERAGE_INVERT),
                                VITRAIL_NAMED(GL_MIN_SAMPLE_SHADING_VALUE),
                                VITRAIL_NAMED(GL_BLEND_COLOR),
                                VITRAIL_NAMED(GL_CLIP_ORIGIN),
                                VITRAIL_NAMED(GL_CLIP_DEPTH_MODE),
                                VITRAIL_NAMED(GL_PROVOKING_VERTEX),
                                VITRAIL_NAMED(GL_PRIMITIVE_RESTART_INDEX),
                                VITRAIL_NAMED(GL_POINT_SIZE),
                                VITRAIL_NAMED(GL_UNPACK_ALIGNMENT),
                                VITRAIL_NAMED(GL_UNPACK_ROW_LENGTH),
                                VITRAIL_NAMED(GL_UNPACK_IMAGE_HEIGHT),
                                VITRAIL_NAMED(GL_UNPACK_SKIP_PIXELS),
                                VITRAIL_NAMED(GL_UNPACK_SKIP_ROWS),
                                VITRAIL_NAMED(GL_UNPACK_SKIP_IMAGES),
                                VITRAIL_NAMED(GL_UNPACK_SWAP_BYTES),
                                VITRAIL_NAMED(GL_UNPACK_LSB_FIRST),
                                VITRAIL_NAMED(GL_PACK_ALIGNMENT),
                                VITRAIL_NAMED(GL_PACK_ROW_LENGTH),
                                VITRAIL_NAMED(GL_PACK_SKIP_PIXELS),
                                VITRAIL_NAMED(GL_PACK_SKIP_ROWS),
                                VITRAIL_NAMED(GL_PACK_SWAP_BYTES)};

// Every one is on in a hostile context, but those that are on by default, which are off.
constexpr std::array kSwitches = {VITRAIL_NAMED(GL_DEPTH_TEST),          VITRAIL_NAMED(GL_STENCIL_TEST),
                                  VITRAIL_NAMED(GL_CULL_FACE),           VITRAIL_NAMED(GL_RASTERIZER_DISCARD),
                                  VITRAIL_NAMED(GL_COLOR_LOGIC_OP),      VITRAIL_NAMED(GL_SAMPLE_MASK),
                                  VITRAIL_NAMED(GL_SAMPLE_COVERAGE),     VITRAIL_NAMED(GL_SAMPLE_SHADING),
                                  VITRAIL_NAMED(GL_SAMPLE_ALPHA_TO_ONE), VITRAIL_NAMED(GL_SAMPLE_ALPHA_TO_COVERAGE),
                                  VITRAIL_NAMED(GL_CLIP_DISTANCE0),      VITRAIL_NAMED(GL_CLIP_DISTANCE1),
                                  VITRAIL_NAMED(GL_CLIP_DISTANCE2),      VITRAIL_NAMED(GL_CLIP_DISTANCE3),
                                  VITRAIL_NAMED(GL_CLIP_DISTANCE4),      VITRAIL_NAMED(GL_CLIP_DISTANCE5),
                                  VITRAIL_NAMED(GL_CLIP_DISTANCE6),      VITRAIL_NAMED(GL_CLIP_DISTANCE7),
                                  VITRAIL_NAMED(GL_MULTISAMPLE),         VITRAIL_NAMED(GL_DITHER),
                                  VITRAIL_NAMED(GL_FRAMEBUFFER_SRGB),    VITRAIL_NAMED(GL_DEPTH_CLAMP),
                                  VITRAIL_NAMED(GL_POLYGON_OFFSET_FILL), VITRAIL_NAMED(GL_PRIMITIVE_RESTART),
                                  VITRAIL_NAMED(GL_PROGRAM_POINT_SIZE),  VITRAIL_NAMED(GL_TEXTURE_CUBE_MAP_SEAMLESS)};

bool isOnByDefault(GLenum name) { return name == GL_MULTISAMPLE || name == GL_DITHER; }

constexpr GLuint kBuffers = 8; // binding points of uniform and storage buffers
constexpr GLuint kUnits = 4;   // of textures and of images
constexpr GLuint kPlanes = 3;  // draw buffers and viewports
constexpr GLuint kNoIndex = 99;

class Taker {
 public:
  Snapshot take() {
    for (const Name& one : kValues) { // not as index 0: some have indexed values of the same name
      std::vector<double>& values = at(one.text, kNoIndex, 4);
      glGetDoublev(one.name, values.data());
    }
    for (const Name& one : kSwitches) at(one.text, 0, 1)[0] = glIsEnabled(one.name);
    takePlanes();
    takeBuffers();
    takeUnits();
    takeVertices();
    return snapshot_;
  }

 private:
  std::vector<double>& at(const char* text, GLuint index, std::size_t count) {
    std::vector<double>& values = snapshot_[text + std::string(" ") + std::to_string(index)];
    values.resize(count);
    return values;
  }
  void integer(const Name& one, GLuint index) {
    std::array<GLint, 4> got{};
    glGetIntegeri_v(one.name, index, got.data());
    at(one.text, index, 4).assign(got.begin(), got.end());
  }
  void takePlanes() {
    for (GLuint i = 0; i < kPlanes; ++i) {
      at("blend", i, 1)[0] = glIsEnabledi(GL_BLEND, i);
      at("scissor test", i, 1)[0] = glIsEnabledi(GL_SCISSOR_TEST, i);
      for (const Name& one :
           {VITRAIL_NAMED(GL_BLEND_SRC_RGB), VITRAIL_NAMED(GL_BLEND_SRC_ALPHA), VITRAIL_NAMED(GL_BLEND_DST_RGB),
            VITRAIL_NAMED(GL_BLEND_DST_ALPHA), VITRAIL_NAMED(GL_BLEND_EQUATION_RGB),
            VITRAIL_NAMED(GL_BLEND_EQUATION_ALPHA), VITRAIL_NAMED(GL_SCISSOR_BOX)}) {
        integer(one, i);
      }
      std::array<GLboolean, 4> mask{};
      glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask.data());
      at("colour mask", i, 4).assign(mask.begin(), mask.end());
      glGetDoublei_v(GL_VIEWPORT, i, at("viewport", i, 4).data());
      glGetDoublei_v(GL_DEPTH_RANGE, i, at("depth range", i, 2).data());
    }
    integer(VITRAIL_NAMED(GL_SAMPLE_MASK_VALUE), 0);
  }
  void takeBuffers() {
    for (GLuint i = 0; i < kBuffers; ++i) {
      integer(VITRAIL_NAMED(GL_UNIFORM_BUFFER_BINDING), i);
      integer(VITRAIL_NAMED(GL_SHADER_STORAGE_BUFFER_BINDING), i);
      for (const Name& one :
           {VITRAIL_NAMED(GL_UNIFORM_BUFFER_START), VITRAIL_NAMED(GL_UNIFORM_BUFFER_SIZE),
            VITRAIL_NAMED(GL_SHADER_STORAGE_BUFFER_START), VITRAIL_NAMED(GL_SHADER_STORAGE_BUFFER_SIZE)}) {
        GLint64 value = 0;
        glGetInteger64i_v(one.name, i, &value);
        at(one.text, i, 1)[0] = static_cast<double>(value);
      }
    }
  }
  void takeUnits() {
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (GLuint i = 0; i < kUnits; ++i) {
      for (const Name& one : {VITRAIL_NAMED(GL_IMAGE_BINDING_NAME), VITRAIL_NAMED(GL_IMAGE_BINDING_LEVEL),
                              VITRAIL_NAMED(GL_IMAGE_BINDING_LAYERED), VITRAIL_NAMED(GL_IMAGE_BINDING_LAYER),
                              VITRAIL_NAMED(GL_IMAGE_BINDING_ACCESS), VITRAIL_NAMED(GL_IMAGE_BINDING_FORMAT)}) {
        integer(one, i);
      }
      glActiveTexture(GL_TEXTURE0 + i);
      for (const Name& one : {VITRAIL_NAMED(GL_TEXTURE_BINDING_2D), VITRAIL_NAMED(GL_TEXTURE_BINDING_2D_ARRAY),
                              VITRAIL_NAMED(GL_TEXTURE_BINDING_2D_MULTISAMPLE), VITRAIL_NAMED(GL_SAMPLER_BINDING)}) {
        glGetDoublev(one.name, at(one.text, i, 1).data());
      }
    }
    glActiveTexture(static_cast<GLenum>(active));
  }
  void takeVertices() {
    for (GLuint i = 0; i < kUnits; ++i) {
      for (const Name& one : {VITRAIL_NAMED(GL_VERTEX_ATTRIB_ARRAY_ENABLED), VITRAIL_NAMED(GL_VERTEX_ATTRIB_ARRAY_SIZE),
                              VITRAIL_NAMED(GL_VERTEX_ATTRIB_ARRAY_TYPE), VITRAIL_NAMED(GL_VERTEX_ATTRIB_ARRAY_STRIDE),
                              VITRAIL_NAMED(GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING)}) {
        glGetVertexAttribdv(i, one.name, at(one.text, i, 1).data());
      }
    }
  }

  Snapshot snapshot_;
};

void expectSame(const Snapshot& before, const Snapshot& after, const char* call) {
  for (const auto& [name, values] : before) {
    EXPECT_EQ(values, after.at(name)) << name << " is changed by " << call;
  }
}

// ---- What it could be

// Objects of a host that has left everything on, and bound, and set to what nobody would expect.
class Hostile {
 public:
  Hostile() {
    glGenBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
    for (const GLuint buffer : buffers_) {
      glBindBuffer(GL_ARRAY_BUFFER, buffer);
      glBufferData(GL_ARRAY_BUFFER, 1 << 16, nullptr, GL_STATIC_DRAW);
    }
    glGenVertexArrays(1, &vertexArray_);
    glBindVertexArray(vertexArray_);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 28, nullptr);
    glEnableVertexAttribArray(1);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[7]);
    glGenTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
    for (std::size_t i = 0; i < kUnits; ++i) {
      glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, textures_[i]);
      glTexStorage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGBA8, 4, 4, GL_TRUE);
      glBindTexture(GL_TEXTURE_2D, textures_[kUnits + i]);
      glTexStorage2D(GL_TEXTURE_2D, 2, GL_RGBA8, 4, 4);
      glBindTexture(GL_TEXTURE_2D_ARRAY, textures_[2 * kUnits + i]);
      glTexStorage3D(GL_TEXTURE_2D_ARRAY, 3, GL_RG32UI, 4, 4, 5);
    }
    glGenSamplers(static_cast<GLsizei>(samplers_.size()), samplers_.data());
    for (const GLuint sampler : samplers_) {
      glSamplerParameteri(sampler, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
      glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
      glSamplerParameterf(sampler, GL_TEXTURE_MIN_LOD, 3.0F);
    }
    glGenProgramPipelines(1, &pipeline_);
    glGenRenderbuffers(1, &renderbuffer_);
    program_ = backend().program("#version 430 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n", "");
  }
  ~Hostile() {
    calm();
    glDeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
    glDeleteVertexArrays(1, &vertexArray_);
    glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
    glDeleteSamplers(static_cast<GLsizei>(samplers_.size()), samplers_.data());
    glDeleteProgramPipelines(1, &pipeline_);
    glDeleteRenderbuffers(1, &renderbuffer_);
  }
  Hostile(const Hostile&) = delete;
  Hostile& operator=(const Hostile&) = delete;

  void set() const {
    for (const Name& one : kSwitches) turn(one.name, !isOnByDefault(one.name));
    setBindings();
    setUnits();
    setPlanes();
    glDepthFunc(GL_NEVER);
    glDepthMask(GL_FALSE);
    glStencilFuncSeparate(GL_FRONT, GL_NEVER, 3, 0x0f);
    glStencilOpSeparate(GL_FRONT, GL_INVERT, GL_ZERO, GL_REPLACE);
    glStencilFuncSeparate(GL_BACK, GL_LESS, 5, 0x70);
    glStencilOpSeparate(GL_BACK, GL_ZERO, GL_INCR, GL_DECR_WRAP);
    glStencilMaskSeparate(GL_FRONT, 0x11);
    glStencilMaskSeparate(GL_BACK, 0x22);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glPolygonOffset(3.0F, 4.0F);
    glCullFace(GL_FRONT_AND_BACK);
    glFrontFace(GL_CW);
    glLogicOp(GL_INVERT);
    glSampleCoverage(0.0F, GL_FALSE);
    glSampleMaski(0, 0);
    glMinSampleShading(0.75F);
    glBlendColor(0.1F, 0.2F, 0.3F, 0.4F);
    glClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
    glPrimitiveRestartIndex(0);
    glPointSize(5.0F);
    glClearColor(0.5F, 0.25F, 0.125F, 1.0F);
    glClearDepth(0.25);
    glClearStencil(9);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 3);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 2);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 2);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 5);
    glPixelStorei(GL_UNPACK_SKIP_IMAGES, 1);
    glPixelStorei(GL_UNPACK_SWAP_BYTES, GL_TRUE);
    glPixelStorei(GL_UNPACK_LSB_FIRST, GL_TRUE);
    glPixelStorei(GL_PACK_ALIGNMENT, 2);
    glPixelStorei(GL_PACK_ROW_LENGTH, 7);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 1);
    glPixelStorei(GL_PACK_SKIP_ROWS, 1);
    glPixelStorei(GL_PACK_SWAP_BYTES, GL_TRUE);
  }

  // What the tests' host takes for granted.
  static void calm() {
    for (const Name& one : kSwitches) turn(one.name, isOnByDefault(one.name));
    glUseProgram(0);
    glBindProgramPipeline(0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    for (GLuint i = 0; i < kUnits; ++i) glBindSampler(i, 0);
    glActiveTexture(GL_TEXTURE0);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthRange(0.0, 1.0);
    glDepthMask(GL_TRUE);
    glStencilMask(0xff);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glSampleMaski(0, 0xffffffffU);
    glPointSize(1.0F);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    for (const GLenum name : {GL_UNPACK_ALIGNMENT, GL_PACK_ALIGNMENT}) glPixelStorei(name, 4);
    for (const GLenum name : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS,
                              GL_UNPACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_PACK_ROW_LENGTH,
                              GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS, GL_PACK_SWAP_BYTES}) {
      glPixelStorei(name, 0);
    }
  }

 private:
  static void turn(GLenum name, bool on) { on ? glEnable(name) : glDisable(name); }

  void setBindings() const {
    glUseProgram(program_);
    glBindProgramPipeline(pipeline_);
    glBindVertexArray(vertexArray_);
    for (GLuint i = 0; i < kBuffers; ++i) {
      if (i == 6) { // all of it
        glBindBufferBase(GL_UNIFORM_BUFFER, i, buffers_[i]);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers_[i]);
      } else if (i == 7) {
        glBindBufferBase(GL_UNIFORM_BUFFER, i, 0);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, 0);
      } else {
        glBindBufferRange(GL_UNIFORM_BUFFER, i, buffers_[i], 256 * (i + 1), 1024 + 16 * i);
        glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, buffers_[i], 512 * (i + 1), 2048 + 16 * i);
      }
    }
    constexpr std::array kTargets = {GL_UNIFORM_BUFFER,   GL_SHADER_STORAGE_BUFFER, GL_DRAW_INDIRECT_BUFFER,
                                     GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER,     GL_DISPATCH_INDIRECT_BUFFER,
                                     GL_ARRAY_BUFFER,     GL_PIXEL_UNPACK_BUFFER};
    for (std::size_t i = 0; i < kTargets.size(); ++i)
      glBindBuffer(kTargets[i], buffers_[7 - i]); // not those of index 0
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers_[6]);
    glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffers_[5]);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer_);
  }
  void setUnits() const {
    for (GLuint i = 0; i < kUnits; ++i) {
      glActiveTexture(GL_TEXTURE0 + i);
      glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, textures_[i]);
      glBindTexture(GL_TEXTURE_2D, textures_[kUnits + i]);
      glBindTexture(GL_TEXTURE_2D_ARRAY, textures_[2 * kUnits + i]);
      glBindSampler(i, samplers_[i]);
      glBindImageTexture(i, textures_[2 * kUnits + i], 2, GL_FALSE, static_cast<GLint>(1 + i), GL_WRITE_ONLY,
                         GL_RG32UI);
    }
    glActiveTexture(GL_TEXTURE3);
  }
  static void setPlanes() {
    for (GLuint i = 0; i < kPlanes; ++i) {
      glEnablei(GL_BLEND, i);
      glEnablei(GL_SCISSOR_TEST, i);
      glBlendFuncSeparatei(i, GL_DST_ALPHA, GL_ZERO, GL_CONSTANT_COLOR, GL_SRC_ALPHA_SATURATE);
      glBlendEquationSeparatei(i, GL_MIN, GL_FUNC_REVERSE_SUBTRACT);
      glColorMaski(i, GL_FALSE, i == 0 ? GL_TRUE : GL_FALSE, GL_FALSE, GL_FALSE);
      const auto at = static_cast<GLint>(i);
      glScissorIndexed(i, 1 + at, 2, 1, 2 + at);
      glViewportIndexedf(i, 0.5F + static_cast<GLfloat>(i), 1.25F, 3.5F, 2.5F);
      glDepthRangeIndexed(i, 0.75, 0.5);
    }
  }

  std::array<GLuint, kBuffers> buffers_{};
  std::array<GLuint, 3 * std::size_t{kUnits}> textures_{};
  std::array<GLuint, kUnits> samplers_{};
  GLuint vertexArray_ = 0;
  GLuint pipeline_ = 0;
  GLuint renderbuffer_ = 0;
  GLuint program_ = 0;
};

// In a context of its own, whose state goes with it.
class StateTest : public OpenGlTest {
 protected:
  void SetUp() override {
    OpenGlTest::SetUp();
    backend().context();
    egl_ = std::make_unique<EglContext>(&backend().egl());
    backend().listen();
    hostile_ = std::make_unique<Hostile>();
  }
  void TearDown() override {
    hostile_.reset();
    egl_.reset();
    backend().egl().makeCurrent();
    OpenGlTest::TearDown();
  }

  // Calls in a hostile state, with that framebuffer bound, and looks at what the state is then.
  void check(const char* name, GLuint framebuffer, const std::function<void()>& call, const char* but = nullptr) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    hostile_->set();
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << "before " << name;
    Snapshot before = Taker().take();
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << "before " << name;
    call();
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << name;
    if (but != nullptr) {
      std::erase_if(before, [&](const auto& one) { return one.first.find(but) != std::string::npos; });
    }
    expectSame(before, Taker().take(), name);
    Hostile::calm();
  }

  // A frame, each call of it in a hostile state.
  void checkFrame(const HostDesc& desc, const std::vector<Point>& points, GLuint copied) {
    OpenGlHost host(backend(), desc);
    VitrailGlTarget target = host.target();
    PointTextures& textures = host.texturesOf(0);
    const bool perPixel = desc.samples > 1 && desc.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL;
    const GLuint into = perPixel ? textures.resolved : textures.drawn;
    host.drawOpaque(textures);
    check("vitrailGlUpdateTarget", into, [&] { vitrailGlUpdateTarget(target, 0); });
    check("vitrailGlBegin", into, [&] { vitrailGlBegin(target, nullptr); });
    host.drawOpaque(textures); // for its viewport
    host.drawPoints(textures, points);
    check(
        "vitrailGlBind", into, [&] { vitrailGlBind(target); }, "_BUFFER_");
    check("vitrailGlCollected", into, [&] { vitrailGlCollected(target); });
    if (desc.copyLayers != 0) {
      VitrailGlCopyInfo info{};
      info.area = {0, 0, 8, 8};
      info.buffer = copied;
      info.size = vitrailGlCopySize(target, 8, 8);
      check("vitrailGlCopyLists", into, [&] { vitrailGlCopyLists(target, &info); });
    }
    check("vitrailGlResolve", into, [&] { vitrailGlResolve(target, nullptr); });
    check("vitrailGlEnd", into, [&] { vitrailGlEnd(target); });
    const PointResult result = host.read(textures, 0);
    EXPECT_EQ(result.stats.complete, 1U);
    if (desc.resolve != VITRAIL_RESOLVE_HOST) {
      EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kTolerance);
    }
    VitrailStats stats{};
    check("vitrailGlReadStats", into, [&] { vitrailGlReadStats(target, 0, &stats); });
  }

 private:
  std::unique_ptr<EglContext> egl_;
  std::unique_ptr<Hostile> hostile_;
};

TEST_F(StateTest, EveryCallOfAFrameLeavesWhatItFinds) {
  GLuint copied = 0;
  glGenBuffers(1, &copied);
  glBindBuffer(GL_COPY_WRITE_BUFFER, copied);
  glBufferData(GL_COPY_WRITE_BUFFER, 1 << 20, nullptr, GL_DYNAMIC_READ);
  std::vector<std::uint32_t> counts = sampleCounts(backend().features());
  if (counts.size() > 2) counts = {1, 4};
  for (const std::uint32_t samples : counts) {
    for (const Way& way : everyWay(backend().features(), samples)) {
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc;
      desc.samples = samples;
      desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
      desc.postDepthCoverage = samples == 1; // else the resolve looks at the depth as well
      desc.copyLayers = 2000;
      apply(way, desc);
      const std::vector<Point> points = randomLists(desc, {0, 1, 5, 17, 33, 70, 300}, 4);
      desc.capacity = static_cast<std::uint32_t>(points.size());
      checkFrame(desc, points, copied);
    }
  }
  glDeleteBuffers(1, &copied);
}

// The first of their kind, so that programs are compiled; with a pool that grows, and another size.
TEST_F(StateTest, MakingAndDestroyingLeaveWhatTheyFind) {
  VitrailGlContext context = nullptr;
  const VitrailGlContextDesc contextDesc = backend().contextDesc();
  check("vitrailGlCreateContext", 0,
        [&] { EXPECT_EQ(vitrailGlCreateContext(&contextDesc, &context), VITRAIL_SUCCESS); });
  for (const VitrailResolve resolve : {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT}) {
    HostDesc textureDesc;
    PointTextures textures(textureDesc);
    VitrailGlTargetDesc desc{};
    desc.width = 8;
    desc.height = 8;
    desc.resolve = resolve;
    desc.nodeCapacity = 10;
    desc.memoryBudget = 1 << 20;
    desc.colorFormat = GL_RGBA32F;
    if (resolve == VITRAIL_RESOLVE_COMPUTE) {
      desc.textures.count = 1;
      desc.textures.color = &textures.color;
    }
    VitrailGlTarget target = nullptr;
    check("vitrailGlCreateTarget", textures.drawn,
          [&] { EXPECT_EQ(vitrailGlCreateTarget(context, &desc, &target), VITRAIL_SUCCESS); });
    VitrailGlResizeInfo resize{};
    resize.width = 8;
    resize.height = 4;
    resize.textures = desc.textures;
    check("vitrailGlResizeTarget", textures.drawn,
          [&] { EXPECT_EQ(vitrailGlResizeTarget(target, &resize), VITRAIL_SUCCESS); });
    check("a frame, destroyed while it is in flight", textures.drawn, [&] {
      vitrailGlBegin(target, nullptr);
      vitrailGlCollected(target);
      vitrailGlResolve(target, nullptr);
      vitrailGlEnd(target);
      vitrailGlDestroyTarget(target);
    });
  }
  check("vitrailGlDestroyContext", 0, [&] { vitrailGlDestroyContext(context); });
}

// A target with a memory budget gets a larger pool, between frames.
// OpenGL keeps a program that was deleted only as long as it is current: there is none to put back, and no error.
TEST_F(StateTest, ADeletedProgramIsLetGo) {
  HostDesc desc;
  desc.capacity = 16;
  OpenGlHost host(backend(), desc);
  const GLuint program = glCreateProgram();
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  const char* text = "#version 430\nlayout(local_size_x = 1) in;\nvoid main() {}\n";
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glDeleteShader(shader);
  glLinkProgram(program);
  glUseProgram(program);
  glDeleteProgram(program);
  VitrailGlBeginInfo info{};
  info.frame = 1;
  vitrailGlBegin(host.target(), &info);
  GLint current = -1;
  glGetIntegerv(GL_CURRENT_PROGRAM, &current);
  EXPECT_EQ(current, 0);
  vitrailGlCollected(host.target());
  vitrailGlResolve(host.target(), nullptr);
  vitrailGlEnd(host.target());
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_F(StateTest, APoolThatGrowsLeavesWhatItFinds) {
  HostDesc desc;
  desc.capacity = 16;
  desc.memoryBudget = 1 << 20;
  OpenGlHost host(backend(), desc);
  const std::vector<Point> points = randomLists(desc, {200, 100}, 4);
  host.draw(points);
  const std::uint32_t before = host.memory().nodeCapacity;
  check("vitrailGlUpdateTarget", host.texturesOf(0).drawn, [&] { vitrailGlUpdateTarget(host.target(), 1); });
  EXPECT_GT(host.memory().nodeCapacity, before);
}

} // namespace
} // namespace vitrail::tests::opengl
