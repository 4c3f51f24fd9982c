#include "case.hpp"

namespace dermis::bench {

std::vector<Case> separable_cases() {
  std::vector<Case> cases;
  for (const int taps : {7, 11, 17, 25, 33, 51}) {
    cases.push_back({"separable " + std::to_string(taps), {.taps = {.count = taps}}});
  }
  cases.push_back({"separable 25, jitter 0.1", {.taps = {.count = 25}, .jitter = 0.1}});
  cases.push_back({"separable 25, jitter 0.3", {.taps = {.count = 25}, .jitter = 0.3}});
  return cases;
}

}  // namespace dermis::bench
