#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "dermis/oracle/lighting.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/lighting/lit_point.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

namespace {

constexpr double table_error = 5e-6;  // of T for Gaussians and Burley's profile: 4 e^-2 / (8 * 128^2), and rounding

struct Images {
  Picture light, albedo, position, normal, material, mask, thickness, beauty;
};

double width_at(const AlbedoWidth& width, double albedo) {
  const double a = std::clamp(albedo, 0.0, 1.0);
  const auto& [n, d] = width;
  return (n[0] + n[1] * a + n[2] * a * a + n[3] * a * a * a) / (d[0] + d[1] * a + d[2] * a * a);
}

class Transmission {
 public:
  Transmission(const TranslucencyFrame& frame, std::span<const Slab> slabs, const TranslucencyOptions& options)
      : frame_(frame), slabs_(slabs), options_(options) {
    const auto load = [&](const Image& image, int channels, const char* name) {
      return read_image(image, frame.width, frame.height, channels, name);
    };
    images_ = {load(frame.light, 3, "light"),         load(frame.albedo, 3, "albedo"),
               load(frame.position, 3, "position"),   load(frame.normal, 3, "normal"),
               load(frame.material, 1, "material"),   load(frame.mask, 1, "mask"),
               load(frame.thickness, 1, "thickness"), load(frame.beauty, 3, "beauty")};
    for (const Light& light : frame.lights) lights_.emplace_back(light);
  }

  Transmitted run() const {
    Transmitted all;
    all.lit = images_.light;
    all.lit_bound = Picture(frame_.width, frame_.height, 3);
    all.result = images_.beauty;
    all.result_bound = images_.beauty;
    std::fill(all.result_bound.values.begin(), all.result_bound.values.end(), 0);
    all.touched = Picture(frame_.width, frame_.height, 1);
    for (int y = 0; y < frame_.height; ++y) {
      for (int x = 0; x < frame_.width; ++x) add(all, x, y);
    }
    return all;
  }

 private:
  const Slab* slab_at(int x, int y) const {
    if (!is_there(images_.material)) return &slabs_.front();
    const auto found =
        std::find_if(slabs_.begin(), slabs_.end(), [&](const Slab& slab) { return images_.material(x, y) == slab.id; });
    return found == slabs_.end() ? nullptr : &*found;
  }

  void add(Transmitted& all, int x, int y) const {
    const Slab* slab = slab_at(x, y);
    const Vec3 normal = vector_at(images_.normal, x, y);
    const Vec3 point = vector_at(images_.position, x, y);
    const Vec3 albedo = is_there(images_.albedo) ? vector_at(images_.albedo, x, y) : Vec3{1, 1, 1};
    const double mask = is_there(images_.mask) ? images_.mask(x, y) : 1;
    std::optional<double> thickness_mm;
    if (is_there(images_.thickness)) thickness_mm = images_.thickness(x, y);
    if (slab == nullptr || !is_finite(normal) || length(normal) == 0 || !is_finite(point) || !is_finite(albedo) ||
        !is_finite(vector_at(images_.light, x, y)) || !(mask > 0) || !std::isfinite(mask) ||
        (thickness_mm && !std::isfinite(*thickness_mm))) {
      return;
    }
    if (thickness_mm) thickness_mm = std::max(*thickness_mm, 0.0) * options_.thickness_scale;
    for (int c = 0; c < 3; ++c) {
      const double width = (slab->albedo_width ? width_at(*slab->albedo_width, albedo[c]) : 1) * std::min(mask, 1.0);
      const auto through = [&](double mm) { return slab->transmittance(c, mm / width); };
      const Bounded more = channel(through, c, point, unit(normal), thickness_mm);
      if (more.value > 0) all.touched(x, y) = 1;
      const Bounded coloured = more * exact(albedo[c]);
      const Bounded light = exact(all.lit(x, y, c)) + (options_.lighting == Lighting::lit ? coloured : more);
      all.lit(x, y, c) = light.value;
      all.lit_bound(x, y, c) = light.error;
      if (!is_there(images_.beauty)) continue;
      const Bounded result = exact(all.result(x, y, c)) + coloured;
      all.result(x, y, c) = result.value;
      all.result_bound(x, y, c) = result.error;
    }
  }

  Bounded channel(const std::function<double(double)>& through, int c, const Vec3& point, const Vec3& normal,
                  const std::optional<double>& thickness_mm) const {
    // Rounding changes a thickness by so little: 16 roundings cover its square and the width.
    constexpr double relative = 16 * unit_roundoff;
    const auto at_image = [&]() -> Bounded {
      if (!thickness_mm) return {};
      const double value = through(*thickness_mm);
      return {value, std::abs(through(*thickness_mm * (1 + relative)) - value) + table_error};
    };
    Bounded sum;
    for (const LightSource& source : lights_) {
      const LitPoint lit = source.reach(point);
      const double facing = 0.3 - dot(normal, lit.towards);
      const Bounded irradiance =
          Bounded{std::max(facing, 0.0), 2 * lit.towards_error + 12 * unit_roundoff} * lit.strength;
      const auto of_depth = [&](double behind_units, double slant) {
        const double mm = std::max(behind_units, 0.0) * slant * frame_.mm_per_unit * options_.thickness_scale;
        return through(std::max(mm, thickness_mm.value_or(0)) * (1 + relative));
      };
      const Vec3 shrunk = difference(point, scaled(normal, options_.shrink_units));
      LightSource::Mean mean = source.mean_behind(shrunk, point, options_.softness_texels, of_depth);
      Bounded its = mean.value;
      its.error += table_error + std::abs(its.value) * relative;
      if (!mean.is_known) its = Bounded{at_image().value, at_image().error + mean.value.error};
      sum = sum + its * as_float(source.light().colour[c]) * irradiance;
    }
    return sum;
  }

  const TranslucencyFrame& frame_;
  std::span<const Slab> slabs_;
  const TranslucencyOptions& options_;
  Images images_;
  std::vector<LightSource> lights_;
};

}  // namespace

Transmitted transmit(const TranslucencyFrame& frame, std::span<const Slab> slabs, const TranslucencyOptions& options) {
  return Transmission(frame, slabs, options).run();
}

}  // namespace dermis::oracle
