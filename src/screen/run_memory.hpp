// The device memory of one run, kept from one to the next.
#pragma once

#include <cstddef>

#include "dermis/plan.hpp"
#include "opencl/opencl.hpp"
#include "opencl/params.hpp"

namespace dermis {

/// What a plan asks of the memory for a frame of some size.
struct RunSizes {
  int width, height;
  int tile_width;
  int tile_height, least_tile_height;  ///< the device chooses between them
  int workers;                         ///< work-items that take tiles; 0 if the window is the frame
  int terms;                           ///< images of light between the passes
  int farthest_px;                     ///< no tap is farther
  int side_px;                         ///< taps of the vertical pass that are not turned lie no more columns away
  bool has_pixel_width, turns_taps;
  Method method;
  int texel_levels;  ///< of the disc method

  int stride() const;  ///< of planes as large as the frame, elements
  int blocks_x() const;
  int blocks_y() const;
  int tiles_x() const;
  int tiles_y(int its_tile_height) const;
  std::size_t frame_plane() const;       ///< elements
  std::size_t horizontal_plane() const;  ///< of the window of the horizontal pass
  std::size_t vertical_plane() const;    ///< of the window of the vertical pass; 0 if the window is the frame
  std::size_t windows_bytes() const;
  params::TexelLevels levels() const;
  std::size_t between_bytes() const;
  std::size_t segments_bytes() const;
  std::size_t deferred_bytes() const;    ///< of light that waits for its output
  std::size_t bytes(bool defers) const;  ///< of everything
  bool operator==(const RunSizes&) const = default;
};

/// Buffers for one run at a time.
struct RunMemory {
  RunSizes sizes;
  cl::Buffer material_ids;  ///< material of each pixel
  cl::Buffer blocks;        ///< BlockParams
  cl::Buffer passes;        ///< BlockPasses
  cl::Buffer windows;
  cl::Buffer between;  ///< if the window is the frame: light between the passes, the geometry of the exact integral, or
                       ///< what discs read
  cl::Buffer segments;  ///< if the window is the frame: along y; of the disc method which blocks are lit, then dark
  cl::Buffer deferred;  ///< light that has to wait for its output; made when needed
  cl::Buffer kinds;     ///< of tiles
  cl::Buffer counters;  ///< next tile, bad pixels

  RunMemory(const cl::Context& context, const RunSizes& wanted);
  void need_deferred(const cl::Context& context);
};

}  // namespace dermis
