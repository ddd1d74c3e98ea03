// Draws the pictures that a window shows, on a thread of its own, so that the window is never waited for. By the method
// linked-list on a Vulkan device they are drawn by InteractiveRenderer and stay on the device, else one by one, and go
// through the host's memory.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "../commands/render_options.h"
#include "../image/color_map.h"
#include "../render/device.h"
#include "../render/interactive.h"
#include "../render/pick.h"

namespace vitrail::tool {

// What stands beside the picture of a window.
struct Beside {
  enum class Kind {
    Nothing,
    Method,     // the same by another method
    Complexity, // how many transparent surfaces each pixel has
    Error,      // how far each pixel is from the exact picture
    Overflow,   // surfaces of pixels that are blended approximately, because some of the picture had no room
    Tiles       // surfaces of a pixel in the mean, of each part that the picture was drawn in
  };
  Kind kind = Kind::Nothing;
  std::string method; // of Kind::Method
  bool operator==(const Beside&) const = default;
};
// What numbers are shown as beside a picture.
const ColorMap& colorsOf(const Beside& beside);

// A picture that is wanted: what `vitrail render` would draw, or one with a pixel for each square of `coarse` pixels.
struct Wanted {
  RenderArguments arguments;
  std::uint32_t coarse = 1;
  Beside beside{};
  bool rests = false; // nothing moves: it is drawn until it is what `render` draws, and the host gets its pixels
  std::uint64_t number = 0;
};

// What a window has to know of a scene.
struct SceneFacts {
  std::string name;
  ObjectTree objects;
  std::vector<std::string> materials;
  Bounds bounds; // of all of it, whatever is hidden
  glm::dvec3 origin{0.0};
  std::optional<Background> background;
  bool drawsAlike = true; // drawsAlike() (commands/method_choice.h)
};

// The surfaces under a pixel of the picture of some arguments.
struct Picked {
  RenderArguments arguments;
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::vector<PickedLayer> layers;
  std::shared_ptr<const SceneFacts> scene{}; // that they are of
  bool byDevice = false;                     // from the lists of the Vulkan device that draws; else by the processor
  double milliseconds = 0.0;                 // of it, for them
};

struct Drawn {
  Wanted wanted;
  View view;
  std::uint32_t width = 0; // of the picture
  std::uint32_t height = 0;
  std::shared_ptr<const GpuImage> image; // as InteractivePicture has it; null: the host alone has the picture
  Picture picture;                       // without pixels: the device alone has it
  Picture beside;                        // empty: nothing
  double largest = 0.0;                  // number that `beside` shows: surfaces, or 1/255
  FrameReport report;
  bool isFinal = true;       // it is what `render` draws; else it may lack surfaces for which there was no room
  double milliseconds = 0.0; // for the picture, without what had to be made once
  std::vector<std::string> warnings;
};

class Drawer {
 public:
  // The device outlives it. `sharesImages`: the window shows pictures with the same Gpu, and takes images of it.
  // `onNews` is called from the thread where take() or takeError() has something new.
  Drawer(const Device& device, bool sharesImages, void (*onNews)());
  // Waits for the picture at hand.
  ~Drawer();
  Drawer(const Drawer&) = delete;
  Drawer& operator=(const Drawer&) = delete;

  // Has it drawn. What was asked for before and not begun is dropped.
  void ask(Wanted wanted);

  // Has the surfaces under a pixel of such a picture found, behind the picture at hand.
  void askPick(RenderArguments arguments, std::uint32_t x, std::uint32_t y);

  // The newest picture, once.
  std::optional<Drawn> take();
  std::optional<Picked> takePicked(); // the same of what was picked last
  // Why what was asked for last could not be drawn; null where it could be; once.
  std::exception_ptr takeError();
  // What the last picture shows; null before it. It does not change.
  [[nodiscard]] std::shared_ptr<const SceneFacts> scene() const;
  // What it is at, in words; empty: nothing.
  [[nodiscard]] std::string doing() const;

 private:
  // A picture that is drawn without waiting for it.
  struct Begun {
    Wanted wanted;
    View view;
    std::chrono::steady_clock::time_point start;
  };

  void run();
  void work(std::optional<Wanted> wanted, std::optional<Picked> picking);
  void draw(const Wanted& wanted);
  RenderOptions optionsOf(const Wanted& wanted) const;
  bool begin(const Wanted& wanted);
  void finish(bool isSuperseded);
  void finishAll(bool isSuperseded);
  bool isAgain(const Wanted& wanted, const FrameReport& report);
  void drawExactly(const Wanted& wanted);
  void give(Drawn drawn);
  void pick(Picked& picked);
  void drawBeside(const Wanted& wanted, const RenderOptions& options, Drawn& drawn);
  Renderer& besideRenderer(const RenderArguments& arguments, const MethodOptions& method);
  void letGo();
  void load(const RenderArguments& arguments);
  void choose(const RenderArguments& arguments);
  void prepare(const RenderArguments& arguments);
  void say(const std::string& doing);

  const Device& device_;
  bool sharesImages_;
  void (*onNews_)();

  // Shared.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Wanted> wanted_;
  std::optional<Drawn> drawn_;
  std::optional<Picked> wantedPick_;
  std::optional<Picked> picked_;
  std::exception_ptr error_;
  std::shared_ptr<const SceneFacts> shownScene_;
  std::string doing_;
  bool ends_ = false;

  // The thread's own.
  std::optional<Scene> scene_; // with the draws that are chosen
  std::vector<Draw> allDraws_;
  std::shared_ptr<const SceneFacts> facts_;
  RenderArguments sceneArguments_; // of scene_
  std::unique_ptr<Renderer> renderer_;
  InteractiveRenderer* interactive_ = nullptr; // the same, where it is one
  std::deque<Begun> begun_;                    // what it has pending
  std::optional<Wanted> again_;                // it was drawn, and is not as it should be
  std::uint32_t mostNodes_ = 0;                // that pictures in a row had room for, whose room did not suffice
  RenderArguments rendererArguments_;          // of renderer_
  std::unique_ptr<Renderer> beside_;
  MethodOptions besideMethod_;
  std::optional<float> besideOpacity_;
  std::unique_ptr<Picker> picker_;
  std::optional<float> pickerOpacity_;
  std::thread thread_;
};

} // namespace vitrail::tool
