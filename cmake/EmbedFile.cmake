# Makes a file a header with one array of bytes, so that programs need no files beside them.

# embed_file(TARGET target NAME name SOURCE file NAMESPACE ns) gives the target, of this folder, `#include
# "files/<name>.h"`, which declares `ns::files::<name with . as _>`, bytes without a last zero.
set(VITRAIL_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/embed_bytes.cmake)
function(embed_file)
  cmake_parse_arguments(arg "" "TARGET;NAME;SOURCE;NAMESPACE" "" ${ARGN})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(bytes ${folder}/files/${arg_NAME}.inc)
  string(REPLACE "." "_" symbol ${arg_NAME})
  get_filename_component(source ${arg_SOURCE} ABSOLUTE)
  add_custom_command(
    OUTPUT ${bytes}
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DOUTPUT=${bytes} -P ${VITRAIL_EMBED_SCRIPT}
    DEPENDS ${source} ${VITRAIL_EMBED_SCRIPT}
    COMMENT "Embedding ${arg_NAME}"
    VERBATIM)
  file(CONFIGURE OUTPUT ${folder}/files/${arg_NAME}.h @ONLY CONTENT [=[
// Made by cmake/EmbedFile.cmake.
#pragma once
namespace @arg_NAMESPACE@::files {
inline constexpr unsigned char @symbol@[] = {
#include "@arg_NAME@.inc"
};
} // namespace @arg_NAMESPACE@::files
]=])
  target_sources(${arg_TARGET} PRIVATE ${bytes})
  target_include_directories(${arg_TARGET} PRIVATE ${folder})
endfunction()
