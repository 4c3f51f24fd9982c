// A step of light of height 1: figure 7 and Table 2.
#pragma once

#include "paper/lattice.hpp"

namespace dermis::bench {

/// The light of a step after scattering, per channel, at the pixels of a row.
using StepResponses = std::array<Eigen::VectorXd, 3>;

StepResponses step_responses(const Products& products);
StepResponses step_responses(const Sample& sample);

/// The largest difference between the responses of both, in the worst channel.
double max_step_error(const Products& products, const Sample& sample);

/// The marginal of a preset of Table 2 on every pixel.
Products artist_preset(const char* name, double pixel_mm);

}  // namespace dermis::bench
