/* Stands before the real header where a host must do without it. */
#error "this host has no Vulkan headers"
