// Pipelines that are made once in a process of tests. Every renderer of a test makes its own, and under the validation
// layer on a driver for CPUs that takes nine tenths of a small picture's time: the layer specializes and checks the
// shader, the driver compiles it. Here a pipeline of the same code, constants, layout and state as one before is that
// one again.
//
// Above the layer, as methods_tests and most of library_tests have it, the layer sees each that differs, once, and does
// not see a pipeline that is destroyed while a frame uses it. Below the layer, as the test library.lives has it
// (keeping_layer.cpp), the layer sees all that is made, used and destroyed, and the driver alone is spared. The tool
// itself, which tool_tests runs under the layer, makes and destroys its own.
#pragma once

#include <string>
#include <vector>

#include <volk.h>

namespace vitrail::tests {

// Puts itself before volk's functions, and before those that hosts get by vkGetInstanceProcAddr. After
// volkLoadInstance(), for one device at a time.
void keepPipelines();

// The same for a layer: those functions of a device, found by `next`, that are called from the ones that stand in for
// them; and what stands in for a function, null where nothing does.
void keepPipelinesOf(VkDevice device, PFN_vkGetDeviceProcAddr next);
PFN_vkVoidFunction keepingFunction(const char* name);

// Destroys them all, before their device. A line for each kind of mistake that was seen: pipelines that nobody has
// destroyed, or somebody twice.
std::vector<std::string> destroyKeptPipelines(VkDevice device);

} // namespace vitrail::tests
