// Reads the values of a PLY file's elements, whatever their encoding.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ply_header.h"

namespace vitrail::tool {

// Not a number where a float cannot hold it; what uses it decides what that means.
inline float narrowed(double value) {
  constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
  return std::abs(value) <= largest ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
}

// What a single value of an element is, by the names that programs give it.
enum class PlySlot {
  None,
  X,
  Y,
  Z,
  NormalX,
  NormalY,
  NormalZ,
  Red,
  Green,
  Blue,
  Alpha,
  U,
  V, // of vertices; colours of faces and edges, too
  SplatRed,
  SplatGreen,
  SplatBlue,
  SplatOpacity, // of Gaussian splats
  TexNumber,    // of faces
  Vertex1,
  Vertex2 // of edges
};
constexpr std::size_t plySlotCount = 20;

// What a list of an element is.
enum class PlyList { None, Corners, TexCoords, Colors, TexCorners };
constexpr std::size_t plyListCount = 5;

// One element's values. Lists of no meaning are passed over; their place here stays empty.
struct PlyRow {
  std::array<double, plySlotCount> values{};
  std::array<std::vector<double>, plyListCount> lists;

  double operator[](PlySlot slot) const { return values[static_cast<std::size_t>(slot)]; }
  const std::vector<double>& operator[](PlyList list) const { return lists[static_cast<std::size_t>(list)]; }
};

// Which properties of an element mean something.
class PlyLayout {
 public:
  // A value with a meaning, and where binary files hold it in an element without lists.
  struct Field {
    PlySlot slot;
    PlyType type;
    std::size_t offset;
  };

  explicit PlyLayout(const PlyElement& element);

  bool has(PlySlot slot) const { return present_[static_cast<std::size_t>(slot)]; }
  bool has(PlyList list) const { return listPresent_[static_cast<std::size_t>(list)]; }
  PlyType typeOf(PlySlot slot) const { return types_[static_cast<std::size_t>(slot)]; }
  PlySlot slotOf(std::size_t property) const { return slots_[property]; }
  PlyList listOf(std::size_t property) const { return lists_[property]; }
  // Bytes that an element takes in a binary file at least: exactly, where it has no list.
  std::size_t leastBytes() const { return leastBytes_; }
  bool hasLists() const { return hasLists_; }
  std::span<const Field> fields() const { return fields_; }

 private:
  void findCorners(const PlyElement& element);

  std::vector<PlySlot> slots_; // one a property
  std::vector<PlyList> lists_;
  std::array<bool, plySlotCount> present_{};
  std::array<PlyType, plySlotCount> types_{};
  std::array<bool, plyListCount> listPresent_{};
  std::size_t leastBytes_ = 0;
  bool hasLists_ = false;
  std::vector<Field> fields_;
};

// The body ends before what its header states.
struct PlyEnd {
  std::string problem; // "the file ends in vertex 3 of 4"
};

// Walks over the body of a file.
class PlyBody {
 public:
  PlyBody(std::span<const std::byte> bytes, const PlyHeader& header);

  // How many of `count` things of at least `bytes` bytes each there is room for, before memory is taken for them.
  std::uint64_t roomFor(std::uint64_t count, std::size_t bytes) const;

  // Where the body ended before all that is stated had been read; empty: it did not.
  const std::string& end() const { return end_; }
  // Lines of text that hold more numbers than is stated; those are passed over.
  std::size_t longLines() const { return longLines_; }

  // Reads all of an element, or as many as there are whole, and gives each row and its number to `use`. Throws
  // LoadError.
  template <typename Use>
  void readRows(const PlyElement& element, const PlyLayout& layout, Use use) {
    if (element.properties.empty()) return;
    PlyRow row;
    if (encoding_ == PlyEncoding::Text || layout.hasLists()) {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        try {
          readRow(element, layout, i, row);
        } catch (const PlyEnd& end) {
          end_ = end.problem;
          return;
        }
        use(row, i);
      }
      return;
    }
    const std::uint64_t count = roomFor(element.count, layout.leastBytes());
    if (count < element.count) end_ = endIn(element, count).problem;
    for (std::uint64_t i = 0; i < count; ++i) {
      for (const PlyLayout::Field& field : layout.fields())
        row.values[static_cast<std::size_t>(field.slot)] = decode(field.type, &bytes_[offset_ + field.offset]);
      offset_ += layout.leastBytes();
      use(row, i);
    }
  }

 private:
  static PlyEnd endIn(const PlyElement& element, std::uint64_t number);
  void skipLongLine(std::size_t rowBegin);
  void readRow(const PlyElement& element, const PlyLayout& layout, std::uint64_t number, PlyRow& row);
  void readList(const PlyElement& element, const PlyProperty& property, std::uint64_t number,
                std::vector<double>* values);
  double next(const PlyElement& element, PlyType type, std::uint64_t number);
  double nextWord(const PlyElement& element, std::uint64_t number);
  double decode(PlyType type, const std::byte* at) const;

  std::span<const std::byte> bytes_;
  PlyEncoding encoding_;
  bool swapped_; // the bytes of a number run the other way than this machine's
  std::size_t offset_ = 0;
  bool hasLines_ = false; // of text: there is a line for each element
  std::string end_;
  std::size_t longLines_ = 0;
};

} // namespace vitrail::tool
