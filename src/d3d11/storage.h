// A target's memory: a buffer for each part, its own or the host's, and their views.
#pragma once

#include <array>

#include "context.h"
#include "core/pool.h"
#include "vitrail/bindings.h"

namespace vitrail {

struct D3d11Part {
  Com<ID3D11Buffer> buffer;
  Com<ID3D11UnorderedAccessView> written;
  Com<ID3D11ShaderResourceView> read;
};

struct D3d11Storage {
  StorageNeeds needs;
  StorageLayout layout; // of which the sizes hold
  Com<ID3D11Buffer> parameters;
  std::array<D3d11Part, VITRAIL_BINDINGS> parts; // by VITRAIL_BINDING_*; that of the parameters is empty
  // The arguments of indirect commands, which the control buffer has: it cannot be both at once.
  Com<ID3D11Buffer> arguments;
  bool wholeByBinding = false;

  [[nodiscard]] const D3d11Part& control() const { return parts[VITRAIL_BINDING_CONTROL]; }
  [[nodiscard]] const D3d11Part& heads() const { return parts[VITRAIL_BINDING_HEADS]; }
  [[nodiscard]] const D3d11Part& sums() const { return parts[VITRAIL_BINDING_SUMS]; }
  [[nodiscard]] const D3d11Part& copy() const { return parts[VITRAIL_BINDING_COPY]; }

  // `hostBuffers` null: buffers of its own. Logs its errors.
  VitrailResult create(const VitrailD3d11Context_T& context, const StorageNeeds& wanted,
                       ID3D11Buffer* const* hostBuffers, const char* name);
};

// The sizes of the buffers, by VitrailD3d11BufferKind.
std::array<std::uint64_t, VITRAIL_D3D11_BUFFERS> bufferSizes(const StorageLayout& layout);

// Logs its errors.
VitrailResult createBuffer(const VitrailD3d11Context_T& context, const D3D11_BUFFER_DESC& desc, const void* data,
                           const char* name, const char* what, Com<ID3D11Buffer>& buffer);

} // namespace vitrail
