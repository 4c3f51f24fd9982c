#include "measure/picture_measurement.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/rule_2012.hpp"
#include "measure/copy.hpp"
#include "measure/percentile.hpp"
#include "measure/picture_edges.hpp"
#include "support/stopwatch.hpp"

namespace dermis::bench {

namespace {

oracle::Picture picture_of(const Subject& subject, const std::vector<float>& values) {
  oracle::Picture picture(subject.width, subject.height, 3);
  picture.values.assign(values.begin(), values.end());
  return picture;
}

/// 1 where the pixel has the id of material `index`.
oracle::Picture mask_of(const Subject& subject, std::size_t index) {
  oracle::Picture mask(subject.width, subject.height, 1);
  for (std::size_t i = 0; i < subject.ids.size(); ++i) {
    mask.values[i] = subject.ids[i] == static_cast<float>(subject.materials[index].id) ? 1 : 0;
  }
  return mask;
}

/// A plan and what its runs took.
struct Running {
  PictureRow row;
  Plan plan;
  std::vector<float> scattered;
  std::vector<double> total_ms, scatter_ms;

  Running(const Device& device, const Subject& subject, const PictureCase& what)
      : plan(timed_plan(device, subject, what.options, row.plan_ms)), scattered(subject.light.size()) {
    row.what = what;
    constexpr double mib = 1024 * 1024;
    row.scratch_mib = static_cast<double>(plan.scratch_bytes(subject.width, subject.height)) / mib;
  }

  void run(const Subject& subject) {
    const Stats stats = plan.run(subject.frame(scattered));
    total_ms.push_back(stats.total_ms);
    scatter_ms.push_back(stats.scatter_ms);
  }

  static Plan timed_plan(const Device& device, const Subject& subject, const Options& options, double& ms) {
    std::vector<float> none(subject.light.size());
    std::optional<Plan> plan;
    ms = time_ms([&] { plan.emplace(device, subject.materials, FrameDescription::of(subject.frame(none)), options); });
    return std::move(*plan);
  }
};

constexpr int rule_2012_taps = 25;

oracle::Picture by_rule_2012(const Subject& subject) {
  std::vector<oracle::SliceMaterial> slices;
  for (const Material& material : subject.materials) {
    const Profile& profile = material.profile;
    slices.push_back({material.id, [&profile](int channel, double r_mm) { return profile.radial(channel, r_mm); },
                      profile.half_width(profile.widest_channel(), 0.999)});
  }
  std::vector<float> none;
  return oracle::rule_2012(subject.frame(none), slices, rule_2012_taps);
}

void add_times(PictureRow& row, const Running& running, double copy_ms) {
  row.ms = percentile(running.total_ms, 0.5);
  row.ms_p10 = percentile(running.total_ms, 0.1);
  row.ms_p90 = percentile(running.total_ms, 0.9);
  row.scatter_ms = percentile(running.scatter_ms, 0.5);
  row.copy_ratio = row.ms / copy_ms;
}

}  // namespace

Frame Subject::frame(std::vector<float>& scattered) const {
  Frame frame{.width = width, .height = height, .camera = camera, .mm_per_unit = mm_per_unit};
  frame.light.host = light.data();
  frame.depth.host = depth.data();
  frame.material.host = ids.data();
  frame.scattered.host = scattered.data();
  return frame;
}

Subject load_subject(const std::filesystem::path& path, double mm_per_unit, const std::vector<int>& ids,
                     const std::vector<std::string>& names) {
  const exr::Picture picture = exr::Picture::read(path);
  const exr::Roles roles = exr::find_roles(picture);
  for (const exr::Role role : {exr::Role::light, exr::Role::material}) exr::require(picture, roles, role);
  const exr::FoundCamera camera = exr::find_camera(picture, roles);
  Subject subject{.name = path.stem().string(),
                  .width = picture.width(),
                  .height = picture.height(),
                  .camera = camera.camera,
                  .mm_per_unit = mm_per_unit,
                  .light = exr::load(picture, roles, exr::Role::light),
                  .depth = exr::load_depth(picture, roles, camera),
                  .ids = exr::load(picture, roles, exr::Role::material),
                  .materials = {},
                  .material_names = names};
  for (std::size_t i = 0; i < ids.size(); ++i) subject.materials.push_back({ids[i], preset(names[i]).profile});
  return subject;
}

PictureMeasurement measure_picture(const Device& device, const Subject& subject, const std::vector<PictureCase>& cases,
                                   int rounds, const std::function<void(const std::string&)>& report) {
  PictureMeasurement result;
  report("exact (takes the longest)");
  Running exact(device, subject, {"exact", "", {.method = Method::exact}});
  exact.run(subject);

  std::vector<Running> running;
  for (const PictureCase& what : cases) {
    report("plan of " + what.name);
    running.emplace_back(device, subject, what);
  }
  FrameCopy copy(subject.depth.size());
  std::vector<double> copy_ms;
  constexpr int rounds_to_drop = 2;
  for (int round = 0; round < rounds + rounds_to_drop; ++round) {
    report("round " + std::to_string(round + 1) + " of " + std::to_string(rounds + rounds_to_drop));
    copy_ms.push_back(time_ms([&] { copy.run(); }));
    for (Running& one : running) one.run(subject);
    if (round + 1 == rounds_to_drop) {
      copy_ms.clear();
      for (Running& one : running) {
        one.total_ms.clear();
        one.scatter_ms.clear();
      }
    }
  }

  result.copy_ms = percentile(copy_ms, 0.5);
  result.exact = exact.row;
  add_times(result.exact, exact, result.copy_ms);
  result.exact.rel_l2.assign(subject.materials.size(), 0.0);
  const oracle::Picture truth = picture_of(subject, exact.scattered);
  const oracle::Picture edges = near_edges(subject);
  result.edge_pixels = std::count(edges.values.begin(), edges.values.end(), 1.0);
  std::vector<oracle::Picture> masks;
  for (std::size_t i = 0; i < subject.materials.size(); ++i) {
    masks.push_back(mask_of(subject, i));
    result.pixels.push_back(std::count(masks[i].values.begin(), masks[i].values.end(), 1.0));
  }
  const auto add_errors = [&](PictureRow& row, const oracle::Picture& picture) {
    for (const oracle::Picture& mask : masks) {
      const oracle::Difference difference = oracle::compare(picture, truth, mask);
      row.rel_l2.push_back(difference.relative_l2);
      row.max_error = std::max(row.max_error, difference.max);
    }
    row.edge_rel_l2 = oracle::compare(picture, truth, edges).relative_l2;
  };
  report("the rule of 2012");
  result.rule_2012.what.name = fmt::format("rule of 2012, {} taps", rule_2012_taps);
  result.rule_2012.loads = 2 * rule_2012_taps;
  add_errors(result.rule_2012, by_rule_2012(subject));
  for (Running& one : running) {
    add_times(one.row, one, result.copy_ms);
    const Options& options = one.row.what.options;
    one.row.loads =
        options.method == Method::disc ? 4.0 * options.disc.samples : (1.0 + options.taps.rank) * options.taps.count;
    add_errors(one.row, picture_of(subject, one.scattered));
    result.rows.push_back(one.row);
  }
  return result;
}

}  // namespace dermis::bench
