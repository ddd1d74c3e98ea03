// The one place that knows how each method is made.
#include "method.h"

#include <stdexcept>

#include "a_buffer/a_buffer.h"
#include "depth_peeling/depth_peeling.h"
#include "dual_depth_peeling/dual_depth_peeling.h"
#include "insertion/insertion.h"
#include "interlock/interlock.h"
#include "layer_count/layer_count.h"
#include "linked_list/linked_list.h"
#include "loop/loop.h"
#include "moment/moment.h"
#include "multi_layer/multi_layer.h"
#include "reverse_depth_peeling/reverse_depth_peeling.h"
#include "sorted/sorted.h"
#include "sorted_triangles/sorted_triangles.h"
#include "stencil_routed/stencil_routed.h"
#include "stochastic/stochastic.h"
#include "unsorted/unsorted.h"
#include "weighted/weighted.h"

namespace vitrail::tool {

std::unique_ptr<Method> makeMethod(const MethodHost& host, const MethodOptions& options) {
  if (options.name == "linked-list") return std::make_unique<LinkedList>(host, options);
  if (options.name == "unsorted") return std::make_unique<Unsorted>(host, options);
  if (options.name == "sorted") return std::make_unique<Sorted>(host, options);
  if (options.name == "sorted-triangles") return std::make_unique<SortedTriangles>(host, options);
  if (options.name == "depth-peeling") return std::make_unique<DepthPeeling>(host, options);
  if (options.name == "reverse-depth-peeling") return std::make_unique<ReverseDepthPeeling>(host, options);
  if (options.name == "dual-depth-peeling") return std::make_unique<DualDepthPeeling>(host);
  if (options.name == "a-buffer") return std::make_unique<ABuffer>(host);
  if (options.name == "stencil-routed") return std::make_unique<StencilRouted>(host);
  if (options.name == "insertion") return std::make_unique<Insertion>(host);
  if (options.name == kLayerCount) return std::make_unique<LayerCount>(host);
  if (options.name == "weighted") return std::make_unique<Weighted>(host, options);
  if (options.name == "moment") return std::make_unique<Moment>(host);
  if (options.name == "stochastic") return std::make_unique<Stochastic>(host, options);
  if (options.name == "loop" || options.name == "loop-64") return std::make_unique<Loop>(host, options);
  if (options.name == "interlock") return std::make_unique<Interlock>(host, options);
  if (options.name == "multi-layer") return std::make_unique<MultiLayer>(host, options);
  throw std::logic_error("a method that cannot be made: " + options.name);
}

} // namespace vitrail::tool
