#include "render_options.h"

#include <fmt/format.h>

#include <stdexcept>

#include "../methods/methods.h"
#include "device_options.h"
#include "errors.h"
#include "option_values.h"

namespace vitrail::tool {

namespace {

constexpr const char* kBlendHelp =
    R"(How to blend it:
  --method M            one of these; the first is the default, but windows, and turns of 100 pictures
                        and more, are drawn on a GPU by the faster one of the first two
@methods@
  --samples N           1 (default), 2, 4 or 8 samples a pixel, as the device offers
  --msaa-resolve R      per-pixel (default): the samples are blended and averaged at once.
                        per-sample: each is blended into a multisampled picture. The same picture
  --nodes F             how a fragment is stored: hdr (default, 16 bytes: each pixel within 1/255 of
                        the real-number answer), standard (12 bytes, 8 bits of alpha: faint surfaces
                        may be lost), compact (8 bytes, coarser colours and depths)
  --resolve R           where the lists are sorted: compute or fragment shaders (default: the faster
                        one of the device). The same picture
  --list-build L        where fragments are put on their lists: in the fragment shaders that shade
                        them, or in a compute pass after them (default: the faster one of the
                        device, as far as that was measured). With standard nodes and one sample the
                        last bit of some colours differs
  --passes N            of stochastic: passes over the surfaces (default 16); four times as many
                        halve the noise
  --layers N            blends only the nearest N surfaces of a pixel exactly (default: all; loop,
                        loop-64 and interlock: 8); depth-peeling leaves the others out; the layers
                        of multi-layer (default 4)
  --peel N              leaves out the N nearest transparent surfaces of each pixel: what they hide is
                        seen. Of linked-list and cpu
  --sorting S           on (default), off: surfaces are blended in the order in which they arrive, as
                        a lesson. Of linked-list
  --memory-budget MIB   for fragments, at least 1; a picture that needs more is drawn in tiles, the
                        same picture (default: what the device can give))";

constexpr const char* kRenderHelp =
    R"(Draws models with exact transparency and writes a picture, or the pictures of a turn around them.

Usage:
  vitrail render MODEL... -o FILE [options]
  vitrail render --scene NAME -o FILE [options]

@scene@

@blend@

Where to:
@output@
  --json FILE           a report: fragments, layers, memory, GPU time of each pass; of a
                        turn one for each picture
  --quiet               print nothing but errors
  --strict              fail where there would be a warning: where the picture lacks something
                        that the file has, or shows nothing

Which device:
@api@
@device@
  --validate            run under the Vulkan validation layer, or with OpenGL's debug output; errors
                        fail the command

Examples:
  vitrail render engine.glb -o engine.png --opacity 0.25
  vitrail render car.gltf -o car.png --size 1920x1080 --orbit 30,15 --background '#202028'
  vitrail render --scene interlocked -o rings.png
  vitrail render scan.ply --up z --clip-plane 0,0,-1,-1.2 -o below_1.2_metres.png
  vitrail render house.glb garden.obj --eye 4,1.7,9 --look-at 0,1.5,0 --fov 60 -o view.exr
  vitrail render engine.glb --opacity 0.25 --turntable 120 -o turn.mp4
)";

void addMethodOptions(CLI::App& command, RenderArguments& arguments) {
  MethodOptions& method = arguments.method;
  command.add_option("--method", arguments.methodName);
  addApi(command, arguments.api);
  addPositive(command, "--samples", method.samples);
  addPositive(command, "--layers", method.maxLayers);
  addPositive(command, "--passes", method.passes);
  addPositive(command, "--memory-budget", arguments.memoryBudget);
  addPositive(command, "--peel", arguments.peel);
  addChoice(command, "--sorting", "on and off", method.sorted, sortingNamed);
  addChoice(command, "--nodes", "standard, compact and hdr", method.nodes, nodeFormatNamed);
  addChoice(command, "--resolve", "compute and fragment", method.resolve, resolveNamed);
  addChoice(command, "--list-build", "fragment and compute", method.listBuild, listBuildNamed);
  addChoice(command, "--msaa-resolve", "per-pixel and per-sample", method.msaaResolve, msaaResolveNamed);
}

// An option that only Vulkan devices have; empty where there is none.
std::string vulkanOption(const RenderArguments& arguments) {
  const MethodOptions defaults;
  const MethodOptions& method = arguments.method;
  if (arguments.methodName) return "--method " + *arguments.methodName;
  if (method.nodes != defaults.nodes) return "--nodes";
  if (method.resolve != defaults.resolve) return "--resolve";
  if (method.listBuild != defaults.listBuild) return "--list-build";
  if (method.msaaResolve != defaults.msaaResolve) return "--msaa-resolve";
  if (method.maxLayers != defaults.maxLayers) return "--layers";
  if (method.passes != defaults.passes) return "--passes";
  if (method.sorted != defaults.sorted) return "--sorting off";
  return arguments.validate ? "--validate" : "";
}

void chooseDevice(RenderArguments& arguments) {
  const bool isCpuMethod = arguments.methodName == kCpuMethod;
  const bool isCpuDevice = isProcessor(arguments.device);
  if (arguments.api && (isCpuMethod || isCpuDevice)) {
    throw UsageError(fmt::format("the {} cpu draws without an API: leave --api {} out, or --{} cpu",
                                 isCpuMethod ? "method" : "device", nameOf(*arguments.api),
                                 isCpuMethod ? "method" : "device"));
  }
  if (isCpuMethod && arguments.validate) throw UsageError("the method cpu is without Vulkan: leave --validate out");
  if (isCpuMethod && !isCpuDevice && !arguments.device.empty()) {
    throw UsageError("the method cpu draws on the processor: leave --device out, or name cpu");
  }
  const std::string needsVulkan = isCpuMethod ? "" : vulkanOption(arguments);
  if (isCpuDevice && !needsVulkan.empty()) {
    throw UsageError(
        fmt::format("{} needs a Vulkan device, which cpu is not: leave it out, or --device cpu", needsVulkan));
  }
  if (arguments.method.api == Api::OpenGl) { // which has a device of its own
    arguments.wish = Wish::Vulkan;
  } else if (isCpuMethod || isCpuDevice) {
    arguments.wish = Wish::Processor;
    arguments.method.name = kCpuMethod;
  } else if (!needsVulkan.empty()) {
    arguments.wish = Wish::Vulkan;
  }
}

void checkMethod(const RenderArguments& arguments) {
  try {
    checkMethodOptions(arguments.method);
    checkPictureOptions(arguments.method, arguments.memoryBudget.has_value(), arguments.peel.has_value());
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

} // namespace

std::string withPictureHelp(const std::string& page) {
  const std::string blend = withText(kBlendHelp, "@methods@", methodsHelp());
  return withApiHelp(withDeviceHelp(withText(withSceneHelp(page), "@blend@", blend)), false);
}

std::string renderHelp() { return withText(withPictureHelp(kRenderHelp), "@output@", kOutputHelp); }

void addPictureOptions(CLI::App& command, RenderArguments& arguments) {
  command.add_option("MODEL", arguments.models);
  addSceneOptions(command, arguments);
  command.add_option("--device", arguments.device);
  command.add_flag("--validate", arguments.validate);
  addMethodOptions(command, arguments);
}

void addRenderOptions(CLI::App& command, RenderArguments& arguments) {
  addPictureOptions(command, arguments);
  addOutputOptions(command, arguments);
  command.add_option("--json", arguments.json);
  addWarningOptions(command, arguments);
}

void checkPictureArguments(RenderArguments& arguments, const std::string& command) {
  checkSceneArguments(arguments, command);
  arguments.method.name = arguments.methodName.value_or(arguments.method.name);
  arguments.method.api = arguments.api.value_or(arguments.method.api);
  // What the processor cannot do is said of it, not of the method that a Vulkan device would draw with.
  if (isProcessor(arguments.device) && !arguments.methodName) chooseDevice(arguments);
  checkMethod(arguments);
  static_cast<void>(deviceFor(arguments.device, false, {arguments.method.name}, {arguments.method.api}));
  chooseDevice(arguments);
}

void checkRenderArguments(RenderArguments& arguments) {
  checkPictureArguments(arguments, "render");
  static_cast<void>(outputFormatOf(arguments));
}

} // namespace vitrail::tool
