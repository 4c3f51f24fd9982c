// What every function of dermis.h does: no exception leaves it, and what went wrong is kept for the thread.
#pragma once

#include <string_view>

#include "dermis/dermis.h"
#include "dermis/error.hpp"

namespace dermis::c {

/// Keeps what the exception that is being handled says, and returns its code.
dermis_code keep_error() noexcept;

/// Calls `work`, which throws what goes wrong.
template <class Work>
dermis_code call(const Work& work) noexcept {
  try {
    work();
    return DERMIS_DONE;
  } catch (...) {
    return keep_error();
  }
}

/// Throws Error(usage) if a pointer that a function needs is null.
inline void require(const void* pointer, std::string_view argument) {
  if (pointer == nullptr) throw Error(ErrorCode::usage, argument, "NULL", "a pointer");
}

}  // namespace dermis::c
