// A host in C++17 with vitrail.hpp and OpenGL, without Vulkan's headers: two panes, the nearer one drawn first, in one
// frame and then in tiles through 64 KiB. Every pixel must be right, and the two pictures equal to the last bit.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#define VITRAIL_NO_VULKAN
#include <vitrail/vitrail.hpp>

namespace {

constexpr std::uint32_t kWidth = 256;
constexpr std::uint32_t kHeight = 192;
constexpr std::uint64_t kTileBudget = 64 * 1024;

const std::string kVersion = "#version 430 core\n";
// The first pane is the nearer one and covers the left half.
const std::string kVertex = R"(
flat out vec4 color;
void main() {
  bool first = gl_InstanceID == 0;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  if (first) corner.x = min(corner.x, 0.0);
  gl_Position = vec4(corner, first ? -0.5 : 0.5, 1.0);
  color = first ? vec4(0.0, 1.0, 0.0, 0.5) : vec4(1.0, 0.0, 0.0, 0.5);
}
)";
const std::string kFragment = R"(
flat in vec4 color;
void main() { vitrailCollect(color); }
)";

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "gl_cpp: %s\n", what.c_str());
  std::exit(1);
}

void check(VitrailResult result, const char* call) {
  if (result != VITRAIL_SUCCESS) fail(std::string(call) + " failed");
}

// OpenGL 4.3 or later without a window, current on this thread.
void openContext() {
  EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE || eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
    fail("EGL has no OpenGL");
  }
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) fail("there is no OpenGL 4.3");
}

vitrail::opengl::Context createContext() {
  VitrailGlContextDesc desc{};
  desc.getProcAddress = [](const char* name, void*) { return reinterpret_cast<void*>(eglGetProcAddress(name)); };
  desc.log = [](VitrailLogSeverity, const char* message, void*) { fail(message); };
  vitrail::opengl::Context context;
  check(vitrail::opengl::Context::create(desc, context), "vitrailGlCreateContext");
  return context;
}

class Renderer {
 public:
  explicit Renderer(const vitrail::opengl::Context& context) : context_(context) {
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glGenTextures(2, textures_);
    attach(textures_[0], GL_RGBA32F, GL_COLOR_ATTACHMENT0);
    attach(textures_[1], GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    glGenVertexArrays(1, &vertices_);
    glBindVertexArray(vertices_);
    glViewport(0, 0, kWidth, kHeight);
    const VitrailGlSpecialization only = context.collectSpecialization(targetDesc());
    program_ = glCreateProgram();
    addShader(GL_VERTEX_SHADER, kVersion + kVertex);
    addShader(GL_FRAGMENT_SHADER,
              kVersion + static_cast<const char*>(only.defines) + context.collectSource() + kFragment);
    glLinkProgram(program_);
    GLint linked = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) fail("the program does not link");
  }
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  ~Renderer() {
    glDeleteProgram(program_);
    glDeleteVertexArrays(1, &vertices_);
    glDeleteTextures(2, textures_);
    glDeleteFramebuffers(1, &framebuffer_);
  }

  std::vector<float> drawWhole() {
    VitrailGlTargetDesc desc = targetDesc();
    desc.nodeCapacity = 2 * kWidth * kHeight;
    const vitrail::opengl::Target target = createTarget(desc);
    drawOpaque();
    const VitrailStats stats = drawTransparent(target, {});
    if (stats.coveredPixels != kWidth * kHeight || stats.layersMax != 2) fail("the statistics are wrong");
    return read();
  }

  // `tiles`: how many there were.
  std::vector<float> drawTiled(unsigned& tiles) {
    VitrailTilePlanDesc planDesc{};
    planDesc.width = kWidth;
    planDesc.height = kHeight;
    planDesc.memoryBudget = kTileBudget;
    check(context_.tileLimits(VITRAIL_NODE_STANDARD, 1, planDesc.limits), "vitrailGlTileLimits");
    vitrail::TilePlan plan;
    check(vitrail::TilePlan::create(planDesc, plan), "vitrailCreateTilePlan");
    VitrailGlTargetDesc desc = targetDesc();
    vitrailGlTilePlanTarget(plan.handle(), &desc);
    const vitrail::opengl::Target target = createTarget(desc);
    drawOpaque();
    VitrailRect tile{};
    for (tiles = 0; plan.next(tile); ++tiles) {
      check(plan.finish(drawTransparent(target, tile)), "vitrailFinishTile");
    }
    return read();
  }

 private:
  static void attach(GLuint texture, GLenum format, GLenum attachment) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, format, kWidth, kHeight);
    glFramebufferTexture(GL_FRAMEBUFFER, attachment, texture, 0);
  }

  void addShader(GLenum stage, const std::string& source) const {
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program_, shader);
    glDeleteShader(shader);
  }

  static VitrailGlTargetDesc targetDesc() {
    VitrailGlTargetDesc desc{};
    desc.width = kWidth;
    desc.height = kHeight;
    desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
    desc.overflow = VITRAIL_OVERFLOW_SKIP; // as tiles have it: one program serves both
    desc.debugName = "gl_cpp";
    return desc;
  }

  vitrail::opengl::Target createTarget(const VitrailGlTargetDesc& desc) const {
    vitrail::opengl::Target target;
    check(vitrail::opengl::Target::create(context_, desc, target), "vitrailGlCreateTarget");
    return target;
  }

  static void drawOpaque() {
    glClearColor(0.0F, 0.0F, 1.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  }

  // Collects and resolves one area over what the framebuffer holds, and waits for it.
  VitrailStats drawTransparent(const vitrail::opengl::Target& target, const VitrailRect& area) const {
    VitrailGlBeginInfo info{};
    info.area = area;
    target.begin(info);
    target.bind();
    glUseProgram(program_);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 2);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    target.collected();
    target.resolve();
    target.end();
    glFinish();
    VitrailStats stats{};
    check(target.readStats(0, stats), "vitrailGlReadStats");
    return stats;
  }

  static std::vector<float> read() {
    std::vector<float> pixels(std::size_t{4} * kWidth * kHeight);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, pixels.data());
    return pixels;
  }

  const vitrail::opengl::Context& context_;
  GLuint framebuffer_ = 0;
  GLuint textures_[2] = {}; // colour, depth
  GLuint vertices_ = 0;
  GLuint program_ = 0;
};

// Half of red over blue; in the left half, half of green over that.
void checkPicture(const std::vector<float>& pixels) {
  constexpr float kExpected[2][3] = {{0.25F, 0.5F, 0.25F}, {0.5F, 0.0F, 0.5F}};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i % 4 == 3) continue;
    const float wanted = kExpected[i / 4 % kWidth < kWidth / 2 ? 0 : 1][i % 4];
    if (std::fabs(pixels[i] - wanted) > 0.005F) fail("pixel " + std::to_string(i / 4) + " is wrong");
  }
}

} // namespace

int main() {
  openContext();
  {
    vitrail::opengl::Context made = createContext();
    const vitrail::opengl::Context context = std::move(made);
    if (made || !context) fail("a context that was moved from owns something");
    Renderer renderer(context);
    const std::vector<float> whole = renderer.drawWhole();
    checkPicture(whole);
    unsigned tiles = 0;
    if (renderer.drawTiled(tiles) != whole) fail("the picture in tiles is another");
    if (tiles < 2) fail("the picture was not drawn in tiles");
    if (glGetError() != GL_NO_ERROR) fail("OpenGL has an error");
    std::printf("gl_cpp: every pixel is right, also in %u tiles\n", tiles);
  }
  return 0;
}
