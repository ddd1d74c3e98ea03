// The structures that C++ and GLSL share: the strides and offsets of the compiled shaders equal those of the compiler.
#include <gtest/gtest.h>

#include <spirv/unified1/spirv.hpp>

#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "shaders/points.frag.h"
#include "shaders/resolve_long_rgba16f.h"
#include "shaders/resolve_rgba16f.h"
#include "shaders/resolve_rgba32f.h"
#include "vitrail/layout.h"

namespace vitrail::tests {
namespace {

using Words = std::span<const std::uint32_t>;

// What the test needs of a SPIR-V module: types, and the decorations that lay buffers out.
struct Module {
  std::map<std::uint32_t, std::vector<std::uint32_t>> structs;              // id: member types
  std::map<std::uint32_t, std::uint32_t> runtimeArrays;                     // id: element type
  std::map<std::uint32_t, std::uint32_t> pointers;                          // id: pointee
  std::map<std::uint32_t, std::uint32_t> strides;                           // array id: ArrayStride
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> offsets; // struct id, member: Offset
  std::map<std::uint32_t, std::uint32_t> bindings;                          // variable id: Binding
  std::map<std::uint32_t, std::uint32_t> variables;                         // variable id: pointer type
};

void readDecoration(Module& module, Words op) {
  if (op[2] == spv::DecorationArrayStride) module.strides[op[1]] = op[3];
  if (op[2] == spv::DecorationBinding) module.bindings[op[1]] = op[3];
}

Module parse(Words code) {
  Module module;
  for (std::size_t at = 5; at < code.size();) { // after the header
    const std::size_t length = code[at] >> 16U;
    const Words op = code.subspan(at, length);
    switch (code[at] & 0xffffU) {
      case spv::OpTypeStruct:
        module.structs[op[1]].assign(op.begin() + 2, op.end());
        break;
      case spv::OpTypeRuntimeArray:
        module.runtimeArrays[op[1]] = op[2];
        break;
      case spv::OpTypePointer:
        module.pointers[op[1]] = op[3];
        break;
      case spv::OpVariable:
        module.variables[op[2]] = op[1];
        break;
      case spv::OpDecorate:
        readDecoration(module, op);
        break;
      case spv::OpMemberDecorate:
        if (op[3] == spv::DecorationOffset) module.offsets[{op[1], op[2]}] = op[4];
        break;
      default:
        break;
    }
    at += length;
  }
  return module;
}

// The type of the only member of the block at a binding of set 0; the colour image shares binding 0 and is no struct.
std::uint32_t blockMember(const Module& module, std::uint32_t binding) {
  for (const auto& [variable, number] : module.bindings) {
    if (number != binding) continue;
    const auto block = module.structs.find(module.pointers.at(module.variables.at(variable)));
    if (block != module.structs.end()) return block->second.at(0);
  }
  ADD_FAILURE() << "no block at binding " << binding;
  return 0;
}

void expectOffsets(const Module& module, std::uint32_t type, const std::vector<std::size_t>& offsets) {
  ASSERT_EQ(module.structs.at(type).size(), offsets.size());
  for (std::uint32_t i = 0; i < offsets.size(); ++i)
    EXPECT_EQ(module.offsets.at({type, i}), offsets[i]) << "member " << i;
}

void expectLayout(Words code) {
  using namespace layout;
  const Module module = parse(code);
  expectOffsets(module, blockMember(module, 0),
                {offsetof(VitrailParameters, width), offsetof(VitrailParameters, height),
                 offsetof(VitrailParameters, capacity), offsetof(VitrailParameters, nearestIsOne)});
  expectOffsets(
      module, blockMember(module, 1),
      {offsetof(VitrailControl, stored), offsetof(VitrailControl, missingLow), offsetof(VitrailControl, missingHigh),
       offsetof(VitrailControl, layersMax), offsetof(VitrailControl, coveredPixels),
       offsetof(VitrailControl, cutPixels), offsetof(VitrailControl, longLists), offsetof(VitrailControl, groupsX),
       offsetof(VitrailControl, groupsY), offsetof(VitrailControl, groupsZ)});
  EXPECT_EQ(module.strides.at(blockMember(module, 2)), sizeof(uint));
  const std::uint32_t nodes = blockMember(module, 3);
  EXPECT_EQ(module.strides.at(nodes), sizeof(VitrailNode));
  expectOffsets(module, module.runtimeArrays.at(nodes),
                {offsetof(VitrailNode, color), offsetof(VitrailNode, depth), offsetof(VitrailNode, next)});
}

TEST(SpirvLayout, CollectEqualsTheStructs) { expectLayout(shaders::points_frag); }

TEST(SpirvLayout, ResolveEqualsTheStructs) {
  expectLayout(shaders::resolve_rgba16f);
  expectLayout(shaders::resolve_rgba32f);
  expectLayout(shaders::resolve_long_rgba16f);
}

} // namespace
} // namespace vitrail::tests
