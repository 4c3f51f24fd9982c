// Profiles on the command line: every way to spell one, and every way to get it wrong.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

/// A scene, filtered with one profile after the other.
class Filtered {
 public:
  Filtered() : scene_(make_scene(folder_ / "in.exr", "step", 44, 26, 4)) {}

  const TemporaryFolder& folder() const { return folder_; }

  /// The file that this profile makes of the scene.
  std::string with(const std::string& profile) {
    const std::string output = folder_ / ("out" + std::to_string(++runs_) + ".exr");
    run_well(filter_arguments(scene_, output, {"--material", "1=" + profile}));
    CHECK(relative_l2(output, scene_.path, "ViewLayer.Combined") > 1e-3);
    return output;
  }

  void check_same(const std::string& profile, const std::string& other) {
    CAPTURE(profile, other);
    CHECK(is_identical(with(profile), with(other)));
  }

 private:
  TemporaryFolder folder_;
  MadeScene scene_;
  int runs_ = 0;
};

/// Rows of a Gaussian of variance 1 mm^2, each channel times another number.
std::string gaussian_rows(const std::string& separator) {
  std::string text;
  for (int i = 0; i <= 300; ++i) {
    const double r = i * 0.025;
    const double value = std::exp(-r * r / 2);
    text += std::to_string(r) + separator + std::to_string(value) + separator + std::to_string(3 * value) + separator +
            std::to_string(100 * value) + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("a profile in numbers is the preset of the same numbers") {
  Filtered filtered;
  filtered.check_same("dipole:0.74/0.88/1.01,0.032/0.17/0.48", "dipole-skin1");
  filtered.check_same("dipole:0.74/0.88/1.01,0.032/0.17/0.48,eta=1.3", "dipole-skin1");
  filtered.check_same("dipole:2.19/2.62/3,0.0021/0.0041/0.0071,eta=1.5", "dipole-marble");
  filtered.check_same("artist:0.25/0.08/0.02,1/0.3/0.05,w=0.6", "artist-production");
  CHECK(relative_l2(filtered.with("better-dipole:0.74/0.88/1.01,0.032/0.17/0.48"), filtered.with("dipole-skin1"),
                    "ViewLayer.sss") > 1e-4);
  filtered.check_same("walk:12/7/2,albedo=0.8/0.55/0.2", "wax-walk");
  CHECK(relative_l2(filtered.with("walk:12/7/2,mfp,albedo=0.8/0.55/0.2"), filtered.with("wax-walk"), "ViewLayer.sss") >
        1e-2);
  // d = l / s(.8), s(.8) = 1.1
  CHECK(relative_l2(filtered.with("burley:1.1/0.55/0.275,mfp,albedo=0.8/0.8/0.8"), filtered.with("burley:1/0.5/0.25"),
                    "ViewLayer.sss") <= 1e-5);
}

TEST_CASE("a table is the curve that it was made of") {
  Filtered filtered;
  std::ofstream(filtered.folder() / "one.json") << R"({"terms": [{"variance_mm2": 1, "weight": [1, 1, 1]}]})";
  std::ofstream(filtered.folder() / "plain.csv") << gaussian_rows(",");
  std::ofstream(filtered.folder() / "dressed.csv") << "\xEF\xBB\xBF# measured\r\n\n r_mm, R, G, B \r\n"
                                                   << gaussian_rows(" ,\t") << "\n  # the end\n";
  const std::string plain = filtered.with("table:" + (filtered.folder() / "plain.csv"));
  // The rows are 0.025 standard deviations apart: cubics with slopes of second order are off by some 1e-4.
  CHECK(relative_l2(plain, filtered.with("gaussians:" + (filtered.folder() / "one.json")), "ViewLayer.sss") < 1e-3);
  const std::string dressed = filtered.with("table:" + (filtered.folder() / "dressed.csv"));
  CHECK(is_identical(plain, dressed));
  const std::string info = run_well({"info", dressed});
  CHECK(info.find("Combined") != std::string::npos);
}

TEST_CASE("results name the file of a table without its folders") {
  Filtered filtered;
  std::ofstream(filtered.folder() / "plain.csv") << gaussian_rows(",");
  const std::string output = filtered.with("table:" + (filtered.folder() / "plain.csv"));
  const auto input = OIIO::ImageInput::open(output);
  REQUIRE(input);
  const std::string command = input->spec().get_string_attribute("dermis:command");
  CHECK(command.find("table:plain.csv") != std::string::npos);
  CHECK(command.find(filtered.folder().path().string()) == std::string::npos);
}

TEST_CASE("help tells every kind of profile") {
  const std::string help = run_well({"filter", "--help"});
  for (const char* kind : {"burley:DR/DG/DB", "burley:RR/RG/RB,cycles", "burley:LR/LG/LB,mfp,albedo=AR/AG/AB",
                           "walk:RR/RG/RB ", "walk:RR/RG/RB,albedo=AR/AG/AB", "walk:LR/LG/LB,mfp,albedo=AR/AG/AB",
                           "gaussians:FILE.json", "artist:NR/NG/NB,FR/FG/FB,w=W", "dipole:SR/SG/SB,AR/AG/AB[,eta=E]",
                           "better-dipole:SR/SG/SB,AR/AG/AB[,eta=E]", "table:FILE.csv"}) {
    INFO(kind);
    CHECK(help.find(kind) != std::string::npos);
  }
}

TEST_CASE("misspelled profiles are usage errors") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 12, 9, 4);
  struct Case {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases = {
      {"burley:1/2/3,mfp", {"burley:R/G/B,mfp,albedo=R/G/B"}},
      {"burley:1/2/3,mfp,albedo=1/2/1", {"albedo=1/2/1", "0 to 1"}},
      {"burley:1/2/3,mfp,x=1/1/1", {"x=1", "albedo="}},
      {"walk", {"walk:R/G/B[[,mfp],albedo=R/G/B]"}},
      {"walk:1/2/3,albedo=1/1/1,mfp", {"walk:R/G/B,albedo=R/G/B", "walk:12/7/2,albedo=0.8/0.55/0.2"}},
      {"walk:1/2/0,albedo=1/1/1", {"> 0"}},
      {"walk:1/2/3,cycles,albedo=1/1/1", {"walk:R/G/B,mfp,albedo=R/G/B"}},
      {"walk:1/2/3,mfp", {"albedo= and three numbers from 0 to 1"}},
      {"walk:1/2/3,albedo=1/1", {"albedo= and three numbers from 0 to 1"}},
      {"walk:1/2/3,albedo=1/2/1", {"0 to 1"}},
      {"walk:1/2/1e10,mfp,albedo=1/1/1", {"mfp_mm: got 1e+10", "1e-9..1e9"}},
      {"dipole:1/2/3", {"dipole:", "1/mm", "eta=1.3"}},
      {"dipole:1/2,1/2/3", {"three coefficients"}},
      {"dipole:1/2/3,0/1/1", {"> 0"}},
      {"dipole:1/2/nan,1/1/1", {"> 0"}},
      {"dipole:1/2/3,1/1/1,eta", {"eta= and a refractive index"}},
      {"dipole:1/2/3,1/1/1,eta=0.9", {"from 1 to 2.5"}},
      {"dipole:1/2/3,1/1/1,eta=1.3,more", {"three coefficients"}},
      {"dipole:1/2/3,1/1/1e30", {"absorption_per_mm: got 1e+30", "1e-9..1e9"}},
      {"better-dipole:1/2/3,1/1/1,n=1.3", {"eta= and a refractive index"}},
      {"better-dipole:", {"better-dipole: and twice"}},
      {"artist:1/2/3,1/2/3", {"a weight from 0 to 1"}},
      {"artist:1/2/3,1/2/3,w=1.5", {"a weight from 0 to 1"}},
      {"artist:1/2/3,1/2/3,0.5", {"w=0.6"}},
      {"artist:1/0/3,1/2/3,w=0.5", {"> 0"}},
      {"artist:1/2/3,w=0.5", {"twice three lengths"}},
      {"leather", {"artist:R/G/B,R/G/B,w=W", "dipole:R/G/B,R/G/B[,eta=E]", "table:FILE.csv", "dipole-whole-milk"}}};
  for (const Case& c : cases) {
    INFO(c.text);
    check_refused(run_program(filter_arguments(scene, folder / "out.exr", {"--material", "1=" + c.text})), 2, c.parts);
  }
}

TEST_CASE("a table that is missing or malformed is an input error that names the line") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 12, 9, 4);
  const std::string file = folder / "profile.csv";
  const auto refuses = [&](const std::string& profile, int code, const std::vector<std::string>& parts) {
    check_refused(run_program(filter_arguments(scene, folder / "out.exr", {"--material", "1=" + profile})), code,
                  parts);
  };
  refuses("table:" + file, 3, {"--material 1: got " + file, "CSV"});
  refuses("table:", 3, {"no file name"});
  refuses("table:" + folder.path().string(), 3, {"cannot be read"});
  struct Case {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases = {{"", {"0 rows in all", "2 or more"}},
                                   {"r_mm,R,G,B\n", {"0 rows in all"}},
                                   {"r_mm,R,G,B\n0,1,1,1\n", {"1 row in all", "2 or more"}},
                                   {"r_mm,R,G,B\n0,1,1,1\n1,1,1\n", {"line 3: got 3 columns", "four: r_mm,R,G,B"}},
                                   {"# one\n\n0,1,1,1,1\n", {"line 3: got 5 columns"}},
                                   {"0,1,1,1\nr_mm,R,G,B\n", {"line 2: got r_mm = r_mm", "a number"}},
                                   {"0,1,1,1\n1,1,x,1\n", {"line 2: got G = x", "a number from 0"}},
                                   {"0,1,1,1\n1,1,1,\n", {"line 2: got B = ", "a number from 0"}},
                                   {"0,1,1,1\n1,-1,1,1\n", {"line 2: got R = -1", "a number from 0"}},
                                   {"0,1,1,1\n1,inf,1,1\n", {"line 2: got R = inf", "a number from 0"}},
                                   {"-1,1,1,1\n1,1,1,1\n", {"line 1: got r_mm = -1", "a number from 0"}},
                                   {"0,1,1,1\n1e-12,1,1,1\n", {"line 2: got r_mm = 1e-12", "1e-9 to 1e9"}},
                                   {"0,1,1,1\n2,1,1,1\n2,1,1,1\n", {"line 3: got r_mm = 2 after 2", "ascending"}},
                                   {"0,1,1,1\n2,1,1,1\n1,1,1,1\n", {"line 3: got r_mm = 1 after 2", "ascending"}},
                                   {"0,1,0,1\n1,1,0,1\n", {"nothing above 0 in column G", "every channel"}}};
  for (const Case& c : cases) {
    INFO(c.text);
    std::ofstream(file, std::ios::binary) << c.text;
    std::vector<std::string> parts = c.parts;
    parts.push_back("--material 1 " + file);
    refuses("table:" + file, 4, parts);
  }
}
