// What the JSON documents of reports share. Their names and units are an interface and stay (names.h); what does not
// apply, or could not be measured, is null.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "../bench/measurement.h"
#include "../image/metrics.h"

namespace vitrail::tool {

using Json = nlohmann::ordered_json;

template <class Value>
Json orNull(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

// A text, or null where it is empty.
Json orNull(std::string_view text);

// What --layers or --passes said of a method; 0: nothing.
Json limitOrNull(std::uint32_t limit);

// In 1/255; null where the picture is not complete.
Json errorBoundOf(const FrameStats& frame);

// requested, stored, missing; null where the method does not count them.
Json fragmentsOf(const FrameStats& frame);

// The most and the mean of a pixel that has any; null where the method does not count them.
Json layersOf(const FrameStats& frame);

// Milliseconds by pass: medians and how far they lie apart.
Json passesOf(const Measurement& measured);

// Adds the passes, the cost and the frame, with their ratios.
void addCosts(Json& json, const Measurement& measured);

// Adds what was measured on.
void addMachine(Json& json, const Machine& machine);

// Adds how often a frame was drawn.
void addRounds(Json& json, std::uint32_t repeats, std::uint32_t warmups);

// psnr_db (null: the pictures are equal), ssim, flip, worst {x, y, difference (1/255)}, off_share.
Json metricsOf(const Metrics& metrics);

// The text of a whole document, which ends with a line feed. Names may have bytes that are no UTF-8.
std::string documentOf(const Json& json);

} // namespace vitrail::tool
