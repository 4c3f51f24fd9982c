#include "paper/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dermis::bench {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Outer edge of a pixel, mm; the last pixel within the square has none.
double end_mm(int pixel, double pixel_mm) { return pixel == half_px - 1 ? infinity : (pixel + 0.5) * pixel_mm; }

/// cos(2 pi k x / side), times 2 for pixels that stand for their mirror image too.
const MatrixXd& waves() {
  static const MatrixXd all = [] {
    MatrixXd result(half_px + 1, half_px + 1);
    for (int k = 0; k <= half_px; ++k) {
      for (int x = 0; x <= half_px; ++x) {
        const double both = x == 0 || x == half_px ? 1 : 2;
        result(k, x) = both * std::cos(2 * std::numbers::pi * ((k * x) % side_px) / side_px);
      }
    }
    return result;
  }();
  return all;
}

MatrixXd exact_light(const Profile& profile, int channel, double pixel_mm) {
  MatrixXd light = MatrixXd::Zero(half_px + 1, half_px + 1);
  for (int y = 0; y < half_px; ++y) {
    for (int x = 0; x <= y; ++x) {
      light(y, x) = light(x, y) = profile.rectangle(channel, (x - 0.5) * pixel_mm, end_mm(x, pixel_mm),
                                                    (y - 0.5) * pixel_mm, end_mm(y, pixel_mm));
    }
  }
  return light;
}

}  // namespace

Sample make_sample(const std::string& name, const Profile& profile, double width_mm, double width_px) {
  Sample sample{name, profile, width_mm / width_px, {}, {}};
  for (int c = 0; c < 3; ++c) {
    sample.exact[c] = exact_light(profile, c, sample.pixel_mm);
    sample.spectrum[c] = waves() * sample.exact[c] * waves().transpose();
  }
  return sample;
}

double axis_deviation_mm(const Profile& profile, int channel) {
  // The variance is 4 times the integral over x > 0 of x times the light beyond x.
  constexpr int steps = 4000;
  const double nearest_mm = profile.half_width(channel, 0.5) * 1e-4;
  const double step = std::log(1e7) / steps;
  double variance = 0;
  for (int i = 0; i <= steps; ++i) {
    const double x_mm = nearest_mm * std::exp(step * i);
    variance += 4 * x_mm * x_mm * profile.edge_tail(channel, x_mm) * step;
  }
  return std::sqrt(variance);
}

VectorXd response_of(const VectorXd& row) { return waves() * row; }

MatrixXd spectrum_of(const std::vector<Product>& products) {
  MatrixXd result = MatrixXd::Zero(half_px + 1, half_px + 1);
  for (const Product& product : products) {
    const VectorXd response = response_of(product.f);
    result += product.scale * response * response.transpose();
  }
  return result;
}

MatrixXd light_of(const std::vector<Product>& products) {
  MatrixXd result = MatrixXd::Zero(half_px + 1, half_px + 1);
  for (const Product& product : products) result += product.scale * product.f * product.f.transpose();
  return result;
}

double sum_of(const VectorXd& row) { return 2 * row.sum() - row[0] - row[half_px]; }

double sum_of(const std::vector<Product>& products) {
  double total = 0;
  for (const Product& product : products) total += product.scale * std::pow(sum_of(product.f), 2);
  return total;
}

VectorXd row_sums(const std::vector<Product>& products) {
  VectorXd result = VectorXd::Zero(half_px + 1);
  for (const Product& product : products) result += product.scale * sum_of(product.f) * product.f;
  return result;
}

VectorXd row_sums(const MatrixXd& light) { return 2 * light.rowwise().sum() - light.col(0) - light.col(half_px); }

VectorXd step_response(const VectorXd& row_sums) {
  // Pixel i sees the light of the offsets up to i.
  VectorXd result(side_px);
  double arrived = 0;
  for (int i = 0; i < side_px; ++i) {
    const int offset = i - half_px;
    arrived += row_sums[std::abs(offset)];
    result[i] = arrived;
  }
  return result;
}

Products pre_integrated(const Profile& profile, double pixel_mm) {
  Products products;
  for (int c = 0; c < 3; ++c) {
    Product product{1, VectorXd::Zero(half_px + 1)};
    for (int x = 0; x < half_px; ++x) {
      product.f[x] = profile.strip(c, (x - 0.5) * pixel_mm, end_mm(x, pixel_mm));
    }
    products[c] = {product};
  }
  return products;
}

Products products_of(const TapSet& taps) {
  Products products;
  for (int c = 0; c < 3; ++c) {
    for (const TapTerm& term : taps.terms) {
      Product product{term.scale[c], VectorXd::Zero(half_px + 1)};
      for (std::size_t i = 0; i < taps.offsets_px.size(); ++i) {
        if (taps.offsets_px[i] < 0) continue;  // the row is even
        const double below = std::floor(taps.offsets_px[i]);
        const double share_of_next = taps.offsets_px[i] - below;
        const auto weight = static_cast<double>(term.weights[i][c]);
        const int at = static_cast<int>(below);
        // Both sides of the centre meet where a tap reads the pixel 0.
        const double sides = below == 0 && share_of_next > 0 ? 2 : 1;
        // Light beyond the square belongs to its last pixel, as that of the profile does.
        product.f[std::min(at, half_px - 1)] += sides * weight * (1 - share_of_next);
        product.f[std::min(at + 1, half_px - 1)] += weight * share_of_next;
      }
      products[c].push_back(product);
    }
  }
  return products;
}

Products dense_model(const Sample& sample, Model model, int rank, double guide) {
  constexpr int more_taps_than_pixels = 2047;
  const TapsDesign design = {.model = model, .rank = rank, .count = more_taps_than_pixels, .guide = guide};
  return products_of(make_tap_set(sample.profile, design, sample.pixel_mm));
}

}  // namespace dermis::bench
