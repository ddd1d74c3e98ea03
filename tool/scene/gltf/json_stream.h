// Parses JSON whose one large array is handed over element by element, so that it never stands in memory as a whole.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace vitrail::tool {

struct JsonStream {
  std::string_view array;                               // the member of the outermost object that is handed over
  std::function<void(nlohmann::json&&)> element;        // takes its elements in order
  std::function<void()> restart;                        // the member is there once more: the last one counts
  std::function<bool(std::string_view)> wanted;         // false: a member of the outermost object is skipped
  std::function<void(const char*, const char*)> parsed; // a stretch of the text that is not looked at again
};

// The document; the array that was handed over is in it, but empty. Throws LoadError where the text is not JSON or is
// nested more than 100 levels deep.
nlohmann::json parseJson(std::string_view text, const JsonStream& stream);

} // namespace vitrail::tool
