embed_tool_shader(tiles_setup_clipped.comp tiles_setup.comp TILES_CLIPPED)
embed_tool_shader(tiles_large.comp tiles_setup.comp TILES_OF_LARGE)
embed_tool_shader(tiles_large_clipped.comp tiles_setup.comp TILES_OF_LARGE TILES_CLIPPED)
embed_tool_shader(tiles_deep_fill.comp tiles_deep_collect.comp TILES_FILL)
# Where only constants choose a texture: TILES_CONSTANT_TEXTURES of tiles_shared.h.
embed_tool_shader(tiles_blend_constant.comp tiles_blend.comp SURFACE_CONSTANT_TEXTURES=32)
embed_tool_shader(tiles_deep_blend_constant.comp tiles_deep_blend.comp SURFACE_CONSTANT_TEXTURES=32)
