// What a module of SPIR-V says of its specialization constants.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace vitrail {

// The value that the scalar of 32 bits with this constant_id has where nobody specializes it. None: the module has no
// such constant, or is no module.
std::optional<std::uint32_t> spirvConstant(std::span<const std::uint32_t> code, std::uint32_t constantId);

} // namespace vitrail
