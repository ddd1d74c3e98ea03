// The one place that knows which methods there are.
#include "method.h"

#include "insertion.h"
#include "linked_list.h"
#include "unsorted.h"

namespace vitrail::tool {

std::unique_ptr<Method> makeMethod(Gpu& gpu, const MethodOptions& options) {
  if (options.name == "unsorted") return std::make_unique<Unsorted>(gpu);
  if (options.name == "insertion") return std::make_unique<Insertion>(gpu);
  return std::make_unique<LinkedList>(gpu, options);
}

} // namespace vitrail::tool
