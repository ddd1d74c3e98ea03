// Whether there may be a GPU: the nodes of its driver.
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "gpu/presence.h"

namespace vitrail::tests {
namespace {

namespace fs = std::filesystem;

TEST(Presence, NodesOfGpuDrivers) {
  const fs::path folder = fs::temp_directory_path() / ("vitrail_presence_" + std::to_string(::getpid()));
  const auto has = [&](const std::string& node) {
    fs::remove_all(folder);
    fs::create_directories(folder / "dri");
    std::ofstream(folder / node) << "";
    return tool::mayHaveGpu(folder);
  };
  for (const char* node : {"dri/renderD128", "dri/renderD130", "nvidia0", "nvidia7", "dxg", "mali0", "kgsl-3d0"}) {
    EXPECT_TRUE(has(node)) << node;
  }
  // A screen without a GPU behind it, the control nodes of a driver, and others.
  for (const char* node : {"dri/card0", "dri/renderD", "nvidiactl", "nvidia-uvm", "nvidia", "null"}) {
    EXPECT_FALSE(has(node)) << node;
  }
  fs::remove_all(folder);
  EXPECT_FALSE(tool::mayHaveGpu(folder));
}

} // namespace
} // namespace vitrail::tests
