// The Vulkan backend of the tests: one device under validation, and what hosts on it share, so that pipelines are
// compiled once a process.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "../backend.h"
#include "device.h"
#include "list_walker.h"
#include "point_pipelines.h"

namespace vitrail::tests::vulkan {

using vitrail::vulkan::Context;
using vitrail::vulkan::Target;

class VulkanBackend : public Backend {
 public:
  [[nodiscard]] std::string name() const override { return "vulkan"; }
  [[nodiscard]] std::string callPrefix() const override { return "vitrailVkCmd"; }
  const Features& features() override { return device().features(); }
  std::unique_ptr<PointHost> makeHost(const HostDesc& desc) override;
  VitrailTileLimits tileLimits(VitrailNodeFormat format, std::uint32_t samples) override;
  // Lines of the library's log that no test took are errors, too.
  std::vector<std::string> takeErrors() override;
  void close() override;

  Device& device();

  // The library's context on the device, told of these VitrailVkFeatureBits.
  Context& context(std::uint32_t features);
  // All that the device has been made with, but for the pool's addresses.
  std::uint32_t allFeatures();

  PointPipelines& pipelines(const PointPipelinesInfo& info);
  ListWalker& walker(const Context& context, const WalkKind& kind);

  // What a context is made with: this device, and its log here.
  VitrailVkContextDesc contextDesc();
  std::vector<LogLine> takeLog() override;

 private:
  std::unique_ptr<Device> device_;
  std::map<std::uint32_t, Context> contexts_;
  std::map<PointPipelinesInfo, PointPipelines> pipelines_; // with the contexts' layouts: they go before
  std::map<std::pair<VkDescriptorSetLayout, WalkKind>, ListWalker> walkers_; // as well
  std::vector<LogLine> log_;
  std::vector<std::string> lastErrors_; // of a device that was closed
};

VulkanBackend& backend();

inline void expectOneLine(const std::string& word) { tests::expectOneLine(backend(), word); }

// A test of what only Vulkan has.
class VulkanTest : public ::testing::Test {
 protected:
  // Fails the test for every validation message and every line of the log that it did not take.
  void TearDown() override;
};

} // namespace vitrail::tests::vulkan
