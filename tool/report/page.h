// Reports as one HTML page that needs nothing beside it and no network: what all such pages share.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vitrail::tool {

struct PageParts {
  std::string_view title;
  std::span<const unsigned char> body; // HTML between the header and the footer
  std::string data;                    // JSON, of which withoutTags() has been made; page.js has it as pageData
  std::span<const unsigned char> script;
};

// The page. The header has elements for `title`, `subject` and `machine`, which the script fills. Chart.js, which draws
// its charts, lies in it, and so does page.js, whose functions the script uses.
std::string makePage(const PageParts& parts);

// JSON that cannot end the element in which it lies.
std::string withoutTags(std::string json);

} // namespace vitrail::tool
