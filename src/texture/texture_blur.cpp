// The method TextureMethod::gaussians, whose kernels are in texture_blur.cl.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <sstream>

#include "opencl/device_buffer.hpp"
#include "texture/texture_scatter.hpp"

namespace dermis {

namespace {

/// A GaussianChain as the kernels read it.
struct BlurTables {
  std::vector<params::BlurParams> blurs;  ///< Gaussian by Gaussian, three channels each
  std::vector<float> weights;             ///< of all blurs, where all texels are of one size
};

/// The largest n with n mm <= most, at least 1, as in texture_blur.cl.
int steps_within(float mm, float most) {
  float n = std::floor(most / mm);
  if ((n + 1) * mm <= most) ++n;
  if (n * mm > most) --n;
  return std::max(static_cast<int>(n), 1);
}

/// The smallest n with n mm >= least, at least 1.
int steps_beyond(float mm, float least) {
  float n = std::ceil(least / mm);
  if ((n - 1) * mm >= least) --n;
  if (n * mm < least) ++n;
  return std::max(static_cast<int>(n), 1);
}

/// Completes a blur for texels of one size, and appends its weights: of the centre, then of each pair of taps.
void place_taps(params::BlurParams& blur, std::vector<float>& weights, float mm_per_texel) {
  blur.from_light = blur.is_first != 0 || blur.total_deviation_mm <= GaussianChain::narrow * mm_per_texel ? 1 : 0;
  const float deviation_mm = blur.from_light != 0 ? blur.total_deviation_mm : blur.deviation_mm;
  const float mm = std::max(mm_per_texel, deviation_mm * (1 / GaussianChain::most_texels));
  blur.step = blur.from_light != 0 ? 1 : steps_within(mm, GaussianChain::spacing * deviation_mm);
  const float step_mm = static_cast<float>(blur.step) * mm;
  blur.taps = steps_beyond(step_mm, GaussianChain::reach * deviation_mm);
  blur.first_weight = static_cast<int>(weights.size());
  const double step = static_cast<double>(step_mm) / static_cast<double>(deviation_mm);
  const auto up_to = [&](double o) { return std::erf(o * step / std::numbers::sqrt2); };
  const auto share = [&](int o) {
    if (blur.from_light != 0) return o == 0 ? 2 * up_to(0.5) : up_to(o + 0.5) - up_to(o - 0.5);
    return o == 0 ? 1 : std::exp(-o * step * (o * step) / 2);
  };
  double sum = share(0);
  for (int o = 1; o <= blur.taps; ++o) sum += 2 * share(o);
  for (int o = 0; o <= blur.taps; ++o) weights.push_back(static_cast<float>(share(o) / sum));
}

/// `mm_per_texel`: of all texels, or 0 if they differ and the device makes the weights.
BlurTables make_blur_tables(const GaussianChain& chain, double mm_per_texel) {
  BlurTables tables;
  for (std::size_t k = 0; k < chain.weights.front().size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      const std::vector<double>& variances = chain.variances_mm2[c];
      const double variance = variances[k] - (k > 0 ? variances[k - 1] : 0);
      params::BlurParams blur{};
      blur.total_deviation_mm = static_cast<float>(std::sqrt(variances[k]));
      blur.variance_mm2 = static_cast<float>(variance);
      blur.deviation_mm = static_cast<float>(std::sqrt(variance));
      blur.weight = static_cast<float>(chain.weights[c][k]);
      blur.is_first = k == 0 ? 1 : 0;
      if (mm_per_texel > 0) place_taps(blur, tables.weights, static_cast<float>(mm_per_texel));
      tables.blurs.push_back(blur);
    }
  }
  if (tables.weights.empty()) tables.weights.push_back(0);  // a buffer has at least one byte
  return tables;
}

std::string chain_constants() {
  std::ostringstream constants;
  constants << std::scientific << " -DSPACING=" << GaussianChain::spacing << "f -DREACH=" << GaussianChain::reach
            << "f -DNARROW=" << GaussianChain::narrow << "f -DMOST_TEXELS=" << GaussianChain::most_texels << "f";
  return constants.str();
}

/// Texels of its run before and after each texel, along an axis.
struct Runs {
  cl::Buffer before, after;
};

/// BlurTables on the device, for texels of so many mm.
struct UploadedTables {      // NOLINT(bugprone-exception-escape): to give up a buffer's handle may fail
  double mm_per_texel = -1;  ///< of none yet
  std::vector<cl::Buffer> levels;
  cl::Buffer weights;
};

UploadedTables upload_tables(const cl::Context& context, const GaussianChain& chain, double mm_per_texel) {
  const BlurTables tables = make_blur_tables(chain, mm_per_texel);
  UploadedTables uploaded{mm_per_texel, {}, upload(context, tables.weights)};
  for (std::size_t k = 0; k < tables.blurs.size() / 3; ++k) {
    uploaded.levels.push_back(upload(context, std::span(tables.blurs).subspan(3 * k, 3)));
  }
  return uploaded;
}

struct BlurMemory {
  TextureSizes sizes;
  TexturePlanes planes;
  cl::Buffer between;  ///< after the pass along u
  cl::Buffer last;     ///< the Gaussian before
  cl::Buffer sum;      ///< the scattered light
  Runs along_u, along_v;
  UploadedTables tables;

  BlurMemory(const Device& device, const TextureSizes& wanted);
};

/// A chain of Gaussians, each blurred along u, then along v.
class TextureBlur final : public TextureScatter {
 public:
  TextureBlur(const Device& device, const Profile& profile, const TextureDescription& images)
      : TextureScatter(device, images, false),
        chain_(make_gaussian_chain(profile)),
        passes_(build_passes(device, images, "texture/texture_blur.cl", chain_constants())),
        vector_width_(device.info().vector_width) {}

  double predicted_rel_l2() const override { return chain_.predicted_rel_l2; }
  TextureStats scatter(TextureRun& run) const override {
    return scatter_with(memories_, run, [&](auto& its_run, auto& memory) { launch(its_run, memory); });
  }
  void enqueue(TextureRun& run) const override {
    enqueue_with(memories_, run, [&](auto& its_run, auto& memory) { launch(its_run, memory); });
  }

 private:
  void launch(TextureRun& run, BlurMemory& memory) const;
  void find_runs(TextureRun& run, const BlurMemory& memory) const;
  void blur(TextureRun& run, const BlurMemory& memory) const;

  GaussianChain chain_;
  cl::Program passes_;
  mutable MemoryPool<BlurMemory> memories_;
  int vector_width_;
};

BlurMemory::BlurMemory(const Device& device, const TextureSizes& wanted)
    : sizes(wanted), planes(device, sizes, 3, BLUR_PLANES) {
  for (cl::Buffer* floats : {&between, &last, &sum}) {
    *floats = device_buffer(device, "light between passes", 3 * sizes.texels() * sizeof(float));
  }
  for (cl::Buffer* counts : {&along_u.before, &along_u.after, &along_v.before, &along_v.after}) {
    *counts = device_buffer(device, "runs of texels", sizes.texels() * sizeof(cl_int));
  }
}

void TextureBlur::launch(TextureRun& run, BlurMemory& memory) const {
  if (memory.tables.mm_per_texel != run.mm_per_texel()) {
    memory.tables = upload_tables(run.context(), chain_, run.mm_per_texel());
  }
  run.prepare(memory.planes);
  find_runs(run, memory);
  blur(run, memory);
  run.finish(memory.sum);
}

void TextureBlur::find_runs(TextureRun& run, const BlurMemory& memory) const {
  cl::Kernel rows(passes_, "texture_runs_u");
  set_arguments(rows, run.params(), memory.planes.objects, memory.along_u.before, memory.along_u.after);
  run.launch_lines(TextureRun::Step::prepare, rows, run.sizes().height);
  cl::Kernel columns(passes_, "texture_runs_v");
  set_arguments(columns, run.params(), memory.planes.objects, memory.along_v.before, memory.along_v.after);
  run.launch_lines(TextureRun::Step::prepare, columns, parts_of(run.sizes().width, vector_width_));
}

void TextureBlur::blur(TextureRun& run, const BlurMemory& memory) const {
  for (const cl::Buffer& level : memory.tables.levels) {
    for (const bool along_v : {false, true}) {
      const Runs& runs = along_v ? memory.along_v : memory.along_u;
      cl::Kernel kernel(passes_, "texture_blur");
      set_arguments(kernel, run.params(), run.pass(along_v), level, memory.tables.weights, run.stretch(along_v),
                    runs.before, runs.after, memory.planes.finest, memory.planes.lit, memory.planes.light,
                    memory.between, memory.last, memory.sum, memory.planes.counters);
      run.launch_blocks(TextureRun::Step::scatter, kernel);
      run.count_parts(run.sizes().blocks());
    }
  }
}

}  // namespace

std::unique_ptr<const TextureScatter> make_texture_blur(const Device& device, const Profile& profile,
                                                        const TextureDescription& images) {
  return std::make_unique<TextureBlur>(device, profile, images);
}

}  // namespace dermis
