#include "measure/truth.hpp"

#include <fftw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <set>

#include "dermis/error.hpp"
#include "measure/pixel_kernel.hpp"
#include "opponents/opponents.hpp"

namespace dermis::bench {

namespace {

/// Standard deviations of the widest Gaussian, beyond which is less than 1e-5 of its light.
constexpr double reach = 4.8;

struct Release {
  void operator()(double* memory) const { fftw_free(memory); }
  void operator()(fftw_plan plan) const { fftw_destroy_plan(plan); }
};

/// Convolutions with one kernel, of pictures that are black outside the frame.
class Convolution {
 public:
  Convolution(const Scene& scene, int reach_px)
      : frame_width_(scene.spec.width),
        frame_height_(scene.spec.height),
        width_(fft_size(frame_width_ + reach_px)),
        height_(fft_size(frame_height_ + reach_px)),
        pitch_(2 * (width_ / 2 + 1)),
        work_(fftw_alloc_real(size())),
        response_(size() / 2) {
    auto* spectrum = reinterpret_cast<fftw_complex*>(work_.get());
    forward_.reset(fftw_plan_dft_r2c_2d(height_, width_, work_.get(), spectrum, FFTW_ESTIMATE));
    backward_.reset(fftw_plan_dft_c2r_2d(height_, width_, spectrum, work_.get(), FFTW_ESTIMATE));
  }

  void set_kernel(const PixelKernel& kernel, int channel) {
    std::fill_n(work_.get(), size(), 0.0);
    kernel.wrap_into(channel, work_.get(), width_, height_, pitch_);
    fftw_execute(forward_.get());
    const double unit = 1.0 / (static_cast<double>(width_) * height_);
    for (std::size_t i = 0; i < response_.size(); ++i)
      response_[i] = unit * work_[2 * i];  // even: its spectrum is real
  }

  /// `plane` has the frame's size; the result too.
  std::vector<double> of(const float* plane) {
    std::fill_n(work_.get(), size(), 0.0);
    for (int y = 0; y < frame_height_; ++y) {
      std::copy_n(plane + static_cast<std::ptrdiff_t>(y) * frame_width_, frame_width_, row(y));
    }
    fftw_execute(forward_.get());
    for (std::size_t i = 0; i < size(); ++i) work_[i] *= response_[i / 2];
    fftw_execute(backward_.get());
    std::vector<double> result;
    for (int y = 0; y < frame_height_; ++y) result.insert(result.end(), row(y), row(y) + frame_width_);
    return result;
  }

 private:
  std::size_t size() const { return static_cast<std::size_t>(pitch_) * height_; }
  double* row(int y) { return work_.get() + static_cast<std::ptrdiff_t>(y) * pitch_; }

  int frame_width_, frame_height_, width_, height_, pitch_;
  std::unique_ptr<double[], Release> work_;
  std::vector<double> response_;
  std::unique_ptr<std::remove_pointer_t<fftw_plan>, Release> forward_, backward_;
};

Truth exact_convolution(const Scene& scene) {
  const int width = scene.spec.width;
  const int height = scene.spec.height;
  const int reach_px = static_cast<int>(std::ceil(reach * scene.spec.kernel_px));
  // Where the frame is small its edge is in reach; there the middle has to do.
  const int margin = std::min(reach_px, std::min(width, height) / 3);
  Truth truth = {.source = fmt::format("exact convolution, {} px from the edge", margin), .pixels = {}};
  for (int y = margin; y < height - margin; ++y) {
    for (int x = margin; x < width - margin; ++x) truth.pixels.push_back(static_cast<std::size_t>(y) * width + x);
  }
  truth.light.resize(3 * truth.pixels.size());
  const PixelKernel kernel(scene, reach_px);
  Convolution convolution(scene, reach_px);
  const std::vector<float> ones(scene.pixels(), 1.0F);
  for (int c = 0; c < 3; ++c) {
    convolution.set_kernel(kernel, c);
    const std::vector<double> light = convolution.of(scene.light.data() + c * scene.pixels());
    const std::vector<double> weight = convolution.of(ones.data());
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
      truth.light[3 * i + c] = light[truth.pixels[i]] / weight[truth.pixels[i]];
    }
  }
  return truth;
}

/// A block is as wide as the vectors that the kernels work on, and lies as they do.
constexpr int block_width_px = 16;
constexpr int block_height_px = 4;

/// Blocks one of which is affordable in every block of a grid, so that their number is about that.
int affordable_blocks(const Scene& scene) {
  constexpr double pairs = 2.5e8;                                    // a few seconds of two cores
  const double typical_reach_px = reach * scene.spec.kernel_px / 2;  // most of the scene is at depth 2 and beyond
  return std::max(8,
                  static_cast<int>(pairs / std::pow(2 * typical_reach_px + 1, 2) / (block_width_px * block_height_px)));
}

/// The covered pixels of blocks at random places, one in every block of a grid over the covered ellipse.
std::vector<std::size_t> sampled_pixels(const Scene& scene) {
  const int width = scene.spec.width;
  const int height = scene.spec.height;
  const double half = std::min(0.5, std::sqrt(scene.spec.coverage_percent / (100 * std::numbers::pi)));
  const double left = (0.5 - half) * width;
  const double top = (0.5 - half) * height;
  const int blocks = std::max(1, static_cast<int>(std::sqrt(affordable_blocks(scene))));
  std::mt19937 random(1);
  std::set<std::size_t> pixels;
  for (int i = 0; i < blocks * blocks; ++i) {
    const auto place = [&](int block) { return (block + static_cast<double>(random()) * 0x1p-32) / blocks * 2 * half; };
    const int first_x = static_cast<int>(left + place(i % blocks) * width) / block_width_px * block_width_px;
    const int first_y = static_cast<int>(top + place(i / blocks) * height) / block_height_px * block_height_px;
    for (int y = first_y; y < std::min(first_y + block_height_px, height); ++y) {
      for (int x = first_x; x < std::min(first_x + block_width_px, width); ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
        if (!scene.is_background(pixel)) pixels.insert(pixel);
      }
    }
  }
  return {pixels.begin(), pixels.end()};
}

}  // namespace

Truth TruthMaker::surface_integral(const Scene& scene) {
  Truth truth = {.source = {}, .pixels = sampled_pixels(scene)};
  truth.source = fmt::format("surface integral at {} of its pixels, all over it", truth.pixels.size());
  // Elsewhere the kernel is so narrow that pixels give light but take none, and cost nothing.
  std::vector<float> mask(scene.pixels(), 1e-6F);
  for (const std::size_t pixel : truth.pixels) mask[pixel] = 1;
  std::vector<float> scattered(scene.light.size());
  const Layout planar = {.channel_stride = static_cast<std::ptrdiff_t>(scene.pixels() * sizeof(float)),
                         .pixel_stride = 4,
                         .row_stride = 4L * scene.spec.width};
  const Frame frame = {.width = scene.spec.width,
                       .height = scene.spec.height,
                       .light = {.host = scene.light.data(), .layout = planar},
                       .depth = {.host = scene.depth.data()},
                       .mask = {.host = mask.data()},
                       .camera = scene.camera,
                       .mm_per_unit = scene.mm_per_unit,
                       .scattered = {.host = scattered.data(), .layout = planar}};
  if (!exact_) {
    exact_.emplace(device_, std::vector<Material>{{.profile = skin()}}, FrameDescription::of(frame),
                   Options{.method = Method::exact});
  }
  exact_->run(frame);
  for (const std::size_t pixel : truth.pixels) {
    for (int c = 0; c < 3; ++c) truth.light.push_back(static_cast<double>(scattered[c * scene.pixels() + pixel]));
  }
  return truth;
}

Truth TruthMaker::truth_of(const Scene& scene) {
  if (scene.covered == 0) throw Error(ErrorCode::usage, "scene", scene.spec.name(), "pixels that scatter");
  const bool is_whole_plane = scene.spec.geometry == Geometry::flat && scene.spec.coverage_percent == 100;
  return is_whole_plane ? exact_convolution(scene) : surface_integral(scene);
}

Distance distance(const std::vector<float>& result, const Truth& truth) {
  const std::size_t plane = result.size() / 3;
  double error = 0;
  double power = 0;
  double sum = 0;
  double largest = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double wanted = truth.light[3 * i + c];
      const double difference = static_cast<double>(result[c * plane + truth.pixels[i]]) - wanted;
      error += difference * difference;
      power += wanted * wanted;
      sum += wanted;
      // A comparison with something that is not a number is false.
      if (!(std::abs(difference) <= largest)) largest = std::abs(difference);
    }
  }
  return {std::sqrt(error / power), largest * static_cast<double>(truth.light.size()) / sum};
}

}  // namespace dermis::bench
