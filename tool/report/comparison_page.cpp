#include "comparison_page.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "../image/color_map.h"
#include "../image/png_encode.h"
#include "files/compare.html.h"
#include "files/compare.js.h"
#include "page.h"

namespace vitrail::tool {

namespace {

// RFC 4648.
std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      group = group << 8U | (k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k]) : 0U);
    }
    const std::size_t present = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t digit = 0; digit < 4; ++digit) {
      text += digit <= present ? kDigits[group >> (18 - 6 * digit) & 63U] : '=';
    }
  }
  return text;
}

std::string pngUri(std::span<const std::byte> png) { return "\"data:image/png;base64," + base64(png) + "\""; }

std::string colorsOf(const ColorMap& map) {
  std::string text;
  for (const auto& color : map) {
    text += fmt::format("{}\"rgb({} {} {})\"", text.empty() ? "[" : ",", color[0], color[1], color[2]);
  }
  return text + "]";
}

std::string dataOf(const Comparison& comparison, const ComparisonPictures& pictures, const std::string& report) {
  std::string methods;
  for (std::size_t i = 0; i < pictures.methods.size(); ++i) {
    methods += fmt::format("{}{{\"name\":\"{}\",\"picture\":{},\"error\":{}}}", i == 0 ? "" : ",",
                           labelOf(comparison.methods[i].measurement.options), pngUri(pictures.methods[i].picture),
                           pngUri(pictures.methods[i].error));
  }
  return fmt::format(R"({{"report":{},"exact":{},"layers":{},"error_colors":{},"layers_colors":{},"methods":[{}]}})",
                     withoutTags(report), pngUri(pictures.exact), pngUri(pictures.layers), colorsOf(kMagma),
                     colorsOf(kViridis), methods);
}

} // namespace

ComparisonPictures encodePictures(const Comparison& comparison) {
  ComparisonPictures pictures;
  pictures.exact = encodePng(comparison.exact);
  pictures.layers = encodePng(heatmap(comparison.layers, comparison.layersMax, kViridis));
  for (const ComparedMethod& method : comparison.methods) {
    pictures.methods.push_back({encodePng(method.picture), encodePng(heatmap(method.difference.flip, 1.0, kMagma))});
  }
  return pictures;
}

std::string toPage(const Comparison& comparison, const ComparisonPictures& pictures, const std::string& report) {
  return makePage({.title = "Transparency methods compared",
                   .body = files::compare_html,
                   .data = dataOf(comparison, pictures, report),
                   .script = files::compare_js});
}

} // namespace vitrail::tool
