// Runs a compute shader with Vulkan on the device that Direct3D runs on here: what GLSL means there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vitrail::tests::direct3d {

// Set 0 has the input at binding 0 and `bytes` of output at binding 1, zeros before. Throws HostError.
std::vector<std::byte> runByVulkan(std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> input,
                                   std::size_t bytes, std::uint32_t groups);

} // namespace vitrail::tests::direct3d
