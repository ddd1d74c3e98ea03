# The stages of vitrail/raster.glsl: positions, set_up, large, blend, deep.
function(embed_tiles name stage)
  embed_tool_shader(tiles_${name} tiles.glsl VITRAIL_RASTER_STAGE=${stage} ${ARGN})
endfunction()
embed_tiles(positions 0)

# Of one sample or several, with its other choice or without: StageCode in tiles.cpp.
function(embed_tiles_stage name stage choice define)
  embed_tiles(${name} ${stage})
  embed_tiles(${name}_several ${stage} VITRAIL_MULTISAMPLED)
  embed_tiles(${name}_${choice} ${stage} ${define})
  embed_tiles(${name}_several_${choice} ${stage} VITRAIL_MULTISAMPLED ${define})
endfunction()
embed_tiles_stage(set_up 1 clipped VITRAIL_CLIP_PLANES=8) # CLIP_PLANE_COUNT
embed_tiles_stage(large 2 clipped VITRAIL_CLIP_PLANES=8)
# Where only constants choose a texture: TILES_CONSTANT_TEXTURES of tiles_shared.h.
embed_tiles_stage(blend 3 constant SURFACE_CONSTANT_TEXTURES=32)
embed_tiles_stage(deep 4 constant SURFACE_CONSTANT_TEXTURES=32)
