/// How much memory there is, asked before it is taken: a system that has no more ends the process, or libraries whose
/// threads cannot be started wait for ever.
#pragma once

#include <cstdint>
#include <string_view>

namespace dermis::exr {

/// A limit on the memory of this process, from now on, beside those of the system.
void set_memory_limit(std::uint64_t bytes);

/// Throws Error(device) with need and limit unless as much can be taken: within that limit, that of the process's
/// cgroup, what `ulimit -v` leaves, and what is free.
void require_memory(std::string_view argument, std::uint64_t bytes);

/// Throws Error(device) with need and limit if `ulimit -v` is lower than all addresses that a process takes which does
/// such work with a thread for each core.
void require_addresses(std::string_view work, std::uint64_t bytes, std::uint64_t bytes_per_core);

}  // namespace dermis::exr
