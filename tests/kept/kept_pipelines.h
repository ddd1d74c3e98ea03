// Pipelines that are made once in a process of tests. Every renderer of a test makes its own, and under the validation
// layer on a driver for CPUs that takes nine tenths of a small picture's time: the layer specializes and checks the
// shader, the driver compiles it. Here a pipeline of the same code, constants, layout and state as one before is that
// one again, so that the layer sees each that differs, once.
//
// What the layer does not see then: a pipeline that is destroyed while a frame uses it. The programs of library_tests
// and the tool itself, which tool_tests runs under the layer, make and destroy theirs as they are told to.
#pragma once

#include <string>
#include <vector>

#include <volk.h>

namespace vitrail::tool::test {

// Puts itself before volk's functions, and before those that hosts get by vkGetInstanceProcAddr. After
// volkLoadInstance(), for one device at a time.
void keepPipelines();

// Destroys them all, before their device. A line for each kind of mistake that was seen: pipelines that nobody has
// destroyed, or somebody twice.
std::vector<std::string> destroyKeptPipelines(VkDevice device);

} // namespace vitrail::tool::test
