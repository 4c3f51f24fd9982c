// dermis warm: what a job of the filter needs before it can begin, made ahead.
#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arguments/help.hpp"
#include "commands/commands.hpp"
#include "commands/filter_job.hpp"
#include "commands/filter_session.hpp"
#include "commands/input_report.hpp"
#include "commands/surface_input.hpp"
#include "dermis/error.hpp"
#include "files/picture_roles.hpp"
#include "report/messages.hpp"
#include "report/standard_output.hpp"
#include "report/stopwatch.hpp"

namespace dermis::program {
namespace {

struct WarmArguments {
  std::vector<std::string> inputs;
  FilterArguments filter;
  bool reuse = false;
};

/// Refuses what only a picture can tell more about.
void check_inputs(const WarmArguments& arguments) {
  if (!arguments.inputs.empty()) return;
  const bool is_translucent = arguments.filter.surface.translucency.wanted;
  if (!arguments.reuse && !is_translucent) return;
  throw Error(ErrorCode::usage, is_translucent ? "--translucency" : "--reuse", "no picture",
              "a picture like those that will be filtered");
}

/// Frames as Blender and Cycles write them.
FrameDescription usual_frames(const SurfaceRequest& surface) {
  return {.depth = true,
          .material = have_ids(surface.profiles),
          .mask = false,
          .albedo = true,
          .matte = !surface.mattes.empty(),
          .normal = surface.curvature && any_walk(surface.profiles),
          .views = !surface.views.empty()};
}

/// Plans for a picture, and runs what else the filter would: all but the plan's own first launches.
void warm_for(const std::string& path, const FilterJob& job, FilterSession& session) {
  Messages messages(job.messages);
  messages.begin(path);
  exr::Picture picture = read_picture(path);
  SurfaceInput input =
      load_surface(picture, frame_file(path), views_of(picture, job.surface.picture).front(), job.surface, false);
  warn_of_input(input.roles, input.camera, messages);
  Frame frame = input.frame(job.surface.mm_per_unit);
  const ChosenTaps taps = taps_of(job, count_pixels(input, job.surface, messages), input.lighting);
  transmit_light(session.device(), job.surface, frame, input);
  session.plan(taps, FrameDescription::of(frame));
  if (!job.reuse) return;
  std::vector<float> scattered(input.loaded.light.size());
  frame.scattered = {.host = scattered.data()};
  session.run(frame, {});
}

int run_warm(const WarmArguments& arguments) {
  check_inputs(arguments);
  Stopwatch stopwatch;
  FilterJob job = job_of(arguments.filter);
  job.reuse = arguments.reuse;
  FilterSession session(job.device, job.reuse);
  try {
    for (const std::string& input : arguments.inputs) warm_for(input, job, session);
    if (arguments.inputs.empty()) {
      const std::vector<MaterialPixels> unknown(job.surface.profiles.size());
      session.plan(taps_of(job, unknown, job.surface.lighting.value_or(Lighting::raw)), usual_frames(job.surface));
    }
  } catch (const Error& error) {
    throw named_as_option(error);
  }
  const std::string& folder = job.options.cache_folder;
  const bool is_kept = can_keep_taps(folder);
  print(fmt::format("ready after {:.2f} s: kernels for {}; {}\n", stopwatch.lap_ms() / 1000,
                    session.device().info().name, is_kept ? "taps in " + folder : "taps are kept nowhere"));
  return 0;
}

}  // namespace

Command add_warm(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand(
      "warm", "compile and fit ahead what `filter` with the same options needs, so that it starts at once");
  const auto arguments = std::make_shared<WarmArguments>();
  {
    const HelpGroup group(*app, "Usual options");
    app->add_option("file", arguments->inputs,
                    "pictures like those that will be filtered: of the same channels, with materials as far away; "
                    "without one, frames are as Blender writes them, of any size")
        ->type_name("FILE");
    app->add_flag("--reuse", arguments->reuse, "also what `filter --reuse` needs");
  }
  add_job_arguments(*app, arguments->filter);
  return {app, [arguments] { return run_warm(*arguments); }};
}

}  // namespace dermis::program
