// Direct3D 12 as the build has it, Windows's own or libvkd3d's, and what those differ in.
#pragma once

#if !defined(_MSC_VER) && !defined(WIDL_EXPLICIT_AGGREGATE_RETURNS)
#define WIDL_EXPLICIT_AGGREGATE_RETURNS // structures are returned as Microsoft's compiler does it
#endif
#ifdef _WIN32
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <d3d12.h>
#else
#include <vkd3d_windows.h>

#include <vkd3d_d3d12.h>
#undef max
#undef min
#endif

#include "direct3d/com.h"

namespace vitrail {

// The interfaces' numbers, so that no library has to be linked for them.
template <class Interface>
inline constexpr GUID kGuid{};
template <>
inline constexpr GUID kGuid<ID3D12Resource> = {
    0x696442be, 0xa72e, 0x4059, {0xbc, 0x79, 0x5b, 0x5c, 0x98, 0x04, 0x0f, 0xad}};
template <>
inline constexpr GUID kGuid<ID3D12RootSignature> = {
    0xc54a6b66, 0x72df, 0x4ee8, {0x8b, 0xe5, 0xa9, 0x46, 0xa1, 0x42, 0x92, 0x14}};
template <>
inline constexpr GUID kGuid<ID3D12PipelineState> = {
    0x765a30f3, 0xf624, 0x4c6f, {0xa8, 0x28, 0xac, 0xe9, 0x48, 0x62, 0x24, 0x45}};
template <>
inline constexpr GUID kGuid<ID3D12CommandSignature> = {
    0xc36a797c, 0xec80, 0x4f0a, {0x89, 0x85, 0xa7, 0xb2, 0x47, 0x50, 0x82, 0xd1}};
template <>
inline constexpr GUID kGuid<ID3D12DescriptorHeap> = {
    0x8efb471d, 0x616c, 0x4f49, {0x90, 0xf7, 0x12, 0x7b, 0xb7, 0x63, 0xfa, 0x51}};

// The last two arguments of a call that makes an interface.
template <class Interface>
void** outOf(Com<Interface>& made) {
  return reinterpret_cast<void**>(made.out());
}

} // namespace vitrail
