// The kernels' bytecode: what the table of kernels has is there, and a device takes it.
#include <gtest/gtest.h>

#include "device.h"
#include "direct3d/bytecode.h"

namespace vitrail::tests::d3d11 {
namespace {

TEST(Bytecode, EveryVariantIsTakenByTheDevice) {
  EXPECT_GT(bytecodeVariants().size(), 50U);
  for (const BytecodeVariant& variant : bytecodeVariants()) {
    HRESULT result = E_FAIL;
    ID3D11Device* on = device().get();
    const void* code = variant.code.data();
    const std::size_t bytes = variant.code.size();
    Com<ID3D11ComputeShader> compute;
    Com<ID3D11PixelShader> pixel;
    Com<ID3D11VertexShader> vertex;
    switch (variant.stage) {
      case BytecodeStage::comp:
        result = on->CreateComputeShader(code, bytes, nullptr, compute.out());
        break;
      case BytecodeStage::frag:
        result = on->CreatePixelShader(code, bytes, nullptr, pixel.out());
        break;
      case BytecodeStage::vert:
        result = on->CreateVertexShader(code, bytes, nullptr, vertex.out());
        break;
    }
    EXPECT_EQ(result, S_OK) << variant.symbol;
  }
}

TEST(Bytecode, IsFoundByNameAndVariant) {
  for (const VitrailNodeFormat format : {VITRAIL_NODE_STANDARD, VITRAIL_NODE_COMPACT, VITRAIL_NODE_HDR}) {
    for (const bool several : {false, true}) {
      EXPECT_FALSE(kernelBytecode(Kernel::Resolve, several, format).empty());
      EXPECT_FALSE(kernelBytecode(Kernel::ResolveLong, several, format).empty());
      EXPECT_FALSE(kernelBytecode(Kernel::ResolveOverflow, several, format).empty());
    }
    EXPECT_FALSE(pixelBytecode(FragmentResolve::SingleDual, format).empty());
    EXPECT_FALSE(pixelBytecode(FragmentResolve::PerSampleDualDepth, format).empty());
    EXPECT_NE(pixelBytecode(FragmentResolve::Single, format).data(),
              pixelBytecode(FragmentResolve::SingleDual, format).data());
  }
  EXPECT_NE(kernelBytecode(Kernel::Resolve, false, VITRAIL_NODE_HDR).data(),
            kernelBytecode(Kernel::Resolve, false, VITRAIL_NODE_STANDARD).data());
  EXPECT_TRUE(kernelBytecode(Kernel::ResolveGroup, false, VITRAIL_NODE_STANDARD).empty()); // not in shader model 5.0
  EXPECT_FALSE(vertexBytecode().empty());
}

} // namespace
} // namespace vitrail::tests::d3d11
