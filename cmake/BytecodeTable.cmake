# Makes the kernels of src/kernels/kernels.table for Direct3D 11 and 12: GLSL by glslc to SPIR-V, by SPIRV-Cross and
# cmake/direct3d/kernel_to_hlsl.py to HLSL, by Microsoft's compiler to bytecode of shader model 5.0. Taken are the rows
# that reach the pool by a binding and sort by insertion, or ask for neither; resolve_group needs what shader model 5.0
# has not. One colour serves all: HLSL does not say which format is written.
if(NOT VITRAIL_BYTECODE_FROM)
  find_program(VITRAIL_GLSLC glslc HINTS $ENV{VULKAN_SDK}/Bin REQUIRED)
  find_program(VITRAIL_SPIRV_CROSS spirv-cross HINTS $ENV{VULKAN_SDK}/Bin REQUIRED)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
endif()
set(VITRAIL_KERNEL_TO_HLSL ${CMAKE_CURRENT_LIST_DIR}/direct3d/kernel_to_hlsl.py)

# embed_cross_compiled(TARGET target NAME name SOURCE glsl NAMESPACE ns INCLUDES dir... [DEFINES def...] [CONSTANTS def...])
# gives the target, of this folder, `#include "bytecode/<name>.h"` of a GLSL shader. CONSTANTS: what its specialization
# constants are.
function(embed_cross_compiled)
  cmake_parse_arguments(arg "" "TARGET;NAME;SOURCE;NAMESPACE" "INCLUDES;DEFINES;CONSTANTS" ${ARGN})
  if(VITRAIL_BYTECODE_FROM)
    embed_bytecode_of_other(${arg_TARGET} ${arg_NAME} ${arg_NAMESPACE})
    return()
  endif()
  get_filename_component(source ${arg_SOURCE} ABSOLUTE)
  get_filename_component(stage ${source} LAST_EXT)
  string(SUBSTRING ${stage} 1 -1 stage)
  string(REGEX MATCH "[cfv]" profile ${stage})
  string(REPLACE f p profile ${profile})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(numbers ${folder}/bytecode/${arg_NAME}.inc)
  set(between ${folder}/between/${arg_NAME})
  file(MAKE_DIRECTORY ${folder}/bytecode ${folder}/between)
  list(TRANSFORM arg_INCLUDES PREPEND -I)
  list(TRANSFORM arg_DEFINES PREPEND -D)
  hlsl_command(commands OUTPUT ${numbers} SOURCE ${between}.hlsl PROFILE ${profile}s_5_0 DEFINES ${arg_CONSTANTS})
  # -O0: SPIRV-Cross makes loops of optimized code that Microsoft's compiler refuses.
  add_custom_command(
    OUTPUT ${numbers}
    COMMAND ${VITRAIL_GLSLC} --target-env=vulkan1.2 -O0 -Werror -MD -MF ${numbers}.d -MT ${numbers} ${arg_INCLUDES} ${arg_DEFINES}
            -o ${between}.spv ${source}
    COMMAND Python3::Interpreter ${VITRAIL_KERNEL_TO_HLSL} ${between}.spv ${between}.hlsl ${stage} ${VITRAIL_SPIRV_CROSS}
    ${commands}
    DEPENDS ${source} ${VITRAIL_KERNEL_TO_HLSL}
    DEPFILE ${numbers}.d
    COMMENT "Compiling ${arg_NAME}"
    VERBATIM)
  bytecode_header(${arg_NAME} ${arg_NAMESPACE})
  target_sources(${arg_TARGET} PRIVATE ${numbers})
  target_include_directories(${arg_TARGET} PRIVATE ${folder})
endfunction()

# Compiles one variant, and appends it to `includes` and `variants` of the caller. `format`: a number, or `any`.
function(embed_bytecode target table row samples format)
  list(GET row 0 name)
  list(GET row 1 entry)
  list(GET row 7 defines)
  get_filename_component(kernels ${table} DIRECTORY)
  get_filename_component(stage ${entry} LAST_EXT)
  string(SUBSTRING ${stage} 1 -1 stage)
  string(REGEX REPLACE "^-$" "" defines ${defines})
  string(REPLACE , ";" defines "${defines}")
  list(APPEND defines VITRAIL_NETWORKS=0 VITRAIL_COLOR_FORMAT=rgba32f VITRAIL_NO_IMAGE_LOADS VITRAIL_NO_GROUP_COUNT)
  if(samples STREQUAL several)
    list(APPEND defines VITRAIL_MULTISAMPLED)
  endif()
  set(symbol ${stage}_${name}_${samples}_${format})
  set(constants)
  if(NOT format STREQUAL any)
    list(APPEND constants SPIRV_CROSS_CONSTANT_ID_0=${format}u)
  endif()
  if((samples STREQUAL one) AND (NOT name MATCHES per_sample))
    list(APPEND constants SPIRV_CROSS_CONSTANT_ID_1=1u)
  endif()
  embed_cross_compiled(
    TARGET ${target}
    NAME ${symbol}
    SOURCE ${kernels}/${entry}
    NAMESPACE vitrail
    INCLUDES ${PROJECT_SOURCE_DIR}/shaders ${kernels}
    DEFINES ${defines}
    CONSTANTS ${constants})
  kernel_enumerator(${name} enumerator)
  set(includes "${includes}#include \"bytecode/${symbol}.h\"\n" PARENT_SCOPE)
  set(variants "${variants}VITRAIL_BYTECODE(${stage}, ${enumerator}, ${samples}, ${format}, ${symbol})\n" PARENT_SCOPE)
endfunction()

# embed_bytecode_kernels(target table): gives the target, of this folder, every such kernel, and makes in
# generated/kernels
#   bytecode_includes.inc   the headers with the bytes of all variants
#   bytecode.inc            VITRAIL_BYTECODE(stage, Enumerator, samples, format, symbol) a variant, each axis a value or `any`
function(embed_bytecode_kernels target table)
  file(STRINGS ${table} rows REGEX "^[^#]")
  foreach(line ${rows})
    string(REGEX REPLACE "[ \t]+" ";" row "${line}")
    list(GET row 0 name)
    list(GET row 3 samples)
    list(GET row 4 sorting)
    list(GET row 5 access)
    if(sorting STREQUAL networks)
      continue()
    endif()
    kernel_axis(${samples} "one;several" samples)
    string(REPLACE - any samples "${samples}")
    set(formats any)
    if(access STREQUAL each)
      set(formats 0 1 2)
    endif()
    foreach(s ${samples})
      foreach(format ${formats})
        embed_bytecode(${target} ${table} "${row}" ${s} ${format})
      endforeach()
    endforeach()
  endforeach()
  write_kernel_list(bytecode_includes "${includes}")
  write_kernel_list(bytecode "${variants}")
endfunction()
