#include "arguments/design_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"

namespace dermis::program {
namespace {

constexpr std::string_view automatic = "auto";
constexpr int most_taps = 2047;

bool is_number_of_taps(std::int64_t taps) { return taps >= 3 && taps <= most_taps && taps % 2 == 1; }

CLI::Validator taps_or_dense(bool or_auto) {
  return {[or_auto](const std::string& text) {
            const auto taps = parse_whole(text);
            const bool good = text == "dense" || (or_auto && text == automatic) || (taps && is_number_of_taps(*taps));
            return good ? std::string{}
                        : refusal(text, fmt::format("an odd number from 3 to {} or dense{}", most_taps,
                                                    or_auto ? " or auto" : ""));
          },
          ""};
}

CLI::Validator rank_of_any_model(bool or_auto) {
  return {[or_auto](const std::string& text) {
            const auto rank = parse_whole(text);
            const bool good = (or_auto && text == automatic) || (rank && *rank >= 1 && *rank <= 6);
            return good ? std::string{}
                        : refusal(text, fmt::format("a whole number from 1 to 6, as the model allows{}",
                                                    or_auto ? ", or auto" : ""));
          },
          ""};
}

template <typename Value>
using Named = std::pair<std::string_view, Value>;

constexpr std::array<Named<Model>, 6> models = {{{"pre-integrated", Model::pre_integrated},
                                                 {"artist", Model::artist},
                                                 {"guided", Model::guided},
                                                 {"svd", Model::svd},
                                                 {"gaussians", Model::gaussians},
                                                 {"optimised", Model::optimised}}};

constexpr std::array<Named<Placement>, 4> placements = {{{"uniform", Placement::uniform},
                                                         {"importance", Placement::importance},
                                                         {"quadratic", Placement::quadratic},
                                                         {"optimised", Placement::optimised}}};

/// The name is one of them: the option checks that.
template <typename Value, std::size_t count>
Value value_of(const std::array<Named<Value>, count>& names, std::string_view name) {
  for (const auto& [known, value] : names)
    if (known == name) return value;
  return names.front().second;
}

template <typename Value, std::size_t count>
std::string_view name_in(const std::array<Named<Value>, count>& names, Value value) {
  for (const auto& [name, known] : names)
    if (known == value) return name;
  return {};
}

}  // namespace

std::string_view name_of(Model model) { return name_in(models, model); }
std::string_view name_of(Placement placement) { return name_in(placements, placement); }

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
  app.add_option("--model", arguments.model,
                 "the products of one-dimensional functions that stand for the profile: pre-integrated, artist or "
                 "guided (Jimenez et al. 2015), svd, gaussians, or optimised for natural images")
      ->check(one_of({"pre-integrated", "artist", "guided", "svd", "gaussians", "optimised"}))
      ->default_str(std::string(name_of(arguments.defaults.model)));
  const bool or_auto = arguments.may_be_automatic;
  app.add_option("--rank", arguments.rank,
                 fmt::format("how many products: 1..6 for svd and gaussians, 1..3 for optimised, 1 for the others{}",
                             or_auto ? "; auto: as few as are good enough" : ""))
      ->check(rank_of_any_model(or_auto))
      ->type_name(or_auto ? "N|auto" : "N")
      ->default_str(or_auto ? std::string(automatic) : std::to_string(arguments.defaults.rank));
  app.add_option("--taps", arguments.taps,
                 fmt::format("taps per pass, odd; dense: one on every pixel{}",
                             or_auto ? "; auto: for each width of kernel as few as are good enough" : ""))
      ->check(taps_or_dense(or_auto))
      ->type_name(or_auto ? "N|dense|auto" : "N|dense")
      ->default_str(or_auto ? std::string(automatic) : std::to_string(arguments.defaults.count));
  app.add_option("--placement", arguments.placement,
                 "where taps lie: uniform, importance (the same light each), quadratic or optimised (up to 65 taps; "
                 "more lie as by importance)")
      ->check(one_of({"uniform", "importance", "quadratic", "optimised"}))
      ->default_str(std::string(name_of(arguments.defaults.placement)));
  app.add_option(
         "--guide", arguments.guide,
         fmt::format("--model guided: from 0, sharper, to 4, smoother; {} if not given", arguments.defaults.guide))
      ->check(real_number([](double guide) { return guide >= 0 && guide <= 4; }, "a number from 0 to 4"));
  app.add_flag("--non-negative", arguments.non_negative,
               "--model optimised, --rank 2 or 3: keep the approximated profile above zero, for a little error");
}

std::string first_given(const DesignArguments& arguments) {
  if (arguments.taps) return "--taps " + *arguments.taps;
  if (arguments.rank) return "--rank " + *arguments.rank;
  if (arguments.model) return "--model " + *arguments.model;
  if (arguments.placement) return "--placement " + *arguments.placement;
  if (arguments.guide) return fmt::format("--guide {}", *arguments.guide);
  return arguments.non_negative ? "--non-negative" : "";
}

bool asks_for_automatic(const DesignArguments& arguments) {
  return arguments.rank == automatic || arguments.taps == automatic;
}

TapsDesign design_of(const DesignArguments& arguments, double tolerance) {
  // Beyond so many, the kernel is wide and the fit slow; `chosen_designs` takes more where they are needed.
  constexpr int most_automatic_taps = 33;
  TapsDesign design = arguments.defaults;
  design.tolerance = tolerance;
  if (arguments.model) design.model = value_of(models, *arguments.model);
  if (arguments.placement) design.placement = value_of(placements, *arguments.placement);
  if (highest_rank(design.model) == 1) design.rank = 1;
  if (tolerance > 0) {
    design.rank = 0;
    design.count = most_automatic_taps;
  }
  if (arguments.rank && arguments.rank != automatic) design.rank = static_cast<int>(*parse_whole(*arguments.rank));
  if (arguments.taps == "dense") {
    design.count = most_taps;
  } else if (arguments.taps && arguments.taps != automatic) {
    design.count = static_cast<int>(*parse_whole(*arguments.taps));
  }
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
  constexpr std::string_view before_seen = ": got ";
  constexpr std::string_view before_wanted = ", want ";
  const std::string_view line = error.what();
  const std::size_t seen = line.find(before_seen);
  const std::size_t wanted = line.rfind(before_wanted);
  if (seen == std::string_view::npos || wanted == std::string_view::npos || wanted < seen) return error;
  const std::string_view argument = line.substr(0, seen);
  constexpr std::array<std::string_view, 5> arguments = {"rank", "taps", "guide", "pixel_mm", "tolerance"};
  if (std::find(arguments.begin(), arguments.end(), argument) == arguments.end()) return error;
  std::string option = "--" + std::string(argument);
  std::replace(option.begin(), option.end(), '_', '-');
  const std::size_t seen_at = seen + before_seen.size();
  return {error.code(), option, line.substr(seen_at, wanted - seen_at), line.substr(wanted + before_wanted.size())};
}

}  // namespace dermis::program
