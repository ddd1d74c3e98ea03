#include "option_values.h"

#include <algorithm>
#include <limits>

#include <fmt/ranges.h>

#include "../methods/methods.h"
#include "errors.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kMaxSide = 65536; // a sane bound; the device's own is checked when it is known
constexpr std::uint32_t kMaxFrames = 100000;

std::optional<std::string> methodNamed(const std::string& name) {
  return std::ranges::count(methodNames(), name) > 0 ? std::optional(name) : std::nullopt;
}

} // namespace

std::string withText(std::string page, std::string_view mark, std::string_view text) {
  return page.replace(page.find(mark), mark.size(), text);
}

std::string methodsHelp() {
  std::string lines;
  for (const std::string_view name : methodNames()) {
    const MethodTraits& traits = traitsOf(name);
    lines += fmt::format("{}    {:<23}{}{}", lines.empty() ? "" : "\n", name, traits.wrong.empty() ? "exact: " : "",
                         traits.help);
  }
  return lines;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0;;) {
    const std::size_t next = text.find(separator, at);
    parts.push_back(text.substr(at, next - at));
    if (next == std::string::npos) return parts;
    at = next + 1;
  }
}

void addSize(CLI::App& command, std::uint32_t& width, std::uint32_t& height) {
  command.add_option_function<std::string>("--size", [&width, &height](const std::string& text) {
    const std::vector<std::string> parts = split(text, 'x');
    const std::uint32_t wide = parts.size() == 2 ? numberOf<std::uint32_t>(parts[0]).value_or(0) : 0;
    const std::uint32_t high = parts.size() == 2 ? numberOf<std::uint32_t>(parts[1]).value_or(0) : 0;
    if (wide < 1 || high < 1 || wide > kMaxSide || high > kMaxSide) {
      throw CLI::ValidationError("--size", fmt::format("'{}' is not a size such as 1280x720", text));
    }
    width = wide;
    height = high;
  });
}

void addOpacity(CLI::App& command, std::optional<float>& opacity) {
  command.add_option_function<std::string>("--opacity", [&opacity](const std::string& text) {
    const auto value = numberOf<float>(text);
    // The first opacity that the standard node format does not round to none.
    if (!value || !(*value >= 1.0F / 255.0F) || *value > 1.0F) {
      throw CLI::ValidationError("--opacity", fmt::format("'{}' is not between 1/255 (0.004) and 1", text));
    }
    opacity = *value;
  });
}

void addPointSize(CLI::App& command, std::optional<float>& size) {
  command.add_option_function<std::string>("--point-size", [&size](const std::string& text) {
    size = numberOf<float>(text);
    if (!size || !(*size >= 1.0F) || *size > 65536.0F) {
      throw CLI::ValidationError("--point-size", fmt::format("'{}' is not a number of pixels from 1 to 65536", text));
    }
  });
}

std::string isNot(const std::string& text, std::string_view known) {
  const bool isWhole = !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  if (!isWhole || numberOf<std::uint32_t>(text)) return fmt::format("'{}' is not {}", text, known);
  return fmt::format("{} is too large: {} at the most", text, std::numeric_limits<std::uint32_t>::max());
}

void addCount(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& target) {
  command.add_option_function<std::string>(name, [name, &target](const std::string& text) {
    target = numberOf<std::uint32_t>(text);
    if (!target) throw CLI::ValidationError(name, isNot(text, "a whole number from 0"));
  });
}

void addFrames(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& target) {
  command.add_option_function<std::string>(name, [name, &target](const std::string& text) {
    target = numberOf<std::uint32_t>(text);
    if (!target || *target < 1 || *target > kMaxFrames) {
      throw CLI::ValidationError(name, fmt::format("'{}' is not a whole number from 1 to {}", text, kMaxFrames));
    }
  });
}

void addMethods(CLI::App& command, std::vector<std::string>& methods) {
  addList<std::string>(command, "--methods", methods,
                       fmt::format("a method; there are {}", fmt::join(methodNames(), ", ")), methodNamed);
}

void addLimits(CLI::App& command, MethodLimits& limits) {
  addPositive(command, "--layers", limits.layers);
  addPositive(command, "--passes", limits.passes);
}

void checkLimitsOf(const std::vector<std::string>& methods, const MethodLimits& limits) {
  try {
    checkLimits(methods, limits);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

} // namespace vitrail::tool
