// Reads whole files from disk, or maps them.
#include "read_file.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <fmt/format.h>

#include "load.h"
#include "message.h"
#include "plain/find_file.h"

namespace vitrail::tool {

namespace {

// The size of a regular file that is neither empty nor absurdly large.
std::size_t sizeOfFile(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw LoadError("no such file");
  if (error) throw LoadError(fmt::format("cannot be read: {}", error.message()));
  if (std::filesystem::is_directory(status)) throw LoadError("is a directory, not a file");
  // A pipe or a device could deliver bytes for ever.
  if (!std::filesystem::is_regular_file(status)) throw LoadError("is not a regular file");

  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw LoadError(fmt::format("cannot be read: {}", error.message()));
  if (size == 0) throw LoadError("is empty");
  if (size > std::uintmax_t{1} << 36U) throw LoadError(fmt::format("is too large ({} bytes)", size));
  return static_cast<std::size_t>(size);
}

// Opens a file that a model names with `open`.
template <typename Open>
auto openBeside(std::string_view name, const std::filesystem::path& base, Open open) {
  const auto fail = [name](std::string_view reason) -> LoadError {
    return LoadError(fmt::format("{}: {}", oneLine(name), reason));
  };
  if (base.empty()) throw fail("external files are not read here");
  if (name.empty() || name.find('\0') != std::string_view::npos) throw fail("is not a file name");
  std::filesystem::path path = base / std::filesystem::path(name);
  std::error_code ignored;
  const bool isAbsolute = std::filesystem::path(name).is_absolute();
  if (isAbsolute || !std::filesystem::exists(path, ignored)) {
    const std::optional<std::filesystem::path> found = findFile(name, std::span(&base, 1));
    if (isAbsolute && !found) throw fail("is not relative to the model");
    path = found.value_or(path);
  }
  try {
    return open(path);
  } catch (const LoadError& error) {
    throw fail(error.what());
  }
}

} // namespace

std::vector<std::byte> readFile(const std::filesystem::path& path) {
  const std::size_t size = sizeOfFile(path);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw LoadError(fmt::format("cannot be read: {}", std::strerror(errno)));
  std::vector<std::byte> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream) throw LoadError("cannot be read to its end");
  return bytes;
}

std::vector<std::byte> readFileBeside(std::string_view name, const std::filesystem::path& base) {
  return openBeside(name, base, [](const std::filesystem::path& path) { return readFile(path); });
}

MappedFile mapFileBeside(std::string_view name, const std::filesystem::path& base) {
  return openBeside(name, base, [](const std::filesystem::path& path) { return MappedFile(path); });
}

MappedFile::MappedFile(const std::filesystem::path& path) {
  const std::size_t size = sizeOfFile(path);
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw LoadError(fmt::format("cannot be read: {}", std::strerror(errno)));
  void* const start = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
  close(file);
  if (start == MAP_FAILED) {
    *this = MappedFile(readFile(path));
    return;
  }
  bytes_ = {static_cast<const std::byte*>(start), size};
  mapped_ = true;
}

MappedFile::MappedFile(std::vector<std::byte> bytes) : owned_(std::move(bytes)) { bytes_ = owned_; }

MappedFile::MappedFile(MappedFile&& other) noexcept { *this = std::move(other); }

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_); // a vector's bytes stay where they are when it is swapped
  std::swap(owned_, other.owned_);
  std::swap(mapped_, other.mapped_);
  return *this;
}

MappedFile::~MappedFile() {
  if (mapped_) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

void MappedFile::release(std::span<const std::byte> part) const {
  if (!mapped_ || part.empty()) return;
  const std::less<const std::byte*> before;
  if (before(part.data(), bytes_.data()) || before(bytes_.data() + bytes_.size(), part.data() + part.size())) return;
  // Whole pages alone; what lies beside the part may still be in use.
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const auto offset = static_cast<std::size_t>(part.data() - bytes_.data());
  const std::size_t begin = (offset + page - 1) / page * page;
  const std::size_t end = (offset + part.size()) / page * page;
  if (begin < end) madvise(const_cast<std::byte*>(bytes_.data() + begin), end - begin, MADV_DONTNEED);
}

} // namespace vitrail::tool
