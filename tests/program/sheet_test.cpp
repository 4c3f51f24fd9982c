// dermis sheet: one picture under several profiles and widths.
#include <OpenImageIO/imagebuf.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using Words = std::vector<std::string>;

namespace {

// Cells of a sheet of 60 x 60 pictures.
constexpr int cell_px = 240;
constexpr int title_px = 30;

/// A frame whose unit is `mm_per_unit` times that of the scene.
Words sheet_words(const MadeScene& scene, const std::string& output, double mm_per_unit, const Words& more) {
  Words words{"sheet", scene.path, "-o", output, "--quality", "draft"};
  words.insert(words.end(), scene.camera.begin(), scene.camera.end());
  for (std::size_t i = 0; i + 1 < words.size(); ++i)
    if (words[i] == "--mm-per-unit") words[i + 1] = std::to_string(mm_per_unit * std::stod(words[i + 1]));
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// The pictures of a sheet, without titles, row by row.
std::vector<std::vector<float>> cells_of(const std::string& path, int columns, int rows) {
  OIIO::ImageBuf sheet(path);
  REQUIRE(sheet.read(0, 0, true, OIIO::TypeDesc::FLOAT));
  REQUIRE(sheet.spec().width == columns * cell_px);
  REQUIRE(sheet.spec().height == rows * (cell_px + title_px));
  std::vector<std::vector<float>> cells;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      std::vector<float>& cell = cells.emplace_back();
      for (int y = title_px + 10; y < cell_px; ++y) {
        for (int x = 10; x < cell_px - 10; ++x)
          for (int c = 0; c < 3; ++c)
            cell.push_back(sheet.getchannel(column * cell_px + x, row * (cell_px + title_px) + y, 0, c));
      }
    }
  }
  return cells;
}

}  // namespace

TEST_CASE("a sheet has a row for each profile and a column for each width") {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) return;
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 60, 60, 8);
  const std::string sheet = folder / "sheet.png";
  const Words profiles{"--material", "1=skin", "--profiles", "burley:0.5/0.4/0.3", "marble"};
  Words both = profiles;
  both.insert(both.end(), {"--widths", "1", "2"});
  run_well(sheet_words(scene, sheet, 1, both));
  const auto cells = cells_of(sheet, 3, 2);
  const auto& [plain, burley, burley_2, nothing, marble, marble_2] =
      std::tie(cells[0], cells[1], cells[2], cells[3], cells[4], cells[5]);
  CHECK((plain != burley));
  CHECK((burley != burley_2));
  CHECK((burley != marble));
  CHECK((marble != marble_2));
  CHECK((nothing == std::vector<float>(nothing.size(), 1)));

  // Kernels of twice the width are those of a scene of half the size.
  const std::string small = folder / "small.png";
  Words half = profiles;
  half.insert(half.end(), {"--widths", "0.5", "1"});
  run_well(sheet_words(scene, small, 0.5, half));
  CHECK((cells_of(small, 3, 2) == cells));

  // With one width profiles fill a square.
  const std::string square = folder / "square.png";
  run_well(sheet_words(scene, square, 1, profiles));
  CHECK((cells_of(square, 2, 2)[3] == nothing));
}

TEST_CASE("a sheet that cannot be drawn is refused before the work") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4);
  const auto refuses = [&](const Words& more, int code, const Words& parts) {
    Words words = sheet_words(scene, folder / "sheet.png", 1, {"--material", "1=skin"});
    words.insert(words.end(), more.begin(), more.end());
    check_refused(run_program(words), code, parts);
    CHECK_FALSE(std::filesystem::exists(folder / "sheet.png"));
  };
  refuses({"--widths", "0"}, 2, {"--widths", "0.01 to 100"});
  refuses({"--widths", "nan"}, 2, {"--widths"});
  refuses({"--profiles", "nosuch"}, 2, {"--profiles: got nosuch"});
  Words many{"--widths"};
  many.insert(many.end(), 101, "1");
  refuses(many, 2, {"--widths: got 101 pictures", "at most 100"});
  check_refused(run_program(sheet_words(scene, folder / "sheet.png", 1, {"--material", "1=skin"}),
                            {"PATH=" + (folder / "nosuch")}),
                6, {"--output", "gnuplot"});
}
