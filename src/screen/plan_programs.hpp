// The programs of a plan.
#pragma once

#include <string>
#include <vector>

#include "opencl/program.hpp"
#include "screen/methods/scatter_method.hpp"

namespace dermis {

struct PlanPrograms {
  ProgramSource classification;
  ProgramSource method;             ///< the same as that of classification if both have vectors of one width
  std::vector<ProgramSource> more;  ///< of the method
  ProgramSource fingerprint;        ///< built for a sequence whose frames are compared
};

/// The build options that all kernels of a plan share.
std::string common_options(const PlanSettings& settings);

/// The sources of the programs of a plan whose materials have so many terms.
PlanPrograms plan_programs(const PlanSettings& settings, const ScatterMethod& method, int terms);

}  // namespace dermis
