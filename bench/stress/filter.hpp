// Runs of a frame under stress through a plan, and through the oracle with the same taps.
#pragma once

#include <cstdint>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "dermis/plan.hpp"
#include "stress/field.hpp"

namespace dermis::bench {

/// The output of a run.
struct StressResult {
  oracle::Picture values;
  std::vector<std::uint32_t> bits;        ///< bits of each value
  std::vector<std::uint32_t> input_bits;  ///< bits of the light
  Stats stats;
};

/// A plan, and its materials for the oracle. The frames have depth and ids as the description says.
class StressFilter {
 public:
  StressFilter(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
               const Options& options = {});

  StressResult run(const StressField& field) const;
  oracle::Reference reference(const StressField& field) const;
  const oracle::Material& material(std::size_t index) const { return for_oracle_[index]; }

 private:
  Options options_;
  std::vector<oracle::Material> for_oracle_;
  Plan plan_;
};

}  // namespace dermis::bench
