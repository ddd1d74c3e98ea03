// Opens model files: picks the reader by the file's extension.
#include "load.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <new>
#include <span>
#include <string>
#include <utility>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <fmt/format.h>

#include "message.h"
#include "read_file.h"

namespace vitrail::tool {
namespace {

constexpr const char* knownExtensions = ".gltf, .glb, .obj, .ply and .stl";

// ".GLB" becomes "glb".
std::string extensionOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// The folder of external files. Never empty, since an empty one would refuse them.
std::filesystem::path folderOf(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

// What loading needed beside the scene is free now. Small pieces of it stay with the C library, and drawing, which asks
// for large ones, cannot have them.
void giveBackMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

} // namespace

std::optional<std::size_t> chosenAnimation(const std::vector<FileFacts::Animation>& animations,
                                           const std::optional<std::string>& choice) {
  if (animations.empty()) return std::nullopt;
  if (!choice) return 0;
  const auto named = std::ranges::find(animations, *choice, &FileFacts::Animation::name);
  if (named != animations.end()) return static_cast<std::size_t>(named - animations.begin());
  std::size_t number = 0;
  const char* const end = choice->data() + choice->size();
  const auto [stop, error] = std::from_chars(choice->data(), end, number);
  if (error == std::errc{} && stop == end && number < animations.size()) return number;
  return std::nullopt;
}

bool hasAnimation(const FileFacts& file, const LoadOptions& options) {
  return chosenAnimation(file.animations, options.animation).has_value();
}

bool hasVariant(const FileFacts& file, const LoadOptions& options) {
  return options.variant && std::ranges::find(file.variants, *options.variant) != file.variants.end();
}

Scene loadModel(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string extension = extensionOf(path);
  try {
    // A missing file is the more helpful thing to say about a mistyped name.
    MappedFile mapped(path);
    const std::span<const std::byte> file = mapped.bytes();
    Scene scene;
    if (extension == "gltf" || extension == "glb")
      scene = loadGltf(std::move(mapped), folderOf(path), options);
    else if (!options.optional && (options.time || options.animation))
      throw LoadError("holds no animations: files of its format cannot");
    else if (!options.optional && options.variant)
      throw LoadError("has no variants of its materials: files of its format cannot");
    else if (extension == "obj")
      scene = loadObj(file, folderOf(path));
    else if (extension == "ply")
      scene = loadPly(file, folderOf(path));
    else if (extension == "stl")
      scene = loadStl(file);
    else if (extension.empty())
      throw LoadError(fmt::format("has no extension; {} can be read", knownExtensions));
    else
      throw LoadError(
          fmt::format("has the unknown extension .{}; {} can be read", oneLine(extension), knownExtensions));
    scene.name = path.stem().string();
    giveBackMemory();
    return scene;
  } catch (const std::bad_alloc&) {
    throw LoadError("there is not enough memory to load it");
  }
}

} // namespace vitrail::tool
