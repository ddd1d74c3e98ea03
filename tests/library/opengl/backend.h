// The OpenGL backend of the tests: one surfaceless EGL context with debug output, and the programs that hosts share.
#pragma once

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <vitrail/gl.h>

#include "../backend.h"

namespace vitrail::tests::opengl {

// A context without a window, current on the thread that made it. Throws HostError.
class EglContext {
 public:
  // `share`: null, or the context whose objects it sees.
  explicit EglContext(const EglContext* share = nullptr);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void makeCurrent() const;
  static void makeNoneCurrent();

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

class OpenGlBackend : public Backend {
 public:
  [[nodiscard]] std::string name() const override { return "opengl"; }
  [[nodiscard]] std::string callPrefix() const override { return "vitrailGl"; }
  const Features& features() override;
  std::unique_ptr<PointHost> makeHost(const HostDesc& desc) override;
  VitrailTileLimits tileLimits(VitrailNodeFormat format, std::uint32_t samples) override;
  // Messages of KHR_debug, and lines of the library's log that no test took.
  std::vector<std::string> takeErrors() override;
  void close() override;

  VitrailGlContext context();
  // Hosts are made with that one from now on; gives the one before, which is null where none was made yet.
  VitrailGlContext exchangeContext(VitrailGlContext context) { return std::exchange(context_, context); }
  VitrailGlContextDesc contextDesc();
  [[nodiscard]] const EglContext& egl() const { return *egl_; }
  std::vector<LogLine> takeLog() override;
  // Has what KHR_debug says of the context that is current among the errors, too.
  void listen();

  // The program of these texts, compiled once; with `fragment` empty a compute program. Throws HostError.
  GLuint program(const std::string& first, const std::string& fragment);

 private:
  void open();

  std::unique_ptr<EglContext> egl_;
  VitrailGlContext context_ = nullptr;
  Features features_;
  std::map<std::string, GLuint> programs_;
  std::vector<LogLine> log_;
  std::vector<std::string> messages_;
};

OpenGlBackend& backend();

inline void expectOneLine(const std::string& word) { tests::expectOneLine(backend(), word); }

// A test of what only OpenGL has. The backend's context is current.
class OpenGlTest : public ::testing::Test {
 protected:
  void SetUp() override;
  // Fails the test for every message of KHR_debug and every line of the log that it did not take.
  void TearDown() override;
};

} // namespace vitrail::tests::opengl
