// What the values of options are, for the commands that share them: one wording, one refusal.
#pragma once

#include <charconv>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "../bench/matrix.h"

namespace vitrail::tool {

// The whole text as a number, or nothing.
template <class Number>
std::optional<Number> numberOf(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return {};
  return value;
}

// A help page with a text in place of a mark, which it has once.
std::string withText(std::string page, std::string_view mark, std::string_view text);

// All methods for a help page, a line each: the name, whether it is exact, and how it draws.
std::string methodsHelp();

std::vector<std::string> split(const std::string& text, char separator);

// Each adds an option to a command. A text that cannot be understood ends the parse with a CLI::ValidationError.

// --size WxH
void addSize(CLI::App& command, std::uint32_t& width, std::uint32_t& height);
// --opacity A
void addOpacity(CLI::App& command, std::optional<float>& opacity);
// --point-size N
void addPointSize(CLI::App& command, std::optional<float>& size);
// A whole number from 0; CLI11's own conversion takes -1 and 1e3 for some types.
void addCount(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& target);
// A number of frames to draw.
void addFrames(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& target);
// --methods NAME,...
void addMethods(CLI::App& command, std::vector<std::string>& methods);

// --layers N and --passes N of methods that are compared
void addLimits(CLI::App& command, MethodLimits& limits);
// checkLimits() of what was asked for. Throws UsageError.
void checkLimitsOf(const std::vector<std::string>& methods, const MethodLimits& limits);

// What is wrong with a text that is not, say, "a whole number from 1".
std::string isNot(const std::string& text, std::string_view known);

// A whole number from 1.
template <typename Target>
void addPositive(CLI::App& command, const std::string& name, Target& target) {
  command.add_option_function<std::string>(name, [name, &target](const std::string& text) {
    const auto value = numberOf<std::uint32_t>(text);
    if (!value || *value < 1) throw CLI::ValidationError(name, isNot(text, "a whole number from 1"));
    target = *value;
  });
}

// A choice by name. `names` is what to say where there is none of that name.
template <typename Target, typename Choice>
void addChoice(CLI::App& command, const std::string& name, const char* names, Target& target,
               std::optional<Choice> (*named)(std::string_view)) {
  command.add_option_function<std::string>(name, [name, names, &target, named](const std::string& text) {
    const std::optional<Choice> choice = named(text);
    if (!choice) throw CLI::ValidationError(name, fmt::format("'{}' is none of {}", text, names));
    target = *choice;
  });
}

// A list separated by commas of what `parse` understands of each part; `known` says in words what that is.
template <class Value>
void addList(CLI::App& command, const std::string& name, std::vector<Value>& target, const std::string& known,
             std::function<std::optional<Value>(const std::string&)> parse) {
  command.add_option_function<std::string>(name, [=, &target](const std::string& text) {
    target.clear();
    for (const std::string& part : split(text, ',')) {
      const std::optional<Value> value = parse(part);
      if (!value) throw CLI::ValidationError(name, isNot(part, known));
      target.push_back(*value);
    }
  });
}

} // namespace vitrail::tool
