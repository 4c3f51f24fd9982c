// Samples of the surface integral on a disc about each pixel (Golubev 2018). The kernels are in
// kernels/integral/disc.cl and disc_texels.cl.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "opencl/program.hpp"
#include "screen/frame_run.hpp"
#include "screen/methods/disc_tables.hpp"
#include "screen/methods/profile_tables.hpp"
#include "screen/methods/scatter_methods.hpp"
#include "screen/methods/window_layout.hpp"

namespace dermis {

namespace {

/// The buffers of a run: `lit` says which blocks give light, then which ones none reaches.
enum Buffer { window, texels, lit };

class DiscSampling final : public ScatterMethod {
 public:
  using ScatterMethod::ScatterMethod;

  ProgramSource kernels(int) const override {
    return {{"frame/prepare.cl", "integral/disc_texels.cl", "integral/disc.cl"},
            profile_table_constant() + build_constant("TANGENT_DISC", settings_.options.disc.tangent_plane ? 1 : 0)};
  }

  int rows_per_step(const FrameSize& frame) const override { return rows_at_once(frame); }

  /// Discs have no taps: the plainest ones tell how wide kernels are.
  TapsDesign design_of(const Material&) const override {
    return {.model = Model::pre_integrated, .rank = 1, .count = 3, .placement = Placement::importance};
  }

  /// Samples of a disc lie anywhere, so that its pixels are computed one by one.
  int vector_width() const override { return 1; }

  void upload(const cl::Context& context, const MaterialTables& tables) override {
    profiles_.upload(context, settings_.materials);
    std::vector<params::DiscParams> discs;
    std::vector<params::SampleParams> samples;
    for (std::size_t i = 0; i < settings_.materials.size(); ++i) {
      const auto& widths = tables.materials[i].relative_width;
      const auto* const widest = std::max_element(std::begin(widths), std::end(widths));
      append_disc(settings_.materials[i].profile, static_cast<int>(widest - std::begin(widths)), settings_.options.disc,
                  discs, samples);
    }
    for (const params::DiscParams& disc : discs) reach_mm_ = std::max<double>(reach_mm_, disc.reach_mm);
    std::vector<std::array<float, 2>> turns;
    for (int i = 0; i < ROTATIONS; ++i) {
      const double angle = 2 * std::numbers::pi * i / ROTATIONS;
      turns.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
    }
    discs_ = dermis::upload(context, discs);
    samples_ = dermis::upload(context, samples);
    turns_ = dermis::upload(context, turns);
  }

  std::vector<BufferSize> buffers(const FrameSize& frame) const override {
    return {{"window", window_bytes(frame_window(frame, settings_.has_pixel_width()).planes)},
            {"texels", static_cast<std::size_t>(levels(frame).texels) * sizeof(params::TexelParams)},
            {"lit blocks", 2 * frame.blocks()}};
  }

  /// As dark_blocks has it: rays n pixels apart are n times the size of a pixel apart on any surface, over their
  /// length. The farthest texels are in it; they are square.
  int reach_rows(const Finest& finest, const Camera& camera, const FrameSize& frame) const override {
    const double most_per_mm = settings_.options.disc.prefiltered ? std::max(finest.x, finest.y) : finest.y;
    return rows_within(reach_mm_ * most_per_mm * longest_ray(camera, frame) + 4, frame);
  }

  /// Texels of all levels begin there.
  int band_alignment() const override { return settings_.options.disc.prefiltered ? largest_texel_px : BLOCK; }

  void prepare(FrameRun& run) const override {
    const auto& buffers = run.memory().method;
    const FrameSize& size = run.size();
    run.load_window(buffers[window]);
    cl::Kernel first(run.program(), "texels");
    set_arguments(first, run.frame(), run.images().layouts(), run.images().buffers({ImageName::matte}), run.window(),
                  buffers[window], buffers[texels], run.run_length(size.width));
    run.launch_runs(first, size.width, size.height);
    const params::TexelLevels all = levels(size);
    for (int level = 1; level < all.count; ++level) {
      cl::Kernel halve(run.program(), "halve_texels");
      set_arguments(halve, run.frame(), all, level, buffers[texels], run.run_length(size.width >> level));
      run.launch_runs(halve, size.width >> level, size.height >> level);
    }
    cl::Kernel light(run.program(), "light_blocks");
    set_arguments(light, run.frame(), buffers[texels], buffers[lit]);
    run.launch(light, size.blocks_x(), size.blocks_y(), run.local_size());
    cl::Kernel dark(run.program(), "dark_blocks");
    set_arguments(dark, run.frame(), discs_, run.memory().blocks, buffers[lit]);
    run.launch(dark, size.blocks_x(), size.blocks_y(), run.local_size());
  }

  void scatter(FrameRun& run, RowRange rows) const override {
    const auto& buffers = run.memory().method;
    cl::Kernel kernel(run.program(), "disc");
    set_arguments(kernel, run.frame(), run.images().layouts(), run.images().buffers({ImageName::normal}),
                  run.materials(), profiles_.profiles, profiles_.nodes, discs_, samples_,
                  disc_counts(settings_.options.disc, settings_.options.seed), turns_, run.window(), buffers[window],
                  levels(run.size()), buffers[texels], buffers[lit], rows.first, run.run_length(run.size().width),
                  run.deferred(), run.memory().counters);
    run.launch_runs(kernel, run.size().width, rows.count);
  }

 private:
  static constexpr int largest_texel_px = 1 << (MOST_TEXEL_LEVELS - 1);

  params::TexelLevels levels(const FrameSize& frame) const {
    const int most_levels = settings_.options.disc.prefiltered ? MOST_TEXEL_LEVELS : 1;
    params::TexelLevels levels{};
    while (levels.count < most_levels && (frame.width >> levels.count) > 0 && (frame.height >> levels.count) > 0) {
      levels.first[levels.count] = levels.texels;
      levels.texels += static_cast<params::Bytes>(frame.width >> levels.count) * (frame.height >> levels.count);
      ++levels.count;
    }
    return levels;
  }

  ProfileTables profiles_;
  double reach_mm_ = 0;  ///< no sample of any material is farther away
  cl::Buffer discs_;     ///< DiscParams of each material
  cl::Buffer samples_;   ///< SampleParams
  cl::Buffer turns_;     ///< cosine and sine of ROTATIONS angles
};

}  // namespace

std::unique_ptr<ScatterMethod> make_disc_sampling(const PlanSettings& settings) {
  return std::make_unique<DiscSampling>(settings);
}

}  // namespace dermis
