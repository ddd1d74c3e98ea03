// What repeated measurements of one thing say about it.
#pragma once

#include <vector>

namespace vitrail::tool {

// The middle of a set of measurements and how far they lie apart, in the unit of the measurements. The quartiles are
// interpolated linearly between the two nearest measurements (Hyndman and Fan's definition 7, 1996).
struct Spread {
  double median = 0.0;
  double lowerQuartile = 0.0;
  double upperQuartile = 0.0;
  double min = 0.0;
  double max = 0.0;
};

// Of at least one measurement, in any order; throws std::invalid_argument for none.
Spread spreadOf(std::vector<double> measurements);

// The interquartile range as a fraction of the median; NaN where the median is 0.
double relativeRange(const Spread& spread);

// The median of one over the median of the other; NaN where the latter is 0.
double ratioOfMedians(const Spread& measured, const Spread& baseline);

} // namespace vitrail::tool
