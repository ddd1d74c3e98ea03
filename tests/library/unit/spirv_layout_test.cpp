// The structures that C++ and GLSL share: the strides and offsets of all compiled shaders equal those of the compiler.
#include <gtest/gtest.h>

#include <spirv/unified1/spirv.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "kernels/kernels.h"
#include "shaders/points_address.frag.h"
#include "shaders/points_cpu.frag.h"
#include "shaders/points_cpu_address.frag.h"
#include "shaders/points_post_depth.frag.h"
#include "shaders/points_post_depth_address.frag.h"
#include "shaders/points_post_depth_cpu.frag.h"
#include "shaders/points_simple.frag.h"
#include "vitrail/bindings.h"
#include "vitrail/layout.h"

namespace vitrail::tests {
namespace {

using Words = std::span<const std::uint32_t>;
using Offsets = std::vector<std::size_t>;

struct Pointer {
  std::uint32_t storageClass = 0;
  std::uint32_t pointee = 0;
};

// What the test needs of a SPIR-V module: types, and the decorations that lay buffers out.
struct Module {
  std::map<std::uint32_t, std::vector<std::uint32_t>> structs;              // id: member types
  std::map<std::uint32_t, std::uint32_t> runtimeArrays;                     // id: element type
  std::map<std::uint32_t, std::uint32_t> arrays;                            // the same of those with a size
  std::map<std::uint32_t, Pointer> pointers;                                // id
  std::map<std::uint32_t, std::uint32_t> strides;                           // array id: ArrayStride
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> offsets; // struct id, member: Offset
  std::map<std::uint32_t, std::uint32_t> sets;                              // variable id: DescriptorSet
  std::map<std::uint32_t, std::uint32_t> bindings;                          // variable id: Binding
  std::map<std::uint32_t, std::uint32_t> variables;                         // variable id: pointer type
};

void readDecoration(Module& module, Words op) {
  if (op[2] == spv::DecorationArrayStride) module.strides[op[1]] = op[3];
  if (op[2] == spv::DecorationDescriptorSet) module.sets[op[1]] = op[3];
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
      case spv::OpTypeArray:
        module.arrays[op[1]] = op[2];
        break;
      case spv::OpTypePointer:
        module.pointers[op[1]] = {op[2], op[3]};
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

// The types of the first members of all blocks at a binding of set 0; blocks of several formats share one.
std::set<std::uint32_t> blockMembers(const Module& module, std::uint32_t binding) {
  std::set<std::uint32_t> members;
  for (const auto& [variable, number] : module.bindings) {
    if (number != binding || module.sets.at(variable) != 0) continue;
    members.insert(module.structs.at(module.pointers.at(module.variables.at(variable)).pointee).at(0));
  }
  return members;
}

// The same of all blocks that are reached by address.
std::set<std::uint32_t> addressedMembers(const Module& module) {
  std::set<std::uint32_t> members;
  for (const auto& [id, pointer] : module.pointers) {
    const auto block = module.structs.find(pointer.pointee);
    if (pointer.storageClass != spv::StorageClassPhysicalStorageBuffer || block == module.structs.end()) continue;
    if (module.runtimeArrays.contains(block->second.at(0))) members.insert(block->second.at(0));
  }
  return members;
}

Offsets offsetsOf(const Module& module, std::uint32_t type) {
  Offsets offsets;
  if (!module.structs.contains(type)) return offsets; // a word
  for (std::uint32_t i = 0; i < module.structs.at(type).size(); ++i) offsets.push_back(module.offsets.at({type, i}));
  return offsets;
}

const Offsets& controlOffsets() {
  using layout::VitrailControl;
  static const Offsets offsets = {
      offsetof(VitrailControl, requested),        offsetof(VitrailControl, wraps),
      offsetof(VitrailControl, misfits),          offsetof(VitrailControl, misfitNodes),
      offsetof(VitrailControl, layersMax),        offsetof(VitrailControl, coveredPixels),
      offsetof(VitrailControl, cutPixels),        offsetof(VitrailControl, approximatePixels),
      offsetof(VitrailControl, collected),        offsetof(VitrailControl, staleNodes),
      offsetof(VitrailControl, classes),          offsetof(VitrailControl, overflowGroupsX),
      offsetof(VitrailControl, overflowGroupsY),  offsetof(VitrailControl, overflowGroupsZ),
      offsetof(VitrailControl, pixelGroupsX),     offsetof(VitrailControl, pixelGroupsY),
      offsetof(VitrailControl, pixelGroupsZ),     offsetof(VitrailControl, plainGroupsX),
      offsetof(VitrailControl, plainGroupsY),     offsetof(VitrailControl, plainGroupsZ),
      offsetof(VitrailControl, drawVertices),     offsetof(VitrailControl, drawInstances),
      offsetof(VitrailControl, drawFirstVertex),  offsetof(VitrailControl, drawFirstInstance),
      offsetof(VitrailControl, plainVertices),    offsetof(VitrailControl, plainInstances),
      offsetof(VitrailControl, plainFirstVertex), offsetof(VitrailControl, plainFirstInstance)};
  return offsets;
}

const Offsets& classOffsets() {
  using layout::VitrailListClass;
  static const Offsets offsets = {offsetof(VitrailListClass, count), offsetof(VitrailListClass, groupsX),
                                  offsetof(VitrailListClass, groupsY), offsetof(VitrailListClass, groupsZ)};
  return offsets;
}

const Offsets& parameterOffsets() {
  using layout::VitrailParameters;
  static const Offsets offsets = {offsetof(VitrailParameters, x),
                                  offsetof(VitrailParameters, y),
                                  offsetof(VitrailParameters, width),
                                  offsetof(VitrailParameters, height),
                                  offsetof(VitrailParameters, capacity),
                                  offsetof(VitrailParameters, format),
                                  offsetof(VitrailParameters, samples),
                                  offsetof(VitrailParameters, nearestIsOne),
                                  offsetof(VitrailParameters, keepSums),
                                  offsetof(VitrailParameters, loose),
                                  offsetof(VitrailParameters, nodesLow),
                                  offsetof(VitrailParameters, nodesHigh),
                                  offsetof(VitrailParameters, wholeByBinding),
                                  offsetof(VitrailParameters, wholeByAddress),
                                  offsetof(VitrailParameters, userWords),
                                  offsetof(VitrailParameters, frame),
                                  offsetof(VitrailParameters, capacities)};
  return offsets;
}

// What the pool is an array of, by size: links, the nodes of 8 bytes (standard without its link, and compact), and hdr.
const std::map<std::size_t, Offsets>& nodeOffsets() {
  using namespace layout;
  static_assert(sizeof(VitrailNodeStandard) == sizeof(VitrailNodeCompact));
  static_assert(offsetof(VitrailNodeStandard, words) == offsetof(VitrailNodeCompact, words));
  static const std::map<std::size_t, Offsets> offsets = {
      {sizeof(layout::uint), {}},
      {sizeof(VitrailNodeCompact), {offsetof(VitrailNodeCompact, words)}},
      {sizeof(VitrailNodeHdr), {offsetof(VitrailNodeHdr, words)}},
  };
  return offsets;
}

// All three formats are there, and each is laid out as its struct.
void expectNodes(const Module& module, const std::set<std::uint32_t>& arrays) {
  std::set<std::size_t> strides;
  for (const std::uint32_t array : arrays) {
    const std::size_t stride = module.strides.at(array);
    strides.insert(stride);
    ASSERT_TRUE(nodeOffsets().contains(stride)) << "no node has " << stride << " bytes";
    EXPECT_EQ(offsetsOf(module, module.runtimeArrays.at(array)), nodeOffsets().at(stride));
  }
  EXPECT_EQ(strides.size(), nodeOffsets().size());
}

// The counters: also the array of classes in them.
void expectControl(const Module& module, std::uint32_t type) {
  EXPECT_EQ(offsetsOf(module, type), controlOffsets());
  const std::vector<std::uint32_t>& members = module.structs.at(type);
  std::size_t classes = 0;
  for (const std::uint32_t member : members) {
    const auto array = module.arrays.find(member);
    if (array == module.arrays.end() || !module.structs.contains(array->second)) continue;
    EXPECT_EQ(module.strides.at(member), sizeof(layout::VitrailListClass));
    EXPECT_EQ(offsetsOf(module, array->second), classOffsets());
    ++classes;
  }
  EXPECT_EQ(classes, 1U);
}

void expectShared(const Module& module) {
  for (const std::uint32_t type : blockMembers(module, VITRAIL_BINDING_PARAMETERS)) {
    EXPECT_EQ(offsetsOf(module, type), parameterOffsets());
  }
  std::size_t structs = 0; // the counters, which collecting shaders declare as an array of words, too
  for (const std::uint32_t type : blockMembers(module, VITRAIL_BINDING_CONTROL)) {
    if (module.runtimeArrays.contains(type)) continue;
    expectControl(module, type);
    ++structs;
  }
  constexpr std::array<std::uint32_t, 5> kWords{VITRAIL_BINDING_CONTROL, VITRAIL_BINDING_HEADS, VITRAIL_BINDING_SUMS,
                                                VITRAIL_BINDING_MEDIUM_LISTS, VITRAIL_BINDING_LONG_LISTS};
  for (const std::uint32_t binding : kWords) {
    for (const std::uint32_t array : blockMembers(module, binding)) {
      if (module.structs.contains(array)) continue;
      const bool groups = blockMembers(module, VITRAIL_BINDING_MEDIUM_LISTS).size() > 0;
      const bool words = binding != VITRAIL_BINDING_LONG_LISTS || !groups; // several at once where groups take lists
      EXPECT_EQ(module.strides.at(array), words ? sizeof(layout::uint) : sizeof(layout::uvec4))
          << "binding " << binding;
    }
  }
  EXPECT_EQ(blockMembers(module, VITRAIL_BINDING_PARAMETERS).size(), 1U);
  EXPECT_EQ(structs, 1U);
}

void expectLayout(Words code, bool byAddress) {
  const Module module = parse(code);
  expectShared(module);
  expectNodes(module, byAddress ? addressedMembers(module) : blockMembers(module, VITRAIL_BINDING_NODES));
}

TEST(SpirvLayout, CollectEqualsTheStructs) {
  expectLayout(shaders::points_simple_frag, false);
  expectLayout(shaders::points_post_depth_frag, false);
  expectLayout(shaders::points_cpu_frag, false);
  expectLayout(shaders::points_cpu_address_frag, true);
  expectLayout(shaders::points_address_frag, true);
  expectLayout(shaders::points_post_depth_address_frag, true);
  expectLayout(shaders::points_post_depth_cpu_frag, false);
}

// How many variables name a binding of set 0.
std::size_t declarations(const Module& module, std::uint32_t binding) {
  return static_cast<std::size_t>(std::count_if(module.bindings.begin(), module.bindings.end(), [&](const auto& entry) {
    return entry.second == binding && module.sets.at(entry.first) == 0;
  }));
}

// vitrail/collect.glsl says why, and where.
TEST(SpirvLayout, CollectDeclaresTheBuffersThatItWritesTwiceForCpuDrivers) {
  constexpr std::array<std::uint32_t, 3> kWritten{VITRAIL_BINDING_CONTROL, VITRAIL_BINDING_HEADS, VITRAIL_BINDING_SUMS};
  for (const std::uint32_t binding : kWritten) {
    EXPECT_GT(declarations(parse(shaders::points_cpu_frag), binding), 1U) << "binding " << binding;
    EXPECT_GT(declarations(parse(shaders::points_cpu_address_frag), binding), 1U) << "binding " << binding;
    EXPECT_EQ(declarations(parse(shaders::points_simple_frag), binding), 1U) << "binding " << binding;
    EXPECT_EQ(declarations(parse(shaders::points_address_frag), binding), 1U) << "binding " << binding;
  }
  EXPECT_GT(declarations(parse(shaders::points_cpu_frag), VITRAIL_BINDING_NODES), 1U);
}

TEST(SpirvLayout, EveryKernelEqualsTheStructs) {
  EXPECT_GT(kernelVariants().size(), 0U);
  for (const KernelVariant& variant : kernelVariants()) {
    SCOPED_TRACE(variant.symbol);
    const Module module = parse(variant.code);
    if (module.bindings.empty()) continue; // it draws a triangle
    expectShared(module);
    const std::set<std::uint32_t> nodes =
        variant.byAddress ? addressedMembers(module) : blockMembers(module, VITRAIL_BINDING_NODES);
    if (!nodes.empty()) expectNodes(module, nodes);
  }
}

} // namespace
} // namespace vitrail::tests
