#include "profile/edge_table.hpp"

#include <cmath>
#include <numbers>

namespace dermis {

EdgeTable::EdgeTable(const std::function<double(double)>& tail, double furthest) {
  int exponent = 0;
  std::frexp(furthest, &exponent);
  first_exponent_ = exponent - octaves;
  furthest_ = std::ldexp(0.5, exponent);  // the power of 2 at or below
  nearest_ = std::ldexp(0.5, first_exponent_);
  for (int piece = 0; piece < 2 * octaves; ++piece) {
    const double middle = std::ldexp(piece % 2 == 0 ? 0.625 : 0.875, first_exponent_ + piece / 2);
    const double half = std::ldexp(0.125, first_exponent_ + piece / 2);
    Piece logarithm{};
    const auto angle = [](int i) { return std::numbers::pi * (i + 0.5) / terms; };
    for (int i = 0; i < terms; ++i) logarithm[i] = std::log(tail(middle + half * std::cos(angle(i))));
    Piece& coefficient = pieces_.emplace_back();
    for (int k = 0; k < terms; ++k) {
      double sum = 0;
      for (int i = 0; i < terms; ++i) sum += logarithm[i] * std::cos(k * angle(i));
      coefficient[k] = (k == 0 ? 1.0 : 2.0) / terms * sum;
    }
  }
}

double EdgeTable::operator()(double x) const {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  const bool upper = mantissa >= 0.75;
  const Piece& coefficient = pieces_[2 * (exponent - first_exponent_) + (upper ? 1 : 0)];
  const double t = (mantissa - (upper ? 0.875 : 0.625)) * 8;
  // Clenshaw's recurrence
  double next = 0;
  double after_next = 0;
  for (int k = terms - 1; k > 0; --k) {
    const double value = 2 * t * next - after_next + coefficient[k];
    after_next = next;
    next = value;
  }
  return std::exp(t * next - after_next + coefficient[0]);
}

}  // namespace dermis
