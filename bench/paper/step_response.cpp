#include "paper/step_response.hpp"

#include <algorithm>

namespace dermis::bench {

StepResponses step_responses(const Products& products) {
  return {step_response(row_sums(products[0])), step_response(row_sums(products[1])),
          step_response(row_sums(products[2]))};
}

StepResponses step_responses(const Sample& sample) {
  return {step_response(row_sums(sample.exact[0])), step_response(row_sums(sample.exact[1])),
          step_response(row_sums(sample.exact[2]))};
}

double max_step_error(const Products& products, const Sample& sample) {
  const StepResponses seen = step_responses(products);
  const StepResponses truth = step_responses(sample);
  double largest = 0;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, (seen[c] - truth[c]).cwiseAbs().maxCoeff());
  return largest;
}

Products artist_preset(const char* name, double pixel_mm) { return pre_integrated(preset(name).profile, pixel_mm); }

}  // namespace dermis::bench
