# Gives a target the shaders' sources as text, for backends that compile at run time.

# embed_sources(target shaders kernels): makes generated/sources/includes.inc, which includes a header for each file, and
# generated/sources/list.inc, VITRAIL_SOURCE("vitrail/node.glsl", symbol) a file, named as shaders include it.
function(embed_sources target shaders kernels)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${shaders} ${shaders}/*.glsl ${shaders}/*.h)
  file(GLOB_RECURSE others CONFIGURE_DEPENDS RELATIVE ${kernels} ${kernels}/*.glsl ${kernels}/*.comp ${kernels}/*.frag
       ${kernels}/*.vert)
  set(includes)
  set(list)
  foreach(root shaders kernels)
    set(files ${headers})
    if("${root}" STREQUAL "kernels")
      set(files ${others})
    endif()
    foreach(file ${files})
      string(REPLACE / _ name ${file})
      embed_file(TARGET ${target} NAME ${name} SOURCE ${${root}}/${file} NAMESPACE vitrail)
      string(REPLACE . _ symbol ${name})
      string(APPEND includes "#include \"files/${name}.h\"\n")
      string(APPEND list "VITRAIL_SOURCE(\"${file}\", ${symbol})\n")
    endforeach()
  endforeach()
  foreach(what includes list)
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/generated/sources/${what}.inc @ONLY
         CONTENT "// Made by cmake/EmbedSources.cmake.\n${${what}}")
  endforeach()
endfunction()
