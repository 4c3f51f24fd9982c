// In test programs that run what GPUs get on any device, the linker takes this in place of the library's.
#include "opencl/device_shape.hpp"

dermis::DeviceShape dermis::device_shape(const cl::Device&) { return {"GPU", 1, false}; }
