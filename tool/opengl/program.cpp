#include "program.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

// The preprocessor has left #version, #line and what Vulkan's compiler asks for.
std::string withoutDirectives(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (!line.empty() && line.front() != '#') result.append(line).append("\n");
  }
  return result;
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find_first_of("\r\n")); }

void attach(GLuint program, GLenum stage, const ShaderText& text, const std::string& name) {
  const std::string own = withoutDirectives({reinterpret_cast<const char*>(text.file.data()), text.file.size()});
  const std::array<const GLchar*, 4> parts{"#version 450 core\n", text.library.c_str(), text.constants.c_str(),
                                           own.c_str()};
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::array<GLchar, 512> said{};
  if (compiled == GL_FALSE) glGetShaderInfoLog(shader, static_cast<GLsizei>(said.size()), nullptr, said.data());
  glAttachShader(program, shader);
  glDeleteShader(shader); // goes with the program
  if (compiled == GL_FALSE) {
    throw GpuError(fmt::format("{}: the driver does not take its shader: {}", name, firstLine(said.data())));
  }
}

void link(GLuint program, const std::string& name) {
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != GL_FALSE) return;
  std::array<GLchar, 512> said{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(said.size()), nullptr, said.data());
  throw GpuError(fmt::format("{}: the driver does not link its program: {}", name, firstLine(said.data())));
}

} // namespace

std::string constantLine(const char* declaration, std::uint32_t value) {
  return fmt::format("const {} = {:#x}u;\n", declaration, value);
}
std::string constantLine(const char* declaration, float value) {
  return fmt::format("const {} = {:.9e};\n", declaration, value);
}
std::string constantLine(const char* declaration, bool value) {
  return fmt::format("const {} = {};\n", declaration, value);
}

GlObject makeDrawProgram(const ShaderText& vertex, const ShaderText& fragment, const std::string& name) {
  GlObject program(GlKind::Program, glCreateProgram());
  attach(program.get(), GL_VERTEX_SHADER, vertex, name);
  attach(program.get(), GL_FRAGMENT_SHADER, fragment, name);
  link(program.get(), name);
  return program;
}

GlObject makeComputeProgram(const ShaderText& compute, const std::string& name) {
  GlObject program(GlKind::Program, glCreateProgram());
  attach(program.get(), GL_COMPUTE_SHADER, compute, name);
  link(program.get(), name);
  return program;
}

} // namespace vitrail::tool
