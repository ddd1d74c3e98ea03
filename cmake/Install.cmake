# Makes the libraries a package: a library file for each component, the headers, the shaders that hosts include, and what
# CMake and pkg-config find them by. The installed tree can be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# What a program in C links as well where a library is static: the C++ compiler's own libraries.
set(vitrail_runtime "")
if(NOT BUILD_SHARED_LIBS)
  set(vitrail_runtime ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
  list(REMOVE_ITEM vitrail_runtime ${CMAKE_C_IMPLICIT_LINK_LIBRARIES})
  list(REMOVE_DUPLICATES vitrail_runtime)
endif()

# vitrail_component(target exported-name): a library that hosts link, as vitrail::<exported-name>. Each has the core's
# objects in it, so that a host of one of them sees one library. Where both are linked, the first that is asked for
# vitrailVersion() and the like answers for both.
function(vitrail_component target name)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:vitrail_core>)
  add_library(vitrail::${name} ALIAS ${target})
  set_target_properties(
    ${target} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(${target} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  foreach(library ${vitrail_runtime})
    target_link_libraries(${target} INTERFACE $<INSTALL_INTERFACE:$<$<LINK_LANGUAGE:C>:${library}>>)
  endforeach()
  if(BUILD_SHARED_LIBS)
    target_compile_definitions(${target} PRIVATE VITRAIL_SHARED) # the public functions are exported,
    target_compile_definitions(vitrail_core PRIVATE VITRAIL_SHARED) # those that need no graphics API too
  endif()
endfunction()

if(VITRAIL_BUILD_VULKAN)
  vitrail_component(vitrail vitrail)
  target_link_libraries(vitrail INTERFACE $<INSTALL_INTERFACE:vitrail::vulkan_headers>)
  # The folder for glslc -I, by the name that the installed package gives it.
  set(vitrail_SHADER_DIR ${PROJECT_SOURCE_DIR}/shaders CACHE INTERNAL "Where #include \"vitrail/collect.glsl\" is found")
endif()
if(VITRAIL_BUILD_OPENGL)
  vitrail_component(vitrail_gl gl)
endif()
if(VITRAIL_BUILD_D3D11)
  vitrail_component(vitrail_d3d11 d3d11)
endif()
if(VITRAIL_BUILD_D3D12)
  vitrail_component(vitrail_d3d12 d3d12)
endif()
if(VITRAIL_BUILD_CPU)
  vitrail_component(vitrail_cpu cpu)
endif()

if(NOT VITRAIL_INSTALL)
  return()
endif()

# What programs link beside a static vitrail_cpu, for CMake and for pkg-config.
set(vitrail_cpu_packages "")
set(vitrail_cpu_requires "")
if(NOT BUILD_SHARED_LIBS)
  set(vitrail_cpu_packages "hwy")
  set(vitrail_cpu_requires "libhwy")
endif()

set(vitrail_package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/vitrail)
set(vitrail_shader_folder ${CMAKE_INSTALL_DATADIR}/vitrail/shaders)
configure_package_config_file(
  cmake/vitrailConfig.cmake.in ${PROJECT_BINARY_DIR}/package/vitrailConfig.cmake
  INSTALL_DESTINATION ${vitrail_package_folder}
  PATH_VARS vitrail_shader_folder
  NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/vitrailConfigVersion.cmake COMPATIBILITY SameMinorVersion)

file(RELATIVE_PATH vitrail_pc_to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" vitrail_pc_to_prefix ${vitrail_pc_to_prefix})
list(TRANSFORM vitrail_runtime PREPEND -l OUTPUT_VARIABLE vitrail_pc_private)
list(JOIN vitrail_pc_private " " vitrail_pc_private)

# vitrail_install(target component pkg-config-file)
function(vitrail_install target component pc)
  configure_file(cmake/${pc}.in ${PROJECT_BINARY_DIR}/package/${pc} @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/package/${pc} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
  install(TARGETS ${target} EXPORT vitrail_${component} COMPONENT development)
  install(EXPORT vitrail_${component} FILE vitrail-${component}.cmake NAMESPACE vitrail:: DESTINATION ${vitrail_package_folder}
          COMPONENT development)
endfunction()
set(vitrail_without "") # headers of what is not built
if(VITRAIL_BUILD_VULKAN)
  vitrail_install(vitrail vulkan vitrail.pc)
else()
  list(APPEND vitrail_without PATTERN vulkan.h EXCLUDE PATTERN vulkan_raster.h EXCLUDE
       PATTERN vulkan_trial.h EXCLUDE)
endif()
if(VITRAIL_BUILD_OPENGL)
  vitrail_install(vitrail_gl gl vitrail-gl.pc)
else()
  list(APPEND vitrail_without PATTERN gl.h EXCLUDE)
endif()
if(VITRAIL_BUILD_CPU)
  vitrail_install(vitrail_cpu cpu vitrail-cpu.pc)
else()
  list(APPEND vitrail_without PATTERN cpu.h EXCLUDE)
endif()
foreach(number 11 12)
  if(VITRAIL_BUILD_D3D${number})
    vitrail_install(vitrail_d3d${number} d3d${number} vitrail-d3d${number}.pc)
  else()
    list(APPEND vitrail_without PATTERN d3d${number}.h EXCLUDE)
  endif()
endforeach()
# What hosts' shaders include. (Of OpenGL's the library has the text.)
if(VITRAIL_BUILD_VULKAN OR VITRAIL_BUILD_D3D11 OR VITRAIL_BUILD_D3D12)
  install(DIRECTORY shaders/vitrail DESTINATION ${vitrail_shader_folder} COMPONENT development)
endif()
install(DIRECTORY include/vitrail DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development ${vitrail_without})
install(FILES ${PROJECT_BINARY_DIR}/package/vitrailConfig.cmake ${PROJECT_BINARY_DIR}/package/vitrailConfigVersion.cmake
        DESTINATION ${vitrail_package_folder} COMPONENT development)
# The guides, whose links to each other and to README.md hold there as here.
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
