// Lets calls of OpenCL fail: the functions of the driver, in the table through which the loader calls them, are
// replaced by ones that may refuse before they hand over. Releases always go through.
#pragma once

#include <string>

/// Replaces the functions of the driver of the first platform for the rest of the process.
void install_failing_calls();

/// From now on calls count from 1, and the one of that number fails; 0: none does. `all_after`: and those after it.
void fail_call(int number, bool all_after = false);

/// The calls since then.
int calls_made();

/// The name of the first call that has failed since then; empty if none has.
std::string failed_call();

/// Objects of OpenCL that were made and retained, less those released, since the functions were replaced. A device or a
/// part of one does not count.
long objects_held();
