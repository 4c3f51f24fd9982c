// The program but for main(): it reads the command line, runs one subcommand, and turns errors into exit codes.
#include "commands/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>

#include "arguments/help.hpp"
#include "commands/commands.hpp"
#include "dermis/error.hpp"
#include "dermis/version.hpp"

namespace dermis::program {
namespace {

/// Names of files and channels come from outside: nothing in them may break the line or steer the terminal.
std::string one_line(std::string_view message) {
  std::string line(message);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return line;
}

int fail(ErrorCode code, std::string_view message) {
  std::fflush(stdout);
  fmt::print(stderr, "dermis: error: {}\n", one_line(message));
  return static_cast<int>(code);
}

int finish(int code) {
  if (std::fflush(stdout) != 0)
    return fail(ErrorCode::output, "standard output: got a write error, want all of it out");
  return code;
}

/// The word where a command should stand is not one. CLI11 would only say that a command is missing.
void check_command(const CLI::App& app, std::string_view word) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == word) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw Error(ErrorCode::usage, "command", word, names);
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"dermis makes rendered surfaces translucent: it scatters the light of a G-buffer under the surface.",
               "dermis"};
  app.set_version_flag("--version", "dermis " DERMIS_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 differs (compare), 2 usage, 3 input missing, 4 input damaged or unsupported,\n"
      "5 role or camera missing, 6 output, 7 device.");
  wrap_help(app);
  const std::array commands{add_filter(app),  add_texture(app),  add_light(app), add_info(app),
                            add_warm(app),    add_profiles(app), add_taps(app),  add_compare_methods(app),
                            add_compare(app), add_preview(app),  add_scene(app), add_devices(app)};
  if (argc > 1 && argv[1][0] != '-') check_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return finish(app.exit(error));  // --help, --version
    return fail(ErrorCode::usage, error.what());
  }
  const auto chosen =
      std::find_if(commands.begin(), commands.end(), [](const Command& command) { return command.app->parsed(); });
  return finish(chosen->run());
}

}  // namespace

int run(int argc, char** argv) {
  // PoCL would otherwise hide integer divisions by zero of the host program. It reads this at the first OpenCL call.
  setenv("POCL_SIGFPE_HANDLER", "0", 0);
  try {
    return parse_and_run(argc, argv);
  } catch (const Error& error) {
    return fail(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::device, "memory: got no more from the system, want enough for the picture");
  } catch (const std::exception& error) {
    return fail(ErrorCode::device, error.what());
  }
}

}  // namespace dermis::program
