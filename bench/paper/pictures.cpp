#include "paper/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "inputs/natural_picture.hpp"

namespace dermis::bench {

namespace {

constexpr std::size_t pixels = static_cast<std::size_t>(side_px) * side_px;

std::size_t at(int y, int x) { return static_cast<std::size_t>(y) * side_px + static_cast<std::size_t>(x); }

/// The share of a pixel that is in a half-plane whose edge lies `distance` px from the pixel's centre.
double coverage(double distance, double angle) {
  // The integral of a box along the normal, seen through a box along each axis.
  const double wide = std::abs(std::cos(angle)) + std::abs(std::sin(angle));
  const double narrow = std::abs(std::cos(angle)) - std::abs(std::sin(angle));
  const double area = 2 * std::abs(std::cos(angle) * std::sin(angle));
  const auto square = [](double t) { return t > 0 ? t * t : 0.0; };
  return (square(distance + wide / 2) - square(distance + narrow / 2) - square(distance - narrow / 2) +
          square(distance - wide / 2)) /
         area;
}

}  // namespace

Pictures::Pictures() : power_(Eigen::MatrixXd::Zero(half_px + 1, half_px + 1)) {}

void Pictures::add(const std::vector<double>& picture) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::vector<double> power = power_of(picture, side_px);
  power_ += Eigen::Map<const RowMajor>(power.data(), half_px + 1, half_px + 1);
}

Pictures Pictures::natural(int count, std::uint32_t seed) {
  Pictures result;
  for (int i = 0; i < count; ++i) result.add(natural_picture(side_px, seed + static_cast<std::uint32_t>(i)));
  return result;
}

Pictures Pictures::dot(double radius_px) {
  constexpr int finer = 16;
  std::vector<double> picture(pixels);
  const int reach_px = static_cast<int>(radius_px) + 1;
  for (int y = -reach_px; y <= reach_px; ++y) {
    for (int x = -reach_px; x <= reach_px; ++x) {
      int inside = 0;
      for (int i = 0; i < finer * finer; ++i) {
        const double dx = x + (i % finer + 0.5) / finer - 0.5;
        const double dy = y + (i / finer + 0.5) / finer - 0.5;
        inside += std::hypot(dx, dy) < radius_px ? 1 : 0;
      }
      picture[at((y + side_px) % side_px, (x + side_px) % side_px)] = inside / (1.0 * finer * finer);
    }
  }
  Pictures result;
  result.add(picture);
  return result;
}

double Pictures::rel_l2(const Products& products, const Light& truth) const {
  double errors = 0;
  double truths = 0;
  for (int c = 0; c < 3; ++c) {
    errors += (power_.array() * (spectrum_of(products[c]) - truth[c]).array().square()).sum();
    truths += (power_.array() * truth[c].array().square()).sum();
  }
  return std::sqrt(errors / truths);
}

double Pictures::rel_l2(const Products& products, const Sample& sample) const {
  return rel_l2(products, sample.spectrum);
}

double Pictures::rel_l2(const Products& products, const Products& truth) const {
  return rel_l2(products, Light{spectrum_of(truth[0]), spectrum_of(truth[1]), spectrum_of(truth[2])});
}

Edge::Edge(double angle_degrees) {
  const double angle = angle_degrees * std::numbers::pi / 180;
  spectrum_.resize(pixels);
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      const double distance = (x - half_px + 0.5) * std::cos(angle) + (y - half_px + 0.5) * std::sin(angle);
      spectrum_[at(y, x)] = std::clamp(coverage(distance, angle), 0.0, 1.0);
    }
  }
  to_frequencies(spectrum_, side_px);
}

double Edge::max_error(const Products& products, const Sample& sample) const {
  // The square repeats: the edge has corners at its border.
  constexpr int first = side_px / 4;
  constexpr int last = side_px - first;
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    const Eigen::MatrixXd difference = spectrum_of(products[c]) - sample.spectrum[c];
    Spectrum error(pixels);
    for (int y = 0; y < side_px; ++y) {
      for (int x = 0; x < side_px; ++x)
        error[at(y, x)] = spectrum_[at(y, x)] * difference(mirrored(y, side_px), mirrored(x, side_px));
    }
    to_pixels(error, side_px);
    for (int y = first; y < last; ++y) {
      for (int x = first; x < last; ++x) {
        largest = std::max(largest, std::abs(error[at(y, x)].real()) / static_cast<double>(pixels));
      }
    }
  }
  return largest;
}

}  // namespace dermis::bench
