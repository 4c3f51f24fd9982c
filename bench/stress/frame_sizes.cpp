// Frames of any size, kernels from below a pixel to far beyond the frame.

#include "stress/cases.hpp"
#include "stress/judgement.hpp"

namespace dermis::bench {

namespace {

constexpr StressPromise keeps_bits{.energy = 0, .change = StressChange::keeps_bits};

/// A plane whose kernel has a radius of that many pixels along x.
StressField plane_of_radius(std::mt19937& engine, const StressFilter& flat, int width_px, int height_px,
                            double radius_px) {
  return stress_plane(engine, width_px, height_px, radius_px / flat.material(0).taps.radius_mm);
}

/// Compares the left and right end and a piece between: the oracle would take minutes for all of it.
StressRow wide_frame(const StressFilter& flat, std::mt19937& engine, int width_px, int height_px) {
  constexpr int margin_px = 32;
  const StressField field = plane_of_radius(engine, flat, width_px, height_px, uniform(engine, 5, 12));
  const int middle = 16 * static_cast<int>(engine() % static_cast<unsigned>((width_px - 256) / 16));
  const int last = (width_px - 1) / 16 * 16 - 32;
  return judged(flat, field, "frame", std::to_string(width_px) + "x" + std::to_string(height_px), {},
                {{0, 48}, {middle, 48}, {last, 48}}, margin_px);
}

}  // namespace

void add_frame_cases(std::vector<StressRow>& rows, const StressFilter& flat, std::mt19937& engine) {
  const auto radius = [&] { return uniform(engine, 6, 20); };
  // A pixel that gets light from itself alone does not change.
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

}  // namespace dermis::bench
