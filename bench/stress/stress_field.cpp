#include "stress/stress_field.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace dermis::bench {

namespace {

/// Of the largest value: of what has a larger bound the oracle is not sure.
constexpr double sure_bound = 1e-4;

/// Share of the values that it must be sure of. A frame of a few blocks may have most of them on the border of a level.
double least_sure_share(const StressField& field) {
  constexpr int few_pixels = 40 * 256;
  return field.width_px * field.height_px < few_pixels ? 0.01 : 0.9;
}

std::uint16_t half_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = (bits >> 16) & 0x8000U;
  const double size = std::abs(static_cast<double>(value));
  if (std::isnan(value)) return static_cast<std::uint16_t>(sign | 0x7e00U | ((bits >> 13) & 0x1ffU));
  if (size >= 65520) return static_cast<std::uint16_t>(sign | 0x7c00U);
  const int exponent = size == 0 ? -14 : std::max(-14, std::ilogb(size));
  const auto steps = static_cast<std::uint32_t>(std::nearbyint(std::ldexp(size, 10 - exponent)));
  return static_cast<std::uint16_t>(sign + (static_cast<std::uint32_t>(exponent + 14) << 10) + steps);
}

double value_of_half(std::uint32_t bits) {
  const int exponent = static_cast<int>((bits >> 10) & 31U);
  const int mantissa = static_cast<int>(bits & 1023U);
  double size = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
  if (exponent == 31) size = mantissa == 0 ? HUGE_VAL : std::numeric_limits<double>::quiet_NaN();
  return (bits & 0x8000U) != 0 ? -size : size;
}

/// Distance from a value to the next one of the format.
double last_place(Format format, double value) {
  const int least = format == Format::f16 ? -14 : -126;
  const int digits = format == Format::f16 ? 10 : 23;
  const int exponent = value == 0 ? least : std::max(least, std::ilogb(std::abs(value)));
  return std::ldexp(1.0, exponent - digits);
}

/// The memory behind a frame.
struct StressMemory {
  std::vector<std::byte> light, scattered;

  explicit StressMemory(const StressField& field) {
    const std::size_t bytes = bytes_of(field.format);
    light.resize(field.light.size() * bytes);
    scattered.resize(light.size());
    for (std::size_t i = 0; i < field.light.size(); ++i) {
      if (field.format == Format::f16) {
        const std::uint16_t half = half_of(field.light[i]);
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

std::vector<oracle::Material> materials_for_oracle(const std::vector<Material>& materials, const Options& options) {
  std::vector<oracle::Material> result;
  result.reserve(materials.size());
  for (const Material& material : materials) {
    result.push_back({material.id,
                      material.profile.width_follows_albedo(),
                      make_taps(material.profile, material.taps.value_or(options.taps)),
                      {},
                      {}});
  }
  return result;
}

/// The columns of a plane.
StressField part_of(const StressField& field, StressWindow window) {
  StressField part = field;
  part.width_px = window.width_px;
  part.light.clear();
  for (int y = 0; y < field.height_px; ++y) {
    const auto row = field.light.begin() + (static_cast<std::ptrdiff_t>(y) * field.width_px + window.x_px) * 3;
    part.light.insert(part.light.end(), row, row + static_cast<std::ptrdiff_t>(window.width_px) * 3);
  }
  return part;
}

/// How constant light comes out.
struct White {
  double change = 0;    ///< largest, relative
  double of_bound = 0;  ///< change / the oracle's bound; 0 if not asked for
};

White white_through(const StressFilter& filter, StressField field, double white, bool with_bound) {
  std::fill(field.light.begin(), field.light.end(), static_cast<float>(white));
  const StressResult seen = filter.run(field);
  const auto stored = static_cast<float>(white);
  const double before = field.format == Format::f16 ? value_of_half(half_of(stored)) : static_cast<double>(stored);
  White result;
  for (const double after : seen.values.values) {
    if (!std::isfinite(after)) return {HUGE_VAL, HUGE_VAL};
    result.change = std::max(result.change, std::abs(after / before - 1));
  }
  if (with_bound) {
    StressRow row;
    StressErrors errors(field.format);
    errors.add(seen.values, 0, filter.reference(field), 0, field.width_px);
    errors.write_to(row, false);
    result.of_bound = row.of_bound;
  }
  return result;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

std::string text_of(const StressPromise& promise) {
  std::string text;
  if (std::isfinite(promise.rel_l2)) text += "L2 " + number(promise.rel_l2) + ", ";
  text += "bound";
  if (promise.white_within_bound)
    text += ", white too";
  else if (std::isfinite(promise.energy))
    text += ", white " + number(promise.energy);
  return promise.change == StressChange::keeps_bits ? text + ", keeps bits" : text;
}

double overshoot(const StressResult& seen, const StressField& field) {
  const auto [least, most] = std::minmax_element(field.light.begin(), field.light.end());
  const auto [low, high] = std::minmax_element(seen.values.values.begin(), seen.values.values.end());
  const auto before_low = static_cast<double>(*least);
  const auto before_high = static_cast<double>(*most);
  const double range = before_high - before_low;
  return range > 0 ? std::max({0.0, before_low - *low, *high - before_high}) / range : 0;
}

/// How many values are not those of the light, by more than rounding.
long changed_values(const StressResult& seen, const StressField& field) {
  long changed = 0;
  for (std::size_t i = 0; i < field.light.size(); ++i) {
    const auto before = static_cast<double>(field.light[i]);
    if (!(std::abs(seen.values.values[i] - before) <= 1e-3 * std::abs(before))) ++changed;
  }
  return changed;
}

}  // namespace

// The oracle's taps first: the plan's may then be found in the same caches.
StressFilter::StressFilter(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
                           const Options& options)
    : options_(options),
      for_oracle_(materials_for_oracle(materials, options)),
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

void StressErrors::add(const oracle::Picture& seen, int seen_x, const oracle::Reference& expected, int expected_x,
                       int width) {
  double largest = 0;
  for (const double value : expected.scattered.values) largest = std::max(largest, std::abs(value));
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double value = seen(seen_x + x, y, c);
        const double truth = expected.scattered(expected_x + x, y, c);
        const double bound = expected.scattered_bound(expected_x + x, y, c);
        ++values_;
        if (!std::isfinite(value)) {
          ++non_finite_;
          continue;
        }
        const double error = std::abs(value - truth);
        const double allowed = bound + (format_ == Format::f16 ? 0.5 * last_place(format_, truth) : 0);
        if (error > 0) of_bound_ = std::max(of_bound_, error / allowed);
        all_.add(error, truth, last_place(format_, truth));
        if (bound > sure_bound * largest) continue;
        ++sure_;
        of_sure_.add(error, truth, last_place(format_, truth));
      }
    }
  }
}

void StressErrors::Sums::add(double error, double truth, double last_place) {
  errors2 += error * error;
  truths2 += truth * truth;
  max_ulp = std::max(max_ulp, error / last_place);
  if (truth != 0) max_rel = std::max(max_rel, error / std::abs(truth));
}

void StressErrors::write_to(StressRow& row, bool sure_values_only) const {
  const Sums& sums = sure_values_only ? of_sure_ : all_;
  row.rel_l2 = sums.errors2 == 0 ? 0 : std::sqrt(sums.errors2 / sums.truths2);
  row.max_rel = sums.max_rel;
  row.max_ulp = sums.max_ulp;
  row.of_bound = of_bound_;
  row.non_finite = non_finite_;
}

void fail(StressRow& row, const std::string& text) {
  row.holds = false;
  row.failure += (row.failure.empty() ? "" : "; ") + text;
}

StressRow judged(const StressFilter& filter, const StressField& field, const std::string& group,
                 const std::string& name, const StressPromise& promise, const std::vector<StressWindow>& windows,
                 int margin_px) {
  StressRow row{.group = group, .name = name, .promised = text_of(promise), .holds = true, .failure = {}};
  const StressResult seen = filter.run(field);
  StressErrors errors(field.format);
  if (windows.empty()) errors.add(seen.values, 0, filter.reference(field), 0, field.width_px);
  for (const StressWindow window : windows) {
    const int begin = std::max(0, window.x_px - margin_px);
    const int end = std::min(field.width_px, window.x_px + window.width_px + margin_px);
    errors.add(seen.values, window.x_px, filter.reference(part_of(field, {begin, end - begin})), window.x_px - begin,
               std::min(window.width_px, field.width_px - window.x_px));
  }
  errors.write_to(row, promise.sure_values_only);
  // What the windows do not show.
  row.non_finite = static_cast<long>(std::count_if(seen.values.values.begin(), seen.values.values.end(),
                                                   [](double value) { return !std::isfinite(value); }));
  row.overshoot = overshoot(seen, field);
  const White white = white_through(filter, field, promise.white, promise.white_within_bound);
  row.energy = white.change;

  if (row.non_finite > 0) fail(row, std::to_string(row.non_finite) + " values are not finite");
  if (!(row.rel_l2 <= promise.rel_l2)) fail(row, "relative L2 " + number(row.rel_l2));
  if (!(row.of_bound <= 1)) fail(row, number(row.of_bound) + " times the bound");
  if (promise.white_within_bound) {
    if (!(white.of_bound <= 1)) fail(row, "white is " + number(white.of_bound) + " times the bound off");
  } else if (!(row.energy <= promise.energy)) {
    fail(row, "white changes by " + number(row.energy));
  }
  if (promise.sure_values_only && errors.sure_share() < least_sure_share(field)) {
    fail(row, "the oracle is sure of " + number(errors.sure_share()) + " of the values only");
  }
  if (!(row.overshoot <= promise.overshoot)) fail(row, "overshoots by " + number(row.overshoot));
  const long changed = changed_values(seen, field);
  if (promise.change == StressChange::scatters && changed < static_cast<long>(field.light.size() / 8)) {
    fail(row, "only " + std::to_string(changed) + " values changed");
  }
  if (promise.change == StressChange::keeps_bits && seen.bits != seen.input_bits) fail(row, "bits changed");
  return row;
}

double uniform(std::mt19937& engine, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}

StressField stress_plane(std::mt19937& engine, int width_px, int height_px, double px_per_mm) {
  StressField field{.width_px = width_px,
                    .height_px = height_px,
                    .camera = Camera::orthographic(px_per_mm, px_per_mm * uniform(engine, 0.7, 1.4))};
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const double lit = (x / 9 + y / 5) % 3 != 0 ? 1 : 0.05;
      for (int c = 0; c < 3; ++c) field.light.push_back(static_cast<float>(lit * uniform(engine, 0.4, 1.5)));
    }
  }
  return field;
}

StressField stress_surface(std::mt19937& engine, int width_px, int height_px, double focal_px, double depth_units,
                           double bump_units) {
  StressField field = stress_plane(engine, width_px, height_px, 1);
  field.camera = Camera::perspective(focal_px, focal_px * uniform(engine, 0.8, 1.2),
                                     uniform(engine, 0.3, 0.7) * width_px, uniform(engine, 0.3, 0.7) * height_px);
  const double wave = uniform(engine, 0.1, 0.3);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const bool is_background = uniform(engine, 0, 60) < 1;
      const double bump = bump_units * std::sin(wave * x) * std::cos(0.7 * wave * y);
      field.depth.push_back(static_cast<float>(is_background ? 1e10 : depth_units + bump));
    }
  }
  return field;
}

}  // namespace dermis::bench
