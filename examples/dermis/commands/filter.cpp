// dermis filter: a picture in, the same picture with scattered light out.
#include <memory>
#include <string>
#include <utility>

#include "arguments/config_file.hpp"
#include "commands/commands.hpp"
#include "commands/dry_run.hpp"
#include "commands/filter_job.hpp"
#include "commands/filter_pictures.hpp"
#include "report/messages.hpp"

namespace dermis::program {
namespace {

int run_filter(const FilterArguments& arguments, const std::string& settings) {
  FilterJob job = job_of(arguments);
  job.settings = settings;
  Messages messages(job.messages);
  return arguments.is_dry_run ? dry_run(std::move(job), messages) : filter_pictures(job, messages);
}

}  // namespace

Command add_filter(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("filter", "scatter the light of a G-buffer under its surfaces");
  const auto arguments = std::make_shared<FilterArguments>();
  add_filter_arguments(*app, *arguments);
  return {app, [app, arguments] { return run_filter(*arguments, settings_of(*app)); }};
}

}  // namespace dermis::program
