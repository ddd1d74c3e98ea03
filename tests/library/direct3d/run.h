// Runs a compute shader on the backend's device: d3d11/run.cpp, d3d12/run.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vitrail::tests::direct3d {

// The input is t0; `bytes` of output are u1, zeros before. Throws HostError.
std::vector<std::byte> runByDirect3d(std::span<const unsigned char> code, std::span<const std::uint32_t> input,
                                     std::size_t bytes, std::uint32_t groups);

} // namespace vitrail::tests::direct3d
