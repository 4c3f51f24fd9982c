// The separable passes over a window that is the frame, for devices where a work-item computes one pixel. The kernels
// are in kernels/separable/pixel.cl and passes.cl.
#include <algorithm>
#include <cstddef>

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
    ProgramSource source = passes(terms, 0, 0);
    if (taps_always_fit(terms)) source.files.clear();
    source.files.insert(source.files.begin(), {"frame/prepare.cl", "separable/pixel.cl"});
    return source;
  }

  /// Taps that are turned out of the line have no use for local memory.
  std::vector<ProgramSource> more_kernels(int terms) const override {
    if (settings_.options.jitter > 0) return {};
    return {passes(terms, 1, 0), passes(terms, 1, 1)};
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
    run.launch(shears, parts_of(run.size().width, SHEAR_RUN), run.size().height, 0);
  }

  void scatter(FrameRun& run, RowRange rows) const override {
    const auto& buffers = run.memory().method;
    const cl::Buffer axes = rotations(run);
    std::vector<cl::Program> programs;
    if (!taps_always_fit(terms_)) programs.push_back(run.program());
    programs.insert(programs.end(), run.more_programs().begin(), run.more_programs().end());
    const cl_int room = local_bytes();
    // A work-group leaves what it does not have to compute at once.
    for (const cl::Program& program : programs) {
      cl::Kernel horizontal(program, "scatter_x");
      set_arguments(horizontal, run.frame(), run.window(), buffers[window], run.materials(), run.levels(), taps_at_,
                    taps_, axes, settings_.options.seed, run.memory().passes, buffers[between],
                    cl::Local(static_cast<std::size_t>(room)), room);
      run.launch(horizontal, {round_up(run.size().width, LINE_COLUMNS), run.size().height, GROUP_ITEMS, 1});
    }
    for (const cl::Program& program : programs) {
      cl::Kernel vertical(program, "scatter_y");
      set_arguments(vertical, run.frame(), run.window(), buffers[window], run.materials(), run.levels(), taps_at_,
                    taps_, axes, settings_.options.seed, run.memory().passes, buffers[between],
                    buffers[vertical_segments], run.deferred(), cl::Local(static_cast<std::size_t>(room)), room);
      run.launch(vertical, {parts_of(run.size().width, COLUMN_COLUMNS) * GROUP_ITEMS, parts_of(rows.count, COLUMN_ROWS),
                            GROUP_ITEMS, 1});
    }
  }

 private:
  /// Whether the taps of all blocks of any work-group fit in local memory, whatever their levels are.
  bool taps_always_fit(int terms) const {
    int count = settings_.options.taps.count;
    for (const Material& its : settings_.materials) count = std::max(count, design_of(its).count);
    const int rows = count / 2 + 1;
    const std::size_t words = static_cast<std::size_t>(rows) * (9 * terms + 3 + 1) + LEVEL_WORDS + TAP_WORDS;
    return settings_.options.jitter == 0 &&
           GROUP_BLOCKS * words * sizeof(cl_int) <= static_cast<std::size_t>(local_bytes());
  }

  static ProgramSource passes(int terms, int local_taps, int local_pixels) {
    return {{"separable/passes.cl"},
            build_constant("TERMS", terms) + build_constant("LOCAL_TAPS", local_taps) +
                build_constant("LOCAL_PIXELS", local_pixels)};
  }

  /// Bytes of local memory for the taps and pixels of a work-group, beside what its kernel has there.
  int local_bytes() const {
    constexpr cl_ulong most = 48 << 10;  // so that a compute unit of a large GPU holds several work-groups
    constexpr cl_ulong of_kernel = 1 << 10;
    const cl_ulong all = cl::Device(settings_.device.id(), true).getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    return static_cast<int>(std::clamp(all, of_kernel + 64, most) - of_kernel);
  }
};

}  // namespace

std::unique_ptr<ScatterMethod> make_separable_pixels(const PlanSettings& settings) {
  return std::make_unique<SeparablePixels>(settings);
}

}  // namespace dermis
