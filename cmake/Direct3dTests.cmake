# What the tests of Direct3D need besides.

# GoogleTest for this compiler: from the source that Debian has, else as a package finds it (vcpkg's, on Windows).
set(VITRAIL_GTEST_SOURCE /usr/src/googletest CACHE PATH "GoogleTest's source")
if(NOT EXISTS ${VITRAIL_GTEST_SOURCE}/CMakeLists.txt)
  find_package(GTest REQUIRED)
elseif(NOT TARGET GTest::gtest_main)
  set(INSTALL_GTEST OFF CACHE BOOL "" FORCE)
  set(BUILD_GMOCK OFF CACHE BOOL "" FORCE)
  add_subdirectory(${VITRAIL_GTEST_SOURCE} ${PROJECT_BINARY_DIR}/gtest EXCLUDE_FROM_ALL)
endif()

include(${CMAKE_CURRENT_LIST_DIR}/PlainHeaders.cmake)
