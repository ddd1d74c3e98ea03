# With several samples a pixel the planes are multisampled.
embed_tool_shader(stochastic_composite_samples.comp stochastic_composite.comp SEVERAL_SAMPLES)
