// Specialization constants of modules of SPIR-V, and of what is none.
#include <gtest/gtest.h>

#include <vector>

#include "core/spirv_constant.h"

namespace vitrail::tests {
namespace {

constexpr std::uint32_t op(std::uint32_t words, std::uint32_t code) { return words << 16U | code; }

// Two constants: %7 with constant_id 1720 is 194, %8 with constant_id 3 is 5.
const std::vector<std::uint32_t> kModule = {0x07230203, 0x00010500, 0,  20,   0, // header
                                            op(2, 17),  1,                       // OpCapability
                                            op(3, 71),  9,          2,           // OpDecorate of another kind
                                            op(4, 71),  7,          1,  1720, op(4, 71), 8, 1, 3,    // SpecId
                                            op(4, 43),  6,          10, 1720,                        // OpConstant
                                            op(4, 50),  6,          8,  5,    op(4, 50), 6, 7, 194}; // OpSpecConstant

TEST(SpirvConstant, IsFoundByItsId) {
  EXPECT_EQ(spirvConstant(kModule, 1720), 194U);
  EXPECT_EQ(spirvConstant(kModule, 3), 5U);
  EXPECT_FALSE(spirvConstant(kModule, 4).has_value());
}

TEST(SpirvConstant, WhatIsNoModuleHasNone) {
  EXPECT_FALSE(spirvConstant({}, 3).has_value());
  for (std::size_t i = 0; i < kModule.size(); ++i) { // cut off anywhere
    EXPECT_FALSE(spirvConstant({kModule.data(), i}, 1720).has_value()) << i;
  }
  std::vector<std::uint32_t> wrong = kModule;
  wrong[0] = 0x03022307; // of the other order of bytes
  EXPECT_FALSE(spirvConstant(wrong, 3).has_value());
  wrong = kModule;
  wrong[5] = op(0, 17); // would be gone through for ever
  EXPECT_FALSE(spirvConstant(wrong, 3).has_value());
}

} // namespace
} // namespace vitrail::tests
