# The encoded picture as an image that stays on the GPU.
embed_tool_shader(encode_image.comp encode.comp ENCODE_IMAGE)
# Picking: fragments with the numbers of their instances, and the walk of one list.
embed_tool_shader(surface_object_clipped.vert ../stage/surface.vert SURFACE_OBJECT SURFACE_CLIPPED)
embed_tool_shader(collect_instance.frag ../methods/linked_list/collect.frag COLLECT_INSTANCE)
embed_tool_shader(collect_instance_address.frag ../methods/linked_list/collect.frag COLLECT_INSTANCE VITRAIL_BUFFER_REFERENCE)
embed_tool_shader(pick_address.comp pick.comp VITRAIL_BUFFER_REFERENCE)
