#include "measure/registry.hpp"

#include <regex>
#include <utility>

#include "dermis/error.hpp"
#include "opponents/opponents.hpp"

namespace dermis::bench {

namespace {

constexpr std::pair<int, int> sizes[] = {{960, 540}, {1920, 1080}, {3840, 2160}};
constexpr int kernels_px[] = {8, 16, 32, 64};
constexpr SceneSpec flat_scene = {.geometry = Geometry::flat};

TapsDesign optimised(int rank, int count) { return {.rank = rank, .count = count}; }

TapsDesign by_importance(int count) {
  return {.model = Model::pre_integrated, .count = count, .placement = Placement::importance};
}

/// Opponents are of rank 1.
Case opponent(Family family, Group group, const SceneSpec& scene, int count = 17) {
  return {.family = family, .group = group, .scene = scene, .design = {.rank = 1, .count = count}};
}

Case disc(const SceneSpec& scene, int samples, bool prefiltered) {
  return {.family = Family::dermis_disc, .scene = scene, .disc = {.samples = samples, .prefiltered = prefiltered}};
}

SceneSpec sized(SceneSpec scene, std::pair<int, int> size) {
  std::tie(scene.width, scene.height) = size;
  return scene;
}

SceneSpec wide(SceneSpec scene, int kernel_px) {
  scene.kernel_px = kernel_px;
  return scene;
}

SceneSpec covered(SceneSpec scene, int percent) {
  scene.coverage_percent = percent;
  return scene;
}

std::vector<Case> on_picture(std::vector<Case> cases) {
  for (Case& what : cases) {
    what.group = Group::picture;
    what.scene = {.geometry = Geometry::picture};
  }
  return cases;
}

void add_methods(std::vector<Case>& cases) {
  for (const int count : {7, 17, 25}) cases.push_back({.design = by_importance(count)});
  for (const int count : {7, 17, 25, 33}) cases.push_back({.design = optimised(1, count)});
  for (const int count : {7, 17, 25, 33}) cases.push_back({.design = optimised(2, count)});
  for (const int count : {17, 25}) cases.push_back({.design = optimised(3, count)});
  for (const int count : {3, 5, 7, 17, 25}) cases.push_back({.design = optimised(1, count), .sheared = false});
  cases.push_back({.design = optimised(2, 17), .sheared = false});
  cases.push_back({.design = {.model = Model::gaussians, .rank = 4, .count = 17}});
  for (const int samples : {21, 55}) {
    for (const bool prefiltered : {false, true}) cases.push_back(disc(sized({}, sizes[0]), samples, prefiltered));
  }
  cases.push_back({.family = Family::dermis_exact, .scene = sized({}, {320, 180})});
  for (const Family family : {Family::naive, Family::rule_2012}) {
    for (const int count : {17, 25}) cases.push_back(opponent(family, Group::methods, {}, count));
  }
}

void add_axes(std::vector<Case>& cases) {
  for (const int percent : {50, 10, 1, 0}) {
    cases.push_back({.group = Group::coverage, .scene = covered({}, percent)});
  }
  for (const int percent : {50, 10, 1}) {
    cases.push_back(opponent(Family::naive, Group::coverage, covered({}, percent)));
  }
  for (const int kernel_px : {8, 32, 64}) cases.push_back({.group = Group::width, .scene = wide({}, kernel_px)});
  for (const auto& size : {sizes[0], sizes[2]}) {
    cases.push_back({.group = Group::pixels, .scene = sized({}, size)});
    cases.push_back(opponent(Family::naive, Group::pixels, sized({}, size)));
    cases.push_back(opponent(Family::simd_depth, Group::pixels, sized(flat_scene, size)));
  }
  cases.push_back({.group = Group::threads, .design = optimised(1, 17), .threads = 1});
  cases.push_back({.group = Group::threads, .threads = 1});
  cases.push_back({.group = Group::threads, .memory = Memory::interleaved_f16});
}

void add_flat(std::vector<Case>& cases) {
  for (const int rank : {1, 2, 3}) {
    cases.push_back({.group = Group::flat, .scene = flat_scene, .design = optimised(rank, 17)});
  }
  for (const int count : {7, 25}) {
    cases.push_back({.group = Group::flat, .scene = flat_scene, .design = optimised(1, count)});
  }
  cases.push_back({.group = Group::flat, .scene = flat_scene, .design = optimised(2, 33)});
  for (const int kernel_px : kernels_px) {
    const SceneSpec scene = wide(flat_scene, kernel_px);
    if (kernel_px != flat_scene.kernel_px) {
      cases.push_back({.group = Group::flat, .scene = scene});
      cases.push_back(opponent(Family::simd_depth, Group::flat, scene));
    }
    cases.push_back({.group = Group::flat, .scene = scene, .tolerance = 0.01});
    if (has_opencv()) cases.push_back(opponent(Family::opencv_separable, Group::flat, scene));
  }
  for (const int kernel_px : {16, 64}) {
    cases.push_back(opponent(Family::fft, Group::flat, wide(flat_scene, kernel_px)));
  }
  if (has_opencv()) cases.push_back(opponent(Family::opencv_bilateral, Group::flat, flat_scene));
  for (const Family family : {Family::naive, Family::rule_2012}) {
    cases.push_back(opponent(family, Group::flat, flat_scene));
  }
  cases.push_back(opponent(Family::simd, Group::flat, flat_scene));
  for (const int count : {7, 17, 25}) cases.push_back(opponent(Family::simd_depth, Group::flat, flat_scene, count));
}

void add_texture(std::vector<Case>& cases) {
  for (const int kernel_px : {8, 16, 32, 64, 120}) {
    for (const Family family : {Family::texture_gaussians, Family::texture_recursive}) {
      cases.push_back(opponent(family, Group::texture, wide(flat_scene, kernel_px)));
    }
  }
}

void add_start_up(std::vector<Case>& cases) {
  for (const bool filled : {false, true}) {
    cases.push_back({.family = Family::start_up, .group = Group::start_up, .cache_is_filled = filled});
  }
}

/// Adds every way to filter one scene.
void add_all_methods(std::vector<Case>& cases, const SceneSpec& scene) {
  for (const int threads : {0, 1}) {
    for (const int count : {7, 17, 25, 33}) {
      for (const int rank : {1, 2, 3}) cases.push_back({.scene = scene, .design = optimised(rank, count)});
      cases.push_back({.scene = scene, .design = by_importance(count)});
      for (std::size_t i = cases.size() - 4; i < cases.size(); ++i) cases[i].threads = threads;
    }
  }
  cases.push_back({.scene = scene, .memory = Memory::interleaved_f16});
  cases.push_back({.scene = scene, .tolerance = 0.01});
  for (const int samples : {21, 55, 128}) {
    for (const bool prefiltered : {false, true}) cases.push_back(disc(scene, samples, prefiltered));
  }
  cases.push_back({.family = Family::dermis_exact, .scene = scene});
  std::vector<Family> opponents = {Family::naive, Family::rule_2012};
  if (scene.geometry == Geometry::flat) opponents.insert(opponents.end(), {Family::simd, Family::simd_depth});
  for (const Family family : opponents) {
    for (const int count : {7, 17, 25, 33}) cases.push_back(opponent(family, Group::methods, scene, count));
  }
  if (scene.geometry == Geometry::flat) {
    cases.push_back(opponent(Family::fft, Group::methods, scene));
    if (has_opencv()) {
      cases.push_back(opponent(Family::opencv_separable, Group::methods, scene));
      cases.push_back(opponent(Family::opencv_bilateral, Group::methods, scene));
    }
  }
}

}  // namespace

std::vector<Case> default_cases() {
  std::vector<Case> cases;
  add_methods(cases);
  add_axes(cases);
  add_flat(cases);
  add_texture(cases);
  add_start_up(cases);
  return cases;
}

std::vector<Case> picture_cases() {
  std::vector<Case> cases;
  for (const int count : {7, 17, 25}) cases.push_back({.design = by_importance(count)});
  for (const int count : {7, 11, 17, 25, 33}) cases.push_back({.design = optimised(1, count)});
  for (const int count : {11, 17, 25, 33}) cases.push_back({.design = optimised(2, count)});
  cases.push_back({.design = optimised(3, 25)});
  cases.push_back({.design = {.model = Model::gaussians, .rank = 4, .count = 17}});
  cases.push_back({.design = optimised(2, 17), .sheared = false});
  for (const double jitter : {0.1, 0.3}) cases.push_back({.design = optimised(2, 17), .jitter = jitter});
  for (const bool prefiltered : {false, true}) {
    for (const int samples : {21, 55}) cases.push_back(disc({}, samples, prefiltered));
  }
  for (const Family family : {Family::naive, Family::rule_2012}) {
    for (const int count : {17, 25}) cases.push_back(opponent(family, Group::picture, {}, count));
  }
  for (const int count : {7, 17, 25}) cases.push_back(opponent(Family::simd_depth, Group::picture, {}, count));
  return on_picture(cases);
}

Case picture_reference() { return on_picture({{.family = Family::dermis_exact}}).front(); }

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const std::pair<int, int>& size : {std::pair{320, 180}, sizes[0], sizes[1], sizes[2]}) {
    for (const int kernel_px : kernels_px) {
      const SceneSpec scene = wide(sized({}, size), kernel_px);
      for (const int percent : {100, 50, 10, 1, 0}) add_all_methods(cases, covered(scene, percent));
      add_all_methods(cases, wide(sized(flat_scene, size), kernel_px));
    }
  }
  add_start_up(cases);
  return cases;
}

std::vector<Case> matching(std::vector<Case> cases, const std::string& expression) {
  try {
    const std::regex wanted(expression);
    std::erase_if(cases, [&](const Case& what) { return !std::regex_search(what.name(), wanted); });
  } catch (const std::regex_error&) {
    throw Error(ErrorCode::usage, "--filter", expression, "a regular expression");
  }
  if (cases.empty()) throw Error(ErrorCode::usage, "--filter", expression, "a match of a name that --list prints");
  return cases;
}

}  // namespace dermis::bench
