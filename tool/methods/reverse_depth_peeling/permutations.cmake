# Transmissive surfaces take dual-source blending, which is not on every device.
embed_tool_shader(reverse_depth_peeling_transmission.frag reverse_depth_peeling.frag VITRAIL_TRANSMISSION)
