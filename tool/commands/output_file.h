// Files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace vitrail::tool {

// A file that is written beside its final name and moved there by commit(). Until then the final name is untouched; a
// temporary file is removed by the destructor, and by Ctrl-C, SIGTERM and SIGHUP.
class OutputFile {
 public:
  // Checks that the file can be made, so that nobody waits for a picture that cannot be kept: throws
  // std::runtime_error with a one-line reason.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Writes the whole content to the temporary file. A name that stands for something other than a regular file, such as
  // /dev/stdout, has no temporary file and is written by commit(). Throws std::runtime_error.
  void write(std::span<const std::byte> content);

  // Gives the file its name. Throws std::runtime_error.
  void commit();

  // Whether the name stands for something other than a regular file.
  [[nodiscard]] bool isSpecial() const { return isSpecial_; }

  // Whether both would write one regular file, under whatever names.
  [[nodiscard]] bool isSameAs(const OutputFile& other) const;

 private:
  std::filesystem::path path_;   // as the user wrote it
  std::filesystem::path target_; // with links followed
  std::filesystem::path temporary_;
  std::span<const std::byte> special_; // what commit() writes to a special file
  bool isSpecial_ = false;
};

// Has a signal remove a folder too, where it is empty by then. Watch it before the files in it.
void watchFolder(const std::filesystem::path& folder);
void unwatchFolder(const std::filesystem::path& folder);

} // namespace vitrail::tool
