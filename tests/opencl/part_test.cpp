// A part of a device, which PoCL's threads may look at when all handles are gone.
#include "opencl/device.hpp"
#include "support/catch.hpp"

using dermis::Device;

TEST_CASE("a part of a device is made once, and stays", "[device]") {
  if (Device::open().info().compute_units < 2) return;
  const cl::Device part(Device::open({}, 1).id(), true);
  CHECK(Device::open({}, 1).id() == part());
  CHECK(part.getInfo<CL_DEVICE_REFERENCE_COUNT>() > 1);  // `part` is one
}
