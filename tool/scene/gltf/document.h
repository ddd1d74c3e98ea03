// A glTF or GLB file taken apart: its JSON as checked structures, and the bytes that they refer to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
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
  // What compressed buffer views hold once they are decoded, by the view: it stands for the bytes in the file.
  std::unordered_map<std::size_t, std::vector<std::byte>> decodedViews;
  std::uint64_t decodedBytes = 0;    // of all of them
  std::vector<std::string> warnings; // of what was read so far; those of the scene begin with them
  std::filesystem::path base;        // the folder of external files; empty: they are refused
  std::uint64_t totalBytes = 0;      // the file and its external buffers
};

// Throws LoadError.
GltfDocument openGltf(std::span<const std::byte> file, const std::filesystem::path& base);

// A range of a buffer. Throws LoadError where it reaches past the end.
std::span<const std::byte> bufferBytes(const GltfDocument& document, std::size_t buffer, std::size_t byteOffset,
                                       std::size_t byteLength);

// Lets a buffer view have those bytes. Throws LoadError where all such bytes together are out of proportion to the
// file: a small one that names one stream many times could fill the memory.
void keepDecoded(GltfDocument& document, std::size_t bufferView, std::vector<std::byte> bytes);

// The bytes of a buffer view. Throws LoadError where it reaches past the end of its buffer.
std::span<const std::byte> bufferViewBytes(const GltfDocument& document, std::size_t bufferView);

} // namespace vitrail::tool
