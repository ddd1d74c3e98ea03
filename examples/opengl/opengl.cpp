// A complete host with OpenGL (opengl PICTURE.ppm): the cube of glass panes that examples/minimal draws with Vulkan,
// without a window. What concerns Vitrail is in the glass shader, in drawFrame() and in draw().
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <vitrail/gl.h>

namespace {
constexpr int kWidth = 1600, kHeight = 1200; // four pixels make one of the file
constexpr const char* kVersion = "#version 430 core\n";
// What all shaders know of the scene: the camera and the sky.
constexpr const char* kScene = R"(
const vec3 kEye = vec3(2.3, 2.15, 4.3), kLookAt = vec3(0.0, -0.12, 0.0), kHorizon = vec3(0.70, 0.77, 0.84);
const float kFocal = 2.75, kNear = 0.1; // there is no far plane
vec4 toClip(vec3 position) {
  vec3 back = normalize(kEye - kLookAt);
  vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), back));
  vec3 view = (position - kEye) * mat3(right, cross(back, right), back);
  return vec4(kFocal * 0.75 * view.x, kFocal * view.y, -view.z - 2.0 * kNear, -view.z);
}
vec3 skyColor(vec3 direction) {
  return mix(kHorizon, vec3(0.20, 0.38, 0.75), clamp(direction.y, 0.0, 1.0)) * (direction.y < 0.0 ? 0.5 : 1.0);
}
)";
// Pane -1 is a wide floor; the nine others are square panes, three across each axis, each cutting through six others.
constexpr const char* kVertex = R"(
uniform int firstPane;
out vec3 position;
out vec2 place; // in the square, -1 to 1
flat out int axis, pane;
void main() {
  pane = firstPane + gl_InstanceID;
  axis = pane < 0 ? 1 : pane / 3;
  place = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  position[axis] = pane < 0 ? -1.0 : 0.62 * float(pane % 3 - 1);
  position[(axis + 1) % 3] = place.x * (pane < 0 ? 60.0 : 1.0);
  position[(axis + 2) % 3] = place.y * (pane < 0 ? 60.0 : 1.0);
  gl_Position = toClip(position);
}
)";
// A chequered floor that is darker below the cube and fades into the distance.
constexpr const char* kFloor = R"(
in vec3 position;
out vec4 outColor;
void main() {
  vec2 square = floor(position.xz * 2.0);
  vec3 color = mod(square.x + square.y, 2.0) < 0.5 ? vec3(0.74, 0.72, 0.68) : vec3(0.28, 0.29, 0.32);
  float away = length(max(abs(position.xz) - 0.8, 0.0));
  color *= mix(0.55, 1.0, smoothstep(0.0, 1.2, away));
  outColor = vec4(mix(color, kHorizon, smoothstep(3.0, 16.0, distance(position, kEye) - 4.0)), 1.0);
}
)";
// Tinted glass: a filter for what is behind it, and what it reflects itself. It follows vitrailGlCollectSource().
constexpr const char* kGlass = R"(
in vec3 position;
in vec2 place;
flat in int axis, pane;
const vec3 kTints[3] = vec3[3](vec3(0.60, 0.90, 0.95), vec3(0.98, 0.86, 0.52), vec3(0.96, 0.64, 0.76));
void main() {
  vec3 ray = normalize(position - kEye);
  vec3 normal = vec3(0.0);
  normal[axis] = -sign(ray[axis]);
  float reflectance = 0.04 + 0.96 * pow(1.0 + dot(ray, normal), 5.0); // Schlick's approximation
  float rim = step(0.965, max(abs(place.x), abs(place.y)));           // the ground edge of the pane
  reflectance = mix(reflectance, 0.55, rim);
  vitrailCollect(vec4(kTints[axis], 1.0), VITRAIL_MULTIPLY);
  vec3 sky = skyColor(reflect(ray, normal));
  vitrailCollect(vec4(reflectance * sky, reflectance), VITRAIL_PREMULTIPLIED);
}
)";
void check(bool well, const std::string& what) {
  if (!well) throw std::runtime_error(what);
}

// OpenGL 4.3 or later without a window, current on this thread.
void openContext() {
  EGLDeviceEXT device = nullptr;
  EGLint devices = 0;
  const bool lists = epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration");
  check(lists && eglQueryDevicesEXT(1, &device, &devices) == EGL_TRUE && devices > 0, "EGL has no device");
  EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  check(eglInitialize(display, nullptr, nullptr) == EGL_TRUE && eglBindAPI(EGL_OPENGL_API) == EGL_TRUE,
        "EGL has no OpenGL");
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  check(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE, "there is no OpenGL 4.3");
}

GLuint createProgram(const std::string& vertex, const std::string& fragment) {
  const GLuint program = glCreateProgram();
  const auto add = [&](GLenum stage, const std::string& source) {
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  };
  add(GL_VERTEX_SHADER, vertex);
  add(GL_FRAGMENT_SHADER, fragment);
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  check(linked != GL_FALSE, "a program does not link");
  return program;
}

GLuint createTexture(GLenum format, GLenum attachment) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, kWidth, kHeight);
  glFramebufferTexture(GL_FRAMEBUFFER, attachment, texture, 0);
  return texture;
}

void drawFrame(VitrailGlTarget target, GLuint floor, GLuint glass) {
  glClearColor(0.70F, 0.77F, 0.84F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glUseProgram(floor);
  glUniform1i(glGetUniformLocation(floor, "firstPane"), -1);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  vitrailGlBegin(target, nullptr);
  vitrailGlBind(target);
  glDepthMask(GL_FALSE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glUseProgram(glass);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 9); // nine panes, in any order
  vitrailGlCollected(target);
  vitrailGlResolve(target, nullptr);
  vitrailGlEnd(target);
}

void save(const char* path) {
  std::vector<float> pixels(size_t{4} * kWidth * kHeight);
  glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, pixels.data()); // which waits for the frame
  std::ofstream file(path, std::ios::binary);
  file << "P6 " << kWidth / 2 << ' ' << kHeight / 2 << " 255\n";
  for (int y = kHeight - 2; y >= 0; y -= 2) { // OpenGL's first row is the lowest
    for (int i = 0; i < kWidth / 2 * 3; ++i) {
      const float* p = pixels.data() + size_t{4} * (y * kWidth + 2 * (i / 3)) + i % 3;
      const float mean = std::fmin((p[0] + p[4] + p[4 * kWidth] + p[4 * kWidth + 4]) / 4, 1.0F);
      const float curve = mean <= 0.0031308F ? 12.92F * mean : 1.055F * std::pow(mean, 1 / 2.4F) - 0.055F; // sRGB
      file.put(static_cast<char>(std::lround(255 * curve)));
    }
  }
  check(static_cast<bool>(file.flush()), std::string("cannot write ") + path);
}

void draw(const char* path) {
  openContext();
  std::string reason;
  VitrailGlContextDesc contextDesc{};
  contextDesc.getProcAddress = [](const char* name, void*) { return reinterpret_cast<void*>(eglGetProcAddress(name)); };
  contextDesc.log = [](VitrailLogSeverity, const char* text, void* user) { *static_cast<std::string*>(user) = text; };
  contextDesc.logUser = &reason;
  VitrailGlContext context = nullptr;
  check(vitrailGlCreateContext(&contextDesc, &context) == VITRAIL_SUCCESS, reason);
  const std::string vertex = std::string(kVersion) + kScene + kVertex;
  const GLuint floor = createProgram(vertex, std::string(kVersion) + kScene + kFloor);
  const GLuint glass = createProgram(vertex, std::string(kVersion) + vitrailGlCollectSource(context) + kScene + kGlass);
  GLuint framebuffer = 0, vertices = 0; // the panes have no vertices of their own
  glGenFramebuffers(1, &framebuffer);
  glGenVertexArrays(1, &vertices);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glBindVertexArray(vertices);
  const GLuint color = createTexture(GL_RGBA32F, GL_COLOR_ATTACHMENT0);
  createTexture(GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
  glViewport(0, 0, kWidth, kHeight);
  VitrailGlTargetDesc desc{.width = kWidth, .height = kHeight, .nodeCapacity = 8'000'000, .colorFormat = GL_RGBA32F};
  desc.textures = {.count = 1, .color = &color};
  VitrailGlTarget target = nullptr;
  check(vitrailGlCreateTarget(context, &desc, &target) == VITRAIL_SUCCESS, reason);
  drawFrame(target, floor, glass);
  save(path);
  VitrailStats stats{};
  check(vitrailGlReadStats(target, 0, &stats) == VITRAIL_SUCCESS && stats.complete != 0, "the node pool is too small");
  vitrailGlDestroyTarget(target);
  vitrailGlDestroyContext(context);
}
} // namespace

int main(int argc, char** argv) {
  try {
    check(argc == 2, "usage: opengl PICTURE.ppm");
    draw(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "opengl: error: %s\n", error.what());
    return 1;
  }
}
