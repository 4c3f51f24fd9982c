#include "arguments/number_argument.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "arguments/word_argument.hpp"

namespace dermis::program {
namespace {

template <typename Number>
std::optional<Number> parse(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> parse_real(std::string_view text) {
  const auto value = parse<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::int64_t> parse_whole(std::string_view text) { return parse<std::int64_t>(text); }

CLI::Validator real_number(std::function<bool(double)> allowed, std::string wanted) {
  return {[allowed = std::move(allowed), wanted = std::move(wanted)](const std::string& text) {
            const auto value = parse_real(text);
            return value && allowed(*value) ? std::string{} : refusal(text, wanted);
          },
          ""};
}

CLI::Validator whole_number(std::function<bool(std::int64_t)> allowed, std::string wanted) {
  return {[allowed = std::move(allowed), wanted = std::move(wanted)](const std::string& text) {
            const auto value = parse_whole(text);
            return value && allowed(*value) ? std::string{} : refusal(text, wanted);
          },
          ""};
}

CLI::Validator number_above_zero(std::string_view what) {
  return real_number([](double value) { return value > 0; }, fmt::format("{}, a finite number > 0", what));
}

CLI::Validator number_0_to_1() {
  return real_number([](double value) { return value >= 0 && value <= 1; }, "a number from 0 to 1");
}

void add_seed_argument(CLI::App& app, std::uint32_t& seed) {
  constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
  app.add_option("--seed", seed, "of the rotation, of taps or of discs")
      ->check(whole_number([](std::int64_t number) { return number >= 0 && number <= most; },
                           fmt::format("a whole number from 0 to {}", most)))
      ->capture_default_str();
}

}  // namespace dermis::program
