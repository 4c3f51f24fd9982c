// Lights, checked, and on the device.
#pragma once

#include <span>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/lights.hpp"
#include "opencl/opencl.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// Throws Error(usage) that names the light if one is outside its ranges, or its map does not fit it.
std::vector<params::LightParams> make_light_params(std::span<const Light> lights);

/// The lights of a frame, and the texels of all their maps.
class BoundLights {
 public:
  /// Puts the work of gathering maps on the queue. `program` has shadow_maps.cl. The maps of the caller are read until
  /// the queue is done with it.
  BoundLights(const Device& device, const cl::CommandQueue& queue, const cl::Program& program,
              std::span<const Light> lights);

  const cl::Buffer& lights() const { return lights_; }
  const cl::Buffer& maps() const { return maps_; }

 private:
  cl::Buffer lights_;
  cl::Buffer maps_;
};

/// A buffer with these rows, one at least.
template <class Row>
cl::Buffer upload_rows(const cl::Context& context, std::vector<Row> rows) {
  if (rows.empty()) rows.emplace_back();
  return upload(context, rows);
}

}  // namespace dermis
