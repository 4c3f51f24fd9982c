// The program but for main(): it reads the command line, runs one subcommand, and turns errors into exit codes.
#include "commands/run.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <string_view>

#include "arguments/config_file.hpp"
#include "arguments/help.hpp"
#include "arguments/memory_argument.hpp"
#include "commands/commands.hpp"
#include "dermis/error.hpp"
#include "dermis/version.hpp"
#include "exr/temporary_file.hpp"
#include "files/pocl_cache.hpp"
#include "report/messages.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

int fail(ErrorCode code, std::string_view message) {
  print_error(message);
  return static_cast<int>(code);
}

int finish(int code) {
  const auto problem = output_problem();
  if (!problem) return code;
  return fail(ErrorCode::output, Error(ErrorCode::output, "standard output", *problem, "all of it out").what());
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
      "5 role or camera missing, 6 output, 7 device, 8 some pictures of several failed.");
  wrap_help(app);
  const std::array commands{add_filter(app),  add_texture(app),    add_light(app), add_info(app),
                            add_warm(app),    add_profiles(app),   add_taps(app),  add_compare_methods(app),
                            add_compare(app), add_preview(app),    add_scene(app), add_devices(app),
                            add_submit(app),  add_completion(app), add_sheet(app)};
  for (const char* name :
       {"filter", "texture", "light", "info", "warm", "compare-methods", "sheet", "compare", "preview"})
    add_memory_argument(*app.get_subcommand(name));
  if (argc > 1 && argv[1][0] != '-') check_command(app, argv[1]);
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && words.front()[0] != '-') {
    const std::vector<std::string> rest(words.begin() + 1, words.end());
    const std::vector<std::string> all = with_config(*app.get_subcommand(words.front()), rest);
    words.resize(1);
    words.insert(words.end(), all.begin(), all.end());
  }
  std::reverse(words.begin(), words.end());  // as CLI11 takes a vector
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return finish(app.exit(error));  // --help, --version
    return fail(ErrorCode::usage, error.what());
  }
  const auto chosen =
      std::find_if(commands.begin(), commands.end(), [](const Command& command) { return command.app->parsed(); });
  choose_cache();
  return finish(chosen->run());
}

/// A library that ends the process, as PoCL's compiler does when its cache is full, ends it with a code of its own: 1,
/// which says that pictures differ.
bool is_running = false;

void end_of_process() {
  if (!is_running) return;
  const Error error(ErrorCode::device, "OpenCL", "an end of the process by its driver; " + cache_problem().value_or(""),
                    "room in the cache, or POCL_CACHE_DIR=FOLDER elsewhere");
  fail(error.code(), error.what());
  mark_crash();
  _exit(static_cast<int>(ErrorCode::device));
}

void end_by_signal(int number) {
  exr::remove_temporary_files();
  raise(number);  // whose handler was reset to that of the system
}

void note_crash(int number) {
  mark_crash();
  raise(number);
}

/// A stream that the caller has closed would become that of the next file that is opened. Writing to it fails.
void fill_closed_streams() {
  for (int file = open("/dev/null", O_RDONLY); file >= 0; file = open("/dev/null", O_RDONLY)) {
    if (file <= STDERR_FILENO) continue;
    close(file);
    break;
  }
}

int parse_and_run_safely(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (...) {
    return report_exception().code;
  }
}

}  // namespace

void handle_signals() {
  const auto handle = [](std::initializer_list<int> numbers, void (*handler)(int)) {
    for (const int number : numbers) {
      struct sigaction before = {};
      sigaction(number, nullptr, &before);
      if (before.sa_handler != SIG_DFL) continue;
      struct sigaction action = {};
      action.sa_handler = handler;
      action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_NODEFER;
      sigaction(number, &action, nullptr);
    }
  };
  handle({SIGHUP, SIGINT, SIGTERM}, end_by_signal);
  handle({SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT}, note_crash);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

int run(int argc, char** argv) {
  // PoCL would otherwise hide integer divisions by zero of the host program. It reads this at the first OpenCL call.
  setenv("POCL_SIGFPE_HANDLER", "0", 0);
  fill_closed_streams();
  handle_signals();
  std::atexit(end_of_process);
  is_running = true;
  const int code = parse_and_run_safely(argc, argv);
  is_running = false;
  close_cache();
  return code;
}

}  // namespace dermis::program
