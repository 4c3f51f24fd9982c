// dermis taps: the numbers it prints and writes, its source code, its figure, and what it refuses.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<std::string>;

namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// The JSON of `dermis taps` with these arguments.
json taps(const Words& arguments) { return json::parse(run_well(with(with({"taps"}, arguments), {"--json", "-"}))); }

std::vector<float> column(const json& term, std::size_t channel) {
  std::vector<float> values;
  for (const json& weight : term["weights"]) values.push_back(weight[channel].get<float>());
  return values;
}

/// Sums in float32, in an order by chance.
float shuffled_sum(std::vector<float> values, Random& random) {
  for (std::size_t i = values.size(); i > 1; --i)
    std::swap(values[i - 1], values[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  float sum = 0;
  for (const float value : values) sum += value;
  return sum;
}

/// Checks what holds for every set of taps.
void check_taps(const json& set, Random& random) {
  Words keys;
  for (const auto& [key, value] : set.items()) keys.push_back(key);
  CHECK(keys ==
        Words{"fetch", "model", "offsets_px", "pixel_mm", "predicted_rel_l2", "profile", "rank", "taps", "terms"});
  const std::vector<double> offsets = set["offsets_px"];
  REQUIRE(offsets.size() == set["taps"]);
  REQUIRE(set["terms"].size() == set["rank"]);
  CHECK(offsets.size() % 2 == 1);
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    CHECK(offsets[i] == -offsets[offsets.size() - 1 - i]);
    if (i > 0) CHECK(offsets[i] > offsets[i - 1]);
    if (set["fetch"] == "integer") CHECK(offsets[i] == std::round(offsets[i]));
  }
  CHECK(set["predicted_rel_l2"] > 0.0);
  CHECK(set["predicted_rel_l2"] < 1.0);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(shuffled_sum(column(set["terms"][0], c), random) == 1);
    double light = 0;
    for (const json& term : set["terms"]) {
      CHECK(term.size() == 2);
      CHECK(term["scale"].size() == 3);
      const std::vector<float> weights = column(term, c);
      REQUIRE(weights.size() == offsets.size());
      for (std::size_t i = 0; i < weights.size(); ++i) CHECK(weights[i] == weights[weights.size() - 1 - i]);
      const double sum = shuffled_sum(weights, random);
      light += term["scale"][c].get<double>() * sum * sum;
    }
    // Scales are fitted in double precision, and the sums are exact or, for svd, of multiples of 2^-24.
    CHECK(light == Approx(1).margin(1e-5));
  }
}

std::string gaussians_file(const TemporaryFolder& folder) {
  const std::string path = folder / "terms.json";
  std::ofstream(path) << R"({"terms": [{"variance_mm2": 0.05, "weight": [0.3, 0.6, 0.9]},
                                       {"variance_mm2": 1.5, "weight": [0.7, 0.4, 0.1]}]})";
  return "gaussians:" + path;
}

struct ModelAndRank {
  std::string model;
  std::string rank;
};

const std::vector<ModelAndRank> all_models = {
    {"pre-integrated", "1"}, {"artist", "1"},    {"guided", "1"},    {"svd", "1"},       {"svd", "3"},
    {"gaussians", "1"},      {"gaussians", "4"}, {"optimised", "1"}, {"optimised", "2"}, {"optimised", "3"}};

/// Writes the taps as C beside a program that includes them, builds both without a warning, and returns what it prints.
std::string run_exported_c(const TemporaryFolder& folder, const Words& arguments, const std::string& program) {
  run_well(with(with({"taps"}, arguments), {"--export", "c", "-o", folder / "taps.h"}));
  std::ofstream(folder / "main.c") << "#include <stdio.h>\n#include \"taps.h\"\n" << program;
  const std::string compiler = "cd '" + folder.path().string() + "' && cc -Wall -Wextra -Werror ";
  REQUIRE(std::system((compiler + "-x c -c taps.h -o alone.o").c_str()) == 0);
  REQUIRE(std::system((compiler + "main.c -o main && ./main > printed").c_str()) == 0);
  return read_file(folder / "printed");
}

}  // namespace

TEST_CASE("taps prints a table of its design, its price, its error and half of its weights") {
  const Words arguments = {"skin", "--model", "optimised", "--rank", "2", "--taps", "9"};
  const json set = taps(arguments);
  const std::string table = run_well(with({"taps"}, arguments));
  for (const char* part : {"profile          skin\n", "model            optimised\n", "rank             2\n",
                           "taps             9 per pass\n", "fetch            integer\n", "0.25 mm on the surface\n",
                           "loads per pixel  27\n", "predicted error  ", "Offsets < 0 weigh the same", "term 1 of 2",
                           "term 2 of 2", "offset, px"}) {
    INFO(part);
    CHECK(has(table, part));
  }
  // one line per tap from the middle on, with the weights that the JSON has
  std::istringstream lines(table.substr(table.find("term 1 of 2")));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  for (std::size_t i = 4; i < 9; ++i) {
    double offset = 0;
    double weight = 0;
    std::getline(lines, line);
    std::istringstream(line) >> offset >> weight;
    CHECK(offset == set["offsets_px"][i]);
    CHECK(weight == Approx(set["terms"][0]["weights"][i][0].get<double>()).margin(0.5e-8));
  }
  std::getline(lines, line);
  CHECK(line.empty());
}

TEST_CASE("taps of every model are symmetric, ascending, and keep the light exactly") {
  const TemporaryFolder folder;
  Random random(1);
  for (const std::string& profile : {std::string("skin"), std::string("wax"), gaussians_file(folder)}) {
    for (const auto& [model, rank] : all_models) {
      const std::string count = std::to_string(2 * random.integer(2, 12) + 1);
      const std::string fetch = random.coin() ? "linear" : "integer";
      INFO(profile << " " << model << " rank " << rank << ", " << count << " taps, " << fetch);
      const json set = taps({profile, "--model", model, "--rank", rank, "--taps", count, "--fetch", fetch, "--pixel-mm",
                             std::to_string(random.uniform(0.02, 0.5))});
      check_taps(set, random);
      CHECK(set["model"] == model);
      CHECK(std::to_string(set["rank"].get<int>()) == rank);
      CHECK(set["taps"].get<int>() <= std::stoi(count));
      CHECK(set["fetch"] == fetch);
      CHECK(set["profile"] == (profile.starts_with("gaussians") ? "gaussians:terms.json" : profile));
    }
  }
}

TEST_CASE("more taps and more terms come closer to the profile") {
  for (const std::string profile : {"skin", "wax", "burley:1.5/0.7/0.4"}) {
    INFO(profile);
    double previous = 1;
    // Half as many taps leave at least a fifth more error, as long as the taps and not the model are what is wrong.
    for (const char* count : {"3", "7", "15", "31"}) {
      const double error = taps({profile, "--rank", "3", "--taps", count, "--pixel-mm", "0.1"})["predicted_rel_l2"];
      INFO(count << " taps: " << error);
      CHECK(error < previous / 1.2);
      previous = error;
    }
    const auto error_of = [&](const char* rank) {
      return taps({profile, "--rank", rank, "--taps", "dense"})["predicted_rel_l2"].get<double>();
    };
    CHECK(error_of("2") < error_of("1") / 2);
    CHECK(error_of("3") < error_of("2"));
  }
}

TEST_CASE("every option of the design reaches the taps") {
  const Words base = {"skin", "--taps", "9"};
  const auto weights = [&](const Words& more) { return taps(with(base, more))["terms"]; };
  const auto offsets = [&](const Words& more) { return taps(with(base, more))["offsets_px"]; };
  CHECK(weights({"--model", "guided", "--guide", "0.5"}) != weights({"--model", "guided", "--guide", "3"}));
  CHECK(weights({"--model", "guided"}) == weights({"--model", "guided", "--guide", "2"}));
  CHECK(weights({"--rank", "2", "--non-negative"}) != weights({"--rank", "2"}));
  CHECK(weights({}) == weights({"--model", "optimised", "--rank", "1", "--placement", "optimised", "--fetch", "integer",
                                "--pixel-mm", "0.25"}));
  const Words placements = {"uniform", "importance", "quadratic", "optimised"};
  std::map<json, std::string> seen;
  for (const std::string& placement : placements) {
    INFO(placement);
    CHECK(seen.emplace(offsets({"--placement", placement, "--pixel-mm", "0.05"}), placement).second);
  }
  CHECK(offsets({"--pixel-mm", "0.05"}) != offsets({"--pixel-mm", "0.1"}));
  CHECK(taps({"skin"})["taps"] == 17);
}

TEST_CASE("dense taps lie on every pixel, and a kernel that is too wide for them is refused") {
  Random random(2);
  const json set = taps({"skin", "--taps", "dense", "--pixel-mm", "0.1"});
  check_taps(set, random);
  const std::vector<double> offsets = set["offsets_px"];
  CHECK(offsets.size() > 31);
  for (std::size_t i = 1; i < offsets.size(); ++i) CHECK(offsets[i] == offsets[i - 1] + 1);
  CHECK(has(run_well({"taps", "skin", "--taps", "dense"}), "one on every pixel"));
  for (const char* pixel_mm : {"0.001", "1e-12"})
    check_refused(run_program({"taps", "skin", "--taps", "dense", "--pixel-mm", pixel_mm}), 2,
                  {"--taps: got dense", "1023 pixels", std::string("--pixel-mm ") + pixel_mm});
}

TEST_CASE("rows of taps restore the same floats as JSON") {
  const TemporaryFolder folder;
  const Words arguments = {"skin", "--model", "gaussians", "--rank", "3", "--taps", "7", "--fetch", "linear"};
  const json set = taps(arguments);
  run_well(with(with({"taps"}, arguments), {"--csv", folder / "taps.csv"}));
  std::ifstream file(folder / "taps.csv");
  std::string line;
  std::getline(file, line);
  CHECK(line == "offset_px,term,R,G,B,scale_R,scale_G,scale_B");
  for (std::size_t t = 0; t < 3; ++t) {
    for (std::size_t i = 0; i < 7; ++i) {
      REQUIRE(std::getline(file, line));
      INFO(line);
      std::vector<std::string> blocks;
      std::istringstream row(line);
      for (std::string block; std::getline(row, block, ',');) blocks.push_back(block);
      REQUIRE(blocks.size() == 8);
      CHECK(std::stod(blocks[0]) == set["offsets_px"][i]);
      CHECK(blocks[1] == std::to_string(t + 1));
      for (std::size_t c = 0; c < 3; ++c) {
        CHECK(std::stof(blocks[2 + c]) == set["terms"][t]["weights"][i][c].get<float>());
        CHECK(std::stod(blocks[5 + c]) == set["terms"][t]["scale"][c].get<double>());
      }
    }
  }
  CHECK_FALSE(std::getline(file, line));
}

TEST_CASE("exported C compiles without a warning, and its weights sum to 1") {
  const TemporaryFolder folder;
  const std::string sums =
      "int main(void) {\n"
      "  for (int c = 0; c < 3; ++c) {\n"
      "    float sum = 0;\n"
      "    for (int i = 0; i < dermis_taps; ++i) sum += dermis_weight[0][i][c];\n"
      "    printf(\"%.9g \", sum);\n"
      "  }\n"
      "  const float row[3] = {2, 2, 2};\n"
      "  for (int c = 0; c < 3; ++c) {\n"
      "    float of_terms[dermis_terms];\n"
      "    for (int t = 0; t < dermis_terms; ++t) of_terms[t] = dermis_pass(row, 3, 1, t, c);\n"
      "    printf(\"%.5f \", dermis_sum(of_terms, c));\n"
      "  }\n"
      "  printf(\"%d %d\", dermis_terms, dermis_taps);\n"
      "  return 0;\n"
      "}\n";
  for (const std::string fetch : {"integer", "linear"}) {
    const Words design = {"skin", "--rank", "2", "--taps", "11", "--fetch", fetch};
    CHECK(run_exported_c(folder, design, sums) == "1 1 1 2.00000 2.00000 2.00000 2 11");
  }
}

TEST_CASE("a pass of exported C is the sum over the taps") {
  const TemporaryFolder folder;
  Random random(3);
  const int count = random.integer(20, 60);
  const int x = random.integer(0, count - 1);
  std::vector<double> row;
  std::string listed;
  for (int i = 0; i < count; ++i) {
    row.push_back(random.integer(0, 1000));
    listed += std::to_string(static_cast<int>(row.back())) + ",";
  }
  const std::string program = "int main(void) {\n  const float row[] = {" + listed +
                              "};\n  printf(\"%.9g\", dermis_pass(row, " + std::to_string(count) + ", " +
                              std::to_string(x) + ", 1, 0));\n  return 0;\n}\n";
  for (const std::string fetch : {"integer", "linear"}) {
    const Words design = {"wax", "--rank", "2", "--taps", "13", "--fetch", fetch};
    const json set = taps(design);
    double expected = 0;
    for (std::size_t i = 0; i < 13; ++i) {
      const double at = std::clamp(x + set["offsets_px"][i].get<double>(), 0.0, count - 1.0);
      const auto left = static_cast<std::size_t>(at);
      const std::size_t right = std::min(left + 1, row.size() - 1);
      const double part = at - static_cast<double>(left);
      expected += set["terms"][1]["weights"][i][0].get<double>() * (row[left] * (1 - part) + row[right] * part);
    }
    INFO(fetch << " at " << x << " of " << count);
    // 13 products of at most 1000 with weights whose absolute values sum to 1: (13 + 1) 2^-24 1000 < 1e-3; an offset
    // rounded to float32 moves at most 2^-19 of the 1000 between neighbours: another 2e-3.
    CHECK(std::stod(run_exported_c(folder, design, program)) == Approx(expected).margin(3e-3));
  }
}

TEST_CASE("exported shader code has all the numbers of the taps") {
  const TemporaryFolder folder;
  const Words design = {"skin", "--rank", "2", "--taps", "5"};
  const std::string glsl = run_well(with({"taps"}, with(design, {"--export", "glsl"})));
  for (const char* part :
       {"const int dermis_terms = 2;", "const int dermis_taps = 5;", "const int dermis_offset_px[5] = int[5](",
        "const vec3 dermis_scale[2] = vec3[2](", "const vec3 dermis_weight[10] = vec3[10]("}) {
    INFO(part);
    CHECK(has(glsl, part));
  }
  run_well(with({"taps"}, with(design, {"--export", "hlsl", "--fetch", "linear", "-o", folder / "taps.hlsl"})));
  const std::string hlsl = read_file(folder / "taps.hlsl");
  for (const char* part : {"static const int dermis_terms = 2;", "static const int dermis_taps = 5;",
                           "static const float dermis_offset_px[5] = {", "static const float3 dermis_scale[2] = {",
                           "static const float3 dermis_weight[10] = {"}) {
    INFO(part);
    CHECK(has(hlsl, part));
  }
  const auto count = [](const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  };
  CHECK(count(glsl, "    vec3(") == 12);
  CHECK(count(hlsl, "    float3(") == 12);
  for (const std::string& text : {glsl, hlsl}) {
    CHECK(count(text, "(") == count(text, ")"));
    CHECK(count(text, "{") == count(text, "}"));
    CHECK_FALSE(has(text, "profile  "));  // the table
  }
  if (!is_installed("glslangValidator")) return;
  std::ofstream(folder / "taps.frag") << "#version 330\n"
                                      << glsl
                                      << "out vec3 sum;\nvoid main() {\n  sum = vec3(0.0);\n"
                                         "  for (int i = 0; i < dermis_taps; ++i) sum += dermis_weight[i];\n}\n";
  CHECK(std::system(("glslangValidator '" + (folder / "taps.frag") + "' >/dev/null").c_str()) == 0);
}

TEST_CASE("the figure of taps has all its panels") {
  const TemporaryFolder folder;
  const Words call = {"taps", "skin", "--rank", "2", "--plot"};
  check_refused(run_program(with(call, {folder / "plot.svg"}), {"PATH=" + (folder / "nosuch")}), 6,
                {"--plot", "gnuplot"});
  CHECK(fs::is_empty(folder.path()));
  if (!is_installed("gnuplot")) return;
  CHECK(has(run_well(with(call, {folder / "it's a plot.svg"})), "predicted error"));
  const std::string svg = read_file(folder / "it's a plot.svg");
  for (const char* part :
       {"<svg", "skin: model optimised, rank 2, 17 taps, integer fetch, pixel 0.25 mm, predicted error",
        "slice of the kernel along an axis", "slice of the kernel along a diagonal",
        "singular values of the profile on pixels", "response to a step of light", "error of the response to the step",
        "weights of the taps", "light per area, 1/mm^2", "offset, px", "distance from the edge, mm"}) {
    INFO(part);
    CHECK(has(svg, part));
  }
  run_well(with(call, {folder / "plot.png"}));
  CHECK(fs::file_size(folder / "plot.png") > 10000);
  // kernels of less than a pixel and of too many to have a tap on each
  run_well({"taps", "wax", "--pixel-mm", "1000", "--plot", folder / "narrow.svg"});
  run_well({"taps", "wax", "--pixel-mm", "0.0001", "--plot", folder / "wide.svg"});
}

TEST_CASE("no name of a file is run by the program that draws a figure") {
  if (!is_installed("gnuplot")) return;
  for (const std::string name :
       {"a\nsystem 'touch run'\n", "a'\nsystem 'touch run'\n'", "a'; system 'touch run'; '", "`touch run`",
        "$(touch run)", "a\"; system \"touch run\"; \"", "\\'; system 'touch run'"}) {
    INFO(name);
    const TemporaryFolder folder;
    std::ofstream(folder / (name + ".csv")) << "0, 1, 1, 1\n1, .5, .5, .5\n2, 0, 0, 0\n";
    const Outcome outcome = run_program({"taps", "table:" + name + ".csv", "--taps", "7", "--plot", name + ".svg"},
                                        {.folder = folder.path().string()});
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(has(read_file(folder / (name + ".svg")), "weights of the taps"));
    CHECK(folder.file_count() == 2);
  }
}

TEST_CASE("bad calls of taps name the option, and nothing is written") {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  struct Case {
    Words words;
    Words parts;
  };
  const std::vector<Case> cases = {
      {{"--rank", "7"}, {"--rank: got 7", "1 to 6"}},
      {{"--rank", "0"}, {"--rank: got 0", "1 to 6"}},
      {{"--rank", "4"}, {"--rank: got 4", "1..3"}},
      {{"--model", "artist", "--rank", "2"}, {"--rank: got 2", "1 for this model"}},
      {{"--model", "guided", "--rank", "2"}, {"--rank: got 2", "1 for this model"}},
      {{"--model", "pre-integrated", "--rank", "3"}, {"--rank: got 3", "1 for this model"}},
      {{"--model", "Burley"}, {"--model: got Burley", "pre-integrated or artist", "optimised"}},
      {{"--taps", "4"}, {"--taps: got 4", "odd number from 3 to 2047 or dense"}},
      {{"--taps", "1"}, {"--taps: got 1", "odd number"}},
      {{"--taps", "2049"}, {"--taps: got 2049", "2047"}},
      {{"--taps", "many"}, {"--taps: got many", "dense"}},
      {{"--taps", ""}, {"--taps: got nothing", "dense"}},
      {{"--placement", "random"}, {"--placement: got random", "uniform", "quadratic"}},
      {{"--fetch", "cubic"}, {"--fetch: got cubic", "integer or linear"}},
      {{"--pixel-mm", "0"}, {"--pixel-mm: got 0", "1e-12..1e12"}},
      {{"--pixel-mm", "nan"}, {"--pixel-mm: got nan", "1e-12..1e12"}},
      {{"--pixel-mm", "1e13"}, {"--pixel-mm: got 1e13", "1e-12..1e12"}},
      {{"--guide", "5", "--model", "guided"}, {"--guide: got 5", "0 to 4"}},
      {{"--guide", "1"}, {"--guide: got 1 for --model optimised", "--model guided"}},
      {{"--non-negative"}, {"--non-negative: got", "--rank 1", "--rank 2 or 3"}},
      {{"--non-negative", "--model", "svd", "--rank", "2"}, {"--non-negative: got --model svd", "optimised"}},
      {{"--export", "rust"}, {"--export: got rust", "c or glsl or hlsl"}},
      {{"--plot", folder / "plot.pdf"}, {"--plot: got", ".svg or .png"}},
      {{"-o", out}, {"--output: got " + out, "--export"}},
      {{"--json", out, "--csv", folder / "./out"}, {"--csv: got", "not --json as well"}},
      {{"--json", out, "--export", "c", "-o", out}, {"--output: got", "not --json as well"}},
      {{"--json", "-", "--csv", "-"}, {"--csv: got standard output", "--json"}},
      {{"--csv", "-", "--export", "c"}, {"--export: got standard output", "--csv"}}};
  for (const Case& c : cases) {
    INFO(c.parts.front());
    check_refused(run_program(with({"taps", "skin"}, c.words)), 2, c.parts);
    CHECK(fs::is_empty(folder.path()));
  }
  check_refused(run_program({"taps"}), 2, {"profile"});
  check_refused(run_program({"taps", "leather"}), 2, {"PROFILE: got leather", "skin"});
  check_refused(run_program({"taps", "gaussians:" + (folder / "none.json")}), 3, {"PROFILE: got", "none.json"});
}

TEST_CASE("no output of taps takes the place of the profile's file") {
  const TemporaryFolder folder;
  const std::string profile = gaussians_file(folder);
  const std::string before = read_file(folder / "terms.json");
  check_refused(run_program({"taps", profile, "--json", folder / "./terms.json"}), 2,
                {"--json: got", "not the profile as well"});
  CHECK(read_file(folder / "terms.json") == before);
}

TEST_CASE("an output of taps that cannot be written is an error before anything is written") {
  const TemporaryFolder folder;
  const std::string good = folder / "good.json";
  const auto check = [&](const Words& words, const std::string& option, const std::string& wanted) {
    INFO(option);
    Words call = {"taps", "skin"};
    if (option != "--json") call = with(call, {"--json", good});
    check_refused(run_program(with(call, words)), 6, {option + ": got " + words.back(), wanted});
    CHECK_FALSE(fs::exists(good));
  };
  const std::string nowhere = folder / "nosuch/file";
  check({"--json", nowhere}, "--json", "folder that exists");
  check({"--csv", nowhere}, "--csv", "folder that exists");
  check({"--export", "c", "-o", nowhere}, "--output", "folder that exists");
  check({"--plot", nowhere + ".svg"}, "--plot", "folder that exists");
  check({"--csv", folder.path().string()}, "--csv", "not of a folder");
  fs::create_directory(folder / "folder.png");
  check({"--plot", folder / "folder.png"}, "--plot", "not of a folder");
  // a folder in which nobody can make files, not even root
  check_refused(run_program({"taps", "skin", "--csv", "/proc/taps.csv"}), 6, {"--csv: got /proc/taps.csv"});
}
