/// The subcommands, one per file.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace dermis::program {

/// A subcommand: how the command line names it, and what it does. `run` returns the exit code.
struct Command {
  CLI::App* app;
  std::function<int()> run;
};

Command add_filter(CLI::App& parent);
Command add_texture(CLI::App& parent);
Command add_compare_methods(CLI::App& parent);
Command add_sheet(CLI::App& parent);
Command add_light(CLI::App& parent);
Command add_info(CLI::App& parent);
Command add_warm(CLI::App& parent);
Command add_devices(CLI::App& parent);
Command add_profiles(CLI::App& parent);
Command add_taps(CLI::App& parent);
Command add_compare(CLI::App& parent);
Command add_preview(CLI::App& parent);
Command add_scene(CLI::App& parent);
Command add_submit(CLI::App& parent);
Command add_completion(CLI::App& parent);

}  // namespace dermis::program
