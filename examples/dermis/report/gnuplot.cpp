#include "report/gnuplot.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "dermis/error.hpp"
#include "files/output_file.hpp"

namespace dermis::program {
namespace {

std::string header(const std::filesystem::path& output, bool svg, const FigureSize& size) {
  return fmt::format("set terminal {} size {},{} {}\nset output {}\n", svg ? "svg background 'white'" : "pngcairo",
                     size.width_px, size.height_px, size.terminal_options, script_string(output.string()));
}

void run_gnuplot(std::string_view argument, const std::string& script) {
  need_gnuplot(argument);
  const auto before = std::signal(SIGPIPE, SIG_IGN);  // if gnuplot ends early, its exit status tells
  std::FILE* pipe = popen("gnuplot", "w");
  if (pipe != nullptr) std::fwrite(script.data(), 1, script.size(), pipe);
  const int status = pipe != nullptr ? pclose(pipe) : -1;
  std::signal(SIGPIPE, before);
  if (status != 0)
    throw Error(ErrorCode::output, argument, fmt::format("exit status {} from gnuplot", status), "a plot");
}

}  // namespace

void need_gnuplot(std::string_view argument) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    throw Error(ErrorCode::output, argument, "no gnuplot", "gnuplot on the PATH");
}

std::string script_string(std::string_view text) {
  std::string result(1, '\'');
  for (const char c : text) {
    if (c == '\'') result.push_back(c);
    result.push_back(c);
  }
  result.push_back('\'');
  return result;
}

void draw_figure(std::string_view argument, const std::filesystem::path& path, const FigureSize& size,
                 const std::string& script) {
  if (path.string().find('\n') != std::string::npos)
    throw Error(ErrorCode::usage, argument, path.string(), "a file name without line ends");
  TemporaryFile temporary(path, argument);
  const bool svg = path.extension() != ".png" && path.extension() != ".PNG";
  run_gnuplot(argument, header(temporary.path(), svg, size) + script + "unset output\n");
  temporary.commit();
}

}  // namespace dermis::program
