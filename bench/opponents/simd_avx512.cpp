#include "opponents/simd_strip.hpp"

namespace dermis::bench {

void filter_strip_avx512(const Strip& strip, bool with_depth) { filter_strip<16>(strip, with_depth); }

}  // namespace dermis::bench
