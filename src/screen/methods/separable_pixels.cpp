// The separable passes over a window that is the frame, for devices where a work-item computes one pixel. The kernels
// are in kernels/separable/pixel.cl.
#include "opencl/program.hpp"
#include "screen/methods/scatter_methods.hpp"
#include "screen/methods/separable_method.hpp"
#include "screen/methods/window_layout.hpp"

namespace dermis {

namespace {

/// The buffers of a run: the window of the horizontal pass, and light and segments of the vertical one.
enum Buffer { window, between, vertical_segments };

class SeparablePixels final : public SeparableMethod {
 public:
  using SeparableMethod::SeparableMethod;

  ProgramSource kernels(int terms) const override {
    return {{"frame/prepare.cl", "separable/pixel.cl"}, build_constant("TERMS", terms)};
  }

  std::vector<BufferSize> buffers(const FrameSize& frame) const override {
    const std::size_t plane_bytes = frame.plane() * sizeof(float);
    return {{"window", window_bytes(frame_window(frame, settings_.has_pixel_width()).planes)},
            {"light between the passes", 3 * plane_bytes * terms_},
            {"vertical segments", plane_bytes}};
  }

  void prepare(FrameRun& run) const override {
    const auto& buffers = run.memory().method;
    run.load_window(buffers[window]);
    cl::Kernel kernel(run.program(), "segments");
    set_arguments(kernel, run.frame(), run.images().layouts(), run.images().buffers({ImageName::matte}), run.window(),
                  buffers[window], buffers[vertical_segments]);
    run.launch(kernel, run.size().width, run.size().height, 0);
    if (!settings_.is_sheared()) return;
    cl::Kernel shears(run.program(), "shears");
    set_arguments(shears, run.frame(), run.window(), buffers[window]);
    run.launch(shears, run.size().blocks_x(), run.size().height, 0);
  }

  void scatter(FrameRun& run, RowRange rows) const override {
    const auto& buffers = run.memory().method;
    const cl::Buffer axes = rotations(run);
    cl::Kernel horizontal(run.program(), "scatter_x");
    set_arguments(horizontal, run.frame(), run.window(), buffers[window], run.materials(), run.levels(), taps_at_,
                  taps_, axes, settings_.options.seed, run.memory().passes, buffers[between]);
    run.launch(horizontal, run.size().width, run.size().height, 0);
    cl::Kernel vertical(run.program(), "scatter_y");
    set_arguments(vertical, run.frame(), run.window(), buffers[window], run.materials(), run.levels(), taps_at_, taps_,
                  axes, settings_.options.seed, run.memory().passes, buffers[between], buffers[vertical_segments],
                  run.deferred());
    run.launch(vertical, run.size().width, rows.count, 0);
  }
};

}  // namespace

std::unique_ptr<ScatterMethod> make_separable_pixels(const PlanSettings& settings) {
  return std::make_unique<SeparablePixels>(settings);
}

}  // namespace dermis
