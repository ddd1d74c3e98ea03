#include "page.h"

#include <utility>

#include "files/chart.min.js.h"
#include "files/page.css.h"
#include "files/page.html.h"
#include "files/page.js.h"

namespace vitrail::tool {

namespace {

std::string_view textOf(std::span<const unsigned char> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

std::string withoutTags(std::string json) {
  constexpr std::string_view kEscaped = "\\u003c";
  for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at + kEscaped.size())) {
    json.replace(at, 1, kEscaped);
  }
  return json;
}

std::string makePage(const PageParts& parts) {
  const std::pair<std::string_view, std::string_view> contents[] = {{"@title@", parts.title},
                                                                    {"@style@", textOf(files::page_css)},
                                                                    {"@body@", textOf(parts.body)},
                                                                    {"@version@", VITRAIL_TOOL_VERSION},
                                                                    {"@data@", parts.data},
                                                                    {"@charts@", textOf(files::chart_min_js)},
                                                                    {"@common@", textOf(files::page_js)},
                                                                    {"@script@", textOf(parts.script)}};
  std::string page;
  std::string_view rest = textOf(files::page_html);
  for (const auto& [mark, content] : contents) { // in the order in which the page has them
    const std::size_t at = rest.find(mark);
    page.append(rest.substr(0, at)).append(content);
    rest.remove_prefix(at + mark.size());
  }
  return page.append(rest);
}

} // namespace vitrail::tool
