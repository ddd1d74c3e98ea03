#include "source.h"

#include <array>
#include <vector>

#include "sources/includes.inc"

namespace vitrail {

namespace {

struct Source {
  std::string_view name;
  std::string_view text;
};

template <std::size_t N>
std::string_view textOf(const unsigned char (&bytes)[N]) {
  return {reinterpret_cast<const char*>(&bytes[0]), N};
}

#define VITRAIL_SOURCE(name, symbol) Source{name, textOf(files::symbol)},
const std::array kSources = {
#include "sources/list.inc"
};
#undef VITRAIL_SOURCE

const Source* find(std::string_view name) {
  for (const Source& source : kSources) {
    if (source.name == name) return &source;
  }
  return nullptr;
}

bool startsWith(std::string_view line, std::string_view with) { return line.substr(0, with.size()) == with; }

std::string_view folderOf(std::string_view name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string_view::npos ? std::string_view() : name.substr(0, slash + 1);
}

// What stands between the quotation marks of an #include.
std::string_view included(std::string_view line) {
  const std::size_t first = line.find('"') + 1;
  return line.substr(first, line.find('"', first) - first);
}

// Extensions that Vulkan's compiler asks for and OpenGL has without them.
bool isForeign(std::string_view line) {
  return line.find("GL_GOOGLE_include_directive") != std::string_view::npos ||
         line.find("GL_EXT_samplerless_texture_functions") != std::string_view::npos;
}

class Flattener {
 public:
  std::string run(std::string_view name) {
    const Source* source = find(name);
    if (source == nullptr) return {};
    expand(*source);
    return extensions_ + text_;
  }

 private:
  void expand(const Source& source) {
    std::string_view rest = source.text;
    bool guarded = false; // past the file's include guard, which is no condition
    while (!rest.empty()) {
      const std::size_t end = rest.find('\n');
      const std::string_view line = rest.substr(0, end);
      rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
      if (startsWith(line, "#if")) {
        const bool guard = !guarded && startsWith(line, "#ifndef VITRAIL_");
        guarded = true;
        conditions_.push_back(!guard);
      } else if (startsWith(line, "#endif")) {
        conditions_.pop_back();
      }
      if (startsWith(line, "#include \"")) { // those of C++ stand in conditions that no shader meets
        include(source, included(line));
      } else if (startsWith(line, "#extension") && !inCondition() && !isForeign(line)) {
        extensions_.append(line).append("\n");
      } else if (!startsWith(line, "#version") && !isForeign(line)) {
        text_.append(line).append("\n");
      }
    }
  }

  // Again where it was behind a condition only: the files' guards keep what is there twice from meaning anything.
  void include(const Source& from, std::string_view name) {
    std::string beside(folderOf(from.name));
    beside += name;
    const Source* source = find(beside);
    if (source == nullptr) source = find(name);
    for (const Source* known : whole_) {
      if (known == source) return;
    }
    if (source == nullptr) return;
    if (!inCondition()) whole_.push_back(source);
    expand(*source);
  }

  [[nodiscard]] bool inCondition() const {
    for (const bool condition : conditions_) {
      if (condition) return true;
    }
    return false;
  }

  std::string extensions_;
  std::string text_;
  std::vector<const Source*> whole_; // files that are there whatever is defined
  std::vector<bool> conditions_;     // of the place; false: an include guard
};

} // namespace

std::string flattened(std::string_view name) { return Flattener().run(name); }

} // namespace vitrail
