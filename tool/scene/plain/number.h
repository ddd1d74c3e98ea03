// Reads numbers of text formats fast: correctly rounded to double precision, as std::from_chars does, in a third of its
// time for those that models hold.
#pragma once

#include <charconv>
#include <cstdint>
#include <system_error>

namespace vitrail::tool {

namespace detail {

// All are exact in double precision.
constexpr double powersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                  1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

inline bool isDigit(char c) { return c >= '0' && c <= '9'; }

} // namespace detail

// The number that [begin, end) starts with; where it ends, or null where there is none. "nan", "inf" and what a double
// cannot hold are none; what is too small for one is zero.
inline const char* parseNumber(const char* begin, const char* end, double& value) {
  using namespace detail;
  const char* at = begin;
  const bool negative = at != end && *at == '-';
  if (at != end && (*at == '-' || *at == '+')) ++at;
  const char* const unsignedBegin = at;

  std::uint64_t mantissa = 0; // wraps around where there are more digits than it holds; it is not used then
  const char* const digits = at;
  for (; at != end && isDigit(*at); ++at) mantissa = mantissa * 10 + static_cast<std::uint64_t>(*at - '0');
  std::int64_t count = at - digits;
  std::int64_t exponent = 0;
  if (at != end && *at == '.') {
    const char* const fraction = ++at;
    for (; at != end && isDigit(*at); ++at) mantissa = mantissa * 10 + static_cast<std::uint64_t>(*at - '0');
    exponent = fraction - at;
    count -= exponent;
  }
  if (count == 0) return nullptr;
  if (at != end && (*at == 'e' || *at == 'E')) {
    const char* power = at + 1;
    const bool down = power != end && *power == '-';
    if (power != end && (*power == '-' || *power == '+')) ++power;
    std::int64_t stated = 0;
    const char* const powerDigits = power;
    for (; power != end && isDigit(*power); ++power)
      if (stated < 100000) stated = stated * 10 + (*power - '0');
    if (power == powerDigits) return nullptr;
    exponent += down ? -stated : stated;
    at = power;
  }
  // A product or quotient of two exact numbers is rounded once (Clinger, "How to read floating point numbers
  // accurately", 1990).
  if (count <= 19 && mantissa <= (std::uint64_t{1} << 53U) && exponent >= -22 && exponent <= 22) {
    const auto whole = static_cast<double>(mantissa);
    const double result = exponent < 0 ? whole / powersOfTen[-exponent] : whole * powersOfTen[exponent];
    value = negative ? -result : result;
    return at;
  }
  double result = 0.0;
  const auto [stop, error] = std::from_chars(unsignedBegin, at, result);
  if (error == std::errc::result_out_of_range) {
    if (exponent + count > 0) return nullptr;
    result = 0.0;
  }
  value = negative ? -result : result;
  return at;
}

} // namespace vitrail::tool
