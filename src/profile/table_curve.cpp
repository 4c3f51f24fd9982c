#include "profile/table_curve.hpp"

#include <math.h>  // NOLINT(modernize-deprecated-headers): j0 is in POSIX, not in C++

#include <algorithm>
#include <cmath>
#include <numbers>

#include "profile/monotone_cubic.hpp"
#include "profile/quadrature.hpp"

namespace dermis {

namespace {

using std::numbers::pi;

/// t in r = x cosh t, for r close to x too.
double line_angle(double r, double x) { return r > x ? 2 * std::asinh(std::sqrt((r - x) / (2 * x))) : 0; }

}  // namespace

double TableCurve::Segment::density(double r) const {
  const double t = r - from;
  return coefficient[0] + t * (coefficient[1] + t * (coefficient[2] + t * coefficient[3]));
}

double TableCurve::Segment::light(double near, double far) const {
  // three points are exact up to degree 5
  return 2 * pi * panel_integral<3>(near, far, [this](double r) { return r * density(r); });
}

void TableCurve::Segment::place_nodes() {
  static const GaussLegendre<nodes> rule;
  for (int i = 0; i < nodes; ++i) {
    const double r = (from + to) / 2 + (to - from) / 2 * rule.point[i];
    const double weight = (to - from) / 2 * rule.weight[i];
    square[i] = r * r;
    marginal[i] = weight * density(r) * r;
    edge[i] = weight * light_beyond(r) / r;
  }
}

TableCurve::TableCurve(std::span<const double> radii, std::span<const double> values) {
  const double largest = *std::max_element(values.begin(), values.end());
  const std::vector<double> slopes = monotone_slopes(radii, values);
  if (radii.front() > 0) segments_.push_back({0, radii.front(), {values.front() / largest, 0, 0, 0}});
  for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
    const double length = radii[i + 1] - radii[i];
    const double secant = (values[i + 1] - values[i]) / length;
    const double second = (3 * secant - 2 * slopes[i] - slopes[i + 1]) / length;
    const double third = (slopes[i] + slopes[i + 1] - 2 * secant) / (length * length);
    segments_.push_back(
        {radii[i], radii[i + 1], {values[i] / largest, slopes[i] / largest, second / largest, third / largest}});
  }
  double all = 0;
  for (const Segment& segment : segments_) all += segment.light(segment.from, segment.to);
  double within = 0;
  for (Segment& segment : segments_) {
    for (double& coefficient : segment.coefficient) coefficient /= all;
    segment.within = within;
    within += segment.light(segment.from, segment.to);
    knots_.push_back(segment.to);
  }
  double beyond = 0;
  for (std::size_t i = segments_.size(); i-- > 0;) {
    segments_[i].beyond = beyond;
    beyond += segments_[i].light(segments_[i].from, segments_[i].to);
    segments_[i].place_nodes();
  }
}

const TableCurve::Segment& TableCurve::segment_at(double r) const {
  const auto knot = std::lower_bound(knots_.begin(), knots_.end() - 1, r);
  return segments_[static_cast<std::size_t>(knot - knots_.begin())];
}

std::vector<double> TableCurve::numbers() const {
  std::vector<double> all;
  for (const Segment& segment : segments_) {
    all.insert(all.end(), {segment.from, segment.to});
    all.insert(all.end(), segment.coefficient.begin(), segment.coefficient.end());
  }
  return all;
}

double TableCurve::radial(double r) const { return r > reach() ? 0 : std::max(0.0, segment_at(r).density(r)); }

double TableCurve::disc(double r) const {
  if (r >= reach()) return 1;
  const Segment& segment = segment_at(r);
  return segment.within + segment.light(segment.from, r);
}

double TableCurve::disc_tail(double r) const {
  if (r >= reach()) return 0;
  const Segment& segment = segment_at(r);
  return segment.beyond + segment.light(r, segment.to);
}

template <class Function>
double TableCurve::along_line(double x, const Function& near, Weights Segment::*far) const {
  double sum = 0;
  for (auto segment = segments_.begin() + (&segment_at(x) - segments_.data()); segment != segments_.end(); ++segment) {
    if (segment->is_far_from(x)) {
      for (int i = 0; i < nodes; ++i) sum += ((*segment).*far)[i] / std::sqrt(segment->square[i] - x * x);
      continue;
    }
    const double begin = line_angle(segment->from, x);
    const double end = line_angle(segment->to, x);
    const auto value = [&](double u) {
      const double c = std::cosh(u);
      return near(*segment, x * c, c);
    };
    // What is summed is a polynomial of degree 5 in cosh u, divided by cosh u: its nearest singularity is i pi / 2, and
    // over a tenth it is nearly a polynomial of degree 10 in u, of which 8 points leave 1e-13.
    if (end - begin < 0.1) {
      sum += panel_integral<8>(begin, end, value);
    } else {
      const int panels = static_cast<int>(std::ceil(end - begin));
      const double width = (end - begin) / panels;
      for (int i = 0; i < panels; ++i) sum += panel_integral<12>(begin + i * width, begin + (i + 1) * width, value);
    }
  }
  return sum;
}

double TableCurve::marginal(double x) const {
  if (x >= reach()) return 0;
  const double away = std::max(x, 1e-30 * knots_.front());
  const auto near = [](const Segment& segment, double r, double) { return segment.density(r) * r; };
  return 2 * along_line(away, near, &Segment::marginal);
}

double TableCurve::edge_tail(double x) const {
  if (x >= reach()) return 0;
  if (x < 1e-30 * knots_.front()) return 0.5;
  const auto near = [x](const Segment& segment, double r, double c) { return segment.light_beyond(r) / (c * x); };
  return x / pi * along_line(x, near, &Segment::edge);
}

double TableCurve::spectrum(double omega) const {
  const double frequency = std::abs(omega);
  double sum = 0;
  for (const Segment& segment : segments_) {
    const double length = segment.to - segment.from;
    // Over a segment of so many turns J0 adds up to less than 3e-8 of the segment's light.
    if (length * frequency > 1e5) continue;
    const auto value = [&](double r) { return r * segment.density(r) * j0(frequency * r); };
    if (length * frequency < 0.5) {
      // off by less than 1e-10 of its light, as 12 points are over 8 radians
      sum += panel_integral<5>(segment.from, segment.to, value);
      continue;
    }
    const int panels = static_cast<int>(std::ceil(length * frequency / 8));
    const double width = length / panels;
    for (int i = 0; i < panels; ++i) {
      const double from = segment.from + i * width;
      sum += panel_integral<12>(from, from + width, value);
    }
  }
  return 2 * pi * sum;
}

}  // namespace dermis
