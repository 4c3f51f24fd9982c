#include "dermis/oracle/rule_2012.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "oracle/frame/frame_images.hpp"

namespace dermis::oracle {

namespace {

constexpr double background_depth = 1e9;  // scene units; see Frame
constexpr double mix_over_reach = 4;      // The authors' demo mixes over 12 mm of depth for a reach of 3 mm.

double reach_mm(const SliceMaterial& material) { return material.radius_mm / 3; }

struct SliceTap {
  double offset_mm;
  std::array<double, 3> weight;
};

std::vector<SliceTap> slice_taps(const SliceMaterial& material, int count) {
  const double reach = reach_mm(material);
  std::vector<SliceTap> taps(count);
  for (int i = 0; i < count; ++i) {
    const double even = 2.0 * i / (count - 1) - 1;
    taps[i].offset_mm = std::copysign(even * even, even) * reach;
  }
  std::array<double, 3> sum{};
  for (int i = 0; i < count; ++i) {
    const double step = taps[std::min(i + 1, count - 1)].offset_mm - taps[std::max(i - 1, 0)].offset_mm;
    for (int c = 0; c < 3; ++c) {
      const double r_mm = std::max(std::abs(taps[i].offset_mm), 1e-6 * reach);  // R may have a pole at 0.
      taps[i].weight[c] = step / 2 * material.radial(c, r_mm);
      sum[c] += taps[i].weight[c];
    }
  }
  for (SliceTap& tap : taps) {
    for (int c = 0; c < 3; ++c) tap.weight[c] /= sum[c];
  }
  return taps;
}

class Rule {
 public:
  Rule(const Frame& frame, const FrameImages& images, std::span<const SliceMaterial> materials, int count)
      : frame_(frame), images_(images) {
    for (const SliceMaterial& material : materials) {
      taps_.push_back(slice_taps(material, count));
      mix_per_mm_.push_back(1 / (mix_over_reach * reach_mm(material)));
    }
    material_.assign(static_cast<std::size_t>(frame.width) * frame.height, -1);
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const double z = depth(x, y);
        if (!(z < background_depth)) continue;
        for (std::size_t m = 0; m < materials.size(); ++m) {
          if (!is_there(images.material) || images.material(x, y) == materials[m].id)
            material_[static_cast<std::size_t>(y) * frame.width + x] = static_cast<int>(m);
        }
      }
    }
  }

  Picture pass(const Picture& from, bool along_x) const {
    Picture to = from;
    for (int y = 0; y < frame_.height; ++y) {
      for (int x = 0; x < frame_.width; ++x) {
        const int m = material_[static_cast<std::size_t>(y) * frame_.width + x];
        if (m >= 0) scatter(to, from, x, y, along_x, m);
      }
    }
    return to;
  }

 private:
  double depth(int x, int y) const { return is_there(images_.depth) ? images_.depth(x, y) : 0; }

  void scatter(Picture& to, const Picture& from, int x, int y, bool along_x, int m) const {
    const Camera& camera = frame_.camera;
    const double scale = along_x ? camera.scale_x : camera.scale_y;
    const bool is_lens = camera.projection == Camera::Projection::perspective;
    const double px_per_mm = (is_lens ? scale / depth(x, y) : scale) / frame_.mm_per_unit;
    const int last = (along_x ? frame_.width : frame_.height) - 1;
    std::array<double, 3> sum{};
    for (const SliceTap& tap : taps_[m]) {
      const double at = std::clamp((along_x ? x : y) + tap.offset_mm * px_per_mm, 0.0, static_cast<double>(last));
      const int low = static_cast<int>(at);
      const int high = std::min(low + 1, last);
      const double part = at - low;
      const int nearest = part < 0.5 ? low : high;
      const double other = along_x ? depth(nearest, y) : depth(x, nearest);
      const double mix = std::min(1.0, mix_per_mm_[m] * frame_.mm_per_unit * std::abs(other - depth(x, y)));
      for (int c = 0; c < 3; ++c) {
        const double a = along_x ? from(low, y, c) : from(x, low, c);
        const double b = along_x ? from(high, y, c) : from(x, high, c);
        sum[c] += tap.weight[c] * ((1 - mix) * ((1 - part) * a + part * b) + mix * from(x, y, c));
      }
    }
    for (int c = 0; c < 3; ++c) to(x, y, c) = sum[c];
  }

  const Frame& frame_;
  const FrameImages& images_;
  std::vector<std::vector<SliceTap>> taps_;  ///< of each material
  std::vector<double> mix_per_mm_;
  std::vector<int> material_;
};

}  // namespace

Picture rule_2012(const Frame& frame, std::span<const SliceMaterial> materials, int taps) {
  if (taps < 3 || taps % 2 == 0) throw Error(ErrorCode::usage, "taps", std::to_string(taps), "an odd number from 3 on");
  const FrameImages images = read_images(frame);
  const Rule rule(frame, images, materials, taps);
  return rule.pass(rule.pass(images.light, true), false);
}

}  // namespace dermis::oracle
