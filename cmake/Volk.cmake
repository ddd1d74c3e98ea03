# volk: Vulkan's functions, found at run time. For programs; the library has none of its own.
include_guard(GLOBAL)
find_path(VITRAIL_VOLK_SOURCE volk.c REQUIRED)

add_library(volk STATIC ${VITRAIL_VOLK_SOURCE}/volk.c)
target_include_directories(volk SYSTEM PUBLIC ${VITRAIL_VOLK_SOURCE})
target_compile_definitions(volk PUBLIC VK_NO_PROTOTYPES)
target_link_libraries(volk PUBLIC ${CMAKE_DL_LIBS})
