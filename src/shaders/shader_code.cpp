#include "shader_code.h"

#include <array>

#include "shaders/clear_sums_insertion_address.h"
#include "shaders/clear_sums_insertion_binding.h"
#include "shaders/link_insertion_address.h"
#include "shaders/link_insertion_binding.h"
#include "shaders/resolve_frag_dual_insertion_address.h"
#include "shaders/resolve_frag_dual_insertion_binding.h"
#include "shaders/resolve_frag_dual_networks_address.h"
#include "shaders/resolve_frag_dual_networks_binding.h"
#include "shaders/resolve_frag_insertion_address.h"
#include "shaders/resolve_frag_insertion_binding.h"
#include "shaders/resolve_frag_multisampled_insertion_address.h"
#include "shaders/resolve_frag_multisampled_insertion_binding.h"
#include "shaders/resolve_frag_multisampled_networks_address.h"
#include "shaders/resolve_frag_multisampled_networks_binding.h"
#include "shaders/resolve_frag_networks_address.h"
#include "shaders/resolve_frag_networks_binding.h"
#include "shaders/resolve_frag_sample_depth_insertion_address.h"
#include "shaders/resolve_frag_sample_depth_insertion_binding.h"
#include "shaders/resolve_frag_sample_depth_networks_address.h"
#include "shaders/resolve_frag_sample_depth_networks_binding.h"
#include "shaders/resolve_frag_sample_dual_depth_insertion_address.h"
#include "shaders/resolve_frag_sample_dual_depth_insertion_binding.h"
#include "shaders/resolve_frag_sample_dual_depth_networks_address.h"
#include "shaders/resolve_frag_sample_dual_depth_networks_binding.h"
#include "shaders/resolve_frag_sample_dual_insertion_address.h"
#include "shaders/resolve_frag_sample_dual_insertion_binding.h"
#include "shaders/resolve_frag_sample_dual_networks_address.h"
#include "shaders/resolve_frag_sample_dual_networks_binding.h"
#include "shaders/resolve_frag_sample_insertion_address.h"
#include "shaders/resolve_frag_sample_insertion_binding.h"
#include "shaders/resolve_frag_sample_networks_address.h"
#include "shaders/resolve_frag_sample_networks_binding.h"
#include "shaders/resolve_group_rgba16f_multisampled_networks_address.h"
#include "shaders/resolve_group_rgba16f_multisampled_networks_binding.h"
#include "shaders/resolve_group_rgba16f_networks_address.h"
#include "shaders/resolve_group_rgba16f_networks_binding.h"
#include "shaders/resolve_group_rgba32f_multisampled_networks_address.h"
#include "shaders/resolve_group_rgba32f_multisampled_networks_binding.h"
#include "shaders/resolve_group_rgba32f_networks_address.h"
#include "shaders/resolve_group_rgba32f_networks_binding.h"
#include "shaders/resolve_long_rgba16f_insertion_address.h"
#include "shaders/resolve_long_rgba16f_insertion_binding.h"
#include "shaders/resolve_long_rgba16f_multisampled_insertion_address.h"
#include "shaders/resolve_long_rgba16f_multisampled_insertion_binding.h"
#include "shaders/resolve_long_rgba32f_insertion_address.h"
#include "shaders/resolve_long_rgba32f_insertion_binding.h"
#include "shaders/resolve_long_rgba32f_multisampled_insertion_address.h"
#include "shaders/resolve_long_rgba32f_multisampled_insertion_binding.h"
#include "shaders/resolve_medium_rgba16f_multisampled_networks_address.h"
#include "shaders/resolve_medium_rgba16f_multisampled_networks_binding.h"
#include "shaders/resolve_medium_rgba16f_networks_address.h"
#include "shaders/resolve_medium_rgba16f_networks_binding.h"
#include "shaders/resolve_medium_rgba32f_multisampled_networks_address.h"
#include "shaders/resolve_medium_rgba32f_multisampled_networks_binding.h"
#include "shaders/resolve_medium_rgba32f_networks_address.h"
#include "shaders/resolve_medium_rgba32f_networks_binding.h"
#include "shaders/resolve_overflow_rgba16f_insertion_address.h"
#include "shaders/resolve_overflow_rgba16f_insertion_binding.h"
#include "shaders/resolve_overflow_rgba16f_multisampled_insertion_address.h"
#include "shaders/resolve_overflow_rgba16f_multisampled_insertion_binding.h"
#include "shaders/resolve_overflow_rgba32f_insertion_address.h"
#include "shaders/resolve_overflow_rgba32f_insertion_binding.h"
#include "shaders/resolve_overflow_rgba32f_multisampled_insertion_address.h"
#include "shaders/resolve_overflow_rgba32f_multisampled_insertion_binding.h"
#include "shaders/resolve_rgba16f_insertion_address.h"
#include "shaders/resolve_rgba16f_insertion_binding.h"
#include "shaders/resolve_rgba16f_multisampled_insertion_address.h"
#include "shaders/resolve_rgba16f_multisampled_insertion_binding.h"
#include "shaders/resolve_rgba16f_multisampled_networks_address.h"
#include "shaders/resolve_rgba16f_multisampled_networks_binding.h"
#include "shaders/resolve_rgba16f_networks_address.h"
#include "shaders/resolve_rgba16f_networks_binding.h"
#include "shaders/resolve_rgba32f_insertion_address.h"
#include "shaders/resolve_rgba32f_insertion_binding.h"
#include "shaders/resolve_rgba32f_multisampled_insertion_address.h"
#include "shaders/resolve_rgba32f_multisampled_insertion_binding.h"
#include "shaders/resolve_rgba32f_multisampled_networks_address.h"
#include "shaders/resolve_rgba32f_multisampled_networks_binding.h"
#include "shaders/resolve_rgba32f_networks_address.h"
#include "shaders/resolve_rgba32f_networks_binding.h"
#include "shaders/resolve_vert.h"
#include "shaders/sort_find_insertion_address.h"
#include "shaders/sort_find_insertion_binding.h"
#include "shaders/sort_find_networks_address.h"
#include "shaders/sort_find_networks_binding.h"
#include "shaders/sort_long_insertion_address.h"
#include "shaders/sort_long_insertion_binding.h"
#include "shaders/sort_long_networks_address.h"
#include "shaders/sort_long_networks_binding.h"

namespace vitrail {

namespace {

// One way to sort, by binding and by address.
struct Access {
  Spirv binding;
  Spirv address;
};

// One permutation by networks and by insertion; the same twice where it comes in one of them.
struct Code {
  std::array<Access, 2> ways;

  [[nodiscard]] Spirv get(bool byAddress, bool networks) const {
    const Access& access = ways[networks ? 0 : 1];
    return byAddress ? access.address : access.binding;
  }
};

// One kernel that writes pictures: of each colour image, for one sample and for several.
using PictureCode = std::array<std::array<Code, 2>, 2>;

constexpr PictureCode kResolve = {
    PictureCode::value_type{
        Code{{Access{shaders::resolve_rgba16f_networks_binding, shaders::resolve_rgba16f_networks_address},
              Access{shaders::resolve_rgba16f_insertion_binding, shaders::resolve_rgba16f_insertion_address}}},
        Code{{Access{shaders::resolve_rgba16f_multisampled_networks_binding,
                     shaders::resolve_rgba16f_multisampled_networks_address},
              Access{shaders::resolve_rgba16f_multisampled_insertion_binding,
                     shaders::resolve_rgba16f_multisampled_insertion_address}}}},
    PictureCode::value_type{
        Code{{Access{shaders::resolve_rgba32f_networks_binding, shaders::resolve_rgba32f_networks_address},
              Access{shaders::resolve_rgba32f_insertion_binding, shaders::resolve_rgba32f_insertion_address}}},
        Code{{Access{shaders::resolve_rgba32f_multisampled_networks_binding,
                     shaders::resolve_rgba32f_multisampled_networks_address},
              Access{shaders::resolve_rgba32f_multisampled_insertion_binding,
                     shaders::resolve_rgba32f_multisampled_insertion_address}}}}};
constexpr PictureCode kResolveMedium = {
    PictureCode::value_type{Code{{Access{shaders::resolve_medium_rgba16f_networks_binding,
                                         shaders::resolve_medium_rgba16f_networks_address},
                                  Access{shaders::resolve_medium_rgba16f_networks_binding,
                                         shaders::resolve_medium_rgba16f_networks_address}}},
                            Code{{Access{shaders::resolve_medium_rgba16f_multisampled_networks_binding,
                                         shaders::resolve_medium_rgba16f_multisampled_networks_address},
                                  Access{shaders::resolve_medium_rgba16f_multisampled_networks_binding,
                                         shaders::resolve_medium_rgba16f_multisampled_networks_address}}}},
    PictureCode::value_type{Code{{Access{shaders::resolve_medium_rgba32f_networks_binding,
                                         shaders::resolve_medium_rgba32f_networks_address},
                                  Access{shaders::resolve_medium_rgba32f_networks_binding,
                                         shaders::resolve_medium_rgba32f_networks_address}}},
                            Code{{Access{shaders::resolve_medium_rgba32f_multisampled_networks_binding,
                                         shaders::resolve_medium_rgba32f_multisampled_networks_address},
                                  Access{shaders::resolve_medium_rgba32f_multisampled_networks_binding,
                                         shaders::resolve_medium_rgba32f_multisampled_networks_address}}}}};
constexpr PictureCode kResolveGroup = {
    PictureCode::value_type{
        Code{
            {Access{shaders::resolve_group_rgba16f_networks_binding, shaders::resolve_group_rgba16f_networks_address},
             Access{shaders::resolve_group_rgba16f_networks_binding, shaders::resolve_group_rgba16f_networks_address}}},
        Code{{Access{shaders::resolve_group_rgba16f_multisampled_networks_binding,
                     shaders::resolve_group_rgba16f_multisampled_networks_address},
              Access{shaders::resolve_group_rgba16f_multisampled_networks_binding,
                     shaders::resolve_group_rgba16f_multisampled_networks_address}}}},
    PictureCode::value_type{
        Code{
            {Access{shaders::resolve_group_rgba32f_networks_binding, shaders::resolve_group_rgba32f_networks_address},
             Access{shaders::resolve_group_rgba32f_networks_binding, shaders::resolve_group_rgba32f_networks_address}}},
        Code{{Access{shaders::resolve_group_rgba32f_multisampled_networks_binding,
                     shaders::resolve_group_rgba32f_multisampled_networks_address},
              Access{shaders::resolve_group_rgba32f_multisampled_networks_binding,
                     shaders::resolve_group_rgba32f_multisampled_networks_address}}}}};
constexpr PictureCode kResolveLong = {
    PictureCode::value_type{
        Code{
            {Access{shaders::resolve_long_rgba16f_insertion_binding, shaders::resolve_long_rgba16f_insertion_address},
             Access{shaders::resolve_long_rgba16f_insertion_binding, shaders::resolve_long_rgba16f_insertion_address}}},
        Code{{Access{shaders::resolve_long_rgba16f_multisampled_insertion_binding,
                     shaders::resolve_long_rgba16f_multisampled_insertion_address},
              Access{shaders::resolve_long_rgba16f_multisampled_insertion_binding,
                     shaders::resolve_long_rgba16f_multisampled_insertion_address}}}},
    PictureCode::value_type{
        Code{
            {Access{shaders::resolve_long_rgba32f_insertion_binding, shaders::resolve_long_rgba32f_insertion_address},
             Access{shaders::resolve_long_rgba32f_insertion_binding, shaders::resolve_long_rgba32f_insertion_address}}},
        Code{{Access{shaders::resolve_long_rgba32f_multisampled_insertion_binding,
                     shaders::resolve_long_rgba32f_multisampled_insertion_address},
              Access{shaders::resolve_long_rgba32f_multisampled_insertion_binding,
                     shaders::resolve_long_rgba32f_multisampled_insertion_address}}}}};
constexpr PictureCode kResolveOverflow = {
    PictureCode::value_type{Code{{Access{shaders::resolve_overflow_rgba16f_insertion_binding,
                                         shaders::resolve_overflow_rgba16f_insertion_address},
                                  Access{shaders::resolve_overflow_rgba16f_insertion_binding,
                                         shaders::resolve_overflow_rgba16f_insertion_address}}},
                            Code{{Access{shaders::resolve_overflow_rgba16f_multisampled_insertion_binding,
                                         shaders::resolve_overflow_rgba16f_multisampled_insertion_address},
                                  Access{shaders::resolve_overflow_rgba16f_multisampled_insertion_binding,
                                         shaders::resolve_overflow_rgba16f_multisampled_insertion_address}}}},
    PictureCode::value_type{Code{{Access{shaders::resolve_overflow_rgba32f_insertion_binding,
                                         shaders::resolve_overflow_rgba32f_insertion_address},
                                  Access{shaders::resolve_overflow_rgba32f_insertion_binding,
                                         shaders::resolve_overflow_rgba32f_insertion_address}}},
                            Code{{Access{shaders::resolve_overflow_rgba32f_multisampled_insertion_binding,
                                         shaders::resolve_overflow_rgba32f_multisampled_insertion_address},
                                  Access{shaders::resolve_overflow_rgba32f_multisampled_insertion_binding,
                                         shaders::resolve_overflow_rgba32f_multisampled_insertion_address}}}}};
constexpr Code kLink = Code{{Access{shaders::link_insertion_binding, shaders::link_insertion_address},
                             Access{shaders::link_insertion_binding, shaders::link_insertion_address}}};
constexpr Code kSortFind = Code{{Access{shaders::sort_find_networks_binding, shaders::sort_find_networks_address},
                                 Access{shaders::sort_find_insertion_binding, shaders::sort_find_insertion_address}}};
constexpr Code kSortLong = Code{{Access{shaders::sort_long_networks_binding, shaders::sort_long_networks_address},
                                 Access{shaders::sort_long_insertion_binding, shaders::sort_long_insertion_address}}};
constexpr Code kClearSums =
    Code{{Access{shaders::clear_sums_insertion_binding, shaders::clear_sums_insertion_address},
          Access{shaders::clear_sums_insertion_binding, shaders::clear_sums_insertion_address}}};
constexpr std::array<Code, 7> kFragment = {
    Code{{Access{shaders::resolve_frag_networks_binding, shaders::resolve_frag_networks_address},
          Access{shaders::resolve_frag_insertion_binding, shaders::resolve_frag_insertion_address}}},
    Code{{Access{shaders::resolve_frag_dual_networks_binding, shaders::resolve_frag_dual_networks_address},
          Access{shaders::resolve_frag_dual_insertion_binding, shaders::resolve_frag_dual_insertion_address}}},
    Code{{Access{shaders::resolve_frag_sample_networks_binding, shaders::resolve_frag_sample_networks_address},
          Access{shaders::resolve_frag_sample_insertion_binding, shaders::resolve_frag_sample_insertion_address}}},
    Code{
        {Access{shaders::resolve_frag_sample_dual_networks_binding, shaders::resolve_frag_sample_dual_networks_address},
         Access{shaders::resolve_frag_sample_dual_insertion_binding,
                shaders::resolve_frag_sample_dual_insertion_address}}},
    Code{{Access{shaders::resolve_frag_sample_depth_networks_binding,
                 shaders::resolve_frag_sample_depth_networks_address},
          Access{shaders::resolve_frag_sample_depth_insertion_binding,
                 shaders::resolve_frag_sample_depth_insertion_address}}},
    Code{{Access{shaders::resolve_frag_sample_dual_depth_networks_binding,
                 shaders::resolve_frag_sample_dual_depth_networks_address},
          Access{shaders::resolve_frag_sample_dual_depth_insertion_binding,
                 shaders::resolve_frag_sample_dual_depth_insertion_address}}},
    Code{{Access{shaders::resolve_frag_multisampled_networks_binding,
                 shaders::resolve_frag_multisampled_networks_address},
          Access{shaders::resolve_frag_multisampled_insertion_binding,
                 shaders::resolve_frag_multisampled_insertion_address}}}};

const Code& kernelPermutation(Kernel kernel, ColorImage color, bool multisampled) {
  const auto of = [&](const PictureCode& code) -> const Code& {
    return code[static_cast<std::size_t>(color)][multisampled ? 1 : 0];
  };
  switch (kernel) {
    case Kernel::Resolve:
      return of(kResolve);
    case Kernel::ResolveMedium:
      return of(kResolveMedium);
    case Kernel::ResolveGroup:
      return of(kResolveGroup);
    case Kernel::ResolveLong:
      return of(kResolveLong);
    case Kernel::ResolveOverflow:
      return of(kResolveOverflow);
    case Kernel::Link:
      return kLink;
    case Kernel::SortFind:
      return kSortFind;
    case Kernel::SortLong:
      return kSortLong;
    case Kernel::ClearSums:
      break;
  }
  return kClearSums;
}

} // namespace

Spirv kernelCode(Kernel kernel, ColorImage color, bool multisampled, bool byAddress, bool networks) {
  return kernelPermutation(kernel, color, multisampled).get(byAddress, networks);
}

Spirv fragmentCode(FragmentResolve resolve, bool byAddress, bool networks) {
  return kFragment[static_cast<std::size_t>(resolve)].get(byAddress, networks);
}

Spirv vertexCode() { return shaders::resolve_vert; }

} // namespace vitrail
