// The separable passes tile by tile, for CPUs: the windows of a tile stay in the cache of a core. The kernels are in
// kernels/separable/tile.cl.
#pragma once

#include "screen/separable_method.hpp"

namespace dermis {

class SeparableTiles final : public SeparableMethod {
 public:
  using SeparableMethod::SeparableMethod;

  std::vector<std::string> kernel_files() const override;
  std::vector<std::size_t> buffer_bytes(const FrameSize& frame) const override;
  void prepare(FrameRun& run) const override;
  void scatter(FrameRun& run, int step) const override;
  void finish(FrameRun& run) const override;
  bool by_tiles() const override { return true; }
  void add_to(Stats& stats, const FrameRun& run) const override;

 private:
  params::TileParams tiles(const FrameSize& frame) const;
  params::TileMemory worker_memory(const FrameSize& frame) const;
};

}  // namespace dermis
