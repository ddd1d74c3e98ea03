// Which extensions of glTF are drawn, and what a picture lacks without the others: one table, from which refusals,
// warnings and `vitrail info` speak.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vitrail::tool {

enum class GltfSupport : std::uint8_t {
  Drawn,     // honoured
  Partly,    // honoured but for what `lost` says
  Nothing,   // not read, and no picture is the worse for it
  Left,      // not read: the picture lacks what `lost` says
  Unreadable // not read, and the data that it holds cannot be drawn without: refused where a file requires it
};

struct GltfExtension {
  std::string_view name;
  GltfSupport support = GltfSupport::Left;
  std::string_view lost; // what the picture lacks, as the end of a sentence: "fabrics lack their soft rim"
};

// The row of an extension. Names that no row has are Left, and it cannot be told what they stand for.
GltfExtension gltfExtension(std::string_view name);

// The line that warns of an extension that the picture needs; empty where it loses nothing.
std::string extensionWarning(std::string_view name);

} // namespace vitrail::tool
