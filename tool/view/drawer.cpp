#include "drawer.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "../commands/errors.h"
#include "../commands/method_choice.h"
#include "../commands/progress.h"
#include "../commands/scene_options.h"
#include "../methods/methods.h"
#include "settings.h"

namespace vitrail::tool {

namespace {

// Whether both load the same scene.
bool sameScene(const RenderArguments& a, const RenderArguments& b) {
  return a.models == b.models && a.scene == b.scene && a.count == b.count && a.seed == b.seed && a.up == b.up &&
         a.pointSize == b.pointSize && a.load.time == b.load.time && a.load.animation == b.load.animation &&
         a.load.variant == b.load.variant;
}

// The mean of the surfaces of a pixel, of each part that a picture was drawn in; the first row and column of each are
// 0, to be told apart. The largest mean.
double fillTiles(const FrameReport& report, Plane& plane) {
  std::vector<DrawnTile> tiles = report.drawnTiles;
  if (tiles.empty()) tiles.push_back({0, 0, report.width, report.height, report.fragmentsRequested});
  const auto meanOf = [](const DrawnTile& tile) {
    return static_cast<double>(tile.fragments) / (static_cast<double>(tile.width) * tile.height);
  };
  double largest = 1.0;
  for (const DrawnTile& tile : tiles) largest = std::max(largest, meanOf(tile));
  for (const DrawnTile& tile : tiles) {
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y) {
      for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
        const bool isEdge = x == tile.x || y == tile.y;
        plane.values[std::size_t{y} * report.width + x] = isEdge ? 0.0 : meanOf(tile);
      }
    }
  }
  return largest;
}

// Whether a picture at rest is left to drawExactly(): one that does not fit the memory whole, that the driver cut
// short, or that may show nothing, which is then said.
bool needsExact(const FrameReport& report) {
  return report.fragmentsMissing > 0 || report.cutPixels > 0 || report.fragmentsRequested == 0;
}

} // namespace

Drawer::Drawer(const Device& device, bool sharesImages, void (*onNews)())
    : device_(device), sharesImages_(sharesImages), onNews_(onNews), thread_([this] { run(); }) {}

Drawer::~Drawer() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Drawer::ask(Wanted wanted) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = std::move(wanted);
  }
  changed_.notify_one();
}

void Drawer::askPick(RenderArguments arguments, std::uint32_t x, std::uint32_t y) {
  {
    const std::lock_guard lock(mutex_);
    wantedPick_.emplace();
    wantedPick_->arguments = std::move(arguments);
    wantedPick_->x = x;
    wantedPick_->y = y;
  }
  changed_.notify_one();
}

std::optional<Picked> Drawer::takePicked() {
  const std::lock_guard lock(mutex_);
  return std::exchange(picked_, std::nullopt);
}

std::optional<Drawn> Drawer::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(drawn_, std::nullopt);
}

std::exception_ptr Drawer::takeError() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, nullptr);
}

std::shared_ptr<const SceneFacts> Drawer::scene() const {
  const std::lock_guard lock(mutex_);
  return shownScene_;
}

std::string Drawer::doing() const {
  const std::lock_guard lock(mutex_);
  return doing_;
}

void Drawer::say(const std::string& doing) {
  const std::lock_guard lock(mutex_);
  doing_ = doing;
}

void Drawer::run() {
  if (device_.gl() != nullptr) device_.gl()->comeToThread(); // what is made with it stays on this thread
  std::unique_lock lock(mutex_);
  while (true) {
    const bool goesOn = !begun_.empty() || again_;
    if (!goesOn) changed_.wait(lock, [this] { return ends_ || wanted_ || wantedPick_; });
    if (ends_) break;
    // Pictures first where they load what is picked in. Else they wait: while something moves there is always another.
    std::optional<Picked> picking;
    if (wantedPick_ && ((!wanted_ && !goesOn) || (scene_ && sameScene(wantedPick_->arguments, sceneArguments_)))) {
      picking = std::exchange(wantedPick_, std::nullopt);
    }
    const bool isPicture = !picking;
    std::optional<Wanted> wanted;
    if (isPicture) wanted = std::exchange(wanted_, std::nullopt);
    doing_ = isPicture ? "drawing" : "picking";
    lock.unlock();
    std::exception_ptr error;
    try {
      work(std::move(wanted), std::move(picking));
    } catch (...) {
      error = std::current_exception();
    }
    if (error && isPicture) letGo(); // it may be half made, or on a device that is lost
    lock.lock();
    if (error) error_ = error;
    doing_.clear();
    lock.unlock();
    onNews_();
    lock.lock();
  }
  lock.unlock();
  letGo();
  if (device_.gl() != nullptr) device_.gl()->leaveThread();
}

// One step: what is wanted now is begun, else what was begun before is finished.
void Drawer::work(std::optional<Wanted> wanted, std::optional<Picked> picking) {
  if (picking) return pick(*picking);
  if (wanted) {
    again_.reset(); // for a newer one
    mostNodes_ = 0;
  } else if (begun_.empty()) {
    wanted = std::exchange(again_, std::nullopt);
  }
  if (wanted) draw(*wanted);
  if (begun_.size() == InteractiveRenderer::kFramesInFlight || (!wanted && !begun_.empty())) finish(false);
}

// What was made of the scene.
void Drawer::letGo() {
  begun_.clear();
  again_.reset();
  interactive_ = nullptr;
  renderer_.reset();
  beside_.reset();
  picker_.reset();
}

void Drawer::load(const RenderArguments& arguments) {
  if (scene_ && sameScene(arguments, sceneArguments_)) return;
  say("loading " + nameOfScene(arguments));
  onNews_();
  const Progress silent(false);
  RenderArguments all = arguments;
  all.objects = {};
  Scene loaded = openScene(all, silent);
  if (loaded.draws.empty()) throw std::runtime_error(nameOfScene(arguments) + ": there is nothing to draw in it");
  try {
    static_cast<void>(shownObjects(loaded.objects, arguments.objects)); // before anything is let go of
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  letGo();
  SceneFacts facts{nameOfScene(arguments), loaded.objects, {}, worldBounds(loaded), loaded.origin, loaded.background};
  for (const Material& material : loaded.materials) facts.materials.push_back(material.name);
  facts.drawsAlike = drawsAlike(loaded);
  facts_ = std::make_shared<const SceneFacts>(std::move(facts));
  scene_ = std::move(loaded);
  allDraws_ = scene_->draws;
  sceneArguments_ = all;
}

// Draws these objects of the scene, cut so, from now on.
void Drawer::choose(const RenderArguments& arguments) {
  if (arguments.clipPlanes != sceneArguments_.clipPlanes) {
    const bool wasCut = !scene_->clipPlanes.empty();
    setClipPlanes(arguments, *scene_);
    sceneArguments_.clipPlanes = arguments.clipPlanes;
    if (interactive_ != nullptr && wasCut && !scene_->clipPlanes.empty()) {
      interactive_->setClipPlanes(*scene_);
      beside_.reset();
      picker_.reset();
    } else {
      letGo();
    }
  }
  const ObjectChoice& choice = arguments.objects;
  if (choice == sceneArguments_.objects) return;
  const std::vector<bool> shown = shownObjects(scene_->objects, choice);
  const auto isShown = [&](const Draw& draw) { return bool{shown[draw.object]}; };
  if (std::ranges::none_of(allDraws_, isShown)) throw std::runtime_error("all of it would be hidden");
  scene_->draws = allDraws_;
  scene_->materials.resize(facts_->materials.size()); // without those of an earlier choice
  chooseObjects(*scene_, choice);
  sceneArguments_.objects = choice;
  letGo();
}

void Drawer::pick(Picked& picked) {
  if (!scene_) return;
  finishAll(false); // none is pending while it picks
  load(picked.arguments);
  choose(picked.arguments);
  const RenderOptions options = pictureOf(picked.arguments, *scene_);
  const auto start = std::chrono::steady_clock::now();
  picked.scene = facts_;
  if (interactive_ != nullptr && rendererArguments_.opacity == picked.arguments.opacity) {
    if (auto layers = interactive_->pick(options, picked.x, picked.y)) {
      picked.layers = std::move(*layers);
      picked.byDevice = true;
      picked.milliseconds = interactive_->pickMilliseconds();
      const std::lock_guard lock(mutex_);
      picked_ = std::move(picked);
      return;
    }
  }
  if (!picker_ || pickerOpacity_ != picked.arguments.opacity) {
    picker_.reset();
    picker_ = std::make_unique<Picker>(*scene_, picked.arguments.opacity);
    pickerOpacity_ = picked.arguments.opacity;
  }
  picked.layers = picker_->at(options.view, options.width, options.height, picked.x, picked.y);
  picked.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const std::lock_guard lock(mutex_);
  picked_ = std::move(picked);
}

void Drawer::prepare(const RenderArguments& arguments) {
  if (renderer_ && rendererArguments_.method == arguments.method && rendererArguments_.opacity == arguments.opacity)
    return;
  say("preparing " + arguments.method.name);
  onNews_();
  finishAll(true);
  interactive_ = nullptr;
  renderer_.reset(); // what it holds on the device first
  if (device_.gpu() != nullptr && InteractiveRenderer::draws(arguments.method)) {
    auto made = std::make_unique<InteractiveRenderer>(*device_.gpu(), *scene_, arguments.opacity, arguments.method);
    interactive_ = made.get();
    renderer_ = std::move(made);
  } else {
    renderer_ = device_.makeRenderer(*scene_, arguments.opacity, DrawOrder::Forward, arguments.method);
  }
  rendererArguments_ = arguments;
}

const ColorMap& colorsOf(const Beside& beside) {
  return beside.kind == Beside::Kind::Complexity ? kViridis : kMagma; // as on the pages of `compare`
}

Renderer& Drawer::besideRenderer(const RenderArguments& arguments, const MethodOptions& method) {
  if (!beside_ || besideMethod_ != method || besideOpacity_ != arguments.opacity) {
    beside_.reset();
    beside_ = device_.makeRenderer(*scene_, arguments.opacity, DrawOrder::Forward, method);
    besideMethod_ = method;
    besideOpacity_ = arguments.opacity;
  }
  return *beside_;
}

void Drawer::drawBeside(const Wanted& wanted, const RenderOptions& options, Drawn& drawn) {
  if (wanted.beside.kind == Beside::Kind::Nothing) {
    beside_.reset();
    return;
  }
  RenderArguments arguments = wanted.arguments;
  if (device_.gpu() != nullptr) arguments.method.api = Api::Vulkan;
  RenderOptions picture = options;
  picture.memoryBudget.reset();
  picture.peel = 0;
  Plane plane(options.width, options.height);
  switch (wanted.beside.kind) {
    case Beside::Kind::Method:
      chooseMethod(arguments, wanted.beside.method);
      drawn.beside = besideRenderer(arguments, arguments.method).render(picture).picture;
      return;
    case Beside::Kind::Overflow:
      if (drawn.report.fragmentsMissing == 0) break;
      [[fallthrough]];
    case Beside::Kind::Complexity: {
      MethodOptions counting;
      counting.name = kLayerCount;
      const FrameReport report = besideRenderer(arguments, counting).measure(picture);
      std::ranges::copy(report.pixelLayers, plane.values.begin());
      // A pixel of one surface is exact all the same.
      if (wanted.beside.kind == Beside::Kind::Overflow) std::ranges::replace(plane.values, 1.0, 0.0);
      drawn.largest = report.layersMax;
      break;
    }
    case Beside::Kind::Tiles:
      drawn.largest = fillTiles(drawn.report, plane);
      break;
    default: {
      MethodOptions exact = device_.exactMethod();
      exact.samples = arguments.method.samples;
      const Picture right = besideRenderer(arguments, exact).render(picture).picture;
      for (std::size_t i = 0; i < plane.values.size(); ++i) {
        for (std::size_t c = 0; c < 4; ++c) {
          const int off = std::abs(int{drawn.picture.rgba[4 * i + c]} - int{right.rgba[4 * i + c]});
          plane.values[i] = std::max(plane.values[i], static_cast<double>(off));
        }
      }
      drawn.largest = *std::ranges::max_element(plane.values);
    }
  }
  drawn.largest = std::max(drawn.largest, 1.0);
  drawn.beside = heatmap(plane, drawn.largest, colorsOf(wanted.beside));
}

void Drawer::draw(const Wanted& wanted) {
  load(wanted.arguments);
  choose(wanted.arguments);
  prepare(wanted.arguments);
  say("drawing");
  if (interactive_ == nullptr || !begin(wanted)) drawExactly(wanted);
}

RenderOptions Drawer::optionsOf(const Wanted& wanted) const {
  RenderArguments arguments = wanted.arguments;
  arguments.width = std::max(arguments.width / wanted.coarse, 1U);
  arguments.height = std::max(arguments.height / wanted.coarse, 1U);
  RenderOptions options = pictureOf(arguments, *scene_);
  if (arguments.memoryBudget) options.memoryBudget = std::uint64_t{*arguments.memoryBudget} << 20U;
  options.peel = arguments.peel.value_or(0);
  return options;
}

// Begins a picture that is not waited for. False: it cannot be drawn so.
bool Drawer::begin(const Wanted& wanted) {
  const RenderOptions options = optionsOf(wanted);
  const bool readsBack = !sharesImages_ || wanted.rests || wanted.beside.kind == Beside::Kind::Error;
  const auto start = std::chrono::steady_clock::now();
  if (!interactive_->draw(options, {wanted.arguments.width, wanted.arguments.height}, readsBack)) {
    finishAll(true);
    return false;
  }
  begun_.push_back({wanted, options.view, start});
  if (wanted.beside.kind != Beside::Kind::Nothing) finishAll(false); // the other picture is drawn behind it
  return true;
}

// Waits for the oldest picture that was begun. A superseded one, behind which another is about to be begun, is shown as
// it is.
void Drawer::finish(bool isSuperseded) {
  const Begun begun = std::move(begun_.front());
  begun_.pop_front();
  InteractivePicture picture = interactive_->finish();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begun.start;
  Drawn drawn;
  drawn.wanted = begun.wanted;
  drawn.view = begun.view;
  drawn.width = picture.part.width;
  drawn.height = picture.part.height;
  if (sharesImages_) drawn.image = std::move(picture.image);
  const RenderOptions options = optionsOf(begun.wanted);
  const bool hasAlpha = options.background.kind == Background::Kind::Transparent;
  drawn.picture = {drawn.width, drawn.height, hasAlpha, std::move(picture.pixels)};
  drawn.report = std::move(picture.report);
  drawn.milliseconds = drawn.report.frameMs > 0.0 ? drawn.report.frameMs : took.count();
  drawn.warnings = scene_->warnings;
  const bool isNewest = begun_.empty() && !isSuperseded;
  const bool again = isNewest && isAgain(begun.wanted, drawn.report);
  if (isNewest && begun.wanted.rests && !again && needsExact(drawn.report)) return drawExactly(begun.wanted);
  drawBeside(begun.wanted, options, drawn);
  drawn.warnings.insert(drawn.warnings.end(), drawn.report.warnings.begin(), drawn.report.warnings.end());
  if (again) again_ = begun.wanted;
  drawn.wanted.rests = begun.wanted.rests && isNewest && !again;
  drawn.isFinal = drawn.wanted.rests;
  give(std::move(drawn));
}

void Drawer::finishAll(bool isSuperseded) {
  while (!begun_.empty()) finish(isSuperseded);
}

// Whether a picture lacks surfaces for which there will be room when it is drawn again.
bool Drawer::isAgain(const Wanted& wanted, const FrameReport& report) {
  if (report.fragmentsMissing == 0 || wanted.arguments.method.nodeCapacity > 0) return false;
  if (report.nodeCapacity <= mostNodes_) return false; // the budget has no more
  mostNodes_ = report.nodeCapacity;
  return true;
}

// Draws as `render` does, however often or in however many parts that takes.
void Drawer::drawExactly(const Wanted& wanted) {
  const RenderOptions options = optionsOf(wanted);
  const auto start = std::chrono::steady_clock::now();
  RenderResult result = renderer_->render(options);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  Drawn drawn;
  drawn.wanted = wanted;
  drawn.view = options.view;
  drawn.width = options.width;
  drawn.height = options.height;
  drawn.picture = std::move(result.picture);
  drawn.report = std::move(result.report);
  drawn.milliseconds = took.count();
  drawn.warnings = scene_->warnings;
  drawBeside(wanted, options, drawn);
  drawn.warnings.insert(drawn.warnings.end(), drawn.report.warnings.begin(), drawn.report.warnings.end());
  if (result.isEmpty) drawn.warnings.push_back(nothingSeenWarning(*scene_, seenOf(options, wanted.arguments.opacity)));
  give(std::move(drawn));
}

void Drawer::give(Drawn drawn) {
  const std::lock_guard lock(mutex_);
  drawn_ = std::move(drawn);
  shownScene_ = facts_;
}

} // namespace vitrail::tool
