/// The pictures of a call, one after the other, with reading, filtering and writing side by side.
#pragma once

#include "commands/filter_job.hpp"
#include "report/messages.hpp"

namespace dermis::program {

/// While a picture is filtered the next one is read and the last one is written: at most three are in memory at a time.
/// A picture that fails is named, and others are done nevertheless, as the job says. Returns the exit code; throws
/// Error(device) if there is no device.
int filter_pictures(const FilterJob& job, Messages& messages);

}  // namespace dermis::program
