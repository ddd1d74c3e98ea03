// A folder of files that appear together, each whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "output_file.h"

namespace vitrail::tool {

// Files are written beside their final names in the folder, and get these by commit(). Until then files that were there
// are untouched; the temporary ones are removed as OutputFile does it, and so is the folder where it was made for them.
class OutputFolder {
 public:
  // Checks that the folder can be made, or is there and can be written to: throws std::runtime_error with a one-line
  // reason. Makes nothing yet.
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Checks that files of these names can be written, as OutputFile does it: throws std::runtime_error.
  void check(const std::vector<std::string>& names) const;

  // Whether the file is the one of that name in the folder, under whatever name.
  [[nodiscard]] bool has(const std::string& name, const OutputFile& file) const;

  // Writes a whole file under a temporary name; the folder is made where there is none. Throws std::runtime_error.
  void write(const std::string& name, std::span<const std::byte> content);

  // Gives all files their names. Throws std::runtime_error.
  void commit();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool made_ = false; // and not committed yet
  std::vector<std::unique_ptr<OutputFile>> files_;
};

// Throws UsageError where the file of an option is one of those that will be written to the folder.
void checkApart(const OutputFolder& folder, const std::vector<std::string>& names, const std::string& option,
                const OutputFile& file);

} // namespace vitrail::tool
