// Opens model files. Every failure is a LoadError whose text says what is wrong with which file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "read_file.h"
#include "scene.h"

namespace vitrail::tool {

// A file that cannot be used: what() is one line without a file name in front, as in
// "accessor 3 reads 96 bytes past the end of buffer view 2".
struct LoadError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What of a file that holds several states is drawn.
struct LoadOptions {
  std::optional<double> time;           // seconds into the animation; none: the rest pose, no animation
  std::optional<std::string> animation; // a name, or else a number from 0; none: the first
  std::optional<std::string> variant;   // of KHR_materials_variants; none: the file's default materials
  bool optional = false;                // a file without that animation, or variant, is loaded as it is
};

// The index of the animation with that name or number, the first where there is no choice; none: there is no such.
std::optional<std::size_t> chosenAnimation(const std::vector<FileFacts::Animation>& animations,
                                           const std::optional<std::string>& choice);
// Whether a file has what the options choose.
bool hasAnimation(const FileFacts& file, const LoadOptions& options);
bool hasVariant(const FileFacts& file, const LoadOptions& options);

// Loads a model by its file's content and extension: .gltf, .glb, .obj, .ply, .stl (any case).
// Throws LoadError; a file without any triangle, line or point is an error. What is left out of the scene, or drawn
// otherwise than the file says, is among the scene's warnings.
Scene loadModel(const std::filesystem::path& path, const LoadOptions& options = {});

// The glTF part, also reachable from memory for fuzzing: `base` is the folder for external buffers and images; when it
// is empty external files are refused.
Scene loadGltf(std::span<const std::byte> file, const std::filesystem::path& base, const LoadOptions& options = {});
Scene loadGltf(MappedFile file, const std::filesystem::path& base, const LoadOptions& options = {});

// The other formats, likewise. `base` is the folder for an OBJ's .mtl and for textures; when it is empty none are read.
// Missing ones leave a plain material and a warning.
Scene loadObj(std::span<const std::byte> file, const std::filesystem::path& base);
Scene loadPly(std::span<const std::byte> file, const std::filesystem::path& base);
Scene loadStl(std::span<const std::byte> file);

} // namespace vitrail::tool
