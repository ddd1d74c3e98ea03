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
}

PlyBody::PlyBody(std::span<const std::byte> bytes, PlyEncoding encoding)
    : bytes_(bytes),
      encoding_(encoding),
      swapped_((encoding == PlyEncoding::BigEndian) == (std::endian::native == std::endian::little)) {}

void PlyBody::require(std::uint64_t count, std::size_t bytes, std::string_view what) const {
  const std::size_t left = bytes_.size() - offset_;
  // In text each takes a character and a separator at least; the last one needs no separator.
  const bool fits =
      encoding_ == PlyEncoding::Text ? count <= (left + 1) / 2 : count <= left / std::max<std::size_t>(bytes, 1);
  if (!fits) throw LoadError(fmt::format("{} {} are stated, but only {} bytes are left", count, oneLine(what), left));
}

void PlyBody::readRow(const PlyElement& element, const PlyLayout& layout, std::uint64_t number, PlyRow& row) {
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (property.isList) {
      const PlyList list = layout.listOf(p);
      readList(element, property, number, list == PlyList::None ? nullptr : &row.lists[static_cast<std::size_t>(list)]);
    } else {
      row.values[static_cast<std::size_t>(layout.slotOf(p))] = next(element, property.type, number);
    }
  }
}

void PlyBody::readList(const PlyElement& element, const PlyProperty& property, std::uint64_t number,
                       std::vector<double>* values) {
  const double length = next(element, property.countType, number);
  if (!(length >= 0.0 && length <= 4294967295.0) || length != std::floor(length))
    throw LoadError(fmt::format("{} {}: a list has the length {}", oneLine(element.name), number, length));
  const auto count = static_cast<std::uint64_t>(length);
  const std::size_t size = sizeOf(property.type);
  require(count, size, "list values");
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
  if (bytes_.size() - offset_ < size)
    throw LoadError(fmt::format("the file ends in {} {}", oneLine(element.name), number));
  const double value = decode(type, &bytes_[offset_]);
  offset_ += size;
  return value;
}

double PlyBody::nextWord(const PlyElement& element, std::uint64_t number) {
  const char* const text = reinterpret_cast<const char*>(bytes_.data());
  const char* const end = text + bytes_.size();
  const char* begin = text + offset_;
  while (begin != end && endsWord(*begin)) ++begin;
  if (begin == end) throw LoadError(fmt::format("the file ends in {} {}", oneLine(element.name), number));
  double value = 0.0;
  const char* const after = parseNumberOrNan(begin, end, value);
  if (after == nullptr || (after != end && !endsWord(*after))) {
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
