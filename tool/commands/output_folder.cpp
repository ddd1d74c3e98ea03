#include "output_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "errors.h"

namespace vitrail::tool {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw std::runtime_error(fmt::format("cannot write to the folder {}: {}", path.string(), reason));
}

} // namespace

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
  if (!path_.has_filename()) path_ = path_.parent_path(); // "name/"
  std::error_code error;
  if (fs::exists(path_, error)) {
    if (!fs::is_directory(path_, error)) fail(path_, "it is not a folder");
    if (::access(path_.c_str(), W_OK | X_OK) != 0) fail(path_, std::strerror(errno));
    return;
  }
  const fs::path parent = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
  if (!fs::is_directory(parent, error)) fail(path_, fmt::format("there is no folder {}", parent.string()));
  if (::access(parent.c_str(), W_OK | X_OK) != 0) fail(path_, std::strerror(errno));
}

OutputFolder::~OutputFolder() {
  files_.clear(); // removes what was not committed
  if (made_) ::rmdir(path_.c_str());
}

void OutputFolder::check(const std::vector<std::string>& names) const {
  std::error_code error;
  if (!fs::is_directory(path_, error)) return; // it is made, and holds nothing
  for (const std::string& name : names) static_cast<void>(OutputFile(path_ / name));
}

bool OutputFolder::has(const std::string& name, const OutputFile& file) const {
  std::error_code error;
  return fs::is_directory(path_, error) && OutputFile(path_ / name).isSameAs(file);
}

void OutputFolder::write(const std::string& name, std::span<const std::byte> content) {
  if (!made_ && ::mkdir(path_.c_str(), 0777) == 0) {
    made_ = true;
    watchFolder(path_);
  } else if (!made_ && errno != EEXIST) {
    fail(path_, std::strerror(errno));
  }
  files_.push_back(std::make_unique<OutputFile>(path_ / name));
  files_.back()->write(content);
}

void OutputFolder::commit() {
  for (const std::unique_ptr<OutputFile>& file : files_) file->commit();
  if (made_) unwatchFolder(path_);
  made_ = false;
}

void checkApart(const OutputFolder& folder, const std::vector<std::string>& names, const std::string& option,
                const OutputFile& file) {
  for (const std::string& name : names) {
    if (!folder.has(name, file)) continue;
    throw UsageError(
        fmt::format("-o writes {} itself: leave {} out or name another file", (folder.path() / name).string(), option));
  }
}

} // namespace vitrail::tool
