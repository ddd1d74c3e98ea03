#include "programs.h"

#include <array>
#include <string>
#include <string_view>

#include "context.h"
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

// The first line of what a driver says, for a log of lines.
std::string firstLine(std::string text) { return text.substr(0, text.find_first_of("\r\n")); }

// Adds a row's shader to the program. Empty, or what the driver says against it.
std::string addShader(const GlFunctions& gl, GLuint program, GLenum stage, const Row& row, const ProgramKey& key) {
  const std::string defines = definesOf(row, key);
  const std::string source = flattened(row.file);
  const std::array<const GLchar*, 3> parts = {"#version 430 core\n", defines.c_str(), source.c_str()};
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
  gl.CompileShader(shader);
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::array<GLchar, 256> said{};
  if (compiled == GL_FALSE) gl.GetShaderInfoLog(shader, static_cast<GLsizei>(said.size()), nullptr, said.data());
  gl.AttachShader(program, shader);
  gl.DeleteShader(shader); // goes with the program
  if (compiled != GL_FALSE) return {};
  const std::string reason = firstLine(said.data());
  return reason.empty() ? "no reason given" : reason;
}

std::string build(const GlFunctions& gl, GLuint program, const ProgramKey& key) {
  const Row* row = findRow(key.draws ? Stage::frag : Stage::comp, key.kernel, key);
  if (row == nullptr) return "no such variant";
  std::string reason = addShader(gl, program, key.draws ? GL_FRAGMENT_SHADER : GL_COMPUTE_SHADER, *row, key);
  if (reason.empty() && key.draws) {
    reason = addShader(gl, program, GL_VERTEX_SHADER, *findRow(Stage::vert, 0, key), key);
  }
  if (!reason.empty()) return reason;
  gl.LinkProgram(program);
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != GL_FALSE) return {};
  std::array<GLchar, 256> said{};
  gl.GetProgramInfoLog(program, static_cast<GLsizei>(said.size()), nullptr, said.data());
  return "it does not link: " + firstLine(said.data());
}

} // namespace

VitrailResult findProgram(VitrailGlContext_T& context, const ProgramKey& key, GLuint* program) {
  const std::lock_guard lock(context.programsMutex);
  GLuint& kept = context.programs[key];
  if (kept == 0) {
    const GLuint made = context.gl.CreateProgram();
    const char* name = key.draws ? "fragment resolve" : kernelName(static_cast<Kernel>(key.kernel));
    const std::string reason = build(context.gl, made, key);
    if (!reason.empty()) {
      context.gl.DeleteProgram(made);
      if (takeErrors(context.gl).lost) return contextIsLost(context);
      return context.log.fail(VITRAIL_ERROR_UNSUPPORTED, "%s: the driver does not take its shader: %s", name,
                              reason.c_str());
    }
    context.label(GL_PROGRAM, made, "vitrail", name);
    kept = made;
  }
  *program = kept;
  return VITRAIL_SUCCESS;
}

} // namespace vitrail
