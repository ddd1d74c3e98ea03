# Compiles HLSL with Microsoft's compilers and makes each shader a header with one array of bytes. On Windows they are
# fxc.exe and dxc.exe of the SDK; elsewhere d3dcompiler_47.dll and dxcompiler.dll, called by a program of our own under
# Wine. With VITRAIL_BYTECODE_FROM nothing is compiled: another build, for Windows, has made the same.
if(VITRAIL_BYTECODE_FROM)
  get_filename_component(VITRAIL_BYTECODE_FROM "${VITRAIL_BYTECODE_FROM}" ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
elseif(CMAKE_HOST_WIN32)
  # A developer's prompt has the SDK's newest programs on its path. Elsewhere they are where the SDK was installed.
  set(sdk "C:/Program Files (x86)/Windows Kits/10")
  cmake_host_system_information(RESULT installed QUERY WINDOWS_REGISTRY "HKLM/SOFTWARE/Microsoft/Windows Kits/Installed Roots"
                                VALUE KitsRoot10 VIEW BOTH)
  if(installed)
    cmake_path(SET sdk NORMALIZE "${installed}")
  endif()
  file(GLOB programs "${sdk}/bin/10.*/x64")
  list(SORT programs COMPARE NATURAL ORDER DESCENDING)
  find_program(VITRAIL_FXC fxc HINTS ${programs} REQUIRED DOC "fxc.exe of the Windows SDK: shader models up to 5.1")
  find_program(VITRAIL_DXC dxc HINTS ${programs} DOC "dxc.exe of the Windows SDK: shader models from 6.0 on, for the tests")
else()
  find_path(VITRAIL_HLSL_COMPILERS d3dcompiler_47.dll NO_CMAKE_FIND_ROOT_PATH REQUIRED
            DOC "The folder with d3dcompiler_47.dll, and for the tests dxcompiler.dll, of Microsoft's")
  add_executable(vitrail_hlsl_compiler ${CMAKE_CURRENT_LIST_DIR}/direct3d/compile.cpp)
  target_link_libraries(vitrail_hlsl_compiler PRIVATE d3dcompiler_47)
  vitrail_warnings(vitrail_hlsl_compiler)
  add_custom_command(
    TARGET vitrail_hlsl_compiler POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E copy_if_different ${VITRAIL_HLSL_COMPILERS}/d3dcompiler_47.dll ${VITRAIL_HLSL_COMPILERS}/dxcompiler.dll
            $<TARGET_FILE_DIR:vitrail_hlsl_compiler>)
endif()

# hlsl_command(result OUTPUT inc SOURCE hlsl PROFILE profile [ENTRY name] [INCLUDES dir...] [DEFINES def...] [STRICT]): the
# commands that make a file of numbers of a shader. STRICT: warnings are errors.
function(hlsl_command result)
  cmake_parse_arguments(arg "STRICT" "OUTPUT;SOURCE;PROFILE;ENTRY" "INCLUDES;DEFINES" ${ARGN})
  if(NOT arg_ENTRY)
    set(arg_ENTRY main)
  endif()
  set(words)
  foreach(define ${arg_DEFINES})
    list(APPEND words -D ${define})
  endforeach()
  if(CMAKE_HOST_WIN32)
    set(compiler ${VITRAIL_FXC})
    if(arg_PROFILE MATCHES "_6_")
      set(compiler ${VITRAIL_DXC})
      if(NOT VITRAIL_DXC)
        message(FATAL_ERROR "${arg_SOURCE} needs dxc.exe of the Windows SDK: set VITRAIL_DXC to it")
      endif()
    endif()
    # What lies beside an included file is found where these compilers are told to look.
    foreach(folder ${arg_INCLUDES})
      list(APPEND words -I ${folder} -I ${folder}/vitrail)
    endforeach()
    if(arg_STRICT)
      list(APPEND words -WX)
    endif()
    set(${result}
        COMMAND ${compiler} -nologo -O3 -T ${arg_PROFILE} -E ${arg_ENTRY} ${words} -Fo ${arg_OUTPUT}.cso ${arg_SOURCE}
        COMMAND ${CMAKE_COMMAND} -DSOURCE=${arg_OUTPUT}.cso -DOUTPUT=${arg_OUTPUT} -P ${VITRAIL_EMBED_SCRIPT}
        PARENT_SCOPE)
    return()
  endif()
  foreach(folder ${arg_INCLUDES})
    list(APPEND words -I ${folder})
  endforeach()
  if(arg_STRICT)
    list(APPEND words -W)
  endif()
  set(${result} COMMAND vitrail_hlsl_compiler ${arg_OUTPUT} ${arg_PROFILE} ${arg_ENTRY} ${arg_SOURCE} ${words} PARENT_SCOPE)
endfunction()

# bytecode_header(name namespace): the header of `generated/bytecode/<name>.inc`, which declares
# `ns::bytecode::<name with . as _>`.
function(bytecode_header name namespace)
  string(REPLACE "." "_" symbol ${name})
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/generated/bytecode/${name}.h @ONLY CONTENT [=[
// Made by cmake/Hlsl.cmake.
#pragma once
namespace @namespace@::bytecode {
inline constexpr unsigned char @symbol@[] = {
#include "@name@.inc"
};
} // namespace @namespace@::bytecode
]=])
endfunction()

# embed_bytecode_of_other(target name namespace): gives the target what the other build's same folder has by that name.
function(embed_bytecode_of_other target name namespace)
  set(numbers ${CMAKE_CURRENT_BINARY_DIR}/generated/bytecode/${name}.inc)
  file(RELATIVE_PATH place ${PROJECT_BINARY_DIR} ${numbers})
  add_custom_command(
    OUTPUT ${numbers}
    COMMAND ${CMAKE_COMMAND} -E copy ${VITRAIL_BYTECODE_FROM}/${place} ${numbers}
    DEPENDS ${VITRAIL_BYTECODE_FROM}/${place}
    COMMENT "Taking over ${name}"
    VERBATIM)
  bytecode_header(${name} ${namespace})
  target_sources(${target} PRIVATE ${numbers})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/generated)
endfunction()

# embed_hlsl(TARGET target NAME name SOURCE hlsl PROFILE profile NAMESPACE ns [ENTRY name] [INCLUDES dir...] [DEFINES def...])
# gives the target, of this folder, `#include "bytecode/<name>.h"`. Warnings are errors.
function(embed_hlsl)
  cmake_parse_arguments(arg "" "TARGET;NAME;SOURCE;PROFILE;NAMESPACE;ENTRY" "INCLUDES;DEFINES" ${ARGN})
  if(VITRAIL_BYTECODE_FROM)
    embed_bytecode_of_other(${arg_TARGET} ${arg_NAME} ${arg_NAMESPACE})
    return()
  endif()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(numbers ${folder}/bytecode/${arg_NAME}.inc)
  file(MAKE_DIRECTORY ${folder}/bytecode)
  get_filename_component(source ${arg_SOURCE} ABSOLUTE)
  set(headers)
  foreach(include ${arg_INCLUDES})
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${include}/*.hlsl ${include}/*.h)
    list(APPEND headers ${found})
  endforeach()
  hlsl_command(commands OUTPUT ${numbers} SOURCE ${source} PROFILE ${arg_PROFILE} ENTRY ${arg_ENTRY} INCLUDES ${arg_INCLUDES}
               DEFINES ${arg_DEFINES} STRICT)
  add_custom_command(OUTPUT ${numbers} ${commands} DEPENDS ${source} ${headers} COMMENT "Compiling ${arg_NAME}" VERBATIM)
  bytecode_header(${arg_NAME} ${arg_NAMESPACE})
  target_sources(${arg_TARGET} PRIVATE ${numbers})
  target_include_directories(${arg_TARGET} PRIVATE ${folder})
endfunction()
