// Random test cases from a seed that every run prints: DERMIS_TEST_SEED=n repeats one.
#pragma once

#include <cstdint>
#include <random>

/// The seed of this run: DERMIS_TEST_SEED, else fresh.
std::uint32_t test_seed();

/// Random numbers of one test case. `salt` keeps test cases independent of each other and of their order.
class Random {
 public:
  explicit Random(std::uint32_t salt) : engine_(test_seed() * 2654435761U + salt) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }  // both included
  bool coin() { return integer(0, 1) == 1; }

 private:
  std::mt19937 engine_;
};
