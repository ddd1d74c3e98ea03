# What the collecting shader may use differs between devices.
embed_tool_shader(collect_address.frag collect.frag VITRAIL_BUFFER_REFERENCE)
embed_tool_shader(collect_coverage.frag collect.frag VITRAIL_POST_DEPTH_COVERAGE)
embed_tool_shader(collect_coverage_address.frag collect.frag VITRAIL_BUFFER_REFERENCE VITRAIL_POST_DEPTH_COVERAGE)
