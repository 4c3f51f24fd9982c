#include "opponents/simd_strip.hpp"

namespace dermis::bench {

void filter_strip_avx2(const Strip& strip, bool with_depth) { filter_strip<8>(strip, with_depth); }

}  // namespace dermis::bench
