# The encoded picture as an image that stays on the GPU.
embed_tool_shader(encode_image.comp encode.comp ENCODE_IMAGE)
