// IEEE 754 half precision on the host, for values of 2^-14 to 65504 and 0.
#pragma once

#include <bit>
#include <cstdint>

namespace dermis::bench {

/// To nearest, ties to even. Below 2^-14 it is 0.
constexpr std::uint16_t half_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  if (magnitude < 0x38800000U) return 0;
  const std::uint32_t rounded = magnitude + 0xfffU + ((magnitude >> 13) & 1U);
  return static_cast<std::uint16_t>(((bits >> 16) & 0x8000U) | ((rounded - 0x38000000U) >> 13));
}

constexpr float float_of(std::uint16_t half) {
  const std::uint32_t magnitude = half & 0x7fffU;
  if (magnitude < 0x400U) return 0;
  return std::bit_cast<float>(((half & 0x8000U) << 16) | ((magnitude << 13) + 0x38000000U));
}

static_assert(float_of(half_of(0.5F)) == 0.5F && float_of(half_of(-3.0F)) == -3.0F && half_of(0) == 0);

}  // namespace dermis::bench
