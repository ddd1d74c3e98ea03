# Scenes with surfaces that tint light or add it need more planes.
embed_tool_shader(weighted_filters.frag weighted.frag FILTERS)
# With several samples a pixel the planes are multisampled.
embed_tool_shader(weighted_composite_samples.comp weighted_composite.comp SEVERAL_SAMPLES)
