#include "arguments/design_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <string_view>
#include <utility>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"

namespace dermis::program {
namespace {

constexpr int most_taps = 2047;

using Words = std::vector<std::pair<std::string_view, int>>;

/// The words that an option takes in place of a number, and the numbers that stand for them.
Words words_for_counts(bool or_dense, bool or_auto) {
  Words words;
  if (or_dense) words.emplace_back("dense", DesignArguments::dense);
  if (or_auto) words.emplace_back("auto", DesignArguments::automatic);
  return words;
}

std::string text_of_count(int count) {
  for (const auto& [word, value] : words_for_counts(true, true))
    if (value == count) return std::string(word);
  return std::to_string(count);
}

/// The number or the word; none if it is neither, or a number that is not allowed.
std::optional<int> parse_count(const std::string& text, const Words& words, const std::function<bool(int)>& allowed) {
  for (const auto& [word, value] : words)
    if (word == text) return value;
  const auto number = parse_whole(text);
  if (!number || *number < 1 || *number > most_taps || !allowed(static_cast<int>(*number))) return std::nullopt;
  return static_cast<int>(*number);
}

/// Adds an option that takes a number or one of the words; `wanted` says which numbers.
void add_count(CLI::App& app, const std::string& option, std::optional<int>& target, const std::string& help,
               const Words& words, std::function<bool(int)> allowed, std::string wanted, int otherwise) {
  std::string type = "N";
  for (const auto& [word, value] : words) {
    type += fmt::format("|{}", word);
    wanted += fmt::format(" or {}", word);
  }
  const auto parse = [words, allowed = std::move(allowed)](const std::string& text) {
    return parse_count(text, words, allowed);
  };
  const CLI::Validator check(
      [parse, wanted](const std::string& text) { return parse(text) ? std::string{} : refusal(text, wanted); }, "");
  app.add_option_function<std::string>(
         option, [parse, &target](const std::string& text) { target = parse(text); }, help)
      ->check(check)
      ->type_name(type)
      ->default_str(text_of_count(otherwise));
}

}  // namespace

std::string command_text(const TapsDesign& design) {
  std::string text = fmt::format(" --model {}", name_of(design.model));
  if (design.rank > 0) text += fmt::format(" --rank {}", design.rank);
  if (design.tolerance == 0) text += fmt::format(" --taps {}", design.count);
  text += fmt::format(" --placement {}", name_of(design.placement));
  if (design.model == Model::guided) text += fmt::format(" --guide {}", design.guide);
  if (design.non_negative) text += " --non-negative";
  return text;
}

void add_design_arguments(CLI::App& app, DesignArguments& arguments) {
  const bool or_auto = arguments.may_be_automatic;
  const TapsDesign& defaults = arguments.defaults;
  add_word(app, "--model", arguments.model,
           "the products of one-dimensional functions that stand for the profile: pre-integrated, artist or guided "
           "(Jimenez et al. 2015), svd, gaussians, or optimised for natural images",
           defaults.model);
  add_count(
      app, "--rank", arguments.rank,
      fmt::format("how many products: 1..6 for svd and gaussians, 1..3 for optimised, 1 for the others{}",
                  or_auto ? "; auto: as few as are good enough" : ""),
      words_for_counts(false, or_auto), [](int rank) { return rank <= 6; },
      "a whole number from 1 to 6, as the model allows", or_auto ? DesignArguments::automatic : defaults.rank);
  add_count(
      app, "--taps", arguments.taps,
      fmt::format("taps per pass, odd; dense: one on every pixel{}",
                  or_auto ? "; auto: for each width of kernel as few as are good enough" : ""),
      words_for_counts(true, or_auto), [](int taps) { return taps >= 3 && taps % 2 == 1; },
      fmt::format("an odd number from 3 to {}", most_taps), or_auto ? DesignArguments::automatic : defaults.count);
  add_word(app, "--placement", arguments.placement,
           "where taps lie: uniform, importance (the same light each), quadratic or optimised (up to 65 taps; more lie "
           "as by importance)",
           defaults.placement);
  app.add_option("--guide", arguments.guide,
                 fmt::format("--model guided: from 0, sharper, to 4, smoother; {} if not given", defaults.guide))
      ->check(real_number([](double guide) { return guide >= 0 && guide <= 4; }, "a number from 0 to 4"));
  app.add_flag("--non-negative", arguments.non_negative,
               "--model optimised, --rank 2 or 3: keep the approximated profile above zero, for a little error");
}

std::string first_given(const DesignArguments& arguments) {
  if (arguments.taps) return "--taps " + text_of_count(*arguments.taps);
  if (arguments.rank) return "--rank " + text_of_count(*arguments.rank);
  if (arguments.model) return fmt::format("--model {}", name_of(*arguments.model));
  if (arguments.placement) return fmt::format("--placement {}", name_of(*arguments.placement));
  if (arguments.guide) return fmt::format("--guide {}", *arguments.guide);
  return arguments.non_negative ? "--non-negative" : "";
}

TapsDesign design_of(const DesignArguments& arguments, double tolerance) {
  TapsDesign design = arguments.defaults;
  design.model = arguments.model.value_or(design.model);
  design.placement = arguments.placement.value_or(design.placement);
  if (highest_rank(design.model) == 1) design.rank = 1;
  if (tolerance > 0) design = design_within(tolerance, design);
  if (arguments.rank.value_or(DesignArguments::automatic) != DesignArguments::automatic) design.rank = *arguments.rank;
  const int taps = arguments.taps.value_or(DesignArguments::automatic);
  if (taps != DesignArguments::automatic) design.count = taps == DesignArguments::dense ? most_taps : taps;
  if (arguments.guide) {
    if (design.model != Model::guided)
      throw Error(ErrorCode::usage, "--guide",
                  fmt::format("{} for --model {}", *arguments.guide, name_of(design.model)), "--model guided with it");
    design.guide = *arguments.guide;
  }
  design.non_negative = arguments.non_negative;
  if (design.non_negative && (design.model != Model::optimised || design.rank == 1))
    throw Error(ErrorCode::usage, "--non-negative",
                fmt::format("--model {}, --rank {}", name_of(design.model), design.rank),
                "--model optimised and --rank 2 or 3 with it");
  return design;
}

Error named_as_option(const Error& error) {
  constexpr std::array<std::string_view, 5> arguments = {"rank", "taps", "guide", "pixel_mm", "tolerance"};
  if (std::find(arguments.begin(), arguments.end(), error.argument()) == arguments.end()) return error;
  std::string option = "--" + std::string(error.argument());
  std::replace(option.begin(), option.end(), '_', '-');
  return {error.code(), option, error.seen(), error.wanted()};
}

}  // namespace dermis::program
