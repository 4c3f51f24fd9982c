#include "oracle/frame/rotation.hpp"

#include <cmath>
#include <numbers>

namespace dermis::oracle {

namespace {

constexpr int angles = 256;
constexpr int fraction_bits = 12;

std::uint32_t hash(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = (x * 0x9E3779B1U) ^ (y * 0x85EBCA77U) ^ (seed * 0xC2B2AE3DU);
  h ^= h >> 16;
  h *= 0x85EBCA6BU;
  h ^= h >> 13;
  h *= 0xC2B2AE35U;
  h ^= h >> 16;
  return h;
}

std::int32_t fixed_point(double value) { return static_cast<std::int32_t>(std::lround((1 << fraction_bits) * value)); }

std::int32_t whole(std::int32_t value) { return (value + (1 << (fraction_bits - 1))) >> fraction_bits; }

}  // namespace

int turn_of(int x, int y, std::uint32_t seed) {
  return static_cast<int>(hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed) >> 24);
}

Direction Direction::turned(Axis axis, int x, int y, std::uint32_t seed, const Camera& camera) {
  const double angle = 2 * std::numbers::pi * turn_of(x, y, seed) / angles;
  if (axis == horizontal)
    return {fixed_point(std::cos(angle)), fixed_point(std::sin(angle) * camera.scale_y / camera.scale_x)};
  return {fixed_point(-std::sin(angle) * camera.scale_x / camera.scale_y), fixed_point(std::cos(angle))};
}

PixelOffset Direction::offset(int length) const { return {whole(length * x_), whole(length * y_)}; }

}  // namespace dermis::oracle
