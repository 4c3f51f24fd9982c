#include "arguments/disc_arguments.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"

namespace dermis::program {
namespace {

constexpr std::int64_t most_samples = 1024;
constexpr std::int64_t most_seeds = 65536;

CLI::Validator samples_or_auto() {
  return {[](const std::string& text) {
            const auto samples = parse_whole(text);
            const bool good = text == "auto" || (samples && *samples >= 1 && *samples <= most_samples);
            return good ? std::string{}
                        : refusal(text, fmt::format("a whole number from 1 to {} or auto", most_samples));
          },
          ""};
}

}  // namespace

void add_disc_arguments(CLI::App& app, DiscArguments& arguments) {
  app.add_option("--samples", arguments.samples,
                 "--method disc: samples per pixel; auto: 21 for kernels within 4 x 4 pixels, 55 for wide ones")
      ->check(samples_or_auto())
      ->type_name("N|auto")
      ->default_str("auto");
  app.add_option("--disc", arguments.plane,
                 "--method disc: the plane of the discs, that of the surface or of the screen")
      ->check(one_of({"tangent", "screen"}))
      ->type_name("tangent|screen")
      ->default_str("tangent");
  app.add_flag("--prefilter", arguments.prefilter,
               "--method disc: samples read the mean over as many pixels as they stand for, for less noise");
  app.add_option("--accumulate", arguments.accumulate, "--method disc: the mean of so many results, of seed after seed")
      ->check(whole_number([](std::int64_t seeds) { return seeds >= 1 && seeds <= most_seeds; },
                           fmt::format("a whole number from 1 to {}", most_seeds)))
      ->type_name("N")
      ->default_str("1");
}

std::string first_given(const DiscArguments& arguments) {
  if (arguments.samples) return "--samples " + *arguments.samples;
  if (arguments.plane) return "--disc " + *arguments.plane;
  if (arguments.accumulate) return fmt::format("--accumulate {}", *arguments.accumulate);
  return arguments.prefilter ? "--prefilter" : "";
}

DiscOptions disc_options_of(const DiscArguments& arguments) {
  DiscOptions disc;
  if (arguments.samples && arguments.samples != "auto")
    disc.samples = static_cast<int>(*parse_whole(*arguments.samples));
  disc.tangent_plane = arguments.plane != "screen";
  disc.prefiltered = arguments.prefilter;
  disc.accumulate = arguments.accumulate.value_or(disc.accumulate);
  return disc;
}

std::string command_text(const DiscOptions& disc) {
  return fmt::format(
      " --samples {} --disc {}{} --accumulate {}", disc.samples > 0 ? std::to_string(disc.samples) : "auto",
      disc.tangent_plane ? "tangent" : "screen", disc.prefiltered ? " --prefilter" : "", disc.accumulate);
}

}  // namespace dermis::program
