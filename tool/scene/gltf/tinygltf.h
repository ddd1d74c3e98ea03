// tinygltf, with the configuration that every file of the loader must share. It turns checked JSON into typed
// structures and nothing else: files, URIs and images are read by code of our own that knows how to refuse them.
#pragma once

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
