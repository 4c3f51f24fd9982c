// The surface integral over all visible pixels of a material. The kernels are in kernels/integral/exact.cl.
#pragma once

#include "screen/profile_tables.hpp"
#include "screen/scatter_method.hpp"

namespace dermis {

class SurfaceIntegral final : public ScatterMethod {
 public:
  using ScatterMethod::ScatterMethod;

  std::vector<std::string> kernel_files() const override;
  std::string build_constants(int terms) const override;
  void upload(const cl::Context& context, const MaterialTables& tables) override;
  std::vector<std::size_t> buffer_bytes(const FrameSize& frame) const override;
  void prepare(FrameRun& run) const override;
  int steps(int height) const override;
  void scatter(FrameRun& run, int step) const override;

 private:
  ProfileTables profiles_;
};

}  // namespace dermis
