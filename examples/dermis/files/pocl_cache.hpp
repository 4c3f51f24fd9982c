/// The folder in which PoCL keeps the kernels that it has compiled. They are code that runs: whoever may write there,
/// runs what he likes in this process. PoCL's own choice is a folder that all users share if there is no home.
#pragma once

#include <optional>
#include <string>

namespace dermis::program {

/// Names the folder in POCL_CACHE_DIR for all of the process: what is there if the user has set it; else a new folder
/// of this run in the user's cache of dermis, or, if that is not to be had, in the system's temporary one. Runs that
/// have ended by a signal or a crash are cleaned up after. To be called before there are threads.
void choose_cache();

/// Puts the kernels that earlier runs have kept into the folder of this run, before anything calls OpenCL; at the first
/// call alone. Returns what is wrong with the folder that was chosen, once. Throws Error(device) if there is none.
std::optional<std::string> fill_cache();

/// Keeps the kernels that PoCL has compiled for later runs, and removes the folder of this one. Nothing may call OpenCL
/// any more.
void close_cache() noexcept;

/// Notes that the process crashes, so that the next run drops the kernels that are in use. For a signal handler.
void mark_crash() noexcept;

/// "PoCL's cache FOLDER cannot be written (REASON)" if so: without one PoCL has no device, and on a full disk its
/// compiler ends the process.
std::optional<std::string> cache_problem();

}  // namespace dermis::program
