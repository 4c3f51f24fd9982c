/// --memory-limit: how much memory a call may take.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "arguments/number_argument.hpp"
#include "exr/memory_limit.hpp"
#include "exr/message_text.hpp"

namespace dermis::program {

/// Bytes of "500M" or "2.5G".
inline std::optional<std::uint64_t> parse_memory(std::string_view text) {
  const double unit = text.ends_with('G') ? 1e9 : text.ends_with('M') ? 1e6 : 0;
  if (unit == 0) return std::nullopt;
  const auto number = parse_real(text.substr(0, text.size() - 1));
  if (!number || !(*number > 0 && *number <= 1e9)) return std::nullopt;
  return static_cast<std::uint64_t>(*number * unit);
}

inline void add_memory_argument(CLI::App& app) {
  const auto check = [](const std::string& text) {
    return parse_memory(text) ? std::string()
                              : "got " + exr::shown(text) + ", want megabytes or gigabytes, as 500M or 2.5G";
  };
  app.add_option_function<std::string>(
         "--memory-limit", [](const std::string& text) { exr::set_memory_limit(*parse_memory(text)); },
         "take no more memory; beside it what the cgroup, ulimit -v and free memory allow")
      ->check(check, "")
      ->type_name("SIZE")
      ->group("Device")
      ->configurable(false);
}

}  // namespace dermis::program
