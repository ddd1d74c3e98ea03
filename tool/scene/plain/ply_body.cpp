// Reads the values of a PLY file's elements.
#include "ply_body.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"
#include "number_or_nan.h"

namespace vitrail::tool {
namespace {

PlySlot slotNamed(std::string_view name) {
  using enum PlySlot;
  constexpr std::array<std::pair<std::string_view, PlySlot>, 41> slots{{
      {"x", X},
      {"y", Y},
      {"z", Z},
      {"nx", NormalX},
      {"ny", NormalY},
      {"nz", NormalZ},
      {"normal_x", NormalX},
      {"normal_y", NormalY},
      {"normal_z", NormalZ},
      {"red", Red},
      {"green", Green},
      {"blue", Blue},
      {"alpha", Alpha},
      {"r", Red},
      {"g", Green},
      {"b", Blue},
      {"a", Alpha},
      {"diffuse_red", Red},
      {"diffuse_green", Green},
      {"diffuse_blue", Blue},
      {"diffuse_alpha", Alpha},
      {"u", U},
      {"v", V},
      {"s", U},
      {"t", V},
      {"texture_u", U},
      {"texture_v", V},
      {"texture_s", U},
      {"texture_t", V},
      {"texcoord_u", U},
      {"texcoord_v", V},
      {"f_dc_0", SplatRed},
      {"f_dc_1", SplatGreen},
      {"f_dc_2", SplatBlue},
      {"opacity", SplatOpacity},
      {"texnumber", TexNumber},
      {"tx", TexNumber},
      {"vertex1", Vertex1},
      {"vertex2", Vertex2},
      {"vertex_1", Vertex1},
      {"vertex_2", Vertex2},
  }};
  const auto* const found =
      std::ranges::find(slots, name, [](const std::pair<std::string_view, PlySlot>& known) { return known.first; });
  return found == slots.end() ? None : found->second;
}

PlyList listNamed(std::string_view name) {
  if (name == "vertex_indices" || name == "vertex_index") return PlyList::Corners;
  if (name == "texcoord") return PlyList::TexCoords;
  if (name == "color") return PlyList::Colors;
  if (name == "texture_vertex_indices") return PlyList::TexCorners;
  return PlyList::None;
}

template <typename Number, typename Bits>
double numberFrom(const std::byte* at, bool swapped) {
  static_assert(sizeof(Number) == sizeof(Bits));
  Bits bits;
  std::memcpy(&bits, at, sizeof bits);
  if (swapped) {
    if constexpr (sizeof bits == 2) bits = __builtin_bswap16(bits);
    if constexpr (sizeof bits == 4) bits = __builtin_bswap32(bits);
    if constexpr (sizeof bits == 8) bits = __builtin_bswap64(bits);
  }
  return static_cast<double>(std::bit_cast<Number>(bits));
}

} // namespace

PlyLayout::PlyLayout(const PlyElement& element) {
  for (const PlyProperty& property : element.properties) {
    const PlySlot slot = property.isList ? PlySlot::None : slotNamed(property.name);
    const PlyList list = property.isList ? listNamed(property.name) : PlyList::None;
    slots_.push_back(slot);
    lists_.push_back(list);
    present_[static_cast<std::size_t>(slot)] = true;
    types_[static_cast<std::size_t>(slot)] = property.type;
    listPresent_[static_cast<std::size_t>(list)] = true;
    hasLists_ = hasLists_ || property.isList;
    if (slot != PlySlot::None) fields_.push_back({slot, property.type, leastBytes_});
    leastBytes_ += sizeOf(property.isList ? property.countType : property.type);
  }
  if (isFaces(element) && !has(PlyList::Corners)) findCorners(element);
}

// Some writers have other names for the corners of faces.
void PlyLayout::findCorners(const PlyElement& element) {
  std::size_t found = element.properties.size();
  std::size_t candidates = 0;
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (!property.isList || lists_[p] != PlyList::None) continue;
    if (property.name == "vertex_indexes" || property.name == "indices") {
      found = p;
      candidates = 1;
      break;
    }
    if (!isInteger(property.type)) continue;
    found = p;
    ++candidates;
  }
  if (candidates != 1) return;
  lists_[found] = PlyList::Corners;
  listPresent_[static_cast<std::size_t>(PlyList::Corners)] = true;
}

PlyBody::PlyBody(std::span<const std::byte> bytes, const PlyHeader& header)
    : bytes_(bytes),
      encoding_(header.encoding),
      swapped_((encoding_ == PlyEncoding::BigEndian) == (std::endian::native == std::endian::little)) {
  if (encoding_ != PlyEncoding::Text) return;
  double stated = 0.0;
  for (const PlyElement& element : header.elements) stated += static_cast<double>(element.count);
  const auto lines = std::max(std::ranges::count(bytes, std::byte{'\n'}), std::ranges::count(bytes, std::byte{'\r'}));
  hasLines_ = static_cast<double>(lines + 1) >= stated;
}

std::uint64_t PlyBody::roomFor(std::uint64_t count, std::size_t bytes) const {
  const std::size_t left = bytes_.size() - offset_;
  // In text each takes a character and a separator at least; the last one needs no separator.
  return std::min<std::uint64_t>(
      count, encoding_ == PlyEncoding::Text ? (left + 1) / 2 : left / std::max<std::size_t>(bytes, 1));
}

PlyEnd PlyBody::endIn(const PlyElement& element, std::uint64_t number) {
  return {fmt::format("the file ends in {} {} of {}", oneLine(element.name), number + 1, element.count)};
}

// Passes over what is left of the line of a row that began and ended on it.
void PlyBody::skipLongLine(std::size_t rowBegin) {
  const auto at = [this](std::size_t i) { return static_cast<char>(bytes_[i]); };
  std::size_t next = offset_;
  while (next < bytes_.size() && endsWord(at(next)) && !endsLine(at(next))) ++next;
  if (next == bytes_.size() || endsLine(at(next))) return;
  while (endsWord(at(rowBegin))) ++rowBegin;
  for (std::size_t i = rowBegin; i < offset_; ++i)
    if (endsLine(at(i))) return;
  while (next < bytes_.size() && !endsLine(at(next))) ++next;
  offset_ = next;
  ++longLines_;
}

void PlyBody::readRow(const PlyElement& element, const PlyLayout& layout, std::uint64_t number, PlyRow& row) {
  const std::size_t begin = offset_;
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (property.isList) {
      const PlyList list = layout.listOf(p);
      readList(element, property, number, list == PlyList::None ? nullptr : &row.lists[static_cast<std::size_t>(list)]);
    } else {
      row.values[static_cast<std::size_t>(layout.slotOf(p))] = next(element, property.type, number);
    }
  }
  if (hasLines_) skipLongLine(begin);
}

void PlyBody::readList(const PlyElement& element, const PlyProperty& property, std::uint64_t number,
                       std::vector<double>* values) {
  const double length = next(element, property.countType, number);
  if (!(length >= 0.0 && length <= 4294967295.0) || length != std::floor(length))
    throw LoadError(fmt::format("{} {}: a list has the length {}", oneLine(element.name), number, length));
  const auto count = static_cast<std::uint64_t>(length);
  const std::size_t size = sizeOf(property.type);
  if (roomFor(count, size) < count) throw endIn(element, number);
  if (values != nullptr) values->resize(count);
  if (encoding_ == PlyEncoding::Text) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const double value = nextWord(element, number);
      if (values != nullptr) (*values)[i] = value;
    }
    return;
  }
  if (values != nullptr)
    for (std::uint64_t i = 0; i < count; ++i) (*values)[i] = decode(property.type, &bytes_[offset_ + i * size]);
  offset_ += count * size;
}

double PlyBody::next(const PlyElement& element, PlyType type, std::uint64_t number) {
  if (encoding_ == PlyEncoding::Text) return nextWord(element, number);
  const std::size_t size = sizeOf(type);
  if (bytes_.size() - offset_ < size) throw endIn(element, number);
  const double value = decode(type, &bytes_[offset_]);
  offset_ += size;
  return value;
}

double PlyBody::nextWord(const PlyElement& element, std::uint64_t number) {
  const char* const text = reinterpret_cast<const char*>(bytes_.data());
  const char* const end = text + bytes_.size();
  const char* begin = text + offset_;
  while (begin != end && endsWord(*begin)) ++begin;
  if (begin == end) throw endIn(element, number);
  double value = 0.0;
  const char* const after = parseNumberOrNan(begin, end, value);
  if (after == nullptr || (after != end && !endsWord(*after))) {
    if (std::find_if(begin, end, endsWord) == end) throw endIn(element, number); // cut off in a number
    const std::string_view word(begin, static_cast<std::size_t>(std::find_if(begin, end, endsWord) - begin));
    throw LoadError(fmt::format("{} {}: \"{}\" is not a number", oneLine(element.name), number, oneLine(word)));
  }
  offset_ = static_cast<std::size_t>(after - text);
  return value;
}

double PlyBody::decode(PlyType type, const std::byte* at) const {
  switch (type) {
    case PlyType::Int8:
      return numberFrom<std::int8_t, std::uint8_t>(at, swapped_);
    case PlyType::Uint8:
      return numberFrom<std::uint8_t, std::uint8_t>(at, swapped_);
    case PlyType::Int16:
      return numberFrom<std::int16_t, std::uint16_t>(at, swapped_);
    case PlyType::Uint16:
      return numberFrom<std::uint16_t, std::uint16_t>(at, swapped_);
    case PlyType::Int32:
      return numberFrom<std::int32_t, std::uint32_t>(at, swapped_);
    case PlyType::Uint32:
      return numberFrom<std::uint32_t, std::uint32_t>(at, swapped_);
    case PlyType::Int64:
      return numberFrom<std::int64_t, std::uint64_t>(at, swapped_);
    case PlyType::Uint64:
      return numberFrom<std::uint64_t, std::uint64_t>(at, swapped_);
    case PlyType::Float32:
      return numberFrom<float, std::uint32_t>(at, swapped_);
    case PlyType::Float64:
      return numberFrom<double, std::uint64_t>(at, swapped_);
  }
  return 0.0;
}

} // namespace vitrail::tool
