#include "report/contact_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <deque>

#include "report/gnuplot.hpp"

namespace dermis::program {

void draw_sheet(std::string_view argument, const std::filesystem::path& path, int width, int height, int columns,
                const std::vector<SheetCell>& cells) {
  constexpr int least_px = 240;
  constexpr int most_px = 480;
  constexpr int title_px = 30;
  std::deque<FileInMemory> files;
  std::string plots;
  for (const SheetCell& cell : cells) {
    if (cell.png.empty()) {
      plots += "set multiplot next\n";
      continue;
    }
    plots += fmt::format("set title {} offset 0,-0.8\nplot {} binary filetype=png with rgbimage notitle\n",
                         script_string(cell.title), script_string(files.emplace_back(cell.png).name()));
  }
  const int rows = (static_cast<int>(cells.size()) + columns - 1) / columns;
  const int cell_px = std::clamp(width, least_px, most_px);
  const std::string script = fmt::format(
      "unset tics\nunset border\nunset key\nset size ratio -1\nset margins 0.5,0.5,0.2,1.6\n"
      "set xrange [0:{}]\nset yrange [0:{}]\nset multiplot layout {},{}\n{}unset multiplot\n",
      width - 1, height - 1, rows, columns, plots);
  draw_figure(argument, path, {columns * cell_px, rows * (cell_px * height / width + title_px)}, script);
}

}  // namespace dermis::program
