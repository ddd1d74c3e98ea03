// Programs of the tool's shaders as text (cmake/EmbedShaders.cmake, embed_shader_text).
#pragma once

#include <span>
#include <string>

#include "objects.h"

namespace vitrail::tool {

// A shader as text, with what comes before it: the library's text, or what the shader is specialized for.
struct ShaderText {
  std::span<const unsigned char> file;
  std::string library{};   // as the library gives it, behind what it is to be defined with
  std::string constants{}; // declarations
};

// A line that declares a constant of a shader, CONSTANT() of gpu/glsl.h.
std::string constantLine(const char* declaration, std::uint32_t value);
std::string constantLine(const char* declaration, float value);
std::string constantLine(const char* declaration, bool value);

// Throws GpuError with what the driver says. `name` says what it is for.
GlObject makeDrawProgram(const ShaderText& vertex, const ShaderText& fragment, const std::string& name);
GlObject makeComputeProgram(const ShaderText& compute, const std::string& name);

} // namespace vitrail::tool
