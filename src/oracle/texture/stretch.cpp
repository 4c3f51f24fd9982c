// The stretches of texels by the positions of the surface.
#include <cmath>

#include "dermis/oracle/texture.hpp"

namespace dermis::oracle {

Picture stretch_of_positions(const Picture& position, const Picture& mask, double mm_per_unit) {
  Picture stretch(position.width, position.height, 2, 1);
  const auto is_object = [&](int x, int y) {
    if (x < 0 || x >= position.width || y < 0 || y >= position.height) return false;
    const bool finite = std::isfinite(position(x, y, 0) + position(x, y, 1) + position(x, y, 2));
    return finite && (mask.values.empty() || mask(x, y) > 0);
  };
  const auto distance = [&](int x, int y, int other_x, int other_y) {
    double squares = 0;
    for (int c = 0; c < 3; ++c) squares += std::pow(position(x, y, c) - position(other_x, other_y, c), 2);
    return std::sqrt(squares) * mm_per_unit;
  };
  for (int y = 0; y < position.height; ++y) {
    for (int x = 0; x < position.width; ++x) {
      if (!is_object(x, y)) continue;
      const bool left = is_object(x - 1, y);
      const bool right = is_object(x + 1, y);
      const bool up = is_object(x, y - 1);
      const bool down = is_object(x, y + 1);
      const double along_u = (left ? distance(x, y, x - 1, y) : 0) + (right ? distance(x, y, x + 1, y) : 0);
      const double along_v = (up ? distance(x, y, x, y - 1) : 0) + (down ? distance(x, y, x, y + 1) : 0);
      if (left || right) stretch(x, y, 0) = along_u / (left && right ? 2 : 1);
      if (up || down) stretch(x, y, 1) = along_v / (up && down ? 2 : 1);
    }
  }
  return stretch;
}

}  // namespace dermis::oracle
