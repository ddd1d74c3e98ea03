// Reads whole files from disk, and refuses what is not a file of a sensible size.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace vitrail::tool {

// The bytes of a regular file. Throws LoadError without a file name in front: "no such file", "is a directory", "is
// empty", "is not a regular file", or why it cannot be read.
std::vector<std::byte> readFile(const std::filesystem::path& path);

// The bytes of a file that a model names, relative to the model's folder `base`. Throws LoadError that begins with the
// name, also where `base` is empty (no file is read then) or the name is an absolute path.
std::vector<std::byte> readFileBeside(std::string_view name, const std::filesystem::path& base);

// The bytes of a file, mapped into memory where the system can do that, else read: a large model is then in memory only
// as far as it is looked at. A file that another program shortens meanwhile ends this one with SIGBUS, as it does
// everything that maps files; the alternative costs every user the memory of a copy.
class MappedFile {
 public:
  // Throws LoadError as readFile does.
  explicit MappedFile(const std::filesystem::path& path);
  // Bytes that are in memory already.
  explicit MappedFile(std::vector<std::byte> bytes);
  // Bytes that somebody else keeps.
  explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

  // Says that `part` of the bytes is not looked at again soon: it leaves the memory if it is mapped. It is read again
  // where it is looked at nevertheless.
  void release(std::span<const std::byte> part) const;

 private:
  std::span<const std::byte> bytes_;
  std::vector<std::byte> owned_;
  bool mapped_ = false;
};

// readFileBeside(), mapped.
MappedFile mapFileBeside(std::string_view name, const std::filesystem::path& base);

} // namespace vitrail::tool
