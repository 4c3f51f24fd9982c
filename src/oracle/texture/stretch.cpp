// The stretches of texels by the positions of the surface.
#include <cmath>

#include "dermis/oracle/texture.hpp"

namespace dermis::oracle {

namespace {

class Positions {
 public:
  Positions(const Picture& position, const Picture& mask, double mm_per_unit)
      : position_(position), mask_(mask), mm_per_unit_(mm_per_unit) {}

  bool has_object(int x, int y) const {
    if (x < 0 || x >= position_.width || y < 0 || y >= position_.height) return false;
    const bool finite = std::isfinite(position_(x, y, 0) + position_(x, y, 1) + position_(x, y, 2));
    return finite && (mask_.values.empty() || mask_(x, y) > 0);
  }

  /// The mean distance to the texels before and after one along (dx, dy), mm; 1 if neither is of an object.
  double stretch(int x, int y, int dx, int dy) const {
    double sum = 0;
    int neighbours = 0;
    for (const int side : {-1, 1}) {
      if (!has_object(x + side * dx, y + side * dy)) continue;
      sum += distance_mm(x, y, x + side * dx, y + side * dy);
      ++neighbours;
    }
    return neighbours > 0 ? sum / neighbours : 1;
  }

 private:
  double distance_mm(int x, int y, int other_x, int other_y) const {
    double squares = 0;
    for (int c = 0; c < 3; ++c) squares += std::pow(position_(x, y, c) - position_(other_x, other_y, c), 2);
    return std::sqrt(squares) * mm_per_unit_;
  }

  const Picture& position_;
  const Picture& mask_;
  double mm_per_unit_;
};

}  // namespace

Picture stretch_of_positions(const Picture& position, const Picture& mask, double mm_per_unit) {
  const Positions positions(position, mask, mm_per_unit);
  Picture stretch(position.width, position.height, 2, 1);
  for (int y = 0; y < position.height; ++y) {
    for (int x = 0; x < position.width; ++x) {
      if (!positions.has_object(x, y)) continue;
      stretch(x, y, 0) = positions.stretch(x, y, 1, 0);
      stretch(x, y, 1) = positions.stretch(x, y, 0, 1);
    }
  }
  return stretch;
}

}  // namespace dermis::oracle
