// tinygltf's implementation, compiled here so that sanitizers and the fuzzer see into it.
#include <fstream> // tinygltf writes with it, but does not include it under TINYGLTF_NO_FS

#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include "tinygltf.h"
