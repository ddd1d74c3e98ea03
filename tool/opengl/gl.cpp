#include "gl.h"

#include <dlfcn.h>
#include <epoxy/egl.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

constexpr const char* kInstall = "install libegl1, libegl-mesa0 and libgl1-mesa-dri, or the GPU's driver";

// libepoxy ends the program where the library is missing.
void requireEgl() {
  for (const char* library : {"libEGL.so.1", "libGL.so.1", "libOpenGL.so.0"}) {
    void* handle = ::dlopen(library, RTLD_LAZY);
    if (handle != nullptr) ::dlclose(handle);
    if (std::string_view(library) == "libEGL.so.1" && handle == nullptr) {
      throw GpuError(fmt::format("--api opengl needs EGL, which is not there: {}", kInstall));
    }
    if (std::string_view(library) != "libEGL.so.1" && handle != nullptr) return;
  }
  throw GpuError(fmt::format("--api opengl needs OpenGL, which is not there: {}", kInstall));
}

std::vector<EGLDeviceEXT> eglDevices() {
  requireEgl();
  ::setenv("EGL_LOG_LEVEL", "fatal", 0); // Mesa prints what it cannot open
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base")) {
    throw GpuError(fmt::format("EGL has no driver here that lists devices (EGL_EXT_device_enumeration): {}", kInstall));
  }
  std::array<EGLDeviceEXT, 64> devices{};
  EGLint count = 0;
  if (eglQueryDevicesEXT(devices.size(), devices.data(), &count) != EGL_TRUE || count == 0) {
    throw GpuError(fmt::format("EGL finds no device: {}", kInstall));
  }
  return std::vector<EGLDeviceEXT>(devices.begin(), devices.begin() + count); // braces would list two pointers
}

bool isSoftware(EGLDeviceEXT device) {
  const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
  return extensions != nullptr &&
         std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos;
}

std::string textOf(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text != nullptr ? text : "";
}

GLint integerOf(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

bool contains(std::string_view text, std::string_view part) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return std::ranges::search(text, part, same).begin() != text.end();
}

void GLAPIENTRY onMessage(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity, GLsizei /*length*/,
                          const GLchar* message, const void* user) {
  const bool counts = severity == GL_DEBUG_SEVERITY_HIGH || severity == GL_DEBUG_SEVERITY_MEDIUM;
  if (!counts || type == GL_DEBUG_TYPE_PERFORMANCE) return;
  static_cast<std::vector<std::string>*>(const_cast<void*>(user))->emplace_back(message);
}

} // namespace

struct GlContext {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::vector<std::string> messages;

  // Throws GpuError; what() is what the device lacks, in words.
  GlContext(EGLDeviceEXT device, bool debug);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
};

GlContext::GlContext(EGLDeviceEXT device, bool debug) {
  display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    throw GpuError("a driver that EGL can open");
  }
  eglBindAPI(EGL_OPENGL_API);
  const EGLint wanted[] = {
      EGL_CONTEXT_MAJOR_VERSION,    4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_DEBUG,
      debug ? EGL_TRUE : EGL_FALSE, EGL_NONE};
  context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  if (context == EGL_NO_CONTEXT) throw GpuError("OpenGL 4.5");
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
    eglDestroyContext(display, context);
    throw GpuError("contexts without a surface");
  }
  if (!debug) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(onMessage, &messages);
}

GlContext::~GlContext() {
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display, context);
}

namespace {

// The sum of the sample counts that a format has, of 2, 4 and 8.
std::uint32_t sampleCountsOf(GLenum format) {
  GLint count = 0;
  glGetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, format, GL_NUM_SAMPLE_COUNTS, 1, &count);
  std::vector<GLint> counts(static_cast<std::size_t>(std::max(count, 0)));
  glGetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, format, GL_SAMPLES, count, counts.data());
  std::uint32_t sum = 0;
  for (const GLint each : counts) {
    if (each == 2 || each == 4 || each == 8) sum |= static_cast<std::uint32_t>(each);
  }
  return sum;
}

GlLimits readLimits() {
  GlLimits limits;
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  limits.textureSide = static_cast<std::uint32_t>(std::min({integerOf(GL_MAX_TEXTURE_SIZE), viewport[0], viewport[1]}));
  GLint64 vertices = 0;
  glGetInteger64v(GL_MAX_ELEMENT_INDEX, &vertices);
  limits.vertices = static_cast<std::uint32_t>(std::clamp<GLint64>(vertices, 0, UINT32_MAX));
  limits.sampleCounts =
      1 | (sampleCountsOf(GL_RGBA16F) & sampleCountsOf(GL_DEPTH_COMPONENT32F) & sampleCountsOf(GL_DEPTH32F_STENCIL8));
  glGetFloatv(GL_POINT_SIZE_RANGE, limits.pointSizes);
  limits.postDepthCoverage = epoxy_has_gl_extension("GL_ARB_post_depth_coverage");
  return limits;
}

// Of the context that is current.
void describe(GlDeviceSummary& summary, const GlLimits& limits) {
  summary.name = textOf(GL_RENDERER);
  summary.version = fmt::format("{}.{}", integerOf(GL_MAJOR_VERSION), integerOf(GL_MINOR_VERSION));
  summary.driver = fmt::format("{} {}", textOf(GL_VENDOR), textOf(GL_VERSION));
  summary.isCpu = contains(summary.name, "llvmpipe") || contains(summary.name, "softpipe");
  summary.sampleCounts = limits.sampleCounts;
  summary.maxPictureSide = limits.textureSide;
  summary.postDepthCoverage = limits.postDepthCoverage;
}

// The number that a device is named by, if it is one.
std::optional<std::size_t> indexOf(std::string_view name) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  if (name.empty() || error != std::errc() || end != name.data() + name.size()) return {};
  return index;
}

} // namespace

std::vector<GlDeviceSummary> listGlDevices() {
  std::vector<GlDeviceSummary> devices;
  for (EGLDeviceEXT device : eglDevices()) {
    GlDeviceSummary& summary = devices.emplace_back();
    summary.index = static_cast<std::uint32_t>(devices.size() - 1);
    summary.isCpu = isSoftware(device);
    try {
      const GlContext context(device, false);
      describe(summary, readLimits());
    } catch (const GpuError& error) {
      summary.missing = error.what();
    }
  }
  return devices;
}

Gl::Gl(const GlOptions& options) {
  const std::vector<EGLDeviceEXT> devices = eglDevices();
  std::vector<std::size_t> order; // to be tried
  const std::optional<std::size_t> index = indexOf(options.device);
  if (index) {
    if (*index >= devices.size()) {
      throw GpuError(fmt::format("there is no OpenGL device {}: `vitrail info` lists them", *index));
    }
    order = {*index};
  } else {
    for (std::size_t i = 0; i < devices.size(); ++i) order.push_back(i);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return isSoftware(devices[i]); }); // GPUs first
  }
  std::string reason;
  for (const std::size_t i : order) {
    try {
      context_ = std::make_unique<GlContext>(devices[i], options.validate);
    } catch (const GpuError& error) {
      if (reason.empty()) reason = error.what();
      continue;
    }
    limits_ = readLimits();
    summary_.index = static_cast<std::uint32_t>(i);
    describe(summary_, limits_);
    if (index || contains(summary_.name, options.device)) return;
    context_.reset();
  }
  if (!options.device.empty() && !index) {
    throw GpuError(fmt::format("no OpenGL device has \"{}\" in its name: `vitrail info` lists them", options.device));
  }
  throw GpuError(fmt::format("OpenGL cannot be used here, it lacks {}: leave --api out", reason));
}

Gl::~Gl() = default;

void Gl::leaveThread() const { eglMakeCurrent(context_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

void Gl::comeToThread() const {
  eglBindAPI(EGL_OPENGL_API);
  if (eglMakeCurrent(context_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_->context) != EGL_TRUE) {
    throw GpuError(name() + ": OpenGL cannot be used on another thread");
  }
}

void Gl::check(const char* what) const {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  while (glGetError() != GL_NO_ERROR) {
  }
  if (error == GL_OUT_OF_MEMORY) {
    throw GpuError(fmt::format("{} has no memory left for {}: use a smaller --size", name(), what));
  }
  throw GpuError(fmt::format("{}: OpenGL reports error {:#x}", what, error));
}

void Gl::memoryAllocated(std::uint64_t bytes) {
  held_ += bytes;
  peak_ = std::max(peak_, held_);
}

std::vector<std::string> Gl::validationErrors() const { return context_->messages; }

} // namespace vitrail::tool
