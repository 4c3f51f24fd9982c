#include "report/gnuplot.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "dermis/error.hpp"

namespace dermis::bench {

void need_gnuplot(std::string_view option) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
    throw Error(ErrorCode::output, option, "no gnuplot", "gnuplot on the PATH");
  }
}

std::string gnuplot_string(std::string_view text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

void draw_svg(std::string_view option, const std::filesystem::path& path, int width_px, int height_px,
              const std::string& script) {
  need_gnuplot(option);
  const std::string whole = fmt::format(
      "set terminal svg size {},{} dynamic background 'white' font 'Helvetica,14'\nset output {}\n{}\nunset output\n",
      width_px, height_px, gnuplot_string(path.string()), script);
  const auto before = std::signal(SIGPIPE, SIG_IGN);  // if gnuplot ends early, its exit status tells
  std::FILE* gnuplot = popen("gnuplot", "w");
  if (gnuplot != nullptr) std::fwrite(whole.data(), 1, whole.size(), gnuplot);
  const int status = gnuplot != nullptr ? pclose(gnuplot) : -1;
  std::signal(SIGPIPE, before);
  if (status != 0) throw Error(ErrorCode::output, option, path.string(), "gnuplot to draw it");
}

}  // namespace dermis::bench
