#include "taps/tables/surface_weights.hpp"

#include <algorithm>
#include <cmath>

namespace dermis {

TermCurves make_term_curves(const Profile& profile, const ModelTerm& model, double radius_mm) {
  TermCurves curves{.normalised = model.normalised, .sum = {}, .falloff = {}, .centre = {}};
  for (int c = 0; c < 3; ++c) curves.sum[c] = model.normalised ? 1 : model.functions[c].sum();
  const auto falloff = [&](int c, double r) {
    const double value = std::isinf(r) ? 0 : value_of(profile, c, model.functions[c], r);
    return model.normalised ? std::max(value, 0.0) : value;
  };
  const auto centre = [&](int c, double r) {
    const TermFunction& f = model.functions[c];
    return f.sum() - (std::isinf(r) ? 0 : 2 * tail_of(profile, c, f, r));
  };
  // Tilt stretches distances beyond the radius.
  curves.falloff = tabulate(falloff, 2 * radius_mm);
  curves.centre = tabulate([&](int c, double root) { return centre(c, root * root); }, std::sqrt(4 * radius_mm));
  return curves;
}

SurfaceWeights::SurfaceWeights(const SizedTaps& taps, const std::vector<TermCurves>& terms, double px_per_mm)
    : taps_(taps), terms_(terms), px_per_mm_(px_per_mm) {
  followers_.reserve(rows() * functions());
  for (std::size_t row = 0; row < rows(); ++row) {
    const RadialPlace its_place = place(row, 1, 1);
    for (std::size_t t = 0; t < terms.size(); ++t) {
      for (int c = 0; c < 3; ++c) followers_.push_back(follower(row, t, c, its_place));
    }
  }
  on_plane_.resize(followers_.size());
  for (std::size_t row = 0; row < rows(); ++row) on_surface(row, 1, 1, &on_plane_[row * functions()]);
}

// A pair stands for the surface from half the way to one neighbour to half the way to the other.
double SurfaceWeights::length_mm(std::size_t row) const {
  const std::vector<double>& offsets = offsets_px();
  const double before = row < 2 ? 0 : offsets[row - 2];
  const double after = row < offsets.size() ? offsets[row] : 2 * offsets[row - 1] - before;
  return (after - before) / 2 / px_per_mm_;
}

SurfaceWeights::Follower SurfaceWeights::follower(std::size_t row, std::size_t term, int channel,
                                                  const RadialPlace& its_place) const {
  constexpr double longest_of_correction = 4;
  constexpr double longest = 1e4;
  constexpr double largest_share = 1e4;
  const TermCurves& curves = terms_[term];
  const double weight = fitted(row, term, channel);
  const double density = value_at(row == 0 ? curves.centre : curves.falloff, channel, its_place);
  Follower its;
  if (row == 0) {
    if (curves.normalised && density > 0) its.length_mm = weight / density;
    return its;
  }
  if (density == 0) return its;
  const double length = weight / density;
  if (curves.normalised) {
    // Weight and density may be nothing but rounding, of either sign.
    if (length >= 0 && length < longest * length_mm(row)) its.length_mm = length;
    return its;
  }
  its.length_mm = std::clamp(length, 0.0, longest_of_correction * length_mm(row));
  const double rest = weight - its.length_mm * density;
  const double first = fitted(row, 0, channel);
  if (std::abs(rest) < largest_share * first) its.share = rest / first;
  return its;
}

double SurfaceWeights::fitted(std::size_t row, std::size_t term, int channel) const {
  return taps_.placed.weights[channel](static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(term));
}

double SurfaceWeights::distance_mm(std::size_t row) const {
  return (row == 0 ? taps_.centre_half_width_px : offsets_px()[row - 1]) / px_per_mm_;
}

RadialPlace SurfaceWeights::place(std::size_t row, double length, double distance) const {
  if (row == 0) return place_of(std::sqrt(distance_mm(0) * length), terms_[0].centre.first_exponent);
  return place_of(distance_mm(row) * distance, terms_[0].falloff.first_exponent);
}

void SurfaceWeights::on_surface(std::size_t row, double length, double distance, double* weights) const {
  const RadialPlace its_place = place(row, length, distance);
  const Follower* its = &followers_[row * functions()];
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c, ++its) {
      const RadialTable& table = row == 0 ? terms_[t].centre : terms_[t].falloff;
      const double its_length_mm = row == 0 ? its->length_mm : its->length_mm * length;
      weights[3 * t + c] = its_length_mm * value_at(table, static_cast<int>(c), its_place);
      if (its->share != 0) weights[3 * t + c] += its->share * weights[c];
    }
  }
}

}  // namespace dermis
