// Which backends of the library a test program runs on. A backend is a folder beside this file with a host of its own
// (PointHost) and one object that registers it:
//
//   const Registered<VulkanBackend> vulkan;   // in vulkan/backend.cpp
//
// Suites are written once and run on every backend that is registered:
//
//   class ListsTest : public BackendTest {};
//   VITRAIL_ON_EVERY_BACKEND(ListsTest);
//   TEST_P(ListsTest, OneListIsSorted) { ... draw(desc, points) ... }
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <vitrail/tiles.h>

#include "host.h"

namespace vitrail::tests {

// What devices differ in.
struct Features {
  bool dualSourceBlending = false;
  bool sampleRateShading = false;
  bool postDepthCoverage = false;
  bool stencil = false;                    // beside a 32-bit float depth
  bool addresses = false;                  // pools can be reached by their address
  std::uint64_t bindingBytes = 0;          // what one binding reaches of a buffer
  std::uint32_t uncutLayers = 15000;       // of lists that a driver on a CPU walks to the end (VitrailStats::cutPixels)
  std::vector<std::uint32_t> multisampled; // which of 2, 4 and 8 samples it has
};

// A line of the library's log.
struct LogLine {
  VitrailLogSeverity severity = VITRAIL_LOG_ERROR;
  std::string text;
};

// A graphics API and its one device in this process, which the first call that needs it makes.
class Backend {
 public:
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;
  virtual ~Backend() = default;

  [[nodiscard]] virtual std::string name() const = 0; // a word
  virtual const Features& features() = 0;
  // Throws HostError where the library refuses the description.
  virtual std::unique_ptr<PointHost> makeHost(const HostDesc& desc) = 0;
  // What the device can hold, for plans of tiles.
  virtual VitrailTileLimits tileLimits(VitrailNodeFormat format, std::uint32_t samples) = 0;
  // What the names of the calls of a frame begin with.
  [[nodiscard]] virtual std::string callPrefix() const = 0;
  // The log's lines since the last call.
  virtual std::vector<LogLine> takeLog() = 0;
  // What the API's validation has found wrong since the last call, one text each. Any is a failed test.
  virtual std::vector<std::string> takeErrors() = 0;
  // Gives the device back; what outlived it is among the errors. Hosts are gone by then.
  virtual void close() = 0;
};

std::vector<Backend*>& backends();

// The library has logged one line since the last look, and the word is in it.
void expectOneLine(Backend& backend, const std::string& word);

// Registers a backend as long as the program runs.
template <typename Made>
class Registered {
 public:
  Registered() { backends().push_back(&get()); }
  static Made& get() {
    static Made backend;
    return backend;
  }
};

class BackendTest : public ::testing::TestWithParam<Backend*> {
 protected:
  [[nodiscard]] static Backend& backend() { return *GetParam(); }
  [[nodiscard]] static const Features& features() { return backend().features(); }
  [[nodiscard]] static std::unique_ptr<PointHost> makeHost(const HostDesc& desc) { return backend().makeHost(desc); }
  static void expectOneLine(const std::string& word) { tests::expectOneLine(backend(), word); }
  // One frame by a host of its own.
  [[nodiscard]] static PointResult draw(const HostDesc& desc, std::span<const Point> points) {
    return makeHost(desc)->draw(points);
  }

  // Fails the test for every error of its backend.
  void TearDown() override;
};

#define VITRAIL_ON_EVERY_BACKEND(suite)                                                \
  INSTANTIATE_TEST_SUITE_P(, suite, ::testing::ValuesIn(::vitrail::tests::backends()), \
                           [](const auto& one) { return one.param->name(); })

} // namespace vitrail::tests
