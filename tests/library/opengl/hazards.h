// OpenGL's rules of memory, for a record of calls: what shaders write to storage buffers and images (and nothing else)
// is seen by later commands only behind a glMemoryBarrier() that names how they use it (OpenGL 4.5, 7.12.2).
#pragma once

#include <string>
#include <vector>

#include "tapped.h"

namespace vitrail::tests::opengl {

// The host's part of a record.
inline constexpr std::string_view kHostCollects = "(the host's draws that collect)";
inline constexpr std::string_view kHostOrdersPicture = "(the host's barrier for the picture)";
inline constexpr std::string_view kHostUsesPicture = "(the host's use of the picture)";

// One line for each use that no barrier stands before. What programs use is what OpenGL says that they do; the record's
// context is current.
std::vector<std::string> missingBarriers(const std::vector<TappedCall>& calls);

} // namespace vitrail::tests::opengl
