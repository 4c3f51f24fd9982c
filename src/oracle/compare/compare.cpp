#include "dermis/oracle/compare.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "dermis/error.hpp"

namespace dermis::oracle {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string size_of(const Picture& picture) {
  return std::to_string(picture.width) + " x " + std::to_string(picture.height) + " x " +
         std::to_string(picture.channels);
}

void check(const Picture& a, const Picture& b, const Picture& where) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) {
    throw Error(ErrorCode::usage, "picture size", size_of(a), size_of(b));
  }
  if (where.width != a.width || where.height != a.height || where.channels != 1) {
    throw Error(ErrorCode::usage, "size of the selection", size_of(where),
                std::to_string(a.width) + " x " + std::to_string(a.height) + " x 1");
  }
}

bool is_same_kind(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Returns |a - b|. Of values that are not finite it is 0 if both are the same, and infinite otherwise.
double gap(double a, double b) {
  if (std::isfinite(a) && std::isfinite(b)) return std::abs(a - b);
  return is_same_kind(a, b) ? 0 : infinity;
}

/// Sums over the values that are compared.
struct Sums {
  double count = 0;
  double gap2 = 0;        ///< of squared gaps
  double reference2 = 0;  ///< of squared reference values
  double peak = 0;        ///< the largest reference value
};

double ratio(double a, double b) {
  if (a == 0) return 0;
  return a == infinity ? infinity : a / b;
}

void fill(Difference& difference, const Sums& sums) {
  if (sums.count == 0) return;
  difference.relative_l2 = ratio(std::sqrt(sums.gap2), std::sqrt(sums.reference2));
  difference.rmse = std::sqrt(sums.gap2 / sums.count);
  if (difference.rmse > 0) difference.psnr_db = 20 * std::log10(sums.peak / difference.rmse);
}

}  // namespace

Difference compare(const Picture& a, const Picture& b, const Picture& where) {
  check(a, b, where);
  Difference difference;
  Sums sums;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (where(x, y) == 0) continue;
      for (int c = 0; c < a.channels; ++c) {
        const double value_a = a(x, y, c);
        const double value_b = b(x, y, c);
        const double apart = gap(value_a, value_b);
        sums.count += 1;
        sums.gap2 += apart * apart;
        if (std::isfinite(value_b)) {
          sums.reference2 += value_b * value_b;
          sums.peak = std::max(sums.peak, std::abs(value_b));
        }
        if (apart > difference.max) {
          difference.max = apart;
          difference.max_x = x;
          difference.max_y = y;
          difference.max_channel = c;
          difference.max_a = value_a;
          difference.max_b = value_b;
        }
      }
    }
  }
  fill(difference, sums);
  return difference;
}

TruthError compare_with_truth(const Picture& a, const Picture& t, const Picture& u, const Picture& where) {
  check(a, t, where);
  check(a, u, where);
  double off = 0;
  double reference = 0;
  double noise = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (where.values[i / static_cast<std::size_t>(a.channels)] == 0) continue;
    const double x = a.values[i];
    const double first = t.values[i];
    const double second = u.values[i];
    if (!std::isfinite(x + first + second)) return {infinity, infinity};
    off += (x - first) * (x - second);
    reference += first * second;
    noise += (first - second) * (first - second) / 2;
  }
  const auto relative = [&](double sum) {
    if (sum <= 0) return 0.0;
    return reference > 0 ? std::sqrt(sum / reference) : infinity;
  };
  return {relative(off), relative(noise)};
}

Difference compare(const Picture& a, const Picture& b) { return compare(a, b, Picture(a.width, a.height, 1, 1)); }

}  // namespace dermis::oracle
