#include "oracle/texture/texture_light.hpp"

#include <cmath>
#include <limits>

#include "oracle/frame/frame_images.hpp"

namespace dermis::oracle {

namespace {

/// Bounds the power as Light::albedo_power does.
Bounded power_of(double albedo, double exponent) {
  if (exponent == 0) return exact(1);
  const double positive = std::fmax(albedo, 0.0);
  if (exponent == 1 || positive == 0) return exact(positive);
  return rounded(exact(std::pow(positive, exponent)), power_roundings + 2 * std::abs(std::log(positive)));
}

bool is_finite(const Picture& picture, int x, int y) {
  for (int c = 0; c < picture.channels; ++c) {
    if (!(std::abs(picture(x, y, c)) <= static_cast<double>(std::numeric_limits<float>::max()))) return false;
  }
  return true;
}

bool has_light(const Picture& light, const Picture& albedo, const Picture& mask, int x, int y) {
  return is_finite(light, x, y) && (!is_there(albedo) || is_finite(albedo, x, y)) &&
         (!is_there(mask) || mask(x, y) > 0);
}

bool is_stretch(double mm) { return mm >= static_cast<double>(1e-9F) && mm <= static_cast<double>(1e9F); }

}  // namespace

TextureLight::TextureLight(const TextureFrame& frame, double albedo_mix)
    : light(frame.width, frame.height),
      stretch(frame.width, frame.height, 2, static_cast<double>(static_cast<float>(frame.mm_per_texel))),
      object(frame.width, frame.height, 1, 1),
      differs(static_cast<bool>(frame.stretch_u)) {
  const auto read = [&](const Image& image, int channels, const char* name) {
    return read_image(image, frame.width, frame.height, channels, name);
  };
  const Picture given = read(frame.light, 3, "light");
  const Picture albedo = read(frame.albedo, 3, "albedo");
  const Picture mask = read(frame.mask, 1, "mask");
  const Picture stretches[] = {read(frame.stretch_u, 1, "stretch_u"), read(frame.stretch_v, 1, "stretch_v")};
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      double& is_object = object(x, y);
      if (!has_light(given, albedo, mask, x, y)) is_object = 0;
      for (int axis = 0; differs && axis < 2; ++axis) {
        stretch(x, y, axis) = stretches[axis](x, y);
        if (!is_stretch(stretch(x, y, axis))) is_object = 0;
      }
      for (int c = 0; c < 3; ++c) {
        Bounded value = exact(given(x, y, c));
        if (is_there(albedo)) value = value * power_of(albedo(x, y, c), albedo_mix);
        light.set(x, y, c, is_object == 1 ? value : exact(0));
      }
    }
  }
}

std::vector<Run> runs_along(const Picture& object, int axis) {
  std::vector<Run> runs;
  const int lines = axis == 0 ? object.height : object.width;
  const int length = axis == 0 ? object.width : object.height;
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < length; ++i) {
      if (object(axis == 0 ? i : line, axis == 0 ? line : i) == 0) continue;
      const bool goes_on = !runs.empty() && runs.back().line == line && runs.back().end == i;
      if (goes_on) {
        ++runs.back().end;
      } else {
        runs.push_back({axis, line, i, i + 1});
      }
    }
  }
  return runs;
}

TextureReference texture_reference(const TextureFrame& frame, double albedo_mix, const TextureLight& in,
                                   const BoundedPicture& scattered) {
  const Picture given = read_image(frame.light, frame.width, frame.height, 3, "light");
  const Picture albedo = read_image(frame.albedo, frame.width, frame.height, 3, "albedo");
  TextureReference reference;
  reference.object = in.object;
  BoundedPicture after(frame.width, frame.height);
  BoundedPicture result(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const bool object = in.object(x, y) == 1;
        const Bounded light = object ? scattered.at(x, y, c) : exact(given(x, y, c));
        after.set(x, y, c, light);
        if (is_there(albedo)) {
          result.set(x, y, c, object ? light * power_of(albedo(x, y, c), 1 - albedo_mix) : light);
        }
      }
    }
  }
  reference.scattered = after.value;
  reference.scattered_bound = after.error;
  if (is_there(albedo)) {
    reference.result = result.value;
    reference.result_bound = result.error;
  }
  return reference;
}

}  // namespace dermis::oracle
