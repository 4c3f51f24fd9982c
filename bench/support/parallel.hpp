// One thread per core, for what is not on an OpenCL device.
#pragma once

#include <cstddef>
#include <functional>

namespace dermis::bench {

/// The number of cores that this process may use.
std::size_t core_count();

/// Calls work(worker, workers) once on every core and waits.
void on_all_cores(const std::function<void(std::size_t worker, std::size_t workers)>& work);

}  // namespace dermis::bench
