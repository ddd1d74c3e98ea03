// Whether a machine may have a GPU, without Vulkan: to load the loader and all drivers takes longer than a small
// picture.
#pragma once

#include <filesystem>

namespace vitrail::tool {

// Looks for device nodes of GPU drivers that this process may open: /dev/dri/renderD* (all drivers of the kernel's
// DRM), /dev/nvidia0 and on, /dev/dxg (WSL), and those of Arm's, Qualcomm's and NVIDIA's embedded GPUs. Containers have
// those nodes that they were given. True does not say that there is a Vulkan driver for it; false is certain, but for a
// driver that reaches a GPU over a network.
bool mayHaveGpu(const std::filesystem::path& devices = "/dev");

} // namespace vitrail::tool
