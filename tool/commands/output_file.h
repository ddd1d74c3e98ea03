// Files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace vitrail::tool {

// A file that is written beside its final name and moved there by commit(). Until then the final name is untouched; a
// temporary file is removed by the destructor, and by Ctrl-C, SIGTERM and SIGHUP.
class OutputFile {
 public:
  // Checks that the file can be made, so that nobody waits for a picture that cannot be kept: throws
  // std::runtime_error with a one-line reason. "-" is standard output.
  explicit OutputFile(std::filesystem::path path);
  // What this program was started with as standard output.
  static OutputFile standardOutput();
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Writes the whole content to the temporary file. A name that stands for something other than a regular file, such as
  // /dev/stdout, has no temporary file and is written by commit(). Throws std::runtime_error.
  void write(std::span<const std::byte> content);

  // Makes the temporary file, empty, for another program to write, in place of write(): a descriptor of it, which the
  // caller closes. Not for special files. Throws std::runtime_error.
  int create();

  // Gives the file its name. Throws std::runtime_error.
  void commit();

  // Whether the name stands for something other than a regular file.
  [[nodiscard]] bool isSpecial() const { return isSpecial_; }

  // What messages call it.
  [[nodiscard]] std::string name() const { return isStandardOutput_ ? "standard output" : path_.string(); }

  // Whether this would write over that file, under whatever name.
  [[nodiscard]] bool overwrites(const std::filesystem::path& file) const;

  // Whether both would write one regular file, under whatever names, or standard output.
  [[nodiscard]] bool isSameAs(const OutputFile& other) const;

 private:
  std::filesystem::path path_;   // as the user wrote it
  std::filesystem::path target_; // with links followed
  std::filesystem::path temporary_;
  std::span<const std::byte> special_; // what commit() writes to a special file
  bool isSpecial_ = false;
  bool isStandardOutput_ = false;

  struct Standard {};
  explicit OutputFile(Standard /*output*/) : isSpecial_(true), isStandardOutput_(true) {}
};

// Throws UsageError where an output would be written over one of the files that are read.
void checkNotRead(const OutputFile& output, std::span<const std::string> files);

// Has a signal remove a folder too, where it is empty by then. Watch it before the files in it.
void watchFolder(const std::filesystem::path& folder);
void unwatchFolder(const std::filesystem::path& folder);

} // namespace vitrail::tool
