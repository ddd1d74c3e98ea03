# Scenes with surfaces that tint light or add it need more planes.
embed_tool_shader(moment_absorbance_filters.frag moment_absorbance.frag FILTERS)
