// The inverse cdf of Burley's profile in float32, on the device.
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "core/opencl.hpp"
#include "core/program.hpp"
#include "dermis/device.hpp"
#include "dermis/profile.hpp"
#include "random.hpp"

namespace {

/// burley_radius of every share, by a kernel that does nothing else.
std::vector<float> radii_on_device(const std::vector<float>& shares) {
  const dermis::Device opened = dermis::Device::open();
  const cl::Context context(opened.context(), true);
  const cl::Device device(opened.id(), true);
  const std::string caller =
      "kernel void radii(global const float* shares, global float* radii) {\n"
      "  radii[get_global_id(0)] = burley_radius(shares[get_global_id(0)]);\n"
      "}\n";
  cl::Program program(context, dermis::assemble_source({"burley.h"}) + caller);
  program.build({device});
  const std::size_t bytes = shares.size() * sizeof(float);
  cl::Buffer in(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, bytes, const_cast<float*>(shares.data()));
  cl::Buffer out(context, CL_MEM_WRITE_ONLY, bytes);
  cl::Kernel kernel(program, "radii");
  kernel.setArg(0, in);
  kernel.setArg(1, out);
  const cl::CommandQueue queue(context, device);
  queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(shares.size()));
  std::vector<float> radii(shares.size());
  queue.enqueueReadBuffer(out, CL_TRUE, 0, bytes, radii.data());
  return radii;
}

}  // namespace

TEST_CASE("Burley's inverse cdf is good to 5e-7 in float32 for all shares", "[kernels][profile]") {
  // All there are, dense in log u, in log (1 - u) and about where the form changes: from the smallest normal number, as
  // a device may flush what is below, to the last one before 1. Two roundings of the argument of log1p or log,
  // each 6e-8 of a value whose logarithm is 0.5 or more of its size, and two to four of the functions themselves make
  // 5e-7.
  Random random(120);
  constexpr float least = std::numeric_limits<float>::min();
  const float most = std::nextafter(1.0F, 0.0F);
  std::vector<float> shares = {least, 1e-7F, 0.5F, std::nextafter(0.5F, 0.0F), most};
  for (int i = 0; i < 200000; ++i) {
    shares.push_back(static_cast<float>(std::exp(random.uniform(std::log(static_cast<double>(least)), 0))));
    shares.push_back(static_cast<float>(std::exp(random.uniform(std::log(1e-7), 0))));
    shares.push_back(1 - static_cast<float>(std::exp(random.uniform(std::log(5.9e-8), 0))));
    shares.push_back(static_cast<float>(random.uniform(0.499, 0.501)));
  }
  std::erase_if(shares, [&](float u) { return u < least || u > most; });
  const std::vector<float> radii = radii_on_device(shares);
  const dermis::Profile profile = dermis::Profile::burley({1, 1, 1});
  double worst = 0;
  float worst_share = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double expected = profile.radius(0, shares[i]);
    const double error = std::abs(radii[i] - expected) / expected;
    if (!(error <= worst)) {
      worst = error;
      worst_share = shares[i];
    }
  }
  CAPTURE(test_seed(), worst, worst_share);
  CHECK(shares.size() > 750000);
  CHECK(worst <= 5e-7);
  CHECK(radii_on_device({0.0F}).front() == 0);
}
