// Memory that a plan needs, told without a plan.
#include <utility>
#include <vector>

#include "dermis/dermis.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Device;
using dermis::FrameDescription;
using dermis::Options;
using dermis::Plan;

TEST_CASE("the memory of a plan is told without it", "[memory]") {
  Random random(4201);
  const Device device = Device::open();
  const std::vector<dermis::Material> materials = {{1, dermis::preset("skin").profile},
                                                   {2, dermis::preset("marble").profile, {}, 0.3, 0.2}};
  const FrameDescription frames{.depth = true, .material = true, .mask = true, .albedo = true};
  std::vector<Options> all(4);
  all[0].quality = dermis::Quality::draft;
  all[1].jitter = 0.5;
  all[1].taps = {.model = dermis::Model::svd, .rank = 3, .count = 5, .placement = dermis::Placement::importance};
  all[1].bad_pixels = dermis::BadPixels::error;
  all[2].method = dermis::Method::exact;
  all[3].method = dermis::Method::disc;
  all[3].disc.prefiltered = true;
  for (const Device& its : {device, with_kernel_shape(device, 1, "GPU")}) {
    for (const Options& options : all) {
      const Plan plan(its, materials, frames, options);
      for (const auto& [width, height] :
           {std::pair(1, 1), std::pair(random.integer(1, 4000), random.integer(1, 4000))}) {
        INFO(width << " x " << height << ", " << name_of(options.method));
        CHECK(Plan::scratch_bytes(its, materials, frames, options, width, height) == plan.scratch_bytes(width, height));
      }
    }
  }
  CHECK_THROWS_WITH(Plan::scratch_bytes(device, materials, {}, {}, 10, 10),
                    "materials: got 2, want exactly 1, as the frames have no material ids");
}
