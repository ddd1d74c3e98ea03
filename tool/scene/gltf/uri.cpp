// Data URIs (RFC 2397), percent-encoding (RFC 3986) and base64 (RFC 4648).
#include "uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"
#include "../read_file.h"

namespace vitrail::tool {
namespace {

std::optional<unsigned> hexDigit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10U;
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10U;
  return std::nullopt;
}

// A percent sign without two hexadecimal digits stands for itself, since exporters often forget to encode it.
std::string percentDecoded(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && text.size() - i > 2) {
      const auto high = hexDigit(text[i + 1]);
      const auto low = hexDigit(text[i + 2]);
      if (high && low) {
        decoded += static_cast<char>(*high * 16U + *low);
        i += 2;
        continue;
      }
    }
    decoded += text[i];
  }
  return decoded;
}

constexpr std::array<std::int8_t, 256> base64Values = [] {
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::int8_t>(i);
  return values;
}();

std::vector<std::byte> base64Decoded(std::string_view text) {
  std::size_t padding = 0;
  while (padding < 2 && !text.empty() && text.back() == '=') {
    text.remove_suffix(1);
    ++padding;
  }
  if (text.size() % 4 == 1) throw LoadError("its data URI ends in the middle of a base64 group");
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  unsigned bitCount = 0;
  for (const char c : text) {
    const std::int8_t value = base64Values[static_cast<unsigned char>(c)];
    if (value < 0) throw LoadError("its data URI holds a character that is not base64");
    bits = ((bits << 6U) | static_cast<std::uint32_t>(value)) & 0xffffffU;
    bitCount += 6;
    if (bitCount >= 8) {
      bitCount -= 8;
      bytes.push_back(static_cast<std::byte>((bits >> bitCount) & 0xffU));
    }
  }
  return bytes;
}

std::vector<std::byte> dataUriPayload(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) throw LoadError("its data URI has no comma in front of the data");
  const std::string_view header = uri.substr(0, comma);
  const std::string payload = percentDecoded(uri.substr(comma + 1));
  if (header.ends_with(";base64")) return base64Decoded(payload);
  const auto bytes = std::as_bytes(std::span(payload));
  return {bytes.begin(), bytes.end()};
}

// "http:" and the like, but not the drive letter or odd name that a lone colon may stand for.
bool hasScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon < 2) return false;
  return std::ranges::all_of(uri.substr(0, colon), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
  });
}

// The name of the file that a URI stands for.
std::string fileName(std::string_view uri) {
  if (uri.empty()) throw LoadError("its uri is empty");
  if (hasScheme(uri)) throw LoadError(fmt::format("{} is not a local file", oneLine(uri)));
  return percentDecoded(uri);
}

} // namespace

std::vector<std::byte> readUri(std::string_view uri, const std::filesystem::path& base) {
  if (uri.starts_with("data:")) return dataUriPayload(uri);
  return readFileBeside(fileName(uri), base);
}

MappedFile mapUri(std::string_view uri, const std::filesystem::path& base) {
  if (uri.starts_with("data:")) return MappedFile(dataUriPayload(uri));
  return mapFileBeside(fileName(uri), base);
}

} // namespace vitrail::tool
