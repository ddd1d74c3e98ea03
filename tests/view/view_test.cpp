// `vitrail view` in a real window: somebody uses mouse and keyboard, and what is on the screen is what `vitrail render`
// draws.
#include <gtest/gtest.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "commands/method_choice.h"
#include "gpu/device.h"

#include "../thorough.h"
#include "../tool/png_reader.h"
#include "../tool/vitrail.h"
#include "desk.h"

namespace vitrail::tests {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// A window, and what it says of itself.
class View {
 public:
  // With variables NAME=value beside those of this program.
  View(const TemporaryFolder& folder, Words words, Words variables = {}) : folder_(folder) {
    const std::string events = folder.file("events");
    std::ofstream(events).flush();
    words.insert(words.begin(), {kTool, "view", "--events", events, "--size", "640x480"});
    process_ = ::fork();
    if (process_ == 0) {
      if (::chdir(folder.path().c_str()) != 0) ::_exit(99);
      const int error = ::creat(folder.file("stderr").c_str(), 0600);
      const int out = ::creat(folder.file("stdout").c_str(), 0600);
      ::dup2(error, STDERR_FILENO);
      ::dup2(out, STDOUT_FILENO);
      for (std::string& variable : variables) ::putenv(variable.data());
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      ::execv(arguments[0], arguments.data());
      ::_exit(98);
    }
    events_.open(events);
    desk.find();
  }
  ~View() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
  }
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  // The next event that fits, of those to come; those before it are passed. Null where none comes.
  Json next(const std::function<bool(const Json&)>& fits, std::chrono::seconds patience = 60s) {
    const Clock::time_point end = Clock::now() + patience;
    while (Clock::now() < end) {
      std::string line;
      const std::streampos place = events_.tellg();
      if (std::getline(events_, line) && !events_.eof()) {
        Json event = Json::parse(line);
        if (fits(event)) return event;
        continue;
      }
      events_.clear();
      events_.seekg(place);
      int status = 0;
      if (::waitpid(process_, &status, WNOHANG) == process_) {
        ended_ = status;
        process_ = 0;
        return nullptr;
      }
      std::this_thread::sleep_for(5ms);
    }
    return nullptr;
  }
  Json shown(std::chrono::seconds patience = 60s) {
    return next([](const Json& event) { return event["event"] == "shown" && event["coarse"] == 1; }, patience);
  }
  Json happened(const std::string& what) {
    return next([&](const Json& event) { return event["event"] == what; });
  }
  // The picture that it comes to rest with.
  Json settled() {
    Json last;
    const Json rest = next([&](const Json& event) {
      if (event["event"] == "shown" && event["coarse"] == 1) last = event;
      return event["event"] == "rest" && !last.is_null();
    });
    EXPECT_FALSE(rest.is_null());
    EXPECT_TRUE(rest.is_null() || rest["text"] == last["command"]);
    return last;
  }

  // Closes the window. The exit code.
  int close() {
    if (process_ > 0) desk.close();
    for (int i = 0; i < 3000 && process_ > 0; ++i) {
      if (::waitpid(process_, &ended_, WNOHANG) == process_) process_ = 0;
      std::this_thread::sleep_for(10ms);
    }
    EXPECT_EQ(process_, 0) << "the window does not close";
    return WIFEXITED(ended_) ? WEXITSTATUS(ended_) : 128 + WTERMSIG(ended_);
  }
  void expectClosesWell() {
    EXPECT_EQ(close(), 0);
    EXPECT_EQ(readText(folder_.file("stderr")), "");
  }

  // Seconds of processor time so far.
  [[nodiscard]] double processorTime() const {
    std::istringstream text(readText("/proc/" + std::to_string(process_) + "/stat"));
    std::string word;
    double ticks = 0.0;
    for (int i = 1; text >> word; ++i) {
      if (i == 14 || i == 15) ticks += std::stod(word);
    }
    return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
  }

  Desk desk;

 private:
  const TemporaryFolder& folder_;
  std::ifstream events_;
  pid_t process_ = 0;
  int ended_ = 0;
};

// How many pixels show anything but the white background.
std::size_t shownPixels(const Pixels& pixels) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < pixels.rgb.size(); i += 3) {
    count += std::all_of(&pixels.rgb[i], &pixels.rgb[i] + 3, [](auto c) { return c == 255; }) ? 0 : 1;
  }
  return count;
}

// The words of a command for a shell, run in the folder. The picture that it draws.
Pixels drawn(const TemporaryFolder& folder, const std::string& command) {
  const std::size_t program = command.find(' ');
  const ProcessResult result =
      run({"/bin/sh", "-c", "cd '" + folder.path().string() + "' && " + kTool + command.substr(program)});
  EXPECT_EQ(result.exitCode, 0) << command << "\n" << result.error;
  const ReadPng image = readPng(folder.file("picture.png"));
  Pixels pixels{image.width, image.height, {}};
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (i % 4 != 3) pixels.rgb.push_back(image.rgba[i]);
  }
  return pixels;
}

std::uint64_t differing(const Pixels& a, const Pixels& b) {
  if (a.rgb.size() != b.rgb.size()) return std::max(a.rgb.size(), b.rgb.size());
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) count += a.rgb[i] != b.rgb[i] ? 1 : 0;
  return count;
}

// On the processor, and on Mesa's driver by Vulkan.
class ViewTest : public testing::TestWithParam<std::string> {
 protected:
  Words with(Words words) const {
    words.insert(words.end(), {"--device", GetParam(), "--validate"});
    return words;
  }
  // Hides the panel and compares the screen with the command's picture.
  void expectSameAsRendered(View& view, const std::string& command) {
    view.desk.key("Tab");
    std::this_thread::sleep_for(300ms);
    EXPECT_EQ(differing(view.desk.look(), drawn(folder_, command)), 0U) << command;
    view.desk.key("Tab");
  }

  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Devices, ViewTest, testing::Values("cpu", "llvmpipe"),
                         [](const auto& device) { return device.param; });

// What the window does itself, whatever draws: on the processor, if thorough on Mesa's driver, too.
class WindowTest : public ViewTest {};
INSTANTIATE_TEST_SUITE_P(Devices, WindowTest,
                         testing::ValuesIn(tests::isThorough() ? Words{"cpu", "llvmpipe"} : Words{"cpu"}),
                         [](const auto& device) { return device.param; });

TEST_P(ViewTest, ShowsWhatRenderDraws) {
  View view(folder_, with({"--scene", "spheres", "--count", "64"}));
  EXPECT_EQ(view.happened("opened")["text"], "spheres");
  const Json shown = view.settled();
  ASSERT_FALSE(shown.is_null());
  EXPECT_EQ(shown["width"], 640);
  EXPECT_TRUE(shown["exact"]);
  expectSameAsRendered(view, shown["command"]);
  view.expectClosesWell();
}

TEST_P(WindowTest, TheCameraIsMovedByMouseAndKeys) {
  View view(folder_, with({"--scene", "interlocked"}));
  std::set<std::string> commands{view.settled()["command"]};
  const auto expectAnother = [&](const char* how) {
    const Json shown = view.settled();
    ASSERT_FALSE(shown.is_null()) << how;
    EXPECT_TRUE(commands.insert(shown["command"]).second) << how << ": " << shown["command"];
  };
  view.desk.drag(1, 500, 240, 560, 300);
  expectAnother("orbit");
  view.desk.drag(3, 500, 240, 540, 220);
  expectAnother("pan");
  view.desk.move(500, 240);
  view.desk.wheel(3);
  expectAnother("zoom");
  for (const char* key : {"Left", "Up", "minus", "f", "1", "3", "7"}) {
    view.desk.key(key);
    expectAnother(key);
  }
  view.desk.key("Right", {"Shift_L"});
  const Json last = view.settled();
  EXPECT_TRUE(commands.insert(last["command"]).second);
  expectSameAsRendered(view, last["command"]);
  view.desk.key("r");
  EXPECT_FALSE(commands.insert(view.settled()["command"]).second) << "reset";
  view.expectClosesWell();
}

TEST_P(WindowTest, RotatesUntilItIsToldToStop) {
  View view(folder_, with({"--scene", "interlocked"}));
  const Json first = view.settled();
  view.desk.key("space");
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(
        view.next([&](const Json& event) { return event["event"] == "shown" && event["command"] != first["command"]; })
            .is_null());
  }
  view.desk.key("space");
  const Json last = view.settled();
  ASSERT_FALSE(last.is_null());
  expectSameAsRendered(view, last["command"]);
  view.expectClosesWell();
}

TEST_P(ViewTest, TakesNoProcessorTimeAtRest) {
  View view(folder_, with({"--scene", "interlocked"}));
  view.settled();
  std::this_thread::sleep_for(500ms);
  const double before = view.processorTime();
  std::this_thread::sleep_for(2s);
  EXPECT_LE(view.processorTime() - before, 0.021); // two ticks
  view.expectClosesWell();
}

TEST_P(ViewTest, ResizesMinimisesAndComesBack) {
  View view(folder_, with({"--scene", "interlocked"}));
  view.settled();
  for (const auto& [width, height] : {std::pair{800U, 300U}, {333U, 517U}, {1U, 1U}, {400U, 400U}}) {
    view.desk.resize(width, height);
    const Json shown = view.settled();
    ASSERT_FALSE(shown.is_null());
    EXPECT_EQ(shown["width"], width);
    EXPECT_EQ(shown["height"], height);
  }
  view.desk.minimise(true);
  std::this_thread::sleep_for(300ms);
  view.desk.minimise(false);
  std::this_thread::sleep_for(300ms);
  view.desk.key("3");
  const Json shown = view.settled();
  ASSERT_FALSE(shown.is_null());
  expectSameAsRendered(view, shown["command"]);
  view.expectClosesWell();
}

// What a click lists is what `vitrail pick` lists, which the unit tests compare with the reference.
TEST_P(ViewTest, AClickListsTheLayersUnderIt) {
  View view(folder_, with({"--scene", "interlocked"}));
  view.settled();
  std::size_t layers = 0;
  for (const auto& [x, y] : {std::pair{420, 200}, {400, 260}, {450, 240}, {630, 470}}) {
    view.desk.move(x, y);
    view.desk.press(1, true);
    view.desk.press(1, false);
    const Json picked = view.happened("picked");
    ASSERT_FALSE(picked.is_null());
    EXPECT_EQ(picked["x"], x);
    EXPECT_EQ(picked["y"], y);
    const ProcessResult result = vitrail({"pick", "--scene", "interlocked", "--size", "640x480", "--at",
                                          std::to_string(x) + "," + std::to_string(y), "--json"});
    const Json expected = Json::parse(result.out)["layers"];
    ASSERT_EQ(picked["layers"].size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(picked["layers"][i]["object"], expected[i]["object"]);
      const auto expectNear = [](const Json& is, const Json& wanted, double tolerance) {
        EXPECT_NEAR(is.get<double>(), wanted.get<double>(), tolerance);
      };
      const double depth = expected[i]["depth"].get<double>();
      expectNear(picked["layers"][i]["depth"], expected[i]["depth"], 5.0e-4 * depth); // corners are snapped
      expectNear(picked["layers"][i]["alpha"], expected[i]["alpha"], 1.0e-3);         // as nodes store it
      for (int c = 0; c < 3; ++c) expectNear(picked["layers"][i]["color"][c], expected[i]["color"][c], 0.02);
    }
    EXPECT_EQ(picked["byDevice"], GetParam() != "cpu"); // from the lists of the device
    layers += expected.size();
  }
  EXPECT_GE(layers, 5U);
  view.expectClosesWell();
}

TEST_P(WindowTest, ShowsAPartOfTheModel) {
  View view(folder_,
            with({"--scene", "interlocked", "--hide", "pane 0", "--fade", "ring 1=0.3", "--clip-plane=0,-1,0,-0.3"}));
  const Json shown = view.settled();
  ASSERT_FALSE(shown.is_null());
  expectSameAsRendered(view, shown["command"]);
  view.expectClosesWell();
}

// The plane that cuts is dragged in the picture, by a handle.
TEST_P(WindowTest, TheCutIsDragged) {
  View view(folder_, with({"--scene", "interlocked", "--clip-plane=0,-1,0,-0.3", "--orbit", "20,10"}));
  view.settled();
  view.desk.resize(1100, 700); // the handle is beside the panel
  const std::string first = view.settled()["command"];
  EXPECT_NE(first.find("--clip-plane 0,-1,0,-0.3"), std::string::npos) << first;
  const std::size_t before = shownPixels(drawn(folder_, first));
  int x = 0;
  int y = 0;
  ASSERT_EQ(std::sscanf(view.happened("handle")["text"].get<std::string>().c_str(), "%d,%d", &x, &y), 2);
  EXPECT_LT(y, 350) << "the plane is above the middle";
  view.desk.drag(1, x, y, x, y - 60); // up: less is cut away
  const Json up = view.settled();
  const std::string command = up["command"];
  double offset = 0.0;
  const std::size_t at = command.find("--clip-plane 0,-1,0,");
  ASSERT_NE(at, std::string::npos) << command;
  ASSERT_EQ(std::sscanf(command.c_str() + at, "--clip-plane 0,-1,0,%lf", &offset), 1);
  EXPECT_LT(offset, -0.4);
  EXPECT_GT(shownPixels(drawn(folder_, command)), before + 500);
  // The handle is where it was dragged to, and the picture is the command's.
  int upX = 0;
  int upY = 0;
  ASSERT_EQ(std::sscanf(view.happened("handle")["text"].get<std::string>().c_str(), "%d,%d", &upX, &upY), 2);
  EXPECT_NEAR(upY, y - 60, 12);
  expectSameAsRendered(view, command);
  view.expectClosesWell();
}

TEST_P(WindowTest, OpensWhatIsDropped) {
  View view(folder_, with({"--scene", "interlocked"}));
  const Json first = view.settled();
  std::ofstream(folder_.file("bad.glb")) << "no model";
  view.desk.drop({folder_.file("bad.glb")});
  const std::string reason = view.happened("error")["text"];
  EXPECT_NE(reason.find("bad.glb"), std::string::npos) << reason;
  EXPECT_EQ(reason.find('\n'), std::string::npos);
  std::ofstream(folder_.file("one two.stl")) << "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                                "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
  view.desk.drop({folder_.file("one%20two.stl")});
  EXPECT_EQ(view.happened("opened")["text"], "one two.stl");
  view.settled();
  view.desk.key("Left");
  const Json shown = view.settled();
  ASSERT_FALSE(shown.is_null());
  expectSameAsRendered(view, shown["command"]);
  view.expectClosesWell();
}

TEST_P(WindowTest, SavesAndCopiesWhatItShows) {
  View view(folder_, with({"--scene", "interlocked", "--opacity", "0.4", "--background", "#123456"}));
  view.settled();
  view.desk.key("Up");
  view.settled();
  view.desk.key("p");
  const std::string saved = view.happened("saved")["text"];
  view.desk.key("c");
  const std::string command = view.happened("copied")["text"];
  EXPECT_EQ(saved, "interlocked_1.png");
  EXPECT_EQ(readText(folder_.file("stdout")), command + "\n");
  drawn(folder_, command);
  EXPECT_EQ(readText(folder_.file(saved)), readText(folder_.file("picture.png")));
  view.expectClosesWell();
}

// Keys and mouse at random.
TEST_P(ViewTest, TakesWhateverInputThereIs) {
  View view(folder_, with({"--scene", "interlocked"}));
  view.settled();
  std::mt19937 random(7);
  const auto below = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  const std::vector<std::string> keys = {
      "1",     "3",  "7",    "f",     "r",     "space",  "Tab", "s", "bracketleft", "bracketright", "Left",
      "Right", "Up", "Down", "equal", "minus", "Escape", "x",   "m"};
  const auto seconds = std::chrono::seconds(std::getenv("VITRAIL_TEST_SECONDS") != nullptr
                                                ? std::atoi(std::getenv("VITRAIL_TEST_SECONDS"))
                                                : (tests::isThorough() ? 8 : 4));
  for (const auto end = Clock::now() + seconds; Clock::now() < end;) {
    switch (below(5)) {
      case 0:
        view.desk.drag(1 + static_cast<unsigned>(below(3)), below(640), below(480), below(640), below(480));
        break;
      case 1:
        view.desk.wheel(below(7) - 3);
        break;
      case 2:
        if (below(6) == 0)
          view.desk.resize(1 + static_cast<unsigned>(below(700)), 1 + static_cast<unsigned>(below(600)));
        break;
      default:
        view.desk.key(keys[static_cast<std::size_t>(below(static_cast<int>(keys.size())))]);
    }
  }
  view.expectClosesWell();
}

TEST(ViewMethodsTest, DrawsByEveryMethod) {
  const TemporaryFolder folder;
  View view(folder, {"--scene", "planes", "--count", "3", "--device", "llvmpipe", "--validate"});
  const std::string first = view.settled()["method"];
  std::set<std::string> methods{first};
  for (int i = 0; i < 40; ++i) {
    view.desk.key("m");
    const Json event = view.next([](const Json& what) { return what["event"] == "shown" || what["event"] == "error"; });
    ASSERT_FALSE(event.is_null());
    ASSERT_EQ(event["event"], "shown") << event["text"]; // what the device does not have is passed over
    if (event["method"] == first) break;
    methods.insert(event["method"]);
  }
  EXPECT_GE(methods.size(), 15U);
  EXPECT_FALSE(methods.contains("interlock")); // which Mesa's driver lacks
  view.expectClosesWell();
}

TEST(ViewMethodsTest, DrawsByTheFasterMethodWhereNoneIsNamed) {
  const TemporaryFolder folder;
  const tool::DeviceSummary device = tool::listDevices().front();
  tool::rememberCosts(folder.path() / "vitrail" / "methods.json", device.identity,
                      {{{50.0, 6.0}, {40.0, 3.0}}, {{900.0, 0.5}, {800.0, 0.4}}});
  View view(folder, {"--scene", "interlocked", "--device", "llvmpipe", "--samples", "4"}, cachesIn(folder.path()));
  const Json first = view.settled();
  EXPECT_EQ(first["method"], "tiles");
  EXPECT_NE(first["command"].get<std::string>().find("--method tiles --samples 4"), std::string::npos);
  // Light goes its true way through volumes by lists alone.
  view.desk.drop({std::string(VITRAIL_TEST_CORPUS) + "/good/volume.gltf"});
  ASSERT_FALSE(view.happened("opened").is_null());
  EXPECT_EQ(view.settled()["method"], "linked-list");
  view.desk.key("m");
  EXPECT_EQ(view.settled()["method"], "tiles"); // for somebody who asks for it
  view.expectClosesWell();
}

// Depth complexity, the error, another method: to the right of the line in the middle, or wherever it is dragged to.
TEST(ViewMethodsTest, ShowsAnotherPictureBesideIt) {
  const TemporaryFolder folder;
  View view(folder, {"--scene", "interlocked", "--device", "llvmpipe", "--validate", "--method", "weighted"});
  const std::string command = view.settled()["command"];
  view.desk.key("Tab");
  const Pixels alone = drawn(folder, command);
  const auto partThatDiffers = [&](int line, const Pixels& left) {
    std::uint64_t wrong = 0; // pixels to the left of the line
    std::uint64_t other = 0; // to its right
    const Pixels screen = view.desk.look();
    for (std::uint32_t y = 60; y < 480; ++y) {
      for (std::uint32_t x = 0; x < 640; ++x) {
        const std::size_t i = 3 * (y * 640 + x);
        const bool differs = !std::equal(&screen.rgb[i], &screen.rgb[i] + 3, &left.rgb[i]);
        const int side = static_cast<int>(x) - line;
        wrong += side < -3 && differs ? 1 : 0;
        other += side > 3 && differs ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0U);
    return other;
  };
  for (const char* kind : {"complexity", "error"}) {
    view.desk.key("b");
    const Json shown = view.settled();
    EXPECT_EQ(shown["beside"], kind);
    EXPECT_GT(shown["largest"], 3);
    std::this_thread::sleep_for(200ms);
    EXPECT_GT(partThatDiffers(320, alone), 10000U);
  }
  view.desk.drag(1, 320, 300, 100, 300);
  std::this_thread::sleep_for(200ms);
  EXPECT_GT(partThatDiffers(100, alone), 100000U);
  view.desk.key("b");
  const Json method = view.settled();
  EXPECT_EQ(method["beside"], "linked-list");
  for (const char* kind : {"overflow", "tiles"}) {
    view.desk.key("b");
    EXPECT_EQ(view.settled()["beside"], kind);
  }
  view.desk.key("b");
  EXPECT_EQ(view.settled()["beside"], "");
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(differing(view.desk.look(), alone), 0U);
  view.expectClosesWell();
}

// By linked-list on a Vulkan device pictures stay there, are not waited for, and what does not fit says so until it
// does.
TEST(ViewMethodsTest, PicturesStayOnTheDeviceAndGrow) {
  const TemporaryFolder folder;
  View view(folder, {"--scene", "planes", "--count", "24", "--device", "llvmpipe", "--validate"});
  const Json first = view.shown();
  ASSERT_FALSE(first.is_null());
  EXPECT_TRUE(first["onDevice"]);
  EXPECT_FALSE(first["complete"]); // the first pool is a guess
  EXPECT_GT(first["missing"], 0);
  for (const char* pass : {"opaque", "collect", "resolve", "encode"})
    EXPECT_TRUE(first["passes"].contains(pass)) << pass;
  const Json shown = view.settled();
  EXPECT_TRUE(shown["onDevice"]);
  EXPECT_TRUE(shown["exact"]);
  EXPECT_EQ(shown["missing"], 0);
  EXPECT_EQ(shown["tiles"], 1);
  view.desk.key("Tab");
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(differing(view.desk.look(), drawn(folder, shown["command"])), 0U) << shown["command"];
  view.expectClosesWell();
}

TEST(ViewMethodsTest, WhatTheBudgetDoesNotHoldIsDrawnInTilesAtRest) {
  const TemporaryFolder folder;
  View view(folder,
            {"--scene", "planes", "--count", "12", "--device", "llvmpipe", "--validate", "--memory-budget", "13"});
  const Json first = view.shown();
  ASSERT_FALSE(first.is_null());
  EXPECT_FALSE(first["complete"]);
  Json shown = view.settled();
  EXPECT_GT(shown["tiles"], 1);
  EXPECT_TRUE(shown["exact"]);
  view.desk.key("Left");
  EXPECT_FALSE(view.shown()["complete"]); // while it moves
  shown = view.settled();
  EXPECT_GT(shown["tiles"], 1);
  // Which pixels lack room is to be seen while it moves, and which parts it is drawn in at rest.
  const auto besides = [&](const char* kind) {
    for (int i = 0; i < 6; ++i) {
      view.desk.key("b");
      if (view.settled()["beside"] == kind) return;
    }
    ADD_FAILURE() << "there is no " << kind;
  };
  besides("overflow");
  view.desk.key("Left");
  EXPECT_GT(view.shown()["largest"], 3);
  EXPECT_EQ(view.settled()["largest"], 1); // none
  besides("tiles");
  view.desk.key("Tab");
  std::this_thread::sleep_for(300ms);
  const Pixels screen = view.desk.look();
  std::set<std::array<std::uint8_t, 3>> colors;
  for (std::uint32_t y = 80; y < 470; ++y) {
    const std::size_t at = 3 * (std::size_t{y} * 640 + 500);
    colors.insert({screen.rgb[at], screen.rgb[at + 1], screen.rgb[at + 2]});
  }
  EXPECT_GE(colors.size(), 2U);
  view.desk.key("Tab");
  besides("");
  view.desk.key("Left");
  shown = view.settled();
  view.desk.key("Tab");
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(differing(view.desk.look(), drawn(folder, shown["command"])), 0U) << shown["command"];
  view.expectClosesWell();
}

TEST_P(ViewTest, Peels) {
  View view(folder_, with({"--scene", "interlocked", "--peel", "2"}));
  view.settled();
  view.desk.key("Left");
  const Json shown = view.settled();
  EXPECT_EQ(shown["method"], GetParam() == "cpu" ? "cpu" : "linked-list");
  EXPECT_EQ(shown["peeled"], 2);
  EXPECT_TRUE(shown["exact"]); // but for those
  expectSameAsRendered(view, shown["command"]);
  view.expectClosesWell();
}

TEST(ViewMethodsTest, DrawsWithOpenGl) {
  const TemporaryFolder folder;
  View view(folder, {"--scene", "interlocked", "--api", "opengl", "--validate"});
  const Json shown = view.settled();
  EXPECT_EQ(shown["method"], "linked-list");
  view.desk.key("Tab");
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(differing(view.desk.look(), drawn(folder, shown["command"])), 0U) << shown["command"];
  view.desk.key("s");
  EXPECT_EQ(view.settled()["method"], "unsorted");
  std::set<std::string> methods;
  for (int i = 0; i < 5; ++i) {
    view.desk.key("m");
    methods.insert(view.settled()["method"].get<std::string>());
  }
  EXPECT_EQ(methods, (std::set<std::string>{"linked-list", "unsorted", "sorted", "depth-peeling", "cpu"}));
  view.expectClosesWell();
}

TEST(ViewMethodsTest, SortsOrDoesNot) {
  const TemporaryFolder folder;
  View view(folder, {"--scene", "planes", "--count", "5", "--device", "llvmpipe", "--validate", "--layers", "4"});
  view.settled();
  const auto method = [&](const char* key) {
    view.desk.key(key);
    return view.settled();
  };
  const std::string command = method("bracketleft")["command"];
  EXPECT_NE(command.find("--layers 3"), std::string::npos) << command;
  const Json off = method("s");
  EXPECT_EQ(off["method"], "linked-list");
  EXPECT_TRUE(off["onDevice"]);
  EXPECT_FALSE(off["complete"]);
  const std::string unsorted = off["command"];
  EXPECT_NE(unsorted.find("--sorting off"), std::string::npos) << unsorted;
  EXPECT_EQ(unsorted.find("--layers"), std::string::npos) << unsorted;
  view.desk.key("Tab");
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(differing(view.desk.look(), drawn(folder, unsorted)), 0U) << unsorted;
  const Json on = method("s");
  EXPECT_TRUE(on["exact"]);
  EXPECT_GT(differing(drawn(folder, on["command"]), drawn(folder, unsorted)), 100000U);
  view.expectClosesWell();
}

// A device that is lost is opened again; one that is lost again at once is given up for the processor.
TEST(ViewMethodsTest, GoesOnWhenTheDeviceIsLost) {
  const TemporaryFolder folder;
  const std::string lose = folder.file("lose");
  View view(folder, {"--scene", "interlocked", "--device", "llvmpipe"},
            {std::string("VK_LAYER_PATH=") + VITRAIL_TEST_LAYERS, "VK_INSTANCE_LAYERS=VK_LAYER_VITRAIL_losing",
             "VITRAIL_TEST_LOSE=" + lose});
  view.settled();
  for (const char* method : {"linked-list", "cpu"}) {
    std::ofstream(lose).flush();
    view.desk.key("Left");
    ASSERT_FALSE(view.happened("lost").is_null()) << method;
    const Json shown = view.settled();
    ASSERT_FALSE(shown.is_null()) << method;
    EXPECT_EQ(shown["method"], method);
    view.desk.key("Tab");
    std::this_thread::sleep_for(300ms);
    const Pixels right = drawn(folder, shown["command"]);
    const Pixels screen = view.desk.look();
    std::uint64_t wrong = 0; // above the notice
    for (std::size_t i = 0; i < 3 * 640 * 400; ++i) wrong += screen.rgb[i] != right.rgb[i] ? 1 : 0;
    EXPECT_EQ(wrong, 0U) << method;
    view.desk.key("Tab");
  }
  EXPECT_EQ(view.close(), 0);
}

TEST(ViewMethodsTest, ClosesWhileItLoads) {
  const TemporaryFolder folder;
  View view(folder, {"--scene", "spheres", "--count", "3000", "--device", "cpu"});
  const Clock::time_point start = Clock::now();
  EXPECT_EQ(view.close(), 0);
  EXPECT_LT(Clock::now() - start, 5s);
}

TEST(ViewRefusalTest, SaysWhyThereIsNoWindow) {
  const auto refuse = [](const Words& words, const ProcessOptions& options, int code, const std::string& reason) {
    const ProcessResult result = vitrail(words, options);
    EXPECT_EQ(result.exitCode, code);
    EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
    EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  };
  refuse({"view", "--scene", "interlocked"}, {{}, {"DISPLAY=:999", "WAYLAND_DISPLAY="}, {}}, 1,
         "vitrail render writes pictures");
  refuse({"view", "--scene", "interlocked"}, {{}, {"VK_DRIVER_FILES=/none", "VK_ICD_FILENAMES=/none"}, {}}, 1,
         "mesa-vulkan-drivers");
  refuse({"view", "--scene", "none"}, {}, 2, "none");
  refuse({"view", "missing.glb"}, {}, 1, "missing.glb");
  refuse({"view"}, {}, 2, "vitrail view --help");
  refuse({"view", "--scene", "interlocked", "-o", "a.png"}, {}, 2, "-o");
}

} // namespace
} // namespace vitrail::tests
