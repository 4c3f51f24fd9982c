// Lights, checked, and on the device.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/lights.hpp"
#include "opencl/command_chain.hpp"
#include "opencl/image_buffers.hpp"
#include "opencl/opencl.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// Throws Error(usage) that names the light if one is outside its ranges, or its map does not fit it.
std::vector<params::LightParams> make_light_params(std::span<const Light> lights);

/// The images of the maps of lights.
std::vector<CallerImage> map_images(std::span<const Light> lights);

struct LightSizes {
  std::size_t lights, texels;  ///< texels of all maps
  bool operator==(const LightSizes&) const = default;
};

LightSizes sizes_of(std::span<const Light> lights);

/// Device memory for the lights of a frame, and for the texels of all their maps.
struct LightMemory {
  LightSizes sizes;
  cl::Buffer lights;  ///< LightParams
  cl::Buffer maps;    ///< floats

  LightMemory(const Device& device, const LightSizes& wanted);
};

/// The lights of a frame in device memory.
class BoundLights {
 public:
  /// Adds the work of filling the memory to the commands. `program` has shadow_maps.cl. It outlives the work if maps
  /// are in host memory.
  BoundLights(const Device& device, CommandChain& commands, const cl::Program& program, std::span<const Light> lights,
              const LightMemory& memory);

 private:
  std::vector<std::unique_ptr<ImageBuffers>> maps_;
};

/// A buffer with these rows, one at least.
template <class Row>
cl::Buffer upload_rows(const cl::Context& context, std::vector<Row> rows) {
  if (rows.empty()) rows.emplace_back();
  return upload(context, rows);
}

}  // namespace dermis
