#include "commands/compare_methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <deque>
#include <utility>

#include "arguments/material_arguments.hpp"
#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/rule_2012.hpp"
#include "files/output_file.hpp"
#include "files/picture_png.hpp"
#include "report/gnuplot.hpp"

namespace dermis::program {
namespace {

/// The error that a map shows brightest, of the mean of the light.
constexpr double brightest_error = 0.1;

std::size_t values_of(const Frame& frame) {
  return 3 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
}

/// The frame by a plan of its own, into memory of its own.
MethodPicture by_plan(const Device& device, const std::vector<Material>& materials, Frame frame, std::string name,
                      const Options& options) {
  MethodPicture picture{std::move(name), std::vector<float>(values_of(frame)), std::vector<float>(values_of(frame))};
  frame.scattered = {.host = picture.scattered.data()};
  frame.result = {.host = picture.beauty.data()};
  Plan(device, materials, FrameDescription::of(frame), options).run(frame);
  return picture;
}

std::vector<oracle::SliceMaterial> slice_materials(const std::vector<Material>& materials) {
  std::vector<oracle::SliceMaterial> slices;
  for (const Material& material : materials) {
    const Profile& profile = material.profile;
    slices.push_back({material.id, [profile](int channel, double r_mm) { return profile.radial(channel, r_mm); },
                      kernel_radius_mm(profile)});
  }
  return slices;
}

/// What a pixel shows more of its light shows in the beauty by the albedo.
MethodPicture by_rule_2012(const std::vector<Material>& materials, const Frame& frame, const LoadedFrame& loaded,
                           std::vector<float> beauty) {
  constexpr int taps = 25;
  const oracle::Picture light = oracle::rule_2012(frame, slice_materials(materials), taps);
  MethodPicture picture{fmt::format("rule of 2012, {} taps", taps), std::move(beauty), {}};
  for (std::size_t i = 0; i < light.values.size(); ++i) {
    picture.scattered.push_back(static_cast<float>(light.values[i]));
    picture.beauty[i] += loaded.albedo[i] * (picture.scattered[i] - loaded.light[i]);
  }
  return picture;
}

oracle::Picture as_picture(int width, int height, const std::vector<float>& values) {
  oracle::Picture picture(width, height, 3);
  std::copy(values.begin(), values.end(), picture.values.begin());
  return picture;
}

/// 1 where two pictures differ.
oracle::Picture changed_pixels(int width, int height, const std::vector<float>& a, const std::vector<float>& b) {
  oracle::Picture changed(width, height, 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i]) changed.values[i / 3] = 1;
  return changed;
}

/// The mean error of the channels, of the mean of the reference where it counts.
std::vector<float> error_map(const std::vector<float>& values, const std::vector<float>& reference,
                             const oracle::Picture& where) {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (where.values[i / 3] == 0) continue;
    sum += std::abs(static_cast<double>(reference[i]));
    ++count;
  }
  const double unit = count > 0 ? sum / count * brightest_error : 1;
  std::vector<float> map(reference.size() / 3);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double error = std::abs(static_cast<double>(values[i]) - static_cast<double>(reference[i])) / 3 / unit;
    if (where.values[i / 3] != 0) map[i / 3] = std::min(1.0F, map[i / 3] + static_cast<float>(error));
  }
  return map;
}

double relative_l2(int width, int height, const std::vector<float>& a, const std::vector<float>& b,
                   const oracle::Picture& where) {
  return oracle::compare(as_picture(width, height, a), as_picture(width, height, b), where).relative_l2;
}

std::string panel(const std::string& title, const std::filesystem::path& png) {
  return fmt::format("set title {} offset 0,-0.8\nplot {} binary filetype=png with rgbimage notitle\n",
                     script_string(title), script_string(png.string()));
}

}  // namespace

std::vector<MethodPicture> picture_methods(const Device& device, const std::vector<Material>& materials,
                                           const Frame& frame, const LoadedFrame& loaded, std::vector<float> beauty,
                                           const Options& options) {
  const auto say = [](const std::string& name) { fmt::print(stderr, "dermis: comparing: {}\n", name); };
  const auto with = [&](Method method, int rank) {
    Options its = options;
    its.method = method;
    its.taps = {.rank = rank, .count = 17};
    its.sheared = true;
    its.jitter = 0;
    return its;
  };
  std::vector<Material> same_taps = materials;
  for (Material& material : same_taps) material.taps.reset();

  std::vector<MethodPicture> pictures = {{"no scattering", beauty, loaded.light}};
  say("rule of 2012");
  pictures.push_back(by_rule_2012(materials, frame, loaded, std::move(beauty)));
  for (const int rank : {1, 2}) {
    const std::string name = fmt::format("dermis, rank {}, 17 taps", rank);
    say(name);
    pictures.push_back(by_plan(device, same_taps, frame, name, with(Method::separable, rank)));
  }
  const std::string disc = "disc, 55 samples, prefiltered";
  say(disc);
  Options with_discs = with(Method::disc, 1);
  with_discs.disc = {.samples = 55, .prefiltered = true};
  pictures.push_back(by_plan(device, same_taps, frame, disc, with_discs));
  say("exact (takes the longest)");
  pictures.push_back(by_plan(device, same_taps, frame, "exact", with(Method::exact, 1)));
  return pictures;
}

void draw_methods(const char* argument, const std::filesystem::path& path, int width, int height,
                  const std::vector<MethodPicture>& pictures) {
  const bool has_truth = pictures.back().scattered.empty();
  const MethodPicture& truth = pictures.back();
  const MethodPicture& exact = has_truth ? pictures[pictures.size() - 2] : truth;
  const oracle::Picture where = changed_pixels(width, height, exact.scattered, pictures.front().scattered);

  std::deque<TemporaryFile> files;
  std::string upper;
  std::string lower;
  for (const MethodPicture& picture : pictures) {
    const auto beside = [&] {
      return files.emplace_back(argument, fmt::format("{}.{}", path.string(), files.size())).path();
    };
    const std::filesystem::path beauty = beside();
    write_srgb_png(beauty, width, height, picture.beauty);
    upper += panel(picture.name, beauty);
    std::string numbers;
    if (has_truth && &picture != &truth)
      numbers = fmt::format("{:.1f} % off the path tracer",
                            100 * relative_l2(width, height, picture.beauty, truth.beauty, where));
    if (picture.scattered.empty()) {
      lower += "set multiplot next\n";
      continue;
    }
    if (&picture != &exact)
      numbers = fmt::format("{:.2f} % off the exact method",
                            100 * relative_l2(width, height, picture.scattered, exact.scattered, where)) +
                (numbers.empty() ? "" : ", " + numbers);
    const std::filesystem::path map = beside();
    write_heatmap_png(map, width, height, error_map(picture.scattered, exact.scattered, where));
    lower += panel(numbers, map);
  }
  constexpr int widest_px = 480;
  constexpr int title_px = 30;
  const int panel_px = std::clamp(width, 240, widest_px);
  const auto columns = static_cast<int>(pictures.size());
  const int row_px = panel_px * height / width + title_px;
  const std::string script = fmt::format(
      "unset tics\nunset border\nunset key\nset size ratio -1\nset margins 0.5,0.5,0.2,1.6\n"
      "set xrange [0:{}]\nset yrange [0:{}]\nset multiplot layout 2,{}\n{}{}unset multiplot\n",
      width - 1, height - 1, columns, upper, lower);
  draw_figure(argument, path, {columns * panel_px, 2 * row_px}, script);
}

}  // namespace dermis::program
