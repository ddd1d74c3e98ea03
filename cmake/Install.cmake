# Makes the library a package: one library file, the headers, the shaders that hosts include, and what CMake and
# pkg-config find it by. The installed tree can be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_target_property(vitrail_type vitrail TYPE)
# What a program in C links as well where the library is static: the C++ compiler's own libraries.
set(vitrail_runtime "")
if(vitrail_type STREQUAL STATIC_LIBRARY)
  set(vitrail_runtime ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
  list(REMOVE_ITEM vitrail_runtime ${CMAKE_C_IMPLICIT_LINK_LIBRARIES})
  list(REMOVE_DUPLICATES vitrail_runtime)
endif()

# A host sees one library: the core's objects are part of it.
target_sources(vitrail PRIVATE $<TARGET_OBJECTS:vitrail_core>)
add_library(vitrail::vitrail ALIAS vitrail)
set_target_properties(
  vitrail
  PROPERTIES VERSION ${PROJECT_VERSION}
             SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
             INTERFACE_INCLUDE_DIRECTORIES
             "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include;${VITRAIL_VULKAN_INCLUDE}>;$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>"
             INTERFACE_LINK_LIBRARIES
             "$<INSTALL_INTERFACE:vitrail::vulkan_headers;$<$<LINK_LANGUAGE:C>:${vitrail_runtime}>>")
if(vitrail_type STREQUAL SHARED_LIBRARY)
  target_compile_definitions(vitrail PRIVATE VITRAIL_SHARED) # the public functions are exported,
  target_compile_definitions(vitrail_core PRIVATE VITRAIL_SHARED) # those that need no graphics API too
endif()

# The folder for glslc -I, by the name that the installed package gives it.
set(vitrail_SHADER_DIR ${PROJECT_SOURCE_DIR}/shaders CACHE INTERNAL "Where #include \"vitrail/collect.glsl\" is found")

if(NOT VITRAIL_INSTALL)
  return()
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
configure_file(cmake/vitrail.pc.in ${PROJECT_BINARY_DIR}/package/vitrail.pc @ONLY)

install(TARGETS vitrail EXPORT vitrail COMPONENT development)
install(EXPORT vitrail FILE vitrailTargets.cmake NAMESPACE vitrail:: DESTINATION ${vitrail_package_folder} COMPONENT development)
install(DIRECTORY include/vitrail DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(DIRECTORY shaders/vitrail DESTINATION ${vitrail_shader_folder} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/package/vitrailConfig.cmake ${PROJECT_BINARY_DIR}/package/vitrailConfigVersion.cmake
        DESTINATION ${vitrail_package_folder} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/package/vitrail.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
# The guides, whose links to each other and to README.md hold there as here.
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
