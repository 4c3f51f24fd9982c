#include "opponents/simd_strip.hpp"

namespace dermis::bench {

void filter_strip_plain(const Strip& strip, bool with_depth) { filter_strip<4>(strip, with_depth); }

}  // namespace dermis::bench
