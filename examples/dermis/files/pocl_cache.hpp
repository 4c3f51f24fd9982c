/// The folder in which PoCL keeps the kernels that it has compiled. They are code that runs: whoever may write there,
/// runs what he likes in this process. PoCL's own choice is a folder that all users share if there is no home.
#pragma once

#include <optional>
#include <string>

namespace dermis::program {

/// Names the folder in POCL_CACHE_DIR for all of the process: what is there if the user has set it; else kernels in the
/// user's cache of dermis, made for this user alone; else, if that is not to be had, a new temporary folder, which
/// remove_temporary_cache takes away. To be called before anything else calls OpenCL and before there are threads.
void choose_cache();

/// What is wrong with the folder that was chosen, once. Throws Error(device) if there is none.
std::optional<std::string> cache_warning();

void remove_temporary_cache() noexcept;

/// "PoCL's cache FOLDER cannot be written (REASON)" if so: without one PoCL has no device, and on a full disk its
/// compiler ends the process.
std::optional<std::string> cache_problem();

}  // namespace dermis::program
