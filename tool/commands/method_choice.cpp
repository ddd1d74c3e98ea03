#include "method_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string_view>

#include "../methods/methods.h"
#include "../render/still.h"
#include "../scene/builtin/builtin.h"
#include "output_file.h"

namespace vitrail::tool {

namespace {

using Json = nlohmann::ordered_json;

// Small triangles and large ones: devices differ in what their hardware is good at.
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 2> kMeasured = {{{"spheres", 64}, {"planes", 8}}};
constexpr int kWarmUps = 2;
constexpr int kMeasurements = 7;
constexpr std::size_t kMostRemembered = 16; // devices

constexpr const char* kVersion = VITRAIL_TOOL_VERSION;
constexpr const char* kFirst = "first_picture_ms";
constexpr const char* kNext = "next_picture_ms";

MethodCost costOf(Gpu& gpu, const Scene& scene, std::string_view name) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  };
  MethodOptions method;
  method.name = name;
  const RenderOptions picture;
  MethodCost cost;
  const auto start = Clock::now();
  StillRenderer renderer(gpu, scene, {}, DrawOrder::Forward, method);
  static_cast<void>(renderer.measure(picture));
  cost.firstMs = since(start);
  std::array<double, kMeasurements> times{};
  for (int i = 0; i < kWarmUps; ++i) static_cast<void>(renderer.measure(picture));
  for (double& time : times) {
    const auto begin = Clock::now();
    const FrameReport report = renderer.measure(picture);
    time = report.frameMs > 0.0 ? report.frameMs : since(begin);
  }
  std::ranges::sort(times);
  cost.nextMs = times[times.size() / 2];
  return cost;
}

Json toJson(std::span<const MethodCost> costs) {
  Json all = Json::array();
  for (const MethodCost& cost : costs) all.push_back({{kFirst, cost.firstMs}, {kNext, cost.nextMs}});
  return all;
}

std::vector<MethodCost> costsOf(const Json& json) {
  std::vector<MethodCost> costs;
  for (const Json& cost : json) costs.push_back({cost.at(kFirst).get<double>(), cost.at(kNext).get<double>()});
  return costs;
}

// The file, an entry for each device, the newest first; empty where it is not there or is none of ours.
Json readMemory(const std::filesystem::path& memory) {
  std::ifstream file(memory);
  Json json = Json::parse(file, nullptr, false);
  if (!json.is_object() || !json.contains("devices") || !json["devices"].is_array()) return Json::array();
  return json["devices"];
}

bool isOf(const Json& entry, const std::string& identity) {
  const auto has = [&](const char* name, const std::string& text) {
    return entry.contains(name) && entry[name].is_string() && entry[name] == text;
  };
  return entry.is_object() && has("device", identity) && has("version", kVersion);
}

} // namespace

std::optional<std::filesystem::path> methodMemory() {
  const auto folder = [](const char* variable) -> std::filesystem::path {
    const char* value = std::getenv(variable); // NOLINT(concurrency-mt-unsafe): nothing sets any
    return value != nullptr ? value : "";
  };
  std::filesystem::path cache = folder("XDG_CACHE_HOME");
  if (!cache.is_absolute()) { // as the specification of these folders has it
    cache = folder("HOME");
    if (!cache.is_absolute()) return {};
    cache /= ".cache";
  }
  return cache / "vitrail" / "methods.json";
}

std::optional<MethodCosts> rememberedCosts(const std::filesystem::path& memory, const std::string& identity) {
  for (const Json& entry : readMemory(memory)) {
    if (!isOf(entry, identity)) continue;
    try {
      MethodCosts costs{costsOf(entry.at(std::string(kListMethod))), costsOf(entry.at(std::string(kTilesMethod)))};
      const bool isWhole =
          costs.lists.size() == kMeasured.size() && (costs.tiles.empty() || costs.tiles.size() == kMeasured.size());
      if (isWhole) return costs;
    } catch (const Json::exception&) { // somebody has edited it
    }
    return {};
  }
  return {};
}

void rememberCosts(const std::filesystem::path& memory, const std::string& identity, const MethodCosts& costs) {
  Json devices = Json::array();
  devices.push_back({{"device", identity},
                     {"version", kVersion},
                     {std::string(kListMethod), toJson(costs.lists)},
                     {std::string(kTilesMethod), toJson(costs.tiles)}});
  for (const Json& entry : readMemory(memory)) {
    if (devices.size() < kMostRemembered && !isOf(entry, identity)) devices.push_back(entry);
  }
  try {
    std::filesystem::create_directories(memory.parent_path());
    OutputFile file(memory);
    const std::string text = Json{{"devices", devices}}.dump(2) + "\n";
    file.write(std::as_bytes(std::span(text)));
    file.commit();
  } catch (const std::exception&) { // it is measured again next time
  }
}

MethodCosts measureMethods(Gpu& gpu) {
  MethodCosts costs;
  for (const auto& [name, count] : kMeasured) {
    const Scene scene = makeBuiltinScene(name, {count});
    costs.lists.push_back(costOf(gpu, scene, kListMethod));
    try {
      costs.tiles.push_back(costOf(gpu, scene, kTilesMethod));
    } catch (const DeviceLost&) {
      throw;
    } catch (const GpuError&) { // the device does not offer it
    }
  }
  if (costs.tiles.size() != costs.lists.size()) costs.tiles.clear();
  return costs;
}

std::string fasterMethod(const MethodCosts& costs, std::uint64_t pictures) {
  const auto sum = [&](const MethodCost& cost) {
    return cost.firstMs + static_cast<double>(pictures - 1) * cost.nextMs;
  };
  bool isFaster = !costs.tiles.empty() && costs.tiles.size() == costs.lists.size();
  for (std::size_t i = 0; isFaster && i < costs.tiles.size(); ++i) {
    isFaster = sum(costs.tiles[i]) < sum(costs.lists[i]);
  }
  return std::string(isFaster ? kTilesMethod : kListMethod);
}

std::string methodFor(Gpu& gpu, std::uint64_t pictures, const std::function<void()>& onMeasure) {
  const std::optional<std::filesystem::path> memory = methodMemory();
  if (!memory || pictures < kManyPictures) return std::string(kListMethod);
  const std::string identity = identityOf(gpu.properties());
  std::optional<MethodCosts> costs = rememberedCosts(*memory, identity);
  if (!costs) {
    if (gpu.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) return std::string(kListMethod);
    onMeasure();
    try {
      costs = measureMethods(gpu);
    } catch (const DeviceLost&) {
      throw;
    } catch (const GpuError&) { // a measurement that fails is no reason not to draw: what is wrong will be said then
      return std::string(kListMethod);
    }
    rememberCosts(*memory, identity, *costs);
  }
  return fasterMethod(*costs, pictures);
}

bool drawsAlike(const Scene& scene) {
  MethodOptions tiles;
  tiles.name = kTilesMethod;
  return methodWarnings(scene, tiles) == methodWarnings(scene, MethodOptions{});
}

} // namespace vitrail::tool
