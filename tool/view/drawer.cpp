#include "drawer.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "../commands/progress.h"
#include "../commands/scene_options.h"

namespace vitrail::tool {

namespace {

// Whether both load the same scene.
bool sameScene(const RenderArguments& a, const RenderArguments& b) {
  return a.models == b.models && a.scene == b.scene && a.count == b.count && a.seed == b.seed && a.up == b.up &&
         a.clipPlanes == b.clipPlanes && a.pointSize == b.pointSize && a.load.time == b.load.time &&
         a.load.animation == b.load.animation && a.load.variant == b.load.variant;
}

} // namespace

Drawer::Drawer(const Device& device, void (*onNews)()) : device_(device), onNews_(onNews), thread_([this] { run(); }) {}

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

std::optional<Drawn> Drawer::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(drawn_, std::nullopt);
}

std::exception_ptr Drawer::takeError() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, nullptr);
}

std::shared_ptr<const Scene> Drawer::scene() const {
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
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || wanted_.has_value(); });
    if (ends_) break;
    const Wanted wanted = *std::exchange(wanted_, std::nullopt);
    doing_ = "drawing";
    lock.unlock();
    std::exception_ptr error;
    try {
      draw(wanted);
    } catch (...) {
      error = std::current_exception();
    }
    if (error) renderer_.reset(); // it may be half made, or on a device that is lost
    lock.lock();
    if (error) error_ = error;
    doing_.clear();
    lock.unlock();
    onNews_();
    lock.lock();
  }
}

void Drawer::load(const RenderArguments& arguments) {
  if (scene_ && sameScene(arguments, sceneArguments_)) return;
  say("loading " + nameOfScene(arguments));
  onNews_();
  const Progress silent(false);
  auto loaded = std::make_shared<const Scene>(openScene(arguments, silent));
  if (loaded->draws.empty()) throw std::runtime_error(nameOfScene(arguments) + ": there is nothing to draw in it");
  renderer_.reset();
  scene_ = std::move(loaded);
  sceneArguments_ = arguments;
}

void Drawer::prepare(const RenderArguments& arguments) {
  if (renderer_ && rendererArguments_.method == arguments.method && rendererArguments_.opacity == arguments.opacity)
    return;
  say("preparing " + arguments.method.name);
  onNews_();
  renderer_.reset(); // what it holds on the device first
  renderer_ = device_.makeRenderer(*scene_, arguments.opacity, DrawOrder::Forward, arguments.method);
  rendererArguments_ = arguments;
}

void Drawer::draw(const Wanted& wanted) {
  load(wanted.arguments);
  prepare(wanted.arguments);
  say("drawing");
  RenderArguments arguments = wanted.arguments;
  arguments.width = std::max(arguments.width / wanted.coarse, 1U);
  arguments.height = std::max(arguments.height / wanted.coarse, 1U);
  RenderOptions options = pictureOf(arguments, *scene_);
  if (arguments.memoryBudget) options.memoryBudget = std::uint64_t{*arguments.memoryBudget} << 20U;
  const auto start = std::chrono::steady_clock::now();
  RenderResult result = renderer_->render(options);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  Drawn drawn{wanted, std::move(result.picture), std::move(result.report), took.count(), scene_->warnings};
  drawn.warnings.insert(drawn.warnings.end(), drawn.report.warnings.begin(), drawn.report.warnings.end());
  if (result.isEmpty) drawn.warnings.push_back(nothingSeenWarning(*scene_, seenOf(options, arguments.opacity)));
  const std::lock_guard lock(mutex_);
  drawn_ = std::move(drawn);
  shownScene_ = scene_;
}

} // namespace vitrail::tool
