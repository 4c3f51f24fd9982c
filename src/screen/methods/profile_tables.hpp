// Profiles as tables, for the methods that sum over the surface.
#pragma once

#include <string>

#include "dermis/plan.hpp"
#include "opencl/opencl.hpp"
#include "opencl/params.hpp"

namespace dermis {

struct ProfileTables {
  cl::Buffer profiles;     ///< ProfileParams of each material
  cl::Buffer nodes;        ///< of all tables: R(r), and the light within the disc of radius r
  double farthest_mm = 0;  ///< no light of any material comes from farther away

  void upload(const cl::Context& context, const std::vector<Material>& materials);
};

/// The build constant that kernels read the tables with.
std::string profile_table_constant();

}  // namespace dermis
