// Which vector instructions code is compiled for, before any header of Highway: 4, 8 and 16 lanes on x86, 4 on Arm, and
// what every processor has. Not SSSE3, which SSE4 came soon after, nor vectors whose size is not known when compiling.
// Bits 4, 6 and 14 are targets of newer versions of Highway: two kinds of AVX-512 with nothing that is of use here, and
// SSE2.
#pragma once

#define HWY_DISABLED_TARGETS                                                                                       \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | (1LL << 4) | (1LL << 6) | \
   (1LL << 14))
