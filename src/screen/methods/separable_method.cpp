#include "screen/methods/separable_method.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace dermis {

namespace {

/// Tables one after the other, each aligned as a buffer of its own would be.
class PackedTables {
 public:
  template <class Row>
  params::Bytes add(const std::vector<Row>& rows) {
    constexpr std::size_t alignment = 128;
    bytes_.resize((bytes_.size() + alignment - 1) / alignment * alignment);
    const std::size_t begin = bytes_.size();
    const auto* first = reinterpret_cast<const std::byte*>(rows.data());
    bytes_.insert(bytes_.end(), first, first + rows.size() * sizeof(Row));
    return static_cast<params::Bytes>(begin);
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace

void SeparableMethod::measure(const MaterialTables& tables) {
  terms_ = tables.terms_per_material;
  farthest_px_ = tables.farthest_px;
}

void SeparableMethod::upload(const cl::Context& context, const MaterialTables& tables) {
  PackedTables packed;
  taps_at_.terms = packed.add(tables.terms);
  taps_at_.offsets = packed.add(tables.offsets_px);
  taps_at_.nearness = packed.add(tables.nearness);
  taps_at_.weights = packed.add(tables.weights);
  taps_at_.flat_weights = packed.add(tables.flat_weights);
  taps_ = dermis::upload(context, packed.bytes());
}

cl::Buffer SeparableMethod::rotations(const FrameRun& run) const {
  if (settings_.options.jitter == 0) return taps_;
  // In whole 1/4096 px, so that every device rounds alike. Lengths in mm are kept where pixels are not square.
  constexpr double one = 4096;
  const Camera& camera = run.camera();
  std::vector<params::RotationParams> table;
  for (int i = 0; i < ROTATIONS; ++i) {
    const double angle = 2 * std::numbers::pi * i / ROTATIONS;
    table.push_back({static_cast<int>(std::lround(one * std::cos(angle))),
                     static_cast<int>(std::lround(one * std::sin(angle) * camera.scale_y / camera.scale_x)),
                     static_cast<int>(std::lround(-one * std::sin(angle) * camera.scale_x / camera.scale_y)), 0});
  }
  return dermis::upload(run.context(), table);
}

}  // namespace dermis
