#include "rasterizer.h"

#include <algorithm>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "../gpu/device.h"

namespace vitrail::tool {

namespace {

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line) && !line.empty();) { // an empty line ends the first processor's
    const std::size_t colon = line.find(": ");
    for (const std::string_view key : {"model name", "Model", "cpu model"}) { // x86, Arm boards, others
      if (line.starts_with(key) && colon != std::string::npos) return line.substr(colon + 2);
    }
  }
  return "processor";
}

} // namespace

Rasterizer::Rasterizer(std::uint32_t threads) {
  VitrailCpuContextDesc desc{};
  desc.threads = threads;
  desc.log = [](VitrailLogSeverity severity, const char* message, void* user) {
    if (severity == VITRAIL_LOG_ERROR) static_cast<Rasterizer*>(user)->reason_ = message;
  };
  desc.logUser = this;
  check(vitrailCpuCreateContext(&desc, &context_));
}

Rasterizer::~Rasterizer() { vitrailCpuDestroyContext(context_); }

void Rasterizer::render(const VitrailCpuFrame& frame, std::span<const VitrailCpuDraw> draws, VitrailStats* stats) {
  check(vitrailCpuRender(context_, &frame, draws.data(), static_cast<std::uint32_t>(draws.size()), stats));
  fragmentBytes_ = std::max(fragmentBytes_, vitrailCpuFragmentBytes(context_));
}

std::uint32_t Rasterizer::threads() const { return vitrailCpuContextThreads(context_); }

std::string Rasterizer::name() const {
  return fmt::format("{} ({}, {} {})", processorName(),
                     vitrailCpuInstructionsName(vitrailCpuContextInstructions(context_)), threads(),
                     threads() == 1 ? "thread" : "threads");
}

void Rasterizer::check(VitrailResult result) {
  if (result == VITRAIL_SUCCESS) return;
  const std::string unknown = result == VITRAIL_ERROR_OUT_OF_MEMORY ? "out of memory" : "no reason was given";
  throw GpuError("the processor cannot draw this: " + (reason_.empty() ? unknown : reason_));
}

} // namespace vitrail::tool
