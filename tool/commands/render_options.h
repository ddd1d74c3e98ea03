// What `vitrail render` was asked for, with every text already understood.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "../methods/method_options.h"
#include "../render/device.h"
#include "output_format.h"
#include "scene_options.h"

namespace vitrail::tool {

struct RenderArguments : SceneArguments, OutputArguments {
  MethodOptions method;                      // where neither it nor a device is named, the device has its own
  std::optional<std::string> methodName;     // --method
  std::optional<Api> api;                    // --api
  Wish wish = Wish::Fastest;                 // what the other options need
  std::optional<std::uint32_t> memoryBudget; // MiB
  std::optional<std::uint32_t> peel;         // surfaces of each pixel
  std::string device;
  std::string json; // empty: no report
  bool validate = false;
};

// What a picture is of, how it is blended and on which device: the options without those of files.
void addPictureOptions(CLI::App& command, RenderArguments& arguments);

// Checks what one of these alone does not show, and finds out which device they need. `command` is what help is named
// after. Throws UsageError.
void checkPictureArguments(RenderArguments& arguments, const std::string& command);

// Their lines of a help page, in place of the marks @scene@, @blend@, @api@ and @device@.
std::string withPictureHelp(const std::string& page);

// Adds the options to a command. Texts that cannot be understood end the parse with a CLI::ValidationError.
void addRenderOptions(CLI::App& command, RenderArguments& arguments);

// Checks what one option alone does not show, and finds out which device they need. Throws UsageError.
void checkRenderArguments(RenderArguments& arguments);

std::string renderHelp();

} // namespace vitrail::tool
