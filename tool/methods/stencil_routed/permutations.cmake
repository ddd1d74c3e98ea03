# Where samples are drawn by themselves, each is shaded at its place.
embed_tool_shader(stencil_routed_each.frag stencil_routed.frag VITRAIL_EACH_SAMPLE)
