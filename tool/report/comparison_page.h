// A comparison of methods as one HTML page that needs nothing beside it and no network.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "../compare/comparison.h"

namespace vitrail::tool {

// The pictures of a comparison as PNG files.
struct ComparisonPictures {
  struct OfMethod {
    std::vector<std::byte> picture;
    std::vector<std::byte> error; // FLIP, in kMagma from 0 to 1
  };
  std::vector<std::byte> exact;
  std::vector<std::byte> layers; // in kViridis from 0 to the most layers
  std::vector<OfMethod> methods; // as Comparison::methods
};
ComparisonPictures encodePictures(const Comparison& comparison);

// The page: a table, a slider between any two pictures, charts of cost, error and memory, the pictures with heatmaps of
// their errors, and a heatmap of the depth complexity. `report` is the comparison as JSON. The charts are drawn by
// Chart.js, which lies in the page.
std::string toPage(const Comparison& comparison, const ComparisonPictures& pictures, const std::string& report);

} // namespace vitrail::tool
