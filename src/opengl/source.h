// GLSL for OpenGL, which has no #include: the shaders' files with what they include in its place.
#pragma once

#include <string>
#include <string_view>

namespace vitrail {

// What precedes a flattened file: mix() of integers is GLSL 4.50.
constexpr const char* kSourcePrefix =
    "#ifndef VITRAIL_OPENGL\n#define VITRAIL_OPENGL 1\n#endif\n"
    "#if __VERSION__ < 450\n#extension GL_EXT_shader_integer_mix : require\n#endif\n";

// A file of shaders/ or src/kernels/, as shaders name it ("vitrail/collect.glsl"), and all that it includes. Without
// #version and the extensions of other languages; those that OpenGL knows come first. Empty where there is no such
// file.
std::string flattened(std::string_view name);

} // namespace vitrail
