#include "backend.h"

#include <algorithm>
#include <array>
#include <utility>

#include "point_host.h"

namespace vitrail::tests::opengl {

namespace {

const Registered<OpenGlBackend> registered;

EGLDisplay openDisplay() {
  // Of a GPU's driver where there is one (EGL_EXT_platform_device), else Mesa's own.
  std::array<EGLDeviceEXT, 8> devices{};
  EGLint count = 0;
  EGLDisplay display = EGL_NO_DISPLAY;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
      eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE && count > 0) {
    display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[0], nullptr);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE) return display;
  }
  display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    throw HostError("EGL has no display without a window: install libegl-mesa0");
  }
  return display;
}

GLuint compile(GLenum stage, const std::string& text) {
  const GLuint shader = glCreateShader(stage);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_FALSE) {
    std::array<char, 1024> said{};
    glGetShaderInfoLog(shader, said.size(), nullptr, said.data());
    throw HostError(std::string("a shader of the tests: ") + said.data());
  }
  return shader;
}

} // namespace

EglContext::EglContext(const EglContext* share) {
  display_ = share != nullptr ? share->display_ : openDisplay();
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) throw HostError("EGL has no OpenGL");
  constexpr std::array<EGLint, 9> kAttributes = {EGL_CONTEXT_MAJOR_VERSION,
                                                 4,
                                                 EGL_CONTEXT_MINOR_VERSION,
                                                 5, // for glClipControl() of the tests; the library asks for 4.3
                                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                 EGL_CONTEXT_OPENGL_DEBUG,
                                                 EGL_TRUE,
                                                 EGL_NONE};
  context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, share != nullptr ? share->context_ : EGL_NO_CONTEXT,
                              kAttributes.data());
  if (context_ == EGL_NO_CONTEXT) throw HostError("EGL makes no context for OpenGL 4.5");
  makeCurrent();
}

EglContext::~EglContext() {
  if (eglGetCurrentContext() == context_) makeNoneCurrent();
  eglDestroyContext(display_, context_);
}

void EglContext::makeCurrent() const {
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
    throw HostError("EGL does not make a context current");
  }
}

void EglContext::makeNoneCurrent() {
  eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void OpenGlBackend::listen() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(
      [](GLenum, GLenum type, GLuint, GLenum severity, GLsizei, const GLchar* text, const void* self) {
        const bool wrong = type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR ||
                           (type != GL_DEBUG_TYPE_PERFORMANCE &&
                            (severity == GL_DEBUG_SEVERITY_HIGH || severity == GL_DEBUG_SEVERITY_MEDIUM));
        auto* backend = static_cast<OpenGlBackend*>(const_cast<void*>(self));
        if (wrong) backend->messages_.emplace_back(std::string("KHR_debug: ") + text);
      },
      this);
}

void OpenGlBackend::open() {
  if (egl_) return;
  egl_ = std::make_unique<EglContext>();
  listen();
  features_.dualSourceBlending = true;
  features_.sampleRateShading = true;
  features_.postDepthCoverage = epoxy_has_gl_extension("GL_ARB_post_depth_coverage");
  features_.stencil = true;
  features_.uncutLayers = 14000; // Mesa makes other loops of GLSL than of SPIR-V
  GLint64 block = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
  features_.bindingBytes = static_cast<std::uint64_t>(block);
  std::array<GLint, 16> samples{};
  glGetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, GL_RGBA32F, GL_SAMPLES, samples.size(), samples.data());
  for (const std::uint32_t count : {2U, 4U, 8U}) {
    if (std::find(samples.begin(), samples.end(), static_cast<GLint>(count)) != samples.end()) {
      features_.multisampled.push_back(count);
    }
  }
}

const Features& OpenGlBackend::features() {
  open();
  return features_;
}

VitrailGlContextDesc OpenGlBackend::contextDesc() {
  open();
  VitrailGlContextDesc desc{};
  desc.getProcAddress = [](const char* name, void*) { return reinterpret_cast<void*>(eglGetProcAddress(name)); };
  desc.log = [](VitrailLogSeverity severity, const char* message, void* self) {
    static_cast<OpenGlBackend*>(self)->log_.push_back({severity, message});
  };
  desc.logUser = this;
  return desc;
}

VitrailGlContext OpenGlBackend::context() {
  if (context_ != nullptr) return context_;
  const VitrailGlContextDesc desc = contextDesc();
  if (vitrailGlCreateContext(&desc, &context_) != VITRAIL_SUCCESS) throw HostError("vitrailGlCreateContext");
  return context_;
}

std::unique_ptr<PointHost> OpenGlBackend::makeHost(const HostDesc& desc) {
  open();
  return std::make_unique<OpenGlHost>(*this, desc);
}

VitrailTileLimits OpenGlBackend::tileLimits(VitrailNodeFormat format, std::uint32_t samples) {
  VitrailTileLimits limits{};
  if (vitrailGlTileLimits(context(), format, samples, &limits) != VITRAIL_SUCCESS) {
    throw HostError("vitrailGlTileLimits");
  }
  return limits;
}

std::vector<LogLine> OpenGlBackend::takeLog() { return std::exchange(log_, {}); }

std::vector<std::string> OpenGlBackend::takeErrors() {
  std::vector<std::string> errors = std::exchange(messages_, {});
  for (const LogLine& line : takeLog()) errors.push_back("the library's log: " + line.text);
  return errors;
}

void OpenGlBackend::close() {
  if (!egl_) return;
  for (const auto& [text, program] : programs_) glDeleteProgram(program);
  programs_.clear();
  vitrailGlDestroyContext(std::exchange(context_, nullptr));
  egl_.reset();
}

GLuint OpenGlBackend::program(const std::string& first, const std::string& fragment) {
  GLuint& kept = programs_[first + fragment];
  if (kept != 0) return kept;
  const GLuint made = glCreateProgram();
  const GLuint firstShader = compile(fragment.empty() ? GL_COMPUTE_SHADER : GL_VERTEX_SHADER, first);
  glAttachShader(made, firstShader);
  glDeleteShader(firstShader);
  if (!fragment.empty()) {
    const GLuint fragmentShader = compile(GL_FRAGMENT_SHADER, fragment);
    glAttachShader(made, fragmentShader);
    glDeleteShader(fragmentShader);
  }
  glLinkProgram(made);
  GLint linked = GL_FALSE;
  glGetProgramiv(made, GL_LINK_STATUS, &linked);
  if (linked == GL_FALSE) {
    std::array<char, 1024> said{};
    glGetProgramInfoLog(made, said.size(), nullptr, said.data());
    throw HostError(std::string("a program of the tests: ") + said.data());
  }
  kept = made;
  return kept;
}

OpenGlBackend& backend() { return Registered<OpenGlBackend>::get(); }

void OpenGlTest::SetUp() { backend().features(); }

void OpenGlTest::TearDown() {
  for (const std::string& error : backend().takeErrors()) ADD_FAILURE() << error;
}

} // namespace vitrail::tests::opengl
