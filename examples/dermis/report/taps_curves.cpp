#include "report/taps_curves.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>

namespace dermis::program {
namespace {

constexpr int most_pixels_aside = 64;

/// Light of the profile on the pixel (i, j).
double light_on_pixel(const Profile& profile, int channel, int i, int j, double pixel_mm) {
  return profile.rectangle(channel, (i - 0.5) * pixel_mm, (i + 0.5) * pixel_mm, (j - 0.5) * pixel_mm,
                           (j + 0.5) * pixel_mm);
}

/// Light of the sum of products on the pixel (i, j), which is not beyond the taps.
double light_of_products(const TapSet& dense, std::size_t channel, int i, int j) {
  const std::size_t middle = dense.offsets_px.size() / 2;
  double light = 0;
  for (const TapTerm& term : dense.terms)
    light += term.scale[channel] * term.weights[middle + i][channel] * term.weights[middle + j][channel];
  return light;
}

/// Slice through the pixels (i, slope i), slope 0 or 1.
Slice slice(const Profile& profile, const TapSet& dense, int slope, int most) {
  const double length_mm = dense.pixel_mm * (slope == 0 ? 1 : std::numbers::sqrt2);
  const double area_mm2 = dense.pixel_mm * dense.pixel_mm;
  const int last = static_cast<int>(dense.offsets_px.size() / 2);
  const int step = last / most + 1;
  Slice result;
  for (int i = 0; i <= last; i += step) {
    CurvePoint truth{i * length_mm, {}};
    CurvePoint product = truth;
    for (int c = 0; c < 3; ++c) {
      truth.value[c] = light_on_pixel(profile, c, i, slope * i, dense.pixel_mm) / area_mm2;
      product.value[c] = light_of_products(dense, static_cast<std::size_t>(c), i, slope * i) / area_mm2;
    }
    result.truth.push_back(truth);
    result.product.push_back(product);
  }
  return result;
}

/// Singular values of the matrix of all pixels up to `aside` from the middle, largest first. It is symmetric and
/// even in both directions, so that all but those of the even vectors are 0, and these are the absolute eigenvalues of
/// what it does to the orthonormal even vectors: the middle alone, or two pixels by 1/sqrt(2) each.
Eigen::VectorXd singular_values(const Profile& profile, int channel, int aside, double pixel_mm) {
  Eigen::MatrixXd even(aside + 1, aside + 1);
  for (int i = 0; i <= aside; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double both = (i == 0 ? 1 : std::numbers::sqrt2) * (j == 0 ? 1 : std::numbers::sqrt2);
      even(i, j) = even(j, i) = both * light_on_pixel(profile, channel, i, j, pixel_mm);
    }
  }
  Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(even, Eigen::EigenvaluesOnly).eigenvalues().cwiseAbs();
  std::sort(values.begin(), values.end(), std::greater<>());
  return values;
}

/// Light of 1 on the pixels from 0 on, read at `at_px`.
double step_at(double at_px) { return std::clamp(at_px + 1, 0.0, 1.0); }

double step_seen(const TapSet& set, std::size_t channel, int pixel) {
  double result = 0;
  for (const TapTerm& term : set.terms) {
    double across = 0;
    double along = 0;
    for (std::size_t i = 0; i < set.offsets_px.size(); ++i) {
      across += term.weights[i][channel] * step_at(pixel + set.offsets_px[i]);
      along += term.weights[i][channel];
    }
    result += term.scale[channel] * across * along;
  }
  return result;
}

}  // namespace

Slice axis_slice(const Profile& profile, const TapSet& dense, int most) { return slice(profile, dense, 0, most); }

Slice diagonal_slice(const Profile& profile, const TapSet& dense, int most) { return slice(profile, dense, 1, most); }

Curve singular_values(const Profile& profile, const TapSet& dense, int count) {
  const double radius_px = dense.offsets_px.back();
  const int aside = static_cast<int>(std::min<double>(radius_px, most_pixels_aside));
  const double pixel_mm = dense.pixel_mm * radius_px / aside;
  Curve curve;
  for (int k = 1; k <= std::min(count, aside + 1); ++k) curve.push_back({static_cast<double>(k), {}});
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd values = singular_values(profile, c, aside, pixel_mm);
    for (std::size_t k = 0; k < curve.size(); ++k) curve[k].value[c] = values[static_cast<Eigen::Index>(k)] / values[0];
  }
  return curve;
}

StepResponse step_response(const Profile& profile, const TapSet& set, double radius_mm, int most) {
  // A pixel away is the least: the two at the edge.
  const int pixels = static_cast<int>(std::max(1.0, std::ceil(radius_mm / set.pixel_mm)));
  const int step = 2 * pixels / most + 1;
  StepResponse response;
  for (int pixel = -pixels; pixel < pixels; pixel += step) {
    CurvePoint exact{(pixel + 0.5) * set.pixel_mm, {}};
    CurvePoint taps = exact;
    for (int c = 0; c < 3; ++c) {
      exact.value[c] = profile.edge(c, exact.x);
      taps.value[c] = step_seen(set, static_cast<std::size_t>(c), pixel);
    }
    response.exact.push_back(exact);
    response.taps.push_back(taps);
  }
  return response;
}

}  // namespace dermis::program
