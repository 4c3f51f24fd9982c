#include "screen/surface_integral.hpp"

#include "screen/frame_run.hpp"
#include "screen/window_layout.hpp"

namespace dermis {

namespace {

/// The buffers of a run: `geometry` holds the slopes and the area of each pixel.
enum Buffer { window, geometry };

}  // namespace

std::vector<std::string> SurfaceIntegral::kernel_files() const { return {"frame/prepare.cl", "integral/exact.cl"}; }

std::string SurfaceIntegral::build_constants(int) const { return profile_table_constant(); }

void SurfaceIntegral::upload(const cl::Context& context, const MaterialTables&) {
  profiles_ = upload_profiles(context, settings_.materials);
}

std::vector<std::size_t> SurfaceIntegral::buffer_bytes(const FrameSize& frame) const {
  return {window_bytes(frame_window(frame, settings_.has_pixel_width()).planes), 3 * frame.plane() * sizeof(float)};
}

void SurfaceIntegral::prepare(FrameRun& run) const {
  const auto& buffers = run.memory().method;
  run.load_window(buffers[window]);
  cl::Kernel kernel(run.program(), "slopes");
  set_arguments(kernel, run.frame(), run.images().layouts(), run.images().buffers({ImageName::matte}), run.window(),
                buffers[window], buffers[geometry], run.run_length(run.size().width));
  run.launch_runs(kernel, run.size().width, run.size().height);
}

int SurfaceIntegral::steps(int height) const { return parts_of(height, rows_per_step_px); }

void SurfaceIntegral::scatter(FrameRun& run, int step) const {
  const auto& buffers = run.memory().method;
  const RowRange rows = run.rows_of(step);
  cl::Kernel kernel(run.program(), "exact");
  set_arguments(kernel, run.frame(), run.window(), buffers[window], profiles_.profiles, profiles_.nodes,
                buffers[geometry], rows.first, run.run_length(run.size().width), run.deferred());
  run.launch_runs(kernel, run.size().width, rows.count);
}

}  // namespace dermis
