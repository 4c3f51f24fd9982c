// dermis filter --report FOLDER: pages to look at.
#include <OpenImageIO/imagebuf.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;

namespace {

std::string text_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Bytes of base64, by the value of each letter.
std::string decoded(std::string_view letters) {
  const auto value_of = [](char letter) -> std::uint32_t {
    if (letter >= 'A' && letter <= 'Z') return letter - 'A';
    if (letter >= 'a' && letter <= 'z') return letter - 'a' + 26;
    if (letter >= '0' && letter <= '9') return letter - '0' + 52;
    REQUIRE((letter == '+' || letter == '/'));
    return letter == '+' ? 62 : 63;
  };
  REQUIRE(letters.size() % 4 == 0);
  while (letters.ends_with('=')) letters.remove_suffix(1);
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : letters) {
    bits = (bits << 6 | value_of(letter)) & 0xffffff;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

/// The pictures in a page, in their order, as files of their own.
std::vector<OIIO::ImageBuf> pictures_in(const std::string& page, const TemporaryFolder& folder) {
  static const std::regex address("data:image/png;base64,([^\"]*)\"");
  std::vector<OIIO::ImageBuf> pictures;
  for (std::sregex_iterator it(page.begin(), page.end(), address), end; it != end; ++it) {
    const std::string path = folder / ("page" + std::to_string(pictures.size()) + ".png");
    std::ofstream(path, std::ios::binary) << decoded((*it)[1].str());
    OIIO::ImageBuf image(path);
    REQUIRE(image.read(0, 0, true, OIIO::TypeDesc::FLOAT));
    pictures.push_back(image);
  }
  return pictures;
}

bool is_same(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b) {
  for (int y = 0; y < a.spec().height; ++y) {
    for (int x = 0; x < a.spec().width; ++x) {
      for (int c = 0; c < 3; ++c)
        if (a.getchannel(x, y, 0, c) != b.getchannel(x, y, 0, c)) return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("a page has the picture before and after, and maps of it") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "page");
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 90, 50, 4);
  const std::string output = folder / "a<b>&'c.exr";
  const std::string profile = "1=burley:0.5/0.4/0.3";
  run_well(filter_arguments(scene, output,
                            {"--material", profile, "--report", folder / "page", "--preview", folder / "after.png",
                             "--tile-map", folder / "blocks.png"}));
  run_well({"preview", folder / "in.exr", "-o", folder / "before.png"});
  const std::string page = text_in(folder / "page/index.html");
  const std::vector<OIIO::ImageBuf> pictures = pictures_in(page, folder);
  REQUIRE(pictures.size() == 7);  // before, after, change, ramp, radius, ramp, blocks
  for (const std::size_t i : {0, 1, 2, 4, 6}) {
    CHECK(pictures[i].spec().width == 90);
    CHECK(pictures[i].spec().height == 50);
  }
  const auto read = [](const std::string& path) {
    OIIO::ImageBuf image(path);
    REQUIRE(image.read(0, 0, true, OIIO::TypeDesc::FLOAT));
    return image;
  };
  CHECK(is_same(pictures[0], read(folder / "before.png")));
  CHECK(is_same(pictures[1], read(folder / "after.png")));
  CHECK(is_same(pictures[6], read(folder / "blocks.png")));
  CHECK_FALSE(is_same(pictures[0], pictures[1]));

  CHECK(has(page, "a&lt;b&gt;&amp;&#39;c.exr"));
  CHECK_FALSE(has(page, "a<b>"));
  CHECK(has(page, "dermis filter --material 1=burley"));
  CHECK_FALSE(has(page, folder.path().string()));                              // it tells nobody where it was made
  CHECK_FALSE(std::regex_search(page, std::regex("(src|href)=\"(?!data:)")));  // all of it is in the page

  // The result is the same as without.
  run_well(filter_arguments(scene, folder / "plain.exr", {"--material", profile}));
  CHECK(is_identical(folder / "plain.exr", output));
}

TEST_CASE("pictures of a page fit on a screen, and there is one where nothing scatters") {
  const TemporaryFolder folder;
  const MadeScene wide = make_scene(folder / "wide.exr", "step", 1700, 20, 4);
  run_well(
      filter_arguments(wide, folder / "out.exr",
                       {"--material", "1=burley:0.5/0.4/0.3", "--quality", "draft", "--report", folder / "w.html"}));
  const auto pictures = pictures_in(text_in(folder / "w.html"), folder);
  REQUIRE(pictures.size() == 7);
  CHECK(pictures[0].spec().width == 850);
  CHECK(pictures[0].spec().height == 10);

  const MadeScene scene = make_scene(folder / "in.exr", "step", 40, 30, 4);
  const Outcome outcome = run_program(filter_arguments(
      scene, folder / "out.exr", {"--material", "7=skin", "--allow-empty", "--report", folder / "e.html"}));
  CHECK(outcome.exit_code == 0);
  CHECK(has(text_in(folder / "e.html"), "without material 100.0 %"));
}

TEST_CASE("a sequence has a page for each picture and one that leads to them") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "pages");
  const MadeScene scene = make_scene(folder / "shot.1.exr", "sphere", 30, 20, 3);
  fs::copy_file(folder / "shot.1.exr", folder / "shot.3.exr");
  std::ofstream(folder / "shot.2.exr") << "no picture";
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"filter",    folder / "shot.#.exr",
                                   "-o",        folder / "out.#.exr",
                                   "--profile", "burley:0.5/0.4/0.3",
                                   "--report",  folder / "pages",
                                   "--quality", "draft"};
    words.insert(words.end(), scene.camera.begin(), scene.camera.end());
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  CHECK(run({}).exit_code == 8);
  const std::string list = text_in(folder / "pages/index.html");
  CHECK(has(list, "3 pictures, exit code 8"));
  CHECK(has(list, "href=\"./shot.1.html\""));
  CHECK(has(list, "href=\"./shot.3.html\""));
  CHECK_FALSE(has(list, "href=\"./shot.2.html\""));
  CHECK(has(list, "class=\"bad\">failed"));
  CHECK(fs::exists(folder / "pages/shot.1.html"));
  CHECK_FALSE(fs::exists(folder / "pages/shot.2.html"));

  // The list takes the place of no page.
  fs::copy_file(folder / "shot.1.exr", folder / "index.exr");
  std::vector<std::string> words{"filter",         folder / "index.exr", folder / "shot.3.exr", "-o",
                                 folder / "pages", "--profile",          "burley:0.5/0.4/0.3",  "--report",
                                 folder / "pages"};
  words.insert(words.end(), scene.camera.begin(), scene.camera.end());
  check_refused(run_program(words), 2, {"--report: got", "index.html for", "other names"});

  // A page that has gone is made again with its picture; a task of a farm writes no list.
  fs::remove(folder / "pages/shot.3.html");
  fs::remove(folder / "pages/index.html");
  const Outcome again = run({"--frames", "1,3", "--chunk", "2/2", "--skip-existing"});
  CHECK(again.exit_code == 0);
  CHECK(has(again.errors, "shot.3.html"));
  CHECK(fs::exists(folder / "pages/shot.3.html"));
  CHECK_FALSE(fs::exists(folder / "pages/index.html"));
}

TEST_CASE("a page that cannot be written is refused before the work") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4);
  const auto refuses = [&](const std::string& report, int code, const std::string& wanted) {
    check_refused(
        run_program(filter_arguments(scene, folder / "out.exr", {"--material", "1=skin", "--report", report})), code,
        {"--report", wanted});
    CHECK_FALSE(fs::exists(folder / "out.exr"));
  };
  refuses(folder / "page.txt", 2, ".html");
  refuses(folder / "nosuch/page.html", 6, "nosuch/page.html");
  refuses(folder / "nosuch", 2, ".html");
}
