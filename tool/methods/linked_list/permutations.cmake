# What the collecting shader may use differs between devices.
embed_tool_shader(collect_address.frag collect.frag VITRAIL_BUFFER_REFERENCE)
embed_tool_shader(collect_coverage.frag collect.frag VITRAIL_POST_DEPTH_COVERAGE)
embed_tool_shader(collect_coverage_address.frag collect.frag VITRAIL_BUFFER_REFERENCE VITRAIL_POST_DEPTH_COVERAGE)
# The same where fragments say which object light enters or leaves, and the resolve that follows it.
embed_tool_shader(surface_object.vert ../../stage/surface.vert SURFACE_OBJECT)
embed_tool_shader(collect_media.frag collect.frag COLLECT_MEDIA)
embed_tool_shader(collect_media_address.frag collect.frag COLLECT_MEDIA VITRAIL_BUFFER_REFERENCE)
embed_tool_shader(collect_media_coverage.frag collect.frag COLLECT_MEDIA VITRAIL_POST_DEPTH_COVERAGE)
embed_tool_shader(collect_media_coverage_address.frag collect.frag COLLECT_MEDIA VITRAIL_BUFFER_REFERENCE
                  VITRAIL_POST_DEPTH_COVERAGE)
embed_tool_shader(media_resolve_address.comp media_resolve.comp VITRAIL_BUFFER_REFERENCE)
embed_tool_shader(media_resolve_samples.comp media_resolve.comp MEDIA_SAMPLES=8)
embed_tool_shader(media_resolve_samples_address.comp media_resolve.comp MEDIA_SAMPLES=8 VITRAIL_BUFFER_REFERENCE)
# The resolve of pictures that lack surfaces or are not sorted.
foreach(address "" _address)
  set(by "")
  if(address)
    set(by VITRAIL_BUFFER_REFERENCE)
    embed_tool_shader(plain_resolve_address.comp plain_resolve.comp ${by})
  endif()
  embed_tool_shader(plain_resolve_samples${address}.comp plain_resolve.comp RESOLVE_SAMPLES=8 ${by})
  embed_tool_shader(plain_resolve_depths${address}.comp plain_resolve.comp RESOLVE_SAMPLES=8 RESOLVE_DEPTH ${by})
endforeach()
