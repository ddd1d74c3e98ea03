// A scene of 36 figures with Direct3D 11, drawn and measured as a demo of 2014 did it (docs/performance.md).
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "host.h"

namespace vitrail::tests::figures {
namespace {

constexpr const char* kUsage =
    "usage: figures PICTURE.ppm [--scene mannequins|pane] [--size WIDTHxHEIGHT] [--samples N] [--layers N]\n"
    "               [--method unsorted|insertion|fragment|compute] [--whole-pixels]\n"
    "       figures --bench [--size WIDTHxHEIGHT] [--rounds N]\n";
constexpr std::array<std::string_view, 4> kMethods = {"unsorted", "insertion", "fragment", "compute"};

struct Options {
  std::string picture; // empty: --bench
  Settings settings;
  std::uint32_t rounds = 5;
};

struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::uint32_t numberOf(std::string_view text, std::uint32_t most) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1 || number > most) {
    throw UsageError("a number from 1 to " + std::to_string(most) + " is wanted, not " + std::string(text));
  }
  return number;
}

void take(Options& options, std::string_view name, std::string_view value) {
  Settings& settings = options.settings;
  if (name == "--scene" && (value == "mannequins" || value == "pane")) {
    settings.scene = value;
  } else if (const std::size_t x = value.find('x'); name == "--size" && x != std::string_view::npos) {
    settings.width = numberOf(value.substr(0, x), 8192);
    settings.height = numberOf(value.substr(x + 1), 8192);
  } else if (name == "--samples") {
    settings.samples = numberOf(value, 8);
  } else if (name == "--layers") {
    settings.layers = numberOf(value, 1024);
  } else if (name == "--rounds") {
    options.rounds = numberOf(value, 1000);
  } else if (const auto* method = std::ranges::find(kMethods, value); name == "--method" && method != kMethods.end()) {
    settings.method = static_cast<Method>(method - kMethods.begin());
  } else {
    throw UsageError("what is " + std::string(name) + " " + std::string(value) + "?");
  }
}

Options parse(std::span<char*> words) {
  if (words.empty()) throw UsageError("nothing to do");
  Options options;
  const std::string_view first = words[0];
  if (first != "--bench") options.picture = first;
  if (first != "--bench" && first.starts_with("-")) throw UsageError("what is " + std::string(first) + "?");
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--whole-pixels") {
      options.settings.wholePixels = true;
    } else if (i + 1 < words.size()) {
      take(options, word, words[++i]);
    } else {
      throw UsageError("what is " + std::string(word) + "?");
    }
  }
  return options;
}

void save(const Options& options) {
  Host host(options.settings);
  host.draw();
  const std::vector<std::uint8_t> bytes = host.picture();
  std::ofstream file(options.picture, std::ios::binary);
  file << "P6 " << options.settings.width << ' ' << options.settings.height << " 255\n";
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw HostError("cannot write " + options.picture);
}

// ---- Measuring

struct Row {
  std::string name;
  std::uint32_t layers;
  std::unique_ptr<Host> host;
  std::vector<PassTimes> times;
};

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

constexpr std::size_t kResolve = 2;
constexpr std::size_t kFrame = 3; // all passes

double timeOf(const PassTimes& times, std::size_t pass) {
  return pass == kFrame ? times.all() : times.milliseconds.at(pass);
}

double medianTime(const Row& row, std::size_t pass) {
  std::vector<double> values;
  for (const PassTimes& each : row.times) values.push_back(timeOf(each, pass));
  return median(values);
}

// Of what a pass took in each round over what it took another method: other work on the machine slows both.
double medianRatio(const Row& row, const Row& other, std::size_t pass) {
  std::vector<double> values;
  for (std::size_t i = 0; i < row.times.size(); ++i) {
    values.push_back(timeOf(row.times[i], pass) / timeOf(other.times[i], pass));
  }
  return median(values);
}

std::vector<Row> rowsOf(const Settings& all) {
  std::vector<Row> rows;
  const auto add = [&](Method method, std::uint32_t layers) {
    Settings settings = all;
    settings.method = method;
    settings.layers = layers;
    rows.push_back(
        {std::string(kMethods.at(static_cast<std::size_t>(method))), layers, std::make_unique<Host>(settings), {}});
  };
  add(Method::Unsorted, 0);
  for (const std::uint32_t layers : {8U, 16U, 32U}) {
    for (const Method method : {Method::Insertion, Method::Fragment, Method::Compute}) add(method, layers);
  }
  add(Method::Fragment, 0);
  add(Method::Compute, 0);
  return rows;
}

// All methods in turn, a frame each, as often as said, after one that is not counted.
void measure(const Settings& settings, std::uint32_t rounds) {
  std::vector<Row> rows = rowsOf(settings);
  for (std::uint32_t round = 0; round <= rounds; ++round) {
    for (Row& row : rows) {
      const PassTimes times = row.host->draw();
      if (round > 0) row.times.push_back(times);
    }
  }
  const VitrailStats stats = rows.back().host->stats();
  if (stats.complete == 0) throw HostError("there was no room for all fragments");
  std::printf("\n%u sample%s: %llu fragments, %u in the deepest pixel\n\n", settings.samples,
              settings.samples == 1 ? "" : "s", static_cast<unsigned long long>(stats.fragmentsRequested),
              stats.layersMax);
  std::printf("| method | layers | opaque ms | collect ms | resolve ms | frame ms | over insertion | its resolve |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    const auto insertion = std::ranges::find_if(rows, [&](const Row& other) {
      return other.name == "insertion" && other.layers == (row.layers == 0 ? 32U : row.layers);
    });
    std::printf("| %s | %s | %.0f | %.0f | %.0f | %.0f | %.2f | %.2f |\n", row.name.c_str(),
                row.layers == 0 ? "all" : std::to_string(row.layers).c_str(), medianTime(row, 0), medianTime(row, 1),
                medianTime(row, kResolve), medianTime(row, kFrame), medianRatio(row, *insertion, kFrame),
                medianRatio(row, *insertion, kResolve));
  }
}

void bench(const Options& options) {
  for (const std::uint32_t samples : sampleCounts()) {
    Settings settings = options.settings;
    settings.samples = samples;
    measure(settings, options.rounds);
    std::fflush(stdout);
  }
}

} // namespace
} // namespace vitrail::tests::figures

int main(int count, char** words) {
  using namespace vitrail::tests::figures;
  try {
    const Options options = parse(std::span(words, static_cast<std::size_t>(count)).subspan(1));
    options.picture.empty() ? bench(options) : save(options);
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "figures: error: %s\n%s", error.what(), kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "figures: error: %s\n", error.what());
    return 1;
  }
}
