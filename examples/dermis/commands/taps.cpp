// dermis taps: a profile made discrete, and how far off that is.
#include "dermis/taps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arguments/design_arguments.hpp"
#include "arguments/help.hpp"
#include "arguments/number_argument.hpp"
#include "arguments/profile_argument.hpp"
#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "dermis/error.hpp"
#include "files/output_file.hpp"
#include "report/standard_output.hpp"
#include "report/taps_plot.hpp"
#include "report/taps_report.hpp"
#include "report/taps_source.hpp"

namespace dermis::program {
namespace {

struct TapsArguments {
  std::string profile;
  DesignArguments design;
  Fetch fetch = Fetch::integer;
  double pixel_mm = 0.25;
  std::string json;
  std::string csv;
  std::optional<Language> language;
  std::string output;
  std::string plot;
};

/// The files of the command line, some without a name. Source code that has no file is printed.
std::vector<NamedFile> outputs_of(const TapsArguments& arguments) {
  std::vector<NamedFile> outputs = {
      {"--json", arguments.json}, {"--csv", arguments.csv}, {"--plot", arguments.plot}, {"--output", arguments.output}};
  if (arguments.language && arguments.output.empty()) outputs.back() = {"--export", "-"};
  return outputs;
}

void check_outputs_of(const TapsArguments& arguments) {
  if (!arguments.output.empty() && !arguments.language)
    throw Error(ErrorCode::usage, "--output", arguments.output, "--export c, glsl or hlsl with it");
  std::vector<NamedFile> taken;
  const std::size_t colon = arguments.profile.find(':');
  if (colon != std::string::npos && colon + 1 < arguments.profile.size())
    taken.push_back({"the profile", arguments.profile.substr(colon + 1)});
  check_outputs(taken, outputs_of(arguments));
}

bool is_on_every_pixel(const std::vector<double>& offsets_px) {
  for (std::size_t i = 1; i < offsets_px.size(); ++i)
    if (offsets_px[i] != offsets_px[i - 1] + 1) return false;
  return true;
}

TapSet make_set(const TapsArguments& arguments, const Profile& profile, const TapsDesign& design) {
  const bool dense = arguments.design.taps == DesignArguments::dense;
  const int most_px = design.count / 2;
  const auto check = [&](bool fits, double radius_px) {
    if (dense && !fits)
      throw Error(
          ErrorCode::usage, "--taps", "dense",
          fmt::format("a kernel of at most {} pixels radius; with --pixel-mm {} this one has {:.0f} pixels or more",
                      most_px, arguments.pixel_mm, radius_px));
  };
  // No design looks less far than this.
  const double radius_px = profile.half_width(profile.widest_channel(), 0.999) / arguments.pixel_mm;
  check(radius_px < most_px + 1, radius_px);
  try {
    TapSet set = make_tap_set(profile, design, arguments.pixel_mm, arguments.fetch);
    check(is_on_every_pixel(set.offsets_px), most_px + 1);
    return set;
  } catch (const Error& error) {
    throw error.code() == ErrorCode::usage ? named_as_option(error) : error;
  }
}

int run_taps(const TapsArguments& arguments) {
  const TapsDesign design = design_of(arguments.design);
  const Profile profile = parse_profile("PROFILE", arguments.profile);
  check_outputs_of(arguments);
  TapsReport report{.profile = without_folders(arguments.profile),
                    .design = design,
                    .width_follows_albedo = profile.width_follows_albedo(),
                    .set = make_set(arguments, profile, design)};
  if (!arguments.plot.empty()) plot_taps("--plot", arguments.plot, profile, design, report);
  write_text_or_print("--json", arguments.json, json_text_of(report));
  write_text_or_print("--csv", arguments.csv, csv_of(report));
  if (arguments.language)
    write_text_or_print("--output", arguments.output.empty() ? "-" : arguments.output,
                        source_of(report, *arguments.language));
  const std::vector<NamedFile> outputs = outputs_of(arguments);
  if (std::none_of(outputs.begin(), outputs.end(), [](const NamedFile& output) { return output.path == "-"; }))
    print(table_of(report));
  return 0;
}

void add_taps_arguments(CLI::App& app, TapsArguments& arguments) {
  {
    const HelpGroup group(app, "Design");
    app.add_option("profile", arguments.profile, "what to make discrete, see below")->required()->type_name("PROFILE");
    app.add_option("--pixel-mm", arguments.pixel_mm, "size of a pixel on the surface, mm")
        ->check(real_number([](double mm) { return mm >= 1e-12 && mm <= 1e12; }, "a size in mm, 1e-12..1e12"))
        ->capture_default_str();
    add_design_arguments(app, arguments.design);
    add_word(app, "--fetch", arguments.fetch, "how taps read: integer, whole pixels only, or linear, between two");
  }
  const HelpGroup group(app, "Results");
  app.add_option("--json", arguments.json,
                 "write profile, model, rank, taps, fetch, pixel_mm, predicted_rel_l2, offsets_px and terms: scale and "
                 "weights per offset, [R, G, B] each; - is standard output, in place of the table")
      ->type_name("FILE");
  app.add_option("--csv", arguments.csv,
                 "write a row per term and offset: offset_px,term,R,G,B,scale_R,scale_G,scale_B, in which R,G,B are "
                 "weights and terms count from 1; - is standard output, in place of the table")
      ->type_name("FILE");
  add_word(app, "--export", arguments.language, "write source code", Language::c)->default_str("");
  app.add_option("-o,--output", arguments.output, "file of the source code; else it is printed, not the table")
      ->type_name("FILE");
  app.add_option("--plot", arguments.plot,
                 "draw slices of kernel and profile, singular values, step response and weights; needs gnuplot")
      ->check(file_name_ending({".svg", ".png"}))
      ->type_name("FILE.svg|png");
}

}  // namespace

Command add_taps(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("taps", "the taps of a profile, and how far off they are");
  const auto arguments = std::make_shared<TapsArguments>();
  add_taps_arguments(*app, *arguments);
  app->footer(profile_grammar());
  return {app, [arguments] { return run_taps(*arguments); }};
}

}  // namespace dermis::program
