// The exact convolution of a flat scene by FFTW in float: one transform there and one back per channel.
#include <fftw3.h>

#include <algorithm>
#include <complex>

#include "measure/pixel_kernel.hpp"
#include "opponents/opponents.hpp"
#include "support/parallel.hpp"

namespace dermis::bench {

namespace {

struct Release {
  void operator()(float* memory) const { fftwf_free(memory); }
  void operator()(fftwf_plan plan) const { fftwf_destroy_plan(plan); }
};

void use_all_cores() {
#if defined(DERMIS_BENCH_FFTW_THREADS)
  static const int ready = fftwf_init_threads();
  if (ready != 0) fftwf_plan_with_nthreads(static_cast<int>(core_count()));
#endif
}

class Convolution final : public Opponent {
 public:
  explicit Convolution(const Scene& scene) : scene_(scene) {
    constexpr double reach = 4;  // standard deviations: 6e-5 of the light lies beyond
    constexpr double planning_s = 3;
    const PixelKernel kernel(scene, static_cast<int>(reach * scene.spec.kernel_px));
    width_ = fft_size(scene.spec.width + kernel.reach_px());
    height_ = fft_size(scene.spec.height + kernel.reach_px());
    pitch_ = 2 * (width_ / 2 + 1);
    const std::size_t plane = static_cast<std::size_t>(pitch_) * height_;
    work_.reset(fftwf_alloc_real(plane));
    auto* spectrum = reinterpret_cast<fftwf_complex*>(work_.get());
    use_all_cores();
    fftwf_set_timelimit(planning_s);
    forward_.reset(fftwf_plan_dft_r2c_2d(height_, width_, work_.get(), spectrum, FFTW_MEASURE));
    backward_.reset(fftwf_plan_dft_c2r_2d(height_, width_, spectrum, work_.get(), FFTW_MEASURE));
    const float unit = 1 / (static_cast<float>(width_) * static_cast<float>(height_));
    for (int c = 0; c < 3; ++c) {
      std::fill_n(work_.get(), plane, 0.0F);
      kernel.wrap_into(c, work_.get(), width_, height_, pitch_);
      fftwf_execute(forward_.get());
      // The kernel is even, so its spectrum is real.
      for (std::size_t i = 0; i < plane; i += 2) response_[c].push_back(unit * work_[i]);
    }
    scattered_.resize(3 * scene.pixels());
  }

  void run() override {
    for (int c = 0; c < 3; ++c) {
      const float* light = scene_.light.data() + c * scene_.pixels();
      each_row(height_, [&](int y) {
        float* row = work_.get() + static_cast<std::size_t>(y) * pitch_;
        const int used = y < scene_.spec.height ? scene_.spec.width : 0;
        std::copy_n(light + static_cast<std::ptrdiff_t>(y) * used, used, row);
        std::fill(row + used, row + pitch_, 0.0F);
      });
      fftwf_execute(forward_.get());
      each_row(height_, [&](int y) {
        float* row = work_.get() + static_cast<std::size_t>(y) * pitch_;
        const float* response = response_[c].data() + static_cast<std::size_t>(y) * (pitch_ / 2);
        for (int x = 0; x < pitch_; ++x) row[x] *= response[x / 2];
      });
      fftwf_execute(backward_.get());
      float* scattered = scattered_.data() + c * scene_.pixels();
      each_row(scene_.spec.height, [&](int y) {
        std::copy_n(work_.get() + static_cast<std::size_t>(y) * pitch_, scene_.spec.width,
                    scattered + static_cast<std::ptrdiff_t>(y) * scene_.spec.width);
      });
    }
  }

  std::vector<float> result() override { return scattered_; }

 private:
  template <class Work>
  static void each_row(int rows, const Work& work) {
    on_all_cores([&](std::size_t worker, std::size_t workers) {
      const int end = static_cast<int>((worker + 1) * rows / workers);
      for (int y = static_cast<int>(worker * rows / workers); y < end; ++y) work(y);
    });
  }

  const Scene& scene_;
  int width_ = 0, height_ = 0, pitch_ = 0;
  std::unique_ptr<float[], Release> work_;
  std::unique_ptr<std::remove_pointer_t<fftwf_plan>, Release> forward_, backward_;
  std::array<std::vector<float>, 3> response_;
  std::vector<float> scattered_;
};

}  // namespace

std::unique_ptr<Opponent> make_fft(const Scene& scene) { return std::make_unique<Convolution>(scene); }

}  // namespace dermis::bench
