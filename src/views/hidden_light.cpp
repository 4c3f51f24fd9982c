#include "views/hidden_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include "opencl/device_buffer.hpp"
#include "opencl/program.hpp"
#include "screen/methods/profile_tables.hpp"
#include "views/crossing.hpp"
#include "views/hidden_samples.hpp"

namespace dermis {

namespace {

/// Of the pixels of a view, so many may lie in front of what the camera sees: edges, and what the frame's depth leaves
/// out.
constexpr double most_contradicting = 0.05;

/// A motion keeps lengths to so much.
constexpr double motion_tolerance = 1e-3;

enum Name { light, albedo, position, normal, material };
constexpr int view_image_count = material + 1;
using Images = std::array<CallerImage, view_image_count>;

std::string name_of_view(std::size_t number) { return "view " + std::to_string(number + 1); }

Images images_of(const View& view) {
  return {described("light", 3, view.light, view.width), described("albedo", 3, view.albedo, view.width),
          described("position", 3, view.position, view.width), described("normal", 3, view.normal, view.width),
          described("material", 1, view.material, view.width, true)};
}

/// The rows of the matrix turn without a mirror.
bool is_motion(const std::array<double, 12>& m) {
  double worst = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double product = m[4 * i] * m[4 * j] + m[4 * i + 1] * m[4 * j + 1] + m[4 * i + 2] * m[4 * j + 2];
      worst = std::max(worst, std::abs(product - (i == j ? 1 : 0)));
    }
    if (!std::isfinite(m[4 * i + 3])) return false;
  }
  const double determinant =
      m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
  return worst <= motion_tolerance && determinant > 0;  // false for NaN
}

void check_view(const View& view, const std::string& name, const PlanSettings& settings) {
  check_size(view.width, view.height, (name + " size").c_str());
  const Images images = images_of(view);
  const std::array<bool, view_image_count> is_needed = {true, settings.frames.albedo, true, true,
                                                        settings.frames.material};
  for (std::size_t i = 0; i < images.size(); ++i) {
    CallerImage image = images[i];
    const std::string argument = name + " " + image.name;
    if (is_needed[i] && !image.present()) {
      throw Error(ErrorCode::role_missing, argument, "no image", "an image");
    }
    image.name = argument.c_str();
    check_image(image, view.width, view.height);
  }
  if (!is_motion(view.to_camera)) {
    throw Error(ErrorCode::usage, name + " to_camera", "a matrix that scales, mirrors or is not finite",
                "a rotation and a translation");
  }
}

/// The plan that sums the weights of the visible surface: it scatters a light of 1 and does not divide.
PlanSettings weights_of(const PlanSettings& settings) {
  PlanSettings result = settings;
  for (Material& its : result.materials) its.taps = TapsDesign{};
  result.frames.views = false;
  result.options.taps = {};
  result.options.lighting = Lighting::raw;
  result.options.albedo_mix = 0;
  result.options.jitter = 0;
  result.options.bad_pixels = BadPixels::keep;
  result.options.sums_weights = true;
  return result;
}

params::ViewParams params_of(const View& view, double mm_per_unit) {
  params::ViewParams result{};
  result.width = view.width;
  result.height = view.height;
  for (std::size_t i = 0; i < view.to_camera.size(); ++i) {
    result.to_camera[i] = static_cast<float>(view.to_camera[i] * mm_per_unit);
  }
  return result;
}

ViewStats count(const ViewPixels& view) {
  ViewStats stats;
  for (const params::ViewPixel& pixel : view) {
    ++(pixel.place == PLACE_SEEN ? stats.seen : stats.hidden);
    if (pixel.place == PLACE_CONTRADICTING) ++stats.contradicting;
  }
  return stats;
}

void check_place(const ViewStats& stats, std::size_t number) {
  const auto all = static_cast<double>(stats.seen + stats.hidden);
  if (static_cast<double>(stats.contradicting) <= most_contradicting * all) return;
  const double percent = std::round(100 * static_cast<double>(stats.contradicting) / all);
  throw Error(ErrorCode::input_unsupported, name_of_view(number),
              std::to_string(static_cast<int>(percent)) + " % of its surface in front of what the camera sees",
              "the surfaces of the same frame, in its scene units");
}

}  // namespace

void check_views(const Frame& frame, const PlanSettings& settings) {
  if (frame.views.empty()) return;
  if (!settings.frames.views) {
    throw Error(ErrorCode::usage, "views", std::to_string(frame.views.size()) + " views",
                "none, as the plan was made without");
  }
  for (std::size_t i = 0; i < frame.views.size(); ++i) check_view(frame.views[i], name_of_view(i), settings);
}

struct HiddenLight::State {
  std::unique_ptr<Plan::State> weights;  ///< of the visible surface
  cl::Program pixels;                    ///< views/view_pixels.cl
  cl::Program gather;                    ///< views/hidden_light.cl
  ProfileTables profiles;
  std::vector<params::HiddenMaterial> hidden;  ///< of each material, without samples
};

HiddenLight::HiddenLight(const PlanSettings& settings) : state_(std::make_unique<State>()) {
  if (!settings.frames.depth) {
    throw Error(ErrorCode::role_missing, "depth", "no image", "a depth image, for frames with views");
  }
  bool has_projected = false;
  bool has_walk = false;
  for (const Material& its : settings.materials) {
    state_->hidden.push_back(crossing_of(its.profile));
    has_projected = has_projected || state_->hidden.back().crossing == CROSSING_PROJECTED;
    has_walk = has_walk || state_->hidden.back().crossing == CROSSING_WALK;
  }
  const std::string options = common_options(settings) +
                              build_constant("LIT", settings.options.lighting == Lighting::lit ? 1 : 0) +
                              profile_table_constant();
  const std::string by_lanes = options + build_constant("PROJECTED", has_projected ? 1 : 0) +
                               build_constant("WALK", has_walk ? 1 : 0) +
                               build_constant("V", settings.item_is_pixel() ? 1 : BLOCK);
  state_->weights = build_plan(weights_of(settings));
  state_->pixels = build_program(settings.device, {"views/view_pixels.cl"}, options + build_constant("V", 1));
  state_->gather = build_program(settings.device, {"views/hidden_light.cl"}, by_lanes);
  state_->profiles.upload(cl::Context(settings.device.context(), true), settings.materials);
}

HiddenLight::~HiddenLight() = default;

std::vector<ViewStats> HiddenLight::add_to(FrameRun& run, const Frame& frame) const {
  std::vector<ViewStats> stats;
  std::vector<ViewPixels> views;
  for (const View& view : frame.views) {
    views.push_back(pixels_of(run, view, frame.mm_per_unit));
    stats.push_back(count(views.back()));
    check_place(stats.back(), views.size() - 1);
  }
  const HiddenSamples samples = hidden_samples(views, state_->hidden);
  if (samples.samples.empty()) return stats;
  const BorrowedMemory<RunMemory> memory(state_->weights->memories, run.device(), run.queue(),
                                         state_->weights->run_sizes(frame.width, frame.height));
  gather(run, samples, sum_weights(run, frame, *memory));
  run.queue().finish();  // before the memory goes to another run
  return stats;
}

ViewPixels HiddenLight::pixels_of(FrameRun& run, const View& view, double mm_per_unit) const {
  const Images images = images_of(view);
  const ImageBuffers bound(run.device(), run.queue(), view.width, view.height, images);
  const auto buffer = [&](Name name) { return bound.buffer(bound.has(name) ? name : light); };
  const std::size_t pixel_count = static_cast<std::size_t>(view.width) * view.height;
  const std::size_t bytes = pixel_count * sizeof(params::ViewPixel);
  const cl::Buffer pixels = device_buffer(run.device(), "pixels of a view", bytes);
  const params::ViewLayouts layouts{bound.layout(light), bound.layout(albedo), bound.layout(position),
                                    bound.layout(normal), bound.layout(material)};
  const params::ViewParams view_params = params_of(view, mm_per_unit);
  const cl_int columns = run.run_length(view.width);
  cl::Kernel of_pixels(state_->pixels, "view_pixels");
  set_arguments(of_pixels, run.frame(), view_params, layouts, buffer(light), buffer(albedo), buffer(position),
                buffer(normal), buffer(material), run.materials(), columns, pixels);
  run.launch_runs(of_pixels, view.width, view.height);
  cl::Kernel of_surface(state_->pixels, "view_surface");
  set_arguments(of_surface, run.frame(), run.images().layouts(), run.images().buffers({ImageName::depth}),
                run.memory().material_ids, view_params, columns, pixels);
  run.launch_runs(of_surface, view.width, view.height);
  const auto* all =
      static_cast<const params::ViewPixel*>(run.queue().enqueueMapBuffer(pixels, CL_TRUE, CL_MAP_READ, 0, bytes));
  ViewPixels result;
  std::copy_if(all, all + pixel_count, std::back_inserter(result),
               [](const auto& pixel) { return pixel.material != 0 && pixel.place != PLACE_UNLIT; });
  run.queue().enqueueUnmapMemObject(pixels, const_cast<params::ViewPixel*>(all));
  run.queue().finish();
  return result;
}

cl::Buffer HiddenLight::sum_weights(FrameRun& run, const Frame& frame, RunMemory& memory) const {
  using enum ImageName;
  const FrameSize& size = run.size();
  const cl::Buffer ones = device_buffer(run.device(), "light of 1", size.plane() * sizeof(float));
  cl::Kernel kernel(state_->gather, "unit_light");
  set_arguments(kernel, run.frame(), run.images().layouts(),
                run.images().buffers({ImageName::light, ImageName::albedo}), run.run_length(size.width), ones);
  run.launch_runs(kernel, size.width, size.height);

  // All three channels are that plane.
  std::array<CallerImage, dermis::image_count> images = images_of_frame(frame);
  CallerImage& unit = images[static_cast<std::size_t>(ImageName::light)];
  unit.host = nullptr;
  unit.buffer = ones();
  unit.layout = {.format = Format::f32,
                 .channel_stride = 0,
                 .pixel_stride = sizeof(float),
                 .row_stride = static_cast<std::ptrdiff_t>(size.stride() * sizeof(float)),
                 .offset = PADDING * sizeof(float)};
  for (const ImageName output : {scattered, result, beauty}) images[static_cast<std::size_t>(output)] = {};
  const BoundImages bound(run.device(), run.queue(), frame, images);
  const cl_event before = run.last_event()();
  FrameRun weights(*state_->weights, frame, Band::whole(frame.height), bound, memory, run.queue(), {&before, 1});
  weights.classify();
  for (int step = 0; step < weights.scatter_steps(); ++step) weights.scatter(step);
  run.include(weights);
  run.queue().finish();  // while `bound` and `ones` are there
  return weights.deferred();
}

void HiddenLight::gather(FrameRun& run, const HiddenSamples& samples, const cl::Buffer& seen_weights) const {
  using enum ImageName;
  const cl::Buffer materials = upload(run.context(), samples.materials);
  const cl::Buffer cells = upload(run.context(), samples.cells);
  const cl::Buffer rows = upload(run.context(), samples.samples);
  const int side = run.local_size() > 0 ? BLOCK : 1;
  cl::Kernel kernel(state_->gather, "hidden_light");
  set_arguments(kernel, run.frame(), run.images().layouts(), run.images().buffers({ImageName::albedo, depth, mask}),
                run.memory().material_ids, run.materials(), state_->profiles.profiles, state_->profiles.nodes,
                materials, cells, rows, seen_weights, run.deferred(), run.memory().counters, side, side);
  run.launch(kernel, parts_of(run.size().width, side), parts_of(run.size().height, side), run.local_size());
  run.queue().finish();  // while the samples are there
}

}  // namespace dermis
