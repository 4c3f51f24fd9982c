// Ranges of options.
#pragma once

#include <string>

#include "dermis/error.hpp"

namespace dermis {

/// Throws Error(usage) unless low <= value <= high.
inline void check_range(const char* argument, double value, double low, double high, const char* wanted) {
  if (!(value >= low && value <= high)) throw Error(ErrorCode::usage, argument, std::to_string(value), wanted);
}

}  // namespace dermis
