#include "bench_page.h"

#include "files/bench.html.h"
#include "files/bench.js.h"
#include "page.h"

namespace vitrail::tool {

std::string toBenchPage(const std::string& report) {
  return makePage({.title = "Transparency methods measured",
                   .body = files::bench_html,
                   .data = withoutTags(report),
                   .script = files::bench_js});
}

} // namespace vitrail::tool
