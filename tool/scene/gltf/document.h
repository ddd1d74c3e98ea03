// A glTF or GLB file taken apart: its JSON as checked structures, and the bytes that they refer to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "../read_file.h"
#include "../scene.h"
#include "node_list.h"
#include "tinygltf.h"

namespace vitrail::tool {

// Where the bytes of an image are: in a buffer view, or else behind a URI.
struct GltfImageSource {
  std::string name;
  std::optional<std::size_t> bufferView;
  std::string uri;
};

struct GltfScene {
  std::string name;
  std::vector<std::uint32_t> nodes;
  std::vector<std::string> extensions; // the names of those that it has
};

struct GltfAnimation {
  struct Sampler {
    std::size_t input = 0; // accessors
    std::size_t output = 0;
    std::string interpolation = "LINEAR";
  };
  struct Channel {
    std::size_t sampler = 0;
    std::optional<std::uint32_t> node;
    std::string path;
  };
  std::string name;
  std::vector<Channel> channels;
  std::vector<Sampler> samplers;
};

struct GltfDocument {
  // All indices in it are in range, as check.h promises. Its own buffers, images, nodes, scenes, animations and lights
  // are empty; those below stand in for them.
  tinygltf::Model model;
  GltfNodes nodes;
  std::vector<GltfScene> scenes;
  std::size_t defaultScene = 0;
  std::vector<GltfAnimation> animations;
  std::vector<std::optional<Light>> lights; // of KHR_lights_punctual, not yet placed; none: of a kind that is unknown
  std::vector<std::string> variants;        // of KHR_materials_variants
  std::vector<GltfImageSource> images;
  std::map<std::size_t, std::string> wrongCameras; // what is wrong with those of the model that stand for no camera
  std::vector<std::string> extensionsUsed;         // with those that are only required
  std::vector<std::string> extensionsRequired;
  std::vector<std::string> extensions; // the names of those that the document itself has
  std::string generator;
  bool binary = false;

  // What compressed buffer views hold once they are decoded, by the view: it stands for the bytes in the file.
  std::unordered_map<std::size_t, std::vector<std::byte>> decodedViews;
  std::uint64_t decodedBytes = 0;    // of all of them
  std::vector<std::string> warnings; // of what was read so far

  std::vector<MappedFile> files;                   // the file itself, then what its buffers' URIs lead to
  std::vector<std::span<const std::byte>> buffers; // in those; each has the byteLength that the file states
  std::filesystem::path base;                      // the folder of external files; empty: they are refused
  std::uint64_t totalBytes = 0;                    // the file and its external buffers
};

// Throws LoadError.
GltfDocument openGltf(MappedFile file, const std::filesystem::path& base);

// A range of a buffer. Throws LoadError where it reaches past the end.
std::span<const std::byte> bufferBytes(const GltfDocument& document, std::size_t buffer, std::size_t byteOffset,
                                       std::size_t byteLength);

// Lets a buffer view have those bytes. Throws LoadError where all such bytes together are out of proportion to the
// file: a small one that names one stream many times could fill the memory.
void keepDecoded(GltfDocument& document, std::size_t bufferView, std::vector<std::byte> bytes);

// The bytes of a buffer view. Throws LoadError where it reaches past the end of its buffer.
std::span<const std::byte> bufferViewBytes(const GltfDocument& document, std::size_t bufferView);

// Says that these bytes of a buffer are not looked at again soon.
void releaseBytes(const GltfDocument& document, std::span<const std::byte> bytes);

} // namespace vitrail::tool
