// Backends keep their devices until the program's tests are over, and give them back before static objects go.
#include "backend.h"

namespace vitrail::tests {

namespace {

class BackendsEnvironment : public ::testing::Environment {
 public:
  void TearDown() override {
    for (Backend* backend : backends()) {
      backend->close();
      for (const std::string& error : backend->takeErrors()) ADD_FAILURE() << backend->name() << ": " << error;
    }
  }
};

const ::testing::Environment* const environment = ::testing::AddGlobalTestEnvironment(new BackendsEnvironment);

} // namespace

std::vector<Backend*>& backends() {
  static std::vector<Backend*> all;
  return all;
}

void expectOneLine(Backend& backend, const std::string& word) {
  const std::vector<LogLine> lines = backend.takeLog();
  EXPECT_EQ(lines.size(), 1U) << "lines about " << word;
  for (const LogLine& line : lines) {
    EXPECT_NE(line.text.find(word), std::string::npos) << "the log says: " << line.text;
    EXPECT_EQ(line.text.find('\n'), std::string::npos) << "the log says: " << line.text;
  }
}

void BackendTest::TearDown() {
  for (const std::string& error : backend().takeErrors()) ADD_FAILURE() << error;
}

} // namespace vitrail::tests
