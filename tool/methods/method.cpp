// The one place that knows how each method is made.
#include "method.h"

#include <stdexcept>

#include "insertion.h"
#include "interlock.h"
#include "linked_list.h"
#include "loop.h"
#include "moment.h"
#include "multi_layer.h"
#include "sorted.h"
#include "sorted_triangles.h"
#include "stochastic.h"
#include "unsorted.h"
#include "weighted.h"

namespace vitrail::tool {

std::unique_ptr<Method> makeMethod(const MethodHost& host, const MethodOptions& options) {
  if (options.name == "linked-list") return std::make_unique<LinkedList>(host, options);
  if (options.name == "unsorted") return std::make_unique<Unsorted>(host, options);
  if (options.name == "sorted") return std::make_unique<Sorted>(host, options);
  if (options.name == "sorted-triangles") return std::make_unique<SortedTriangles>(host, options);
  if (options.name == "insertion") return std::make_unique<Insertion>(host);
  if (options.name == "weighted") return std::make_unique<Weighted>(host, options);
  if (options.name == "moment") return std::make_unique<Moment>(host);
  if (options.name == "stochastic") return std::make_unique<Stochastic>(host, options);
  if (options.name == "loop" || options.name == "loop-64") return std::make_unique<Loop>(host, options);
  if (options.name == "interlock") return std::make_unique<Interlock>(host, options);
  if (options.name == "multi-layer") return std::make_unique<MultiLayer>(host, options);
  throw std::logic_error("a method that cannot be made: " + options.name);
}

} // namespace vitrail::tool
