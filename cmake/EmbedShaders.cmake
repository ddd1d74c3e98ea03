# Compiles GLSL with glslc and makes each shader a header with one array of SPIR-V words, so that programs need no files
# beside them.
find_program(VITRAIL_GLSLC glslc HINTS $ENV{VULKAN_SDK}/Bin REQUIRED)
set(VITRAIL_SHADER_OPTIMIZE -O CACHE STRING "glslc's flag for shaders that say none: -O, -Os, -O0")

# embed_shader(TARGETS target... NAME name SOURCE file NAMESPACE ns [INCLUDES dir...] [DEFINES def...] [OPTIMIZE flag]
#              [ENVIRONMENT env] [HLSL_STAGE stage])
# gives the targets, all of this folder, `#include "shaders/<name>.h"`, which declares `ns::shaders::<name with . as _>`.
# HLSL_STAGE: the source is HLSL, for that stage; its entry point is main().
function(embed_shader)
  cmake_parse_arguments(arg "" "NAME;SOURCE;NAMESPACE;OPTIMIZE;ENVIRONMENT;HLSL_STAGE" "TARGETS;INCLUDES;DEFINES" ${ARGN})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(words ${folder}/shaders/${arg_NAME}.inc)
  set(header ${folder}/shaders/${arg_NAME}.h)
  string(REPLACE "." "_" symbol ${arg_NAME})
  get_filename_component(source ${arg_SOURCE} ABSOLUTE)
  if(NOT arg_OPTIMIZE)
    set(arg_OPTIMIZE ${VITRAIL_SHADER_OPTIMIZE})
  endif()
  if(NOT arg_ENVIRONMENT)
    set(arg_ENVIRONMENT vulkan1.2) # what every supported device takes
  endif()
  set(language)
  if(arg_HLSL_STAGE)
    set(language -x hlsl -fshader-stage=${arg_HLSL_STAGE} -fentry-point=main)
    set(arg_ENVIRONMENT vulkan1.1) # its buffers are what SPIR-V up to 1.3 has
  endif()
  list(TRANSFORM arg_INCLUDES PREPEND -I)
  list(TRANSFORM arg_DEFINES PREPEND -D)
  # -mfmt=num: comma-separated words.
  add_custom_command(
    OUTPUT ${words}
    COMMAND ${VITRAIL_GLSLC} --target-env=${arg_ENVIRONMENT} ${arg_OPTIMIZE} -Werror -mfmt=num -MD -MF ${words}.d ${arg_INCLUDES} ${arg_DEFINES}
            ${language} -o ${words} ${source}
    DEPENDS ${source}
    DEPFILE ${words}.d
    COMMENT "Compiling ${arg_NAME}"
    VERBATIM)
  file(CONFIGURE OUTPUT ${header} @ONLY CONTENT [=[
// Made by cmake/EmbedShaders.cmake.
#pragma once
#include <cstdint>
namespace @arg_NAMESPACE@::shaders {
inline constexpr std::uint32_t @symbol@[] = {
#ifdef __clang_analyzer__ // clang-tidy, which looks at every word
    0
#else
#include "@arg_NAME@.inc"
#endif
};
} // namespace @arg_NAMESPACE@::shaders
]=])
  foreach(target ${arg_TARGETS})
    target_sources(${target} PRIVATE ${words})
    target_include_directories(${target} PRIVATE ${folder})
  endforeach()
endfunction()

# embed_shader_text(TARGET target NAME name SOURCE file NAMESPACE ns [INCLUDES dir...] [DEFINES def...]): the same shader as
# text for OpenGL, preprocessed with VITRAIL_OPENGL: `#include "files/<name>.h"`, as embed_file() makes it. Its #version
# is that of the source.
function(embed_shader_text)
  cmake_parse_arguments(arg "" "TARGET;NAME;SOURCE;NAMESPACE" "INCLUDES;DEFINES" ${ARGN})
  set(text ${CMAKE_CURRENT_BINARY_DIR}/generated/text/${arg_NAME})
  get_filename_component(source ${arg_SOURCE} ABSOLUTE)
  list(TRANSFORM arg_INCLUDES PREPEND -I)
  list(TRANSFORM arg_DEFINES PREPEND -D)
  file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/generated/text)
  add_custom_command(
    OUTPUT ${text}
    COMMAND ${VITRAIL_GLSLC} -E -DVITRAIL_OPENGL -MD -MF ${text}.d -MT ${text} ${arg_INCLUDES} ${arg_DEFINES} -o ${text} ${source}
    DEPENDS ${source}
    DEPFILE ${text}.d
    COMMENT "Preprocessing ${arg_NAME}"
    VERBATIM)
  embed_file(TARGET ${arg_TARGET} NAME ${arg_NAME} SOURCE ${text} NAMESPACE ${arg_NAMESPACE})
endfunction()
