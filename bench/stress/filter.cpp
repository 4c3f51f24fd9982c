#include "stress/filter.hpp"

#include <bit>
#include <cstring>
#include <utility>

#include "dermis/oracle/materials.hpp"
#include "inputs/half.hpp"

namespace dermis::bench {

namespace {

/// The memory behind a frame.
struct StressMemory {
  std::vector<std::byte> light, scattered;

  explicit StressMemory(const StressField& field) {
    const std::size_t bytes = bytes_of(field.format);
    light.resize(field.light.size() * bytes);
    scattered.resize(light.size());
    for (std::size_t i = 0; i < field.light.size(); ++i) {
      if (field.format == Format::f16) {
        const std::uint16_t half = half_of(static_cast<double>(field.light[i]));
        std::memcpy(&light[i * bytes], &half, bytes);
      } else {
        std::memcpy(&light[i * bytes], &field.light[i], bytes);
      }
    }
  }

  Frame frame(const StressField& field) {
    Frame frame{
        .width = field.width_px, .height = field.height_px, .camera = field.camera, .mm_per_unit = field.mm_per_unit};
    frame.light.host = light.data();
    frame.light.layout.format = field.format;
    if (!field.depth.empty()) frame.depth.host = field.depth.data();
    if (!field.ids.empty()) frame.material.host = field.ids.data();
    frame.scattered.host = scattered.data();
    frame.scattered.layout.format = field.format;
    return frame;
  }

  static std::vector<std::uint32_t> bits(const std::vector<std::byte>& image, Format format) {
    const std::size_t bytes = bytes_of(format);
    std::vector<std::uint32_t> result(image.size() / bytes, 0);
    for (std::size_t i = 0; i < result.size(); ++i) std::memcpy(&result[i], &image[i * bytes], bytes);
    return result;
  }
};

}  // namespace

// The oracle's taps are made first, so that the plan finds its own in the cache of taps.
StressFilter::StressFilter(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
                           const Options& options)
    : options_(options),
      for_oracle_(oracle::materials_of(materials, options.taps)),
      plan_(device, std::move(materials), frames, options) {}

StressResult StressFilter::run(const StressField& field) const {
  StressMemory memory(field);
  StressResult result{oracle::Picture(field.width_px, field.height_px, 3), {}, {}, {}};
  result.stats = plan_.run(memory.frame(field));
  result.bits = StressMemory::bits(memory.scattered, field.format);
  result.input_bits = StressMemory::bits(memory.light, field.format);
  for (std::size_t i = 0; i < result.bits.size(); ++i) {
    const std::uint32_t bits = result.bits[i];
    result.values.values[i] =
        field.format == Format::f16 ? value_of_half(bits) : static_cast<double>(std::bit_cast<float>(bits));
  }
  return result;
}

oracle::Reference StressFilter::reference(const StressField& field) const {
  StressMemory memory(field);
  return oracle::separable(memory.frame(field), for_oracle_, options_);
}

}  // namespace dermis::bench
