// Samples of the surface integral on a disc about each pixel (Golubev 2018). The kernels are in
// kernels/integral/disc.cl and disc_texels.cl.
#pragma once

#include "screen/profile_tables.hpp"
#include "screen/scatter_method.hpp"

namespace dermis {

class DiscSampling final : public ScatterMethod {
 public:
  using ScatterMethod::ScatterMethod;

  TapsDesign design_of(const Material& material) const override;
  int vector_width() const override;
  std::vector<std::string> kernel_files() const override;
  std::string build_constants(int terms) const override;
  void upload(const cl::Context& context, const MaterialTables& tables) override;
  std::vector<std::size_t> buffer_bytes(const FrameSize& frame) const override;
  void prepare(FrameRun& run) const override;
  int steps(int height) const override;
  void scatter(FrameRun& run, int step) const override;

 private:
  params::TexelLevels levels(const FrameSize& frame) const;

  ProfileTables profiles_;
  cl::Buffer discs_;    ///< DiscParams of each material
  cl::Buffer samples_;  ///< SampleParams
  cl::Buffer turns_;    ///< cosine and sine of ROTATIONS angles
};

}  // namespace dermis
