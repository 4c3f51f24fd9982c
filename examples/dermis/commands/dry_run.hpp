/// What a call of the filter would do, without doing it.
#pragma once

#include "commands/filter_job.hpp"
#include "report/messages.hpp"

namespace dermis::program {

/// Reads the pictures, and prints for each what would be read and written and the memory that it needs. Writes nothing
/// and compiles nothing. Pictures that fail are named as filter_pictures does, whose exit code it returns.
int dry_run(FilterJob job, Messages& messages);

}  // namespace dermis::program
