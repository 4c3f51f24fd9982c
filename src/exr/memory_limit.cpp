#include "exr/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "dermis/error.hpp"

namespace dermis::exr {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

std::uint64_t own_limit = unlimited;

/// Memory that can be taken, and what has the last word on it.
struct Room {
  std::uint64_t bytes;
  const char* limit;
};

/// The first number of a file, or of its line that begins with `name`.
std::uint64_t number_in(const std::string& path, std::string_view name = {}) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(name)) continue;
    try {
      return std::stoull(line.substr(name.size()));
    } catch (const std::exception&) {
      return unlimited;  // "max"
    }
  }
  return unlimited;
}

/// Pages that are mapped, and those that are in memory.
struct Taken {
  std::uint64_t addresses = 0;
  std::uint64_t memory = 0;
};

Taken taken() {
  Taken pages;
  std::ifstream("/proc/self/statm") >> pages.addresses >> pages.memory;
  const auto page_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return {pages.addresses * page_bytes, pages.memory * page_bytes};
}

std::uint64_t address_limit() {
  struct rlimit limit = {};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? limit.rlim_cur : unlimited;
}

/// The lowest limit of the groups that the process is in, of either version of them.
std::uint64_t group_limit() {
  std::uint64_t least = unlimited;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t path = line.find(':', line.find(':') + 1);
    if (path == std::string::npos) continue;
    const bool is_unified = line.starts_with("0::");
    if (!is_unified && line.find(":memory:") == std::string::npos) continue;
    const std::string root = is_unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    const char* const file = is_unified ? "/memory.max" : "/memory.limit_in_bytes";
    // In a container the group may be the root of what is seen.
    for (std::string group = line.substr(path + 1);; group.resize(group.rfind('/'))) {
      least = std::min(least, number_in(root + group + file));
      if (group.find('/') == std::string::npos) break;
    }
  }
  return least;
}

Room room() {
  const Taken its = taken();
  const auto left = [](std::uint64_t limit, std::uint64_t used) {
    return limit == unlimited ? limit : limit - std::min(limit, used);
  };
  constexpr std::uint64_t of_libraries = std::uint64_t{128} << 20;  // addresses that they may still take
  const std::uint64_t kib = number_in("/proc/meminfo", "MemAvailable:");
  return std::min({Room{left(own_limit, its.memory), "--memory-limit"},
                   Room{left(group_limit(), its.memory), "the limit of the cgroup"},
                   Room{left(address_limit(), its.addresses + of_libraries), "the limit on addresses (ulimit -v)"},
                   Room{kib == unlimited ? kib : kib << 10, "what is free"}},
                  [](const Room& a, const Room& b) { return a.bytes < b.bytes; });
}

std::string text_of(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f MB", static_cast<double>(bytes) * 1e-6);
  return text;
}

}  // namespace

void set_memory_limit(std::uint64_t bytes) { own_limit = bytes; }

void require_memory(std::string_view argument, std::uint64_t bytes) {
  const Room its = room();
  if (bytes <= its.bytes) return;
  throw Error(ErrorCode::device, argument, text_of(bytes) + " of memory to take",
              "at most " + text_of(its.bytes) + ", " + its.limit);
}

void require_addresses(std::string_view work, std::uint64_t bytes, std::uint64_t bytes_per_core) {
  const std::uint64_t need = bytes + bytes_per_core * std::max(1U, std::thread::hardware_concurrency());
  if (address_limit() >= need) return;
  throw Error(ErrorCode::device, work, "a limit of " + text_of(address_limit()) + " on addresses (ulimit -v)",
              text_of(need) + " or more");
}

}  // namespace dermis::exr
