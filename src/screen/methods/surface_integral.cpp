// The surface integral over all visible pixels of a material. The kernels are in kernels/integral/exact.cl.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "opencl/program.hpp"
#include "screen/frame_run.hpp"
#include "screen/methods/profile_tables.hpp"
#include "screen/methods/scatter_methods.hpp"
#include "screen/methods/window_layout.hpp"

namespace dermis {

namespace {

/// The buffers of a run: `geometry` holds the slopes and the area of each pixel.
enum Buffer { window, geometry };

class SurfaceIntegral final : public ScatterMethod {
 public:
  using ScatterMethod::ScatterMethod;

  ProgramSource kernels(int) const override {
    const auto& materials = settings_.materials;
    const bool has_projected =
        std::any_of(materials.begin(), materials.end(), [](const Material& its) { return its.profile.is_projected(); });
    return {{"frame/prepare.cl", "integral/exact.cl"},
            profile_table_constant() + build_constant("PROJECTED", has_projected ? 1 : 0)};
  }

  int rows_per_step(const FrameSize& frame) const override { return rows_at_once(frame); }

  void measure(const MaterialTables& tables) override {
    for (const params::MaterialParams& its : tables.materials) {
      // An albedo may widen a narrow channel by more than the widest one, by whose width blocks are classified.
      const auto& widths = its.relative_width;
      narrowest_ = std::min<double>(
          narrowest_, its.width.follows_albedo != 0 ? *std::min_element(std::begin(widths), std::end(widths)) : 1);
    }
  }

  void upload(const cl::Context& context, const MaterialTables&) override {
    profiles_.upload(context, settings_.materials);
  }

  std::vector<BufferSize> buffers(const FrameSize& frame) const override {
    return {{"window", window_bytes(frame_window(frame, settings_.has_pixel_width()).planes)},
            {"geometry", 3 * frame.plane() * sizeof(float)}};
  }

  /// As `reach` of exact.cl has it.
  int reach_rows(const Finest& finest, const Camera& camera, const FrameSize& frame) const override {
    if (finest.y == 0) return 0;
    const double reach_mm = profiles_.farthest_mm / narrowest_;
    double rows = reach_mm * finest.y;
    if (camera.projection == Camera::Projection::perspective) {
      const double nearest_mm = camera.scale_y / finest.y - reach_mm;
      if (nearest_mm <= 0) return frame.height;
      const double most_slope =
          std::max(std::abs(camera.center_y), std::abs(frame.height - camera.center_y)) / camera.scale_y;
      rows = reach_mm * (1 + most_slope) * camera.scale_y / nearest_mm;
    }
    return rows_within(1.001 * rows + 2 + 1, frame);  // and one for the slopes of the farthest
  }

  void prepare(FrameRun& run) const override {
    const auto& buffers = run.memory().method;
    run.load_window(buffers[window]);
    cl::Kernel kernel(run.program(), "slopes");
    set_arguments(kernel, run.frame(), run.images().layouts(), run.images().buffers({ImageName::matte}), run.window(),
                  buffers[window], buffers[geometry], run.run_length(run.size().width));
    run.launch_runs(kernel, run.size().width, run.size().height);
  }

  void scatter(FrameRun& run, RowRange rows) const override {
    const auto& buffers = run.memory().method;
    cl::Kernel kernel(run.program(), "exact");
    set_arguments(kernel, run.frame(), run.window(), buffers[window], profiles_.profiles, profiles_.nodes,
                  buffers[geometry], rows.first, run.run_length(run.size().width), run.deferred());
    run.launch_runs(kernel, run.size().width, rows.count);
  }

 private:
  ProfileTables profiles_;
  double narrowest_ = 1;  ///< channel of a material, over its widest one, if an albedo widens each by itself
};

}  // namespace

std::unique_ptr<ScatterMethod> make_surface_integral(const PlanSettings& settings) {
  return std::make_unique<SurfaceIntegral>(settings);
}

}  // namespace dermis
