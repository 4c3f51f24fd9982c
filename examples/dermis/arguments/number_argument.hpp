/// Numbers on the command line. What a check refuses reads "--name: got SEEN, want WANTED".
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace dermis::program {

/// The whole of `text` as a finite number, in any locale; nothing if it is anything else.
std::optional<double> parse_real(std::string_view text);

/// The whole of `text` as a decimal integer; nothing if it is anything else.
std::optional<std::int64_t> parse_whole(std::string_view text);

CLI::Validator real_number(std::function<bool(double)> allowed, std::string wanted);
CLI::Validator whole_number(std::function<bool(std::int64_t)> allowed, std::string wanted);
CLI::Validator number_above_zero(std::string_view what);
CLI::Validator number_0_to_1();

/// Adds --seed.
void add_seed_argument(CLI::App& app, std::uint32_t& seed);

}  // namespace dermis::program
