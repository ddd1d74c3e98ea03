// A glTF or GLB file taken apart: its JSON as checked structures, and the bytes that they refer to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tinygltf.h"

namespace vitrail::tool {

// Where the bytes of an image are: in a buffer view, or else behind a URI.
struct GltfImageSource {
  std::string name;
  std::optional<std::size_t> bufferView;
  std::string uri;
};

struct GltfDocument {
  // All indices in it are in range, as gltf_check.h promises. Its own buffers and images are empty; those below stand
  // in for them.
  tinygltf::Model model;
  std::vector<std::vector<std::byte>> buffers; // each holds at least the byteLength that the file states
  std::vector<GltfImageSource> images;
  std::filesystem::path base;   // the folder of external files; empty: they are refused
  std::uint64_t totalBytes = 0; // the file and its external buffers
};

// Throws LoadError.
GltfDocument openGltf(std::span<const std::byte> file, const std::filesystem::path& base);

// The bytes of a buffer view. Throws LoadError where it reaches past the end of its buffer.
std::span<const std::byte> bufferViewBytes(const GltfDocument& document, std::size_t bufferView);

} // namespace vitrail::tool
