#include "event_log.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vitrail::tool {

namespace {

// What stands beside a picture.
std::string nameOf(const Drawn& drawn) {
  switch (drawn.wanted.beside.kind) {
    case Beside::Kind::Method:
      return drawn.wanted.beside.method;
    case Beside::Kind::Complexity:
      return "complexity";
    case Beside::Kind::Error:
      return "error";
    case Beside::Kind::Overflow:
      return "overflow";
    case Beside::Kind::Tiles:
      return "tiles";
    default:
      return "";
  }
}

void write(std::FILE* file, const nlohmann::json& line) {
  const std::string text = line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  std::fwrite(text.data(), 1, text.size(), file);
  std::fflush(file);
}

} // namespace

EventLog::EventLog(const std::string& file) {
  if (file.empty()) return;
  file_.reset(std::fopen(file.c_str(), "w"));
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot be written: {}", file, std::strerror(errno)));
}

void EventLog::shown(const Drawn& drawn, const std::string& command) {
  if (!file_) return;
  const FrameReport& report = drawn.report;
  nlohmann::json passes = nlohmann::json::object();
  for (const auto& [name, milliseconds] : report.passesMs) passes[name] = milliseconds;
  write(file_.get(), {{"event", "shown"},
                      {"method", report.method},
                      {"device", report.device},
                      {"width", report.width},
                      {"height", report.height},
                      {"samples", report.samples},
                      {"coarse", drawn.wanted.coarse},
                      {"complete", report.complete},
                      {"exact", isExact(report)},
                      {"fragments", report.fragmentsRequested},
                      {"layersMax", report.layersMax},
                      {"missing", report.fragmentsMissing},
                      {"tiles", report.tiles},
                      {"peeled", report.peeled},
                      {"passes", passes},
                      {"onDevice", drawn.image != nullptr},
                      {"milliseconds", drawn.milliseconds},
                      {"beside", nameOf(drawn)},
                      {"largest", drawn.largest},
                      {"warnings", drawn.warnings},
                      {"command", command}});
}

void EventLog::picked(const Picked& picked) {
  if (!file_) return;
  nlohmann::json layers = nlohmann::json::array();
  for (const PickedLayer& layer : picked.layers) {
    layers.push_back({{"object", picked.scene->objects.path(layer.object)},
                      {"material", layer.material},
                      {"depth", layer.distance},
                      {"color", {layer.color.r, layer.color.g, layer.color.b}},
                      {"alpha", layer.alpha}});
  }
  write(file_.get(), {{"event", "picked"},
                      {"x", picked.x},
                      {"y", picked.y},
                      {"layers", layers},
                      {"byDevice", picked.byDevice},
                      {"milliseconds", picked.milliseconds}});
}

void EventLog::happened(const std::string& event, const std::string& text) {
  if (file_) write(file_.get(), {{"event", event}, {"text", text}});
}

} // namespace vitrail::tool
