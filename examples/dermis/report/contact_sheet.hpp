/// Pictures of one size in rows, each with a title.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::program {

/// A cell of a sheet. One without a picture stays empty.
struct SheetCell {
  std::string title;
  std::string png;
};

/// Draws cells of width x height pixels row by row, with gnuplot; wide ones smaller. `argument` is named in errors.
/// Throws Error(output).
void draw_sheet(std::string_view argument, const std::filesystem::path& path, int width, int height, int columns,
                const std::vector<SheetCell>& cells);

}  // namespace dermis::program
