# Surfaces that planes cut.
embed_tool_shader(surface_clipped.vert surface.vert SURFACE_CLIPPED)
