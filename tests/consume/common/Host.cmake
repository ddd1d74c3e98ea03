# add_host(name source...): an executable of the host's own sources, the common ones and the shaders, which are compiled
# with the installed shader folder. Included by every host, after find_package(vitrail).
find_program(GLSLC glslc REQUIRED)
set(CMAKE_C_STANDARD 11)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

set(COMMON ${CMAKE_CURRENT_LIST_DIR})

function(add_host name)
  add_executable(${name} ${ARGN} ${COMMON}/host.c ${COMMON}/scene.c ${COMMON}/view.c)
  foreach(shader quad.vert opaque.frag collect.frag)
    add_custom_command(
      OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${shader}.inc
      COMMAND ${GLSLC} --target-env=vulkan1.2 -O -Werror -mfmt=num -MD -MF ${shader}.d -I${vitrail_SHADER_DIR}
              -o ${CMAKE_CURRENT_BINARY_DIR}/${shader}.inc ${COMMON}/${shader}
      DEPENDS ${COMMON}/${shader}
      DEPFILE ${shader}.d
      VERBATIM)
    target_sources(${name} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${shader}.inc)
  endforeach()
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${COMMON} ${CMAKE_CURRENT_BINARY_DIR})
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
  target_link_libraries(${name} PRIVATE vitrail::vitrail m)
endfunction()
