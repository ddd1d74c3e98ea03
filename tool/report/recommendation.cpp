#include "recommendation.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "../bench/matrix.h"
#include "../methods/methods.h"

namespace vitrail::tool {

namespace {

// Few rounds can agree by chance: costs that lie closer than this are never told apart.
constexpr double kLeastSpread = 0.05;

// What weighs less than a promise.
constexpr double kTrifle = 0.1;

constexpr const char* kUnknown = "unknown";

using Scenes = std::vector<const SceneMeasurement*>;
using Candidates = std::vector<const Measurement*>; // the best first
using Wanted = std::function<bool(const Measurement&)>;

// Steps from `first` to `last` for which one setting is named; nothing where no setting was wanted there.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
  std::string setting;
};

// A setting's name: its sample count is the step of a sweep over samples.
std::string nameOf(const Measurement& measured) { return describeWithoutSamples(measured.options); }

bool isExact(const Measurement& measured) { return isExact(measured.report); }

// What a setting gets wrong in some frames; nothing of one that is always exact.
std::string_view wrongOf(const Measurement& measured) {
  const std::string_view wrong = traitsOf(measured.options.name).wrong;
  if (!wrong.empty()) return wrong;
  if (measured.options.maxLayers > 0) return "surfaces beyond the layers are averaged or left out";
  return measured.options.nodeCapacity > 0 ? "frames of more fragments than nodes are blended approximately" : "";
}

// A promise rather than what the frames happened to hold: no frame has too many layers for it.
bool isAlwaysExact(const Measurement& measured) { return isExact(measured) && wrongOf(measured).empty(); }

bool isExactHereAlone(const Measurement& measured) { return isExact(measured) && !isAlwaysExact(measured); }

bool isOrderIndependent(const Measurement& measured) {
  return isExact(measured) || traitsOf(measured.options.name).orderIndependent;
}

Candidates wantedOf(const SceneMeasurement& scene, const Wanted& wanted) {
  std::uint32_t samples = std::numeric_limits<std::uint32_t>::max();
  for (const Measurement& each : scene.measurements) samples = std::min(samples, each.options.samples);
  Candidates found;
  for (const Measurement& each : scene.measurements) {
    if (each.options.samples == samples && wanted(each)) found.push_back(&each);
  }
  return found;
}

// The settings whose cost cannot be told from the cheapest one's, that one first.
Candidates cheapestOf(const SceneMeasurement& scene, const Wanted& wanted) {
  Candidates found = wantedOf(scene, wanted);
  std::ranges::stable_sort(found, {}, [](const Measurement* each) { return each->costMs.median; });
  if (found.empty()) return found;
  const double most =
      std::max(found.front()->costMs.upperQuartile, (1.0 + kLeastSpread) * found.front()->costMs.median);
  std::erase_if(found, [&](const Measurement* each) { return each->costMs.lowerQuartile > most; });
  return found;
}

// The settings that keep the fewest bytes.
Candidates smallestOf(const SceneMeasurement& scene, const Wanted& wanted) {
  Candidates found = wantedOf(scene, wanted);
  std::ranges::stable_sort(found, {}, [](const Measurement* each) { return each->costMs.median; });
  const auto bytes = [](const Measurement* each) { return each->report.totalBytes; };
  if (found.empty()) return found;
  const std::uint64_t least = bytes(*std::ranges::min_element(found, {}, bytes));
  std::erase_if(found, [&](const Measurement* each) { return bytes(each) > least; });
  return found;
}

bool holds(const Candidates& candidates, const std::string& setting) {
  return std::ranges::any_of(candidates, [&](const Measurement* each) { return nameOf(*each) == setting; });
}

// The last step from `first` on, without a gap, that has the setting among its candidates.
std::size_t lastWith(const std::vector<Candidates>& steps, std::size_t first, const std::string& setting) {
  std::size_t last = first;
  while (last + 1 < steps.size() && holds(steps[last + 1], setting)) ++last;
  return last;
}

// Names one setting for every step, in as few runs as there can be.
std::vector<Run> runsOf(const std::vector<Candidates>& steps) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < steps.size(); i = runs.back().last + 1) {
    Run run{i, i, {}};
    for (const Measurement* each : steps[i]) {
      const std::size_t last = lastWith(steps, i, nameOf(*each));
      if (run.setting.empty() || last > run.last) run = {i, last, nameOf(*each)};
    }
    while (steps[i].empty() && run.last + 1 < steps.size() && steps[run.last + 1].empty()) ++run.last;
    runs.push_back(run);
  }
  return runs;
}

const Measurement& measurementOf(const SceneMeasurement& scene, const std::string& setting) {
  const Candidates found = wantedOf(scene, [&](const Measurement& each) { return nameOf(each) == setting; });
  return *found.front();
}

// "at 1 to 64 layers", "in spheres, planes".
std::string placesOf(const Scenes& scenes, std::size_t first, std::size_t last) {
  if (!scenes[first]->sweep) {
    std::vector<std::string> names;
    for (std::size_t i = first; i <= last; ++i) names.push_back(scenes[i]->name);
    return fmt::format("in {}", fmt::join(names, ", "));
  }
  const SweepPlace& from = *scenes[first]->sweep;
  const std::string& to = scenes[last]->sweep->label;
  const std::string range = from.label == to ? to : fmt::format("{} to {}", from.label, to);
  switch (from.kind) {
    case SweepKind::Layers:
      return fmt::format("at {} {}", range, to == "1" ? "layer" : "layers");
    case SweepKind::Triangles:
      return fmt::format("with {} triangles", range);
    case SweepKind::Resolution:
      return fmt::format("at {} pixels", range);
    case SweepKind::Cap:
      return fmt::format("with at most {} {} blended exactly", range, to == "1" ? "layer" : "layers");
    case SweepKind::Samples:
      break;
  }
  return fmt::format("with {} {} a pixel", range, to == "1" ? "sample" : "samples");
}

// The smallest and the largest of a number over the steps of a run.
template <class Number>
std::string rangeOf(const Scenes& scenes, const Run& run, const char* format, Number number) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    const double value = number(*scenes[i]);
    least = std::min(least, value);
    most = std::max(most, value);
  }
  if (!std::isfinite(least) || !std::isfinite(most)) return kUnknown;
  const std::string low = fmt::format(fmt::runtime(format), least);
  const std::string high = fmt::format(fmt::runtime(format), most);
  return low == high ? low : fmt::format("{} to {}", low, high);
}

// "1.10 to 2.30 times the cost of unsorted (0.520 to 1.100 ms) and 3.5 to 120.0 MiB".
std::string numbersOf(const Scenes& scenes, const Run& run, bool isCpu) {
  const auto of = [&](const SceneMeasurement& scene) -> const Measurement& {
    return measurementOf(scene, run.setting);
  };
  const std::string ratio =
      rangeOf(scenes, run, "{:.2f}", [&](const SceneMeasurement& scene) { return of(scene).costRatio; });
  const std::string milliseconds =
      rangeOf(scenes, run, "{:.3f}", [&](const SceneMeasurement& scene) { return of(scene).costMs.median; }) + " ms";
  std::string text = ratio == kUnknown ? milliseconds : fmt::format("{} times the cost of {}", ratio, kBaselineMethod);
  if (!isCpu && ratio != kUnknown) text += fmt::format(" ({})", milliseconds);
  return text + fmt::format(" and {} MiB", rangeOf(scenes, run, "{:.1f}", [&](const SceneMeasurement& scene) {
                              return static_cast<double>(of(scene).report.totalBytes) / (1024.0 * 1024.0);
                            }));
}

// The other settings that are as good at every step of a run.
std::string othersOf(const std::vector<Candidates>& steps, const Run& run) {
  std::vector<std::string> names;
  for (const Measurement* each : steps[run.first]) {
    const std::string name = nameOf(*each);
    if (name != run.setting && lastWith(steps, run.first, name) >= run.last) names.push_back(name);
  }
  if (names.empty()) return {};
  return fmt::format("; within the measured spread of it: {}", fmt::join(names, "; "));
}

std::string capitalized(std::string text) {
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::vector<Candidates> each(const Scenes& scenes, Candidates (*best)(const SceneMeasurement&, const Wanted&),
                             const Wanted& wanted) {
  std::vector<Candidates> steps;
  for (const SceneMeasurement* scene : scenes) steps.push_back(best(*scene, wanted));
  return steps;
}

// What a method that was exact in these frames gets wrong in others; nothing of one that always is exact.
std::string elsewhere(const Scenes& scenes, const Run& run) {
  const std::string_view wrong = wrongOf(measurementOf(*scenes[run.first], run.setting));
  return wrong.empty() ? "" : fmt::format(" It was exact in these frames; in others {}.", wrong);
}

// The cheapest of the methods that are always exact; where none was measured, of those that were exact.
std::vector<Candidates> cheapestExact(const Scenes& scenes) {
  std::vector<Candidates> steps = each(scenes, cheapestOf, isAlwaysExact);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].empty()) steps[i] = cheapestOf(*scenes[i], isExact);
  }
  return steps;
}

// Methods that cost less than the always exact one of a run by more than a trifle, or by that at most, and were exact
// in these frames alone.
std::string luckyText(const Scenes& scenes, const Run& exact, bool byATrifle, bool isCpu) {
  const Scenes within(scenes.begin() + static_cast<std::ptrdiff_t>(exact.first),
                      scenes.begin() + static_cast<std::ptrdiff_t>(exact.last) + 1);
  std::vector<Candidates> steps = each(within, cheapestOf, isExactHereAlone);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double cost = measurementOf(*within[i], exact.setting).costMs.median;
    std::erase_if(steps[i], [&](const Measurement* each) {
      const bool isTrifle = (1.0 + kTrifle) * each->costMs.median >= cost;
      return each->costMs.median >= cost || isTrifle != byATrifle;
    });
  }
  std::string text;
  for (const Run& run : runsOf(steps)) {
    if (run.setting.empty()) continue;
    const bool isWhole = run.first == 0 && run.last + 1 == within.size();
    const std::string where = isWhole ? "" : capitalized(placesOf(within, run.first, run.last)) + " ";
    const std::string less = byATrifle ? "at most a tenth less" : "less: " + numbersOf(within, run, isCpu);
    text += fmt::format(" {}{} costs {}.{}", where, run.setting, less, elsewhere(within, run));
  }
  return text;
}

std::string exactSentence(const Scenes& scenes, const std::vector<Candidates>& steps, const Run& run, bool isCpu) {
  const std::string where = capitalized(placesOf(scenes, run.first, run.last));
  if (run.setting.empty()) return fmt::format("{} no method that was measured is exact.", where);
  const std::string numbers = numbersOf(scenes, run, isCpu) + othersOf(steps, run);
  if (!isAlwaysExact(measurementOf(*scenes[run.first], run.setting))) {
    return fmt::format("{} {} is the cheapest exact method: {}.{}", where, run.setting, numbers,
                       elsewhere(scenes, run));
  }
  return fmt::format("{} {} is the cheapest method that is exact in every frame: {}.{}{}", where, run.setting, numbers,
                     luckyText(scenes, run, false, isCpu), luckyText(scenes, run, true, isCpu));
}

std::string exactText(const Scenes& scenes, bool isCpu) {
  std::vector<std::string> sentences;
  const std::vector<Candidates> steps = cheapestExact(scenes);
  for (const Run& run : runsOf(steps)) sentences.push_back(exactSentence(scenes, steps, run, isCpu));
  return fmt::format("{}", fmt::join(sentences, " "));
}

// The runs of order-independent settings, of which those of exact ones are one where they follow each other.
std::vector<Run> approximateRuns(const Scenes& scenes, std::vector<Candidates>& steps) {
  for (Candidates& step : steps) { // an approximate method has to be cheaper than every exact one
    if (std::ranges::any_of(step, [](const Measurement* candidate) { return isAlwaysExact(*candidate); })) {
      std::erase_if(step, [](const Measurement* candidate) { return !isAlwaysExact(*candidate); });
    }
  }
  std::vector<Run> runs;
  const auto hasExact = [&](const Run& run) {
    return !run.setting.empty() && isAlwaysExact(measurementOf(*scenes[run.first], run.setting));
  };
  for (const Run& run : runsOf(steps)) {
    if (!runs.empty() && hasExact(runs.back()) && hasExact(run)) {
      runs.back().last = run.last;
    } else {
      runs.push_back(run);
    }
  }
  return runs;
}

bool isExactThroughout(const Scenes& scenes, const Run& run) {
  for (std::size_t i = run.first; i <= run.last; ++i) {
    if (!isExact(measurementOf(*scenes[i], run.setting))) return false;
  }
  return true;
}

std::string approximateText(const Scenes& scenes, bool isCpu) {
  std::vector<std::string> sentences;
  std::vector<Candidates> steps = each(scenes, cheapestOf, isOrderIndependent);
  for (const Run& run : approximateRuns(scenes, steps)) {
    const std::string where = capitalized(placesOf(scenes, run.first, run.last));
    if (run.setting.empty()) {
      sentences.push_back(fmt::format("{} no order-independent method was measured.", where));
      continue;
    }
    const Measurement& measured = measurementOf(*scenes[run.first], run.setting);
    if (isAlwaysExact(measured)) {
      sentences.push_back(
          fmt::format("{} no order-independent method that was measured is cheaper than the exact one.", where));
      continue;
    }
    const std::string_view wrong = wrongOf(measured);
    const bool wasExact = isExactThroughout(scenes, run);
    sentences.push_back(fmt::format(
        "{} {} is the cheapest order-independent method: {}{}.{}", where, run.setting, numbersOf(scenes, run, isCpu),
        othersOf(steps, run),
        wasExact ? elsewhere(scenes, run) : fmt::format(" It is not exact{}{}.", wrong.empty() ? "" : ": ", wrong)));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

// Whether the cheapest keep more than a setting by more than a trifle at a step.
bool savesMemory(const Scenes& scenes, const Run& run, const std::vector<Run>& cheapest) {
  for (const Run& other : cheapest) {
    for (std::size_t i = std::max(run.first, other.first); i <= std::min(run.last, other.last); ++i) {
      const auto most = static_cast<double>(measurementOf(*scenes[i], other.setting).report.totalBytes);
      const auto least = static_cast<double>(measurementOf(*scenes[i], run.setting).report.totalBytes);
      if (most > (1.0 + kTrifle) * least) return true;
    }
  }
  return false;
}

// Nothing where the cheapest exact method keeps the least as well, or little more.
std::string memoryText(const Scenes& scenes, bool isCpu) {
  std::vector<std::string> sentences;
  const std::vector<Run> cheapest = runsOf(cheapestExact(scenes));
  for (const Run& run : runsOf(each(scenes, smallestOf, isExact))) {
    if (run.setting.empty() || !savesMemory(scenes, run, cheapest)) continue;
    sentences.push_back(fmt::format("{} the exact method that keeps the least memory is {}: {}.{}",
                                    capitalized(placesOf(scenes, run.first, run.last)), run.setting,
                                    numbersOf(scenes, run, isCpu), elsewhere(scenes, run)));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

} // namespace

std::vector<std::optional<SweepKind>> sweepsOf(const BenchReport& report) {
  std::vector<std::optional<SweepKind>> sweeps;
  for (const SceneMeasurement& scene : report.scenes) {
    const std::optional<SweepKind> sweep = scene.sweep ? std::optional(scene.sweep->kind) : std::nullopt;
    if (std::ranges::count(sweeps, sweep) == 0) sweeps.push_back(sweep);
  }
  return sweeps;
}

std::vector<const SceneMeasurement*> scenesOf(const BenchReport& report, std::optional<SweepKind> sweep) {
  Scenes scenes;
  for (const SceneMeasurement& scene : report.scenes) {
    const std::optional<SweepKind> kind = scene.sweep ? std::optional(scene.sweep->kind) : std::nullopt;
    if (kind == sweep) scenes.push_back(&scene);
  }
  return scenes;
}

std::vector<Advice> recommend(const BenchReport& report) {
  std::vector<Advice> all;
  for (const std::optional<SweepKind> sweep : sweepsOf(report)) {
    Scenes scenes = scenesOf(report, sweep);
    std::erase_if(scenes, [](const SceneMeasurement* scene) { return scene->measurements.empty(); });
    if (scenes.empty()) continue;
    all.push_back({sweep, "Exact", exactText(scenes, report.isCpu)});
    all.push_back({sweep, "Approximate will do", approximateText(scenes, report.isCpu)});
    std::string memory = memoryText(scenes, report.isCpu);
    if (!memory.empty()) all.push_back({sweep, "Little memory", std::move(memory)});
  }
  return all;
}

} // namespace vitrail::tool
