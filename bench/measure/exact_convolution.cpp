#include <fftw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "measure/pixel_kernel.hpp"
#include "measure/truth.hpp"

namespace dermis::bench {

namespace {

struct Release {
  void operator()(double* memory) const { fftw_free(memory); }
  void operator()(fftw_plan plan) const { fftw_destroy_plan(plan); }
};

/// Convolves pictures that are black outside the frame with one kernel.
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
    // The kernel is even, so its spectrum is real.
    for (std::size_t i = 0; i < response_.size(); ++i) response_[i] = unit * work_[2 * i];
  }

  /// The plane and the result have the frame's size.
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

}  // namespace

Truth exact_convolution(const Scene& scene) {
  const int width = scene.spec.width;
  const int height = scene.spec.height;
  const int reach_px = static_cast<int>(std::ceil(kernel_reach * scene.spec.kernel_px));
  // A small frame's edge is in reach everywhere; then the middle third has to do.
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

}  // namespace dermis::bench
