/// Options by name, for callers that get them as text: C, Python, configurations of hosts.
#pragma once

#include <span>
#include <string_view>

#include "dermis/plan.hpp"

namespace dermis {

struct Setting {
  const char* name;
  const char* help;  ///< the values it takes, and what it is
};

/// All that `set` knows.
std::span<const Setting> settings();

/// Sets an option: numbers in decimal, enumerations by their words, switches by "on" and "off". Throws Error(usage) for
/// a name that `settings` does not list and a value that is none of its kind; its range is checked by Plan.
void set(Options& options, std::string_view name, std::string_view value);

}  // namespace dermis
