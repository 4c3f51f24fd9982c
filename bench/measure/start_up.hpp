// The cost of the first frame of a process.
#pragma once

#include <string>

namespace dermis::bench {

/// Milliseconds, and the memory of the whole process.
struct StartUp {
  double plan_ms = 0;
  double first_run_ms = 0;
  double second_plan_ms = 0;
  double peak_mb = 0;
};

/// Measures one frame of the default scene in another process: this program, run with --start-up-child. The caches of
/// compiled kernels (of PoCL and of CUDA) and of taps are in a new folder; with `cache_is_filled` an earlier process
/// fills them.
/// Throws Error(device) if the process fails.
StartUp measure_start_up(bool cache_is_filled, const std::string& device_name);

/// Is that process: prints a StartUp as JSON on stdout. Taps are kept in the folder `cache`.
void run_start_up_child(const std::string& device_name, const std::string& cache);

}  // namespace dermis::bench
