#define CATCH_CONFIG_RUNNER
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>

#include "support/catch.hpp"
#include "support/random.hpp"

std::uint32_t test_seed() {
  static const std::uint32_t seed = [] {
    const char* text = std::getenv("DERMIS_TEST_SEED");
    return text != nullptr ? static_cast<std::uint32_t>(std::stoul(text)) : std::random_device{}();
  }();
  return seed;
}

int main(int argc, char** argv) {
  std::cout << "DERMIS_TEST_SEED=" << test_seed() << std::endl;
  return Catch::Session().run(argc, argv);
}
