// The one place that knows which methods there are.
#include "method.h"

#include "insertion.h"
#include "layer_count.h"
#include "linked_list.h"
#include "unsorted.h"

namespace vitrail::tool {

std::unique_ptr<Method> makeMethod(Gpu& gpu, const MethodOptions& options) {
  if (options.name == "unsorted") return std::make_unique<Unsorted>(gpu);
  if (options.name == "insertion") return std::make_unique<Insertion>(gpu);
  if (options.name == kLayerCount) return std::make_unique<LayerCount>(gpu);
  return std::make_unique<LinkedList>(gpu, options);
}

} // namespace vitrail::tool
