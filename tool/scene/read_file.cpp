// Reads whole files from disk.
#include "read_file.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "load.h"
#include "message.h"

namespace vitrail::tool {

std::vector<std::byte> readFile(const std::filesystem::path& path) {
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

  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw LoadError(fmt::format("cannot be read: {}", std::strerror(errno)));
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream) throw LoadError("cannot be read to its end");
  return bytes;
}

std::vector<std::byte> readFileBeside(std::string_view name, const std::filesystem::path& base) {
  const auto fail = [name](std::string_view reason) -> LoadError {
    return LoadError(fmt::format("{}: {}", oneLine(name), reason));
  };
  if (base.empty()) throw fail("external files are not read here");
  if (name.empty() || name.find('\0') != std::string_view::npos) throw fail("is not a file name");
  const std::filesystem::path path(name);
  if (path.is_absolute()) throw fail("is not relative to the model");
  try {
    return readFile(base / path);
  } catch (const LoadError& error) {
    throw fail(error.what());
  }
}

} // namespace vitrail::tool
