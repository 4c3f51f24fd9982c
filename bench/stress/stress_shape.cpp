// Frames, cameras and profiles of any size.
#include <algorithm>
#include <cmath>
#include <limits>

#include "stress/stress_field.hpp"

namespace dermis::bench {

namespace {

constexpr StressPromise keeps_bits{.energy = 0, .change = StressChange::keeps_bits};

/// A plane whose kernel has a radius of that many pixels along x.
StressField plane_of_radius(std::mt19937& engine, const StressFilter& flat, int width_px, int height_px,
                            double radius_px) {
  return stress_plane(engine, width_px, height_px, radius_px / flat.material(0).taps.radius_mm);
}

/// The left and right end and a piece between, so that the oracle does not take all day.
StressRow wide_frame(const StressFilter& flat, std::mt19937& engine, int width_px, int height_px) {
  constexpr int margin_px = 32;
  const StressField field = plane_of_radius(engine, flat, width_px, height_px, uniform(engine, 5, 12));
  const int middle = 16 * static_cast<int>(engine() % static_cast<unsigned>((width_px - 256) / 16));
  const int last = (width_px - 1) / 16 * 16 - 32;
  return judged(flat, field, "frame", std::to_string(width_px) + "x" + std::to_string(height_px), {},
                {{0, 48}, {middle, 48}, {last, 48}}, margin_px);
}

/// A few lit pixels where the kernel does not reach the frame's edges.
StressRow impulses(const StressFilter& filter, StressField field, const std::string& name, int margin_px,
                   std::mt19937& engine) {
  StressRow row{.group = "camera", .name = name, .promised = "sum 1e-05", .holds = true, .failure = {}};
  std::fill(field.light.begin(), field.light.end(), 0.0F);
  for (int i = 0; i < 3; ++i) {
    const auto x = margin_px + static_cast<int>(engine() % static_cast<unsigned>(field.width_px - 2 * margin_px));
    const auto y = margin_px + static_cast<int>(engine() % static_cast<unsigned>(field.height_px - 2 * margin_px));
    for (std::size_t c = 0; c < 3; ++c) {
      field.light[(static_cast<std::size_t>(y) * field.width_px + x) * 3 + c] =
          static_cast<float>(uniform(engine, 1, 9));
    }
  }
  const StressResult seen = filter.run(field);
  double before[3] = {};
  double after[3] = {};
  long lit = 0;
  for (std::size_t i = 0; i < field.light.size(); ++i) {
    before[i % 3] += static_cast<double>(field.light[i]);
    after[i % 3] += seen.values.values[i];
    lit += seen.values.values[i] != 0 ? 1 : 0;
  }
  row.energy = 0;
  for (int c = 0; c < 3; ++c) row.energy = std::max(row.energy, std::abs(after[c] / before[c] - 1));
  if (!(row.energy <= 1e-5)) fail(row, "the sum is off by " + std::to_string(row.energy));
  if (lit < 100) fail(row, "nothing spreads");
  return row;
}

/// Upright stripes of one material each.
StressField striped(std::mt19937& engine, int materials) {
  constexpr int stripe_px = 24;
  StressField field = stress_surface(engine, materials * stripe_px, 40, 300, 100, 0);
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    const auto stripe = static_cast<int>(i) % field.width_px / stripe_px;
    field.ids.push_back(static_cast<float>(stripe + 1));
  }
  return field;
}

}  // namespace

void add_frame_cases(std::vector<StressRow>& rows, const StressFilter& flat, std::mt19937& engine) {
  const auto radius = [&] { return uniform(engine, 6, 20); };
  // What has only itself to get light from does not change.
  constexpr StressPromise alone{.change = StressChange::any};
  rows.push_back(judged(flat, plane_of_radius(engine, flat, 1, 1, radius()), "frame", "1x1", alone));
  rows.push_back(judged(flat, plane_of_radius(engine, flat, 211, 1, radius()), "frame", "211x1"));
  rows.push_back(judged(flat, plane_of_radius(engine, flat, 1, 211, radius()), "frame", "1x211"));
  rows.push_back(judged(flat, plane_of_radius(engine, flat, 2, 2, radius()), "frame", "2x2"));
  rows.push_back(wide_frame(flat, engine, 16384, 16));
  rows.push_back(wide_frame(flat, engine, 8193, 3));
  rows.push_back(judged(flat, plane_of_radius(engine, flat, 40, 30, 500), "frame", "kernel 25 times as wide"));
  rows.push_back(
      judged(flat, plane_of_radius(engine, flat, 40, 30, 1e6), "frame", "kernel 50000 times as wide", alone));
  rows.push_back(judged(flat, plane_of_radius(engine, flat, 40, 30, 0.3), "frame", "kernel below a pixel", keeps_bits));
}

void add_camera_cases(std::vector<StressRow>& rows, const StressFilter& deep, std::mt19937& engine) {
  const double px_per_mm = uniform(engine, 2, 5);
  const double bump_mm = 2 / px_per_mm;
  rows.push_back(
      judged(deep, stress_surface(engine, 80, 48, 1, 1 / px_per_mm, 0.02 / px_per_mm), "camera", "focal length 1 px"));
  rows.push_back(
      judged(deep, stress_surface(engine, 80, 48, 1e6, 1e6 / px_per_mm, bump_mm), "camera", "focal length 1e6 px"));
  // A float32 holds depths of that size, in mm, to a sixteenth of a pixel only, unless mm_per_unit is a power of two:
  // what a curved surface is then worth, the oracle's bound says.
  constexpr StressPromise far_away{.rel_l2 = std::numeric_limits<double>::infinity(), .sure_values_only = false};
  StressField away = stress_surface(engine, 80, 48, 1e6, 1e6, 3);
  away.mm_per_unit = 1 / px_per_mm;
  rows.push_back(judged(deep, away, "camera", "1e6 units away", far_away));
  StressField aside = stress_surface(engine, 80, 48, 100 * px_per_mm, 100, 0);
  aside.camera.center_x = -1e6 * px_per_mm;
  rows.push_back(judged(deep, aside, "camera", "1e6 units aside", {.sure_values_only = false}));
  StressField plane = stress_surface(engine, 160, 120, 100 * px_per_mm, 100, 0);
  std::fill(plane.depth.begin(), plane.depth.end(), 100.0F);
  rows.push_back(impulses(deep, plane, "impulses on a plane", 50, engine));
}

void add_width_cases(std::vector<StressRow>& rows, const Device& device, std::mt19937& engine) {
  std::vector<Material> materials;
  std::vector<double> d_mm;
  for (int i = 0; i < 5; ++i) {
    d_mm.push_back(std::pow(10.0, 3 * i - 6));
    materials.push_back({i + 1, Profile::burley({d_mm[i], 0.6 * d_mm[i], 0.3 * d_mm[i]})});
  }
  const Options options{.taps = {.model = Model::pre_integrated, .placement = Placement::importance}};
  const StressFilter filter(device, materials, {.depth = true, .material = true}, options);
  StressField field = striped(engine, 5);
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    if (field.depth[i] < 1e9F)
      field.depth[i] = static_cast<float>(100 * d_mm[static_cast<std::size_t>(field.ids[i]) - 1]);
  }
  rows.push_back(judged(filter, field, "profile", "d 1e-6 to 1e6 mm, 3 px"));
  field = striped(engine, 5);
  rows.push_back(judged(filter, field, "profile", "d 1e-6 to 1e6 mm, 100 mm away"));
}

}  // namespace dermis::bench
