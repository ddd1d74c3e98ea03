#include "programs.h"

#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "context.h"
#include "modules.h"
#include "source.h"

namespace vitrail {

namespace {

enum class Samples { any, one, several, each };
enum class Sorting { any, networks, insertion, each };
enum class Stage { comp, frag, vert };

struct Row {
  Stage stage;
  std::uint32_t kernel; // of the stage's enum
  Samples samples;
  Sorting sorting;
  std::string_view file;
  std::string_view defines; // with commas between them
};

#define VITRAIL_ENUMERATOR_comp(name) static_cast<std::uint32_t>(Kernel::name)
#define VITRAIL_ENUMERATOR_frag(name) static_cast<std::uint32_t>(FragmentResolve::name)
#define VITRAIL_ENUMERATOR_vert(name) 0U
#define VITRAIL_ROW(stage, name, samples, sorting, file, defines) \
  Row{Stage::stage, VITRAIL_ENUMERATOR_##stage(name), Samples::samples, Sorting::sorting, file, defines},
constexpr std::array kRows = {
#include "kernels/rows.inc"
};
#undef VITRAIL_ROW

const Row* findRow(Stage stage, std::uint32_t kernel, const ProgramKey& key) {
  for (const Row& row : kRows) {
    const bool samples = row.samples == Samples::any || row.samples == Samples::each || stage == Stage::frag ||
                         (row.samples == Samples::several) == key.multisampled;
    const bool sorting = row.sorting == Sorting::any || row.sorting == Sorting::each ||
                         (row.sorting == Sorting::networks) == key.networks;
    if (row.stage == stage && row.kernel == kernel && samples && sorting) return &row;
  }
  return nullptr;
}

void define(std::string& text, std::string_view name, std::string_view value) {
  text.append("#define ").append(name).append(" ").append(value).append("\n");
}

std::string definesOf(const Row& row, const ProgramKey& key) {
  const auto number = [](std::uint32_t value) { return std::to_string(value) + "u"; };
  const auto truth = [](bool value) { return value ? "true" : "false"; };
  std::string text = kSourcePrefix;
  define(text, "VITRAIL_IS_FORMAT", number(key.format));
  define(text, "VITRAIL_IS_SAMPLES", number(key.samples));
  define(text, "VITRAIL_IS_NEAREST_ONE", truth(key.nearestIsOne));
  define(text, "VITRAIL_IS_MAX_LAYERS", number(key.maxLayers));
  define(text, "VITRAIL_IS_TEST_DEPTH", truth(key.testDepth));
  define(text, "VITRAIL_IS_GROUP", number(key.group));
  define(text, "VITRAIL_COLOR_FORMAT", key.color == ColorImage::Rgba32f ? "rgba32f" : "rgba16f");
  const bool several = row.samples == Samples::several || (row.samples == Samples::each && key.multisampled);
  if (several) define(text, "VITRAIL_MULTISAMPLED", "");
  const bool networks = row.sorting == Sorting::networks || (row.sorting == Sorting::each && key.networks);
  define(text, "VITRAIL_NETWORKS", networks ? "1" : "0");
  for (std::string_view rest = row.defines; !rest.empty();) {
    const std::size_t comma = rest.find(',');
    define(text, rest.substr(0, comma), "");
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  }
  return text;
}

// ---- Programs that are being made

// Sets how many threads the driver compiles on, and puts back what it found.
class CompilerThreads {
 public:
  explicit CompilerThreads(const GlFunctions& gl) : gl_(gl) {
    if (gl.MaxShaderCompilerThreads == nullptr) return;
    gl.GetIntegerv(GL_MAX_SHADER_COMPILER_THREADS_KHR, &before_);
    gl.MaxShaderCompilerThreads(kAsManyAsThereAre);
  }
  ~CompilerThreads() {
    if (gl_.MaxShaderCompilerThreads != nullptr) gl_.MaxShaderCompilerThreads(static_cast<GLuint>(before_));
  }
  CompilerThreads(const CompilerThreads&) = delete;
  CompilerThreads& operator=(const CompilerThreads&) = delete;

 private:
  static constexpr GLuint kAsManyAsThereAre = 0xffffffffU;
  const GlFunctions& gl_;
  GLint before_ = 0;
};

struct Build {
  ProgramKey key;
  GLuint program = 0;
  std::array<GLuint, 2> shaders{}; // 0 where there is none
  bool isModule = false;

  [[nodiscard]] const char* name() const {
    return key.draws ? "fragment resolve" : kernelName(static_cast<Kernel>(key.kernel));
  }
};

// Hands a kernel's module to the driver.
GLuint startModule(const GlFunctions& gl, Spirv module, const ProgramKey& key) {
  // By their numbers in src/kernels/target.glsl.
  constexpr std::array<GLuint, 6> kNumbers = {0, 1, 2, 3, 4, 5};
  const std::array<GLuint, kNumbers.size()> values = {
      key.format, key.samples, key.nearestIsOne ? 1U : 0U, key.maxLayers, key.testDepth ? 1U : 0U, key.group};
  const GLuint shader = gl.CreateShader(GL_COMPUTE_SHADER);
  gl.ShaderBinary(1, &shader, GL_SHADER_BINARY_FORMAT_SPIR_V, module.data(), static_cast<GLsizei>(module.size_bytes()));
  gl.SpecializeShader(shader, "main", static_cast<GLuint>(kNumbers.size()), kNumbers.data(), values.data());
  return shader;
}

// Hands a row's shader to the driver, and does not wait for it.
GLuint startShader(const GlFunctions& gl, GLenum stage, const Row& row, const ProgramKey& key) {
  const std::string defines = definesOf(row, key);
  const std::string source = flattened(row.file);
  const std::array<const GLchar*, 3> parts = {"#version 430 core\n", defines.c_str(), source.c_str()};
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
  gl.CompileShader(shader);
  return shader;
}

// Nothing that is asked of a shader or program until all are linked: the answer would be waited for.
Build start(const VitrailGlContext_T& context, const ProgramKey& key) {
  const GlFunctions& gl = context.gl;
  Build build{key, gl.CreateProgram(), {}};
  const Spirv module = context.takesModules ? moduleFor(key) : Spirv();
  if (!module.empty()) {
    build.shaders[0] = startModule(gl, module, key);
    build.isModule = true;
  } else if (const Row* row = findRow(key.draws ? Stage::frag : Stage::comp, key.kernel, key)) {
    build.shaders[0] = startShader(gl, key.draws ? GL_FRAGMENT_SHADER : GL_COMPUTE_SHADER, *row, key);
  }
  if (key.draws) build.shaders[1] = startShader(gl, GL_VERTEX_SHADER, *findRow(Stage::vert, 0, key), key);
  for (const GLuint shader : build.shaders) {
    if (shader != 0) gl.AttachShader(build.program, shader);
  }
  return build;
}

// The first line of what a driver says, for a log of lines.
std::string firstLine(std::string text) { return text.substr(0, text.find_first_of("\r\n")); }

// Empty, or what the driver says against a shader.
std::string compileError(const GlFunctions& gl, GLuint shader) {
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_FALSE) return {};
  std::array<GLchar, 256> said{};
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(said.size()), nullptr, said.data());
  const std::string reason = firstLine(said.data());
  return reason.empty() ? "no reason given" : reason;
}

// Waits for a program. Empty, or what the driver says against it.
std::string finish(const GlFunctions& gl, const Build& build) {
  if (build.shaders[0] == 0) return "no such variant";
  GLint linked = GL_FALSE;
  gl.GetProgramiv(build.program, GL_LINK_STATUS, &linked);
  if (linked != GL_FALSE) return {};
  for (const GLuint shader : build.shaders) {
    std::string reason = shader != 0 ? compileError(gl, shader) : std::string();
    if (!reason.empty()) return reason;
  }
  std::array<GLchar, 256> said{};
  gl.GetProgramInfoLog(build.program, static_cast<GLsizei>(said.size()), nullptr, said.data());
  return "it does not link: " + firstLine(said.data());
}

void deleteShaders(const GlFunctions& gl, const Build& build) {
  for (const GLuint shader : build.shaders) {
    if (shader != 0) gl.DeleteShader(shader);
  }
}

// Waits for the programs and keeps those that the driver takes. Of the others the first is logged.
VitrailResult keep(VitrailGlContext_T& context, std::span<Build> builds) {
  const GlFunctions& gl = context.gl;
  VitrailResult result = VITRAIL_SUCCESS;
  for (Build& build : builds) {
    std::string reason = finish(gl, build);
    deleteShaders(gl, build);
    if (!reason.empty() && build.isModule) { // a driver that does not take this one may take its GLSL
      context.takesModules = false;
      gl.DeleteProgram(build.program);
      build = start(context, build.key);
      gl.LinkProgram(build.program);
      reason = finish(gl, build);
      deleteShaders(gl, build);
    }
    if (reason.empty()) {
      context.label(GL_PROGRAM, build.program, "vitrail", build.name());
      context.programs[build.key] = build.program;
      continue;
    }
    gl.DeleteProgram(build.program);
    if (result != VITRAIL_SUCCESS) continue;
    result = takeErrors(gl).lost
                 ? contextIsLost(context)
                 : context.log.fail(VITRAIL_ERROR_UNSUPPORTED, "%s: the driver does not take its shader: %s",
                                    build.name(), reason.c_str());
  }
  return result;
}

} // namespace

VitrailResult findPrograms(VitrailGlContext_T& context, std::span<const ProgramKey> keys, std::span<GLuint> programs) {
  const GlFunctions& gl = context.gl;
  const std::lock_guard lock(context.programsMutex);
  const std::set<ProgramKey> wanted(keys.begin(), keys.end());
  std::vector<Build> builds;
  std::optional<CompilerThreads> threads;
  for (const ProgramKey& key : wanted) {
    if (context.programs.contains(key)) continue;
    if (!threads) threads.emplace(gl);
    builds.push_back(start(context, key));
  }
  for (const Build& build : builds) gl.LinkProgram(build.program);
  const VitrailResult result = keep(context, builds);
  if (result != VITRAIL_SUCCESS) return result;
  for (std::size_t i = 0; i < keys.size(); ++i) programs[i] = context.programs[keys[i]];
  return VITRAIL_SUCCESS;
}

} // namespace vitrail
