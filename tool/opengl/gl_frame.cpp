#include "gl_frame.h"

#include <algorithm>
#include <chrono>

#include "bindings.h"

namespace vitrail::tool {

GlTimers::~GlTimers() {
  if (!queries_.empty()) glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

void GlTimers::startFrame() { frame_.clear(); }

void GlTimers::startSubmission() {
  names_.clear();
  stamps_ = 0;
  stamp();
}

void GlTimers::stamp() {
  if (waits_) {
    glFinish();
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    clock_.resize(++stamps_);
    clock_.back() = static_cast<std::uint64_t>(std::chrono::nanoseconds(now).count());
    return;
  }
  if (stamps_ == queries_.size()) glCreateQueries(GL_TIMESTAMP, 1, &queries_.emplace_back());
  glQueryCounter(queries_[stamps_++], GL_TIMESTAMP);
}

void GlTimers::endPass(const std::string& name) {
  names_.push_back(name);
  stamp();
}

std::uint64_t GlTimers::nanosecondsAt(std::size_t stamp) const {
  if (waits_) return clock_[stamp];
  GLuint64 time = 0;
  glGetQueryObjectui64v(queries_[stamp], GL_QUERY_RESULT, &time);
  return time;
}

void GlTimers::addSubmission() {
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < stamps_; ++i) {
    const std::uint64_t now = nanosecondsAt(i);
    if (i > 0) add(names_[i - 1], static_cast<double>(now - before) * 1e-6);
    before = now;
  }
}

void GlTimers::addHostPass(const std::string& name, double milliseconds) { add(name, milliseconds); }

void GlTimers::add(const std::string& name, double milliseconds) {
  const auto known = std::ranges::find(frame_, name, &std::pair<std::string, double>::first);
  if (known == frame_.end()) {
    frame_.emplace_back(name, milliseconds);
  } else {
    known->second += milliseconds;
  }
}

GlFrame::GlFrame(GlTimers& timers, const GlImages& images, const GlSurfaces& surfaces)
    : timers_(timers), images_(images), surfaces_(surfaces) {
  timers_.startFrame();
  timers_.startSubmission();
}

void GlFrame::drawSurfaces(const GlSurfacePrograms& programs, const GlSurfaces::BeforeRun& before) {
  drawSurfaces(programs, surfaces_.transparentRuns(), before);
}

void GlFrame::drawSurfaces(const GlSurfacePrograms& programs, std::span<const SurfaceRun> runs,
                           const GlSurfaces::BeforeRun& before) {
  surfaces_.draw(surfaces_.scene().transparentDraws(), runs, programs, before);
}

void GlFrame::wait() {
  finish();
  timers_.startSubmission();
}

void GlFrame::finish() {
  glUseProgram(0); // no program is in use when its owner goes
  glFinish();
  timers_.addSubmission();
  surfaces_.gl().check("a frame");
}

void GlPushed::set(std::span<const std::byte> bytes) const {
  glNamedBufferSubData(buffer_.get(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
  glBindBufferBase(GL_UNIFORM_BUFFER, kPushedBlock, buffer_.get());
}

} // namespace vitrail::tool
