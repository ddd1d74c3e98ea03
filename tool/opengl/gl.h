// The OpenGL context that the tool draws with, without a window or an X server: EGL on a device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "../gpu/gpu_error.h"

namespace vitrail::tool {

// What `vitrail info` shows of an OpenGL device.
struct GlDeviceSummary {
  std::uint32_t index = 0; // what --device takes
  std::string name;        // GL_RENDERER
  std::string driver;      // GL_VENDOR, and the version as the driver words it
  std::string version;     // "4.5"
  bool isCpu = false;
  std::string missing;              // empty: the tool can render on it; else why not, in words
  std::uint32_t sampleCounts = 1;   // as GlLimits has them
  std::uint32_t maxPictureSide = 0; // pixels
  bool postDepthCoverage = false;
};

// All devices that EGL has, in its order. Throws GpuError where there is no EGL.
std::vector<GlDeviceSummary> listGlDevices();

struct GlOptions {
  // As GpuOptions::device, of EGL's devices. Without a name the first GPU, else the first device.
  std::string device;
  bool validate = false; // a debug context, whose messages of high and medium severity are kept
};

struct GlLimits {
  std::uint32_t textureSide = 0;  // the largest, of framebuffers too
  std::uint32_t vertices = 0;     // of a mesh
  std::uint32_t sampleCounts = 1; // of a pixel: the sum of those that it draws
  float pointSizes[2] = {1, 1};   // the least and the largest
  bool postDepthCoverage = false; // GL_ARB_post_depth_coverage
};

struct GlContext; // gl.cpp

class Gl {
 public:
  // Makes a context of OpenGL 4.5 or later and makes it current on this thread, where all that is made with it is used
  // and destroyed. Throws GpuError.
  explicit Gl(const GlOptions& options);
  ~Gl();
  Gl(const Gl&) = delete;
  Gl& operator=(const Gl&) = delete;

  // Leaves this thread, and comes to another one, which is from then on the one to use it on. Throws GpuError.
  void leaveThread() const;
  void comeToThread() const;

  const std::string& name() const { return summary_.name; }
  const std::string& driver() const { return summary_.driver; }
  std::string api() const { return "OpenGL " + summary_.version; }
  bool isCpu() const { return summary_.isCpu; }
  const GlLimits& limits() const { return limits_; }

  // Throws GpuError where OpenGL has noticed an error since the last check; `what` was being done.
  void check(const char* what) const;

  // Counts what is held on the device.
  void memoryAllocated(std::uint64_t bytes);
  void memoryFreed(std::uint64_t bytes) { held_ -= bytes; }
  std::uint64_t peakMemory() const { return peak_; }

  // What a debug context has said.
  std::vector<std::string> validationErrors() const;

 private:
  std::unique_ptr<GlContext> context_;
  GlDeviceSummary summary_;
  GlLimits limits_;
  std::uint64_t held_ = 0;
  std::uint64_t peak_ = 0;
};

} // namespace vitrail::tool
