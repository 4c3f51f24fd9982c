// The machine that a measurement is of.
#pragma once

#include <string>

namespace dermis::bench {

/// The processor, as Linux names it.
std::string processor_name();

/// Processes that want a core, over the last minute; 0 where that is not known.
double load_average();

}  // namespace dermis::bench
