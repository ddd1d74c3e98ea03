#include "spirv_constant.h"

namespace vitrail {

namespace {

// Khronos, "SPIR-V Specification", 2.3 and 3.
constexpr std::uint32_t kMagic = 0x07230203;
constexpr std::size_t kHeader = 5; // words
constexpr std::uint32_t kOpSpecConstant = 50;
constexpr std::uint32_t kOpDecorate = 71;
constexpr std::uint32_t kDecorationSpecId = 1;

// The instruction that begins there, or nothing where it does not end within the module.
std::span<const std::uint32_t> instructionAt(std::span<const std::uint32_t> code, std::size_t at) {
  const std::size_t length = code[at] >> 16U;
  return length > 0 && length <= code.size() - at ? code.subspan(at, length) : std::span<const std::uint32_t>{};
}

std::uint32_t opcodeOf(std::span<const std::uint32_t> instruction) { return instruction[0] & 0xffffU; }

} // namespace

std::optional<std::uint32_t> spirvConstant(std::span<const std::uint32_t> code, std::uint32_t constantId) {
  if (code.size() < kHeader || code[0] != kMagic) return std::nullopt;
  std::optional<std::uint32_t> object; // that has the id; decorations come before constants
  for (std::size_t at = kHeader; at < code.size();) {
    const std::span<const std::uint32_t> instruction = instructionAt(code, at);
    if (instruction.empty()) return std::nullopt;
    at += instruction.size();
    if (instruction.size() != 4) continue; // both have four words
    if (opcodeOf(instruction) == kOpDecorate && instruction[2] == kDecorationSpecId && instruction[3] == constantId) {
      object = instruction[1];
    }
    if (opcodeOf(instruction) == kOpSpecConstant && object == instruction[2]) return instruction[3];
  }
  return std::nullopt;
}

} // namespace vitrail
