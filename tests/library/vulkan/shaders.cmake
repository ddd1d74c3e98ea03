# The shaders of Vulkan's point host, for the programs that have it in them.
set(VITRAIL_VULKAN_TEST_SHADERS ${CMAKE_CURRENT_LIST_DIR}/shaders)
set(VITRAIL_HLSL_TEST_SHADERS ${CMAKE_CURRENT_LIST_DIR}/../direct3d/shaders)

# embed_vulkan_test_shaders(target...): gives them to the targets, all of this folder.
function(embed_vulkan_test_shaders)
  set(targets ${ARGN})
  set(glsl ${VITRAIL_VULKAN_TEST_SHADERS})
  set(hlsl ${VITRAIL_HLSL_TEST_SHADERS})
  set(common NAMESPACE vitrail INCLUDES ${PROJECT_SOURCE_DIR}/shaders)
  foreach(shader points.vert opaque.vert opaque.frag)
    embed_shader(TARGETS ${targets} NAME ${shader} SOURCE ${glsl}/${shader} NAMESPACE vitrail)
  endforeach()
  # A host's shader that walks lists.
  macro(embed_walk name)
    embed_shader(TARGETS ${targets} NAME ${name}.comp SOURCE ${glsl}/walk.comp ${common} DEFINES ${ARGN})
  endmacro()
  embed_walk(walk)
  embed_walk(walk_address VITRAIL_BUFFER_REFERENCE)
  embed_walk(walk_sorted VITRAIL_SORTED_LISTS)
  embed_walk(walk_sorted_address VITRAIL_SORTED_LISTS VITRAIL_BUFFER_REFERENCE)
  # Its collecting shader in every way that collect.glsl can be included.
  macro(embed_points name)
    embed_shader(TARGETS ${targets} NAME points_${name}.frag SOURCE ${glsl}/points.frag ${common} DEFINES ${ARGN})
  endmacro()
  embed_points(simple)
  embed_points(post_depth VITRAIL_POST_DEPTH_COVERAGE)
  embed_points(address VITRAIL_BUFFER_REFERENCE)
  embed_points(cpu VITRAIL_CPU_DRIVER)
  embed_points(narrow VITRAIL_ONLY_FORMAT=0 VITRAIL_ONLY_SAMPLES=1 VITRAIL_ONLY_OVERFLOW=1 VITRAIL_ONLY_LIST_BUILD=1
               VITRAIL_ONLY_USER_WORDS=0)
  embed_points(cpu_address VITRAIL_CPU_DRIVER VITRAIL_BUFFER_REFERENCE)
  embed_points(post_depth_address VITRAIL_POST_DEPTH_COVERAGE VITRAIL_BUFFER_REFERENCE)
  embed_points(post_depth_cpu VITRAIL_POST_DEPTH_COVERAGE VITRAIL_CPU_DRIVER)
  # And in HLSL, whose registers are the bindings. list.hlsl is compiled only.
  embed_shader(TARGETS ${targets} NAME points_hlsl.frag SOURCE ${hlsl}/points.hlsl HLSL_STAGE frag ${common}
               DEFINES VITRAIL_REGISTER_PARAMETERS=b0)
  embed_shader(TARGETS ${targets} NAME walk_hlsl.comp SOURCE ${hlsl}/walk.hlsl HLSL_STAGE comp ${common}
               DEFINES VITRAIL_REGISTER_PARAMETERS=b0 VITRAIL_REGISTER_CONTROL=t1 VITRAIL_REGISTER_HEADS=t2 VITRAIL_REGISTER_NODES=t3)
endfunction()

# embed_raster_test_shaders(target...): the stages of the raster host.
function(embed_raster_test_shaders)
  foreach(stage 0 1 2 3 4)
    foreach(variant one several)
      set(defines VITRAIL_RASTER_STAGE=${stage} VITRAIL_COLOR_FORMAT=rgba32f VITRAIL_CLIP_PLANES=1)
      if(variant STREQUAL several)
        list(APPEND defines VITRAIL_MULTISAMPLED)
      endif()
      embed_shader(TARGETS ${ARGN} NAME raster_test_${stage}_${variant} SOURCE ${VITRAIL_VULKAN_TEST_SHADERS}/raster.glsl
                   NAMESPACE vitrail INCLUDES ${PROJECT_SOURCE_DIR}/shaders DEFINES ${defines})
    endforeach()
  endforeach()
  foreach(stage 3 4) # of two fragments a surface
    embed_shader(TARGETS ${ARGN} NAME raster_test_${stage}_two SOURCE ${VITRAIL_VULKAN_TEST_SHADERS}/raster.glsl
                 NAMESPACE vitrail INCLUDES ${PROJECT_SOURCE_DIR}/shaders
                 DEFINES VITRAIL_RASTER_STAGE=${stage} VITRAIL_COLOR_FORMAT=rgba32f VITRAIL_RASTER_FRAGMENTS=2)
  endforeach()
endfunction()
