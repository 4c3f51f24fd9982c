// The method TextureMethod::recursive, whose kernels are in recursion.cl.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "opencl/device_buffer.hpp"
#include "texture/texture_scatter.hpp"

namespace dermis {

namespace {

constexpr double longest_texels = 0x1p14;  // as LEAST_HALF_TEXEL of recursion.cl

/// The decay of a pole pair over such a part of a texel, as recursion.cl has it.
void set_decay(float (&decay)[3][STATES], int lane, const PolePair& pair, double mm_per_texel, double part) {
  const auto length = [&](double rate) { return part * std::max(mm_per_texel, 1 / (rate * longest_texels)); };
  const auto decayed = [&](double rate) { return std::exp(-rate * length(rate)); };
  const double angle = pair.turn_per_mm * length(pair.rate_per_mm[0]);
  decay[0][lane] = static_cast<float>(decayed(pair.rate_per_mm[0]) * std::cos(angle));
  decay[1][lane] = static_cast<float>(decayed(pair.rate_per_mm[1]) * std::cos(angle));
  decay[2][lane] = static_cast<float>(-decayed(pair.rate_per_mm[0]) * std::sin(angle));
}

/// Sets the poles of a lane. `sign` is that of its result.
void set_pair(params::PoleParams& table, int lane, const PolePair& pair, double sign, double mm_per_texel) {
  // The result of a complex pair is the real part of its share times p + i q.
  const double other_sign = pair.turn_per_mm > 0 ? -sign : sign;
  table.rate[lane] = static_cast<float>(pair.rate_per_mm[0]);
  table.other_rate[lane] = static_cast<float>(pair.rate_per_mm[1]);
  table.turn[lane] = static_cast<float>(pair.turn_per_mm);
  table.share[lane] = static_cast<float>(sign * pair.share[0]);
  table.other_share[lane] = static_cast<float>(other_sign * pair.share[1]);
  if (mm_per_texel > 0) {
    set_decay(table.half_texel, lane, pair, mm_per_texel, 0.5);
    set_decay(table.texel, lane, pair, mm_per_texel, 1);
  }
}

/// The poles of the pass along u, then of that along v. `mm_per_texel`: of all texels, or 0 if they differ and the
/// device makes the decays.
std::array<params::PoleParams, 2> make_pole_tables(const Recursion& recursion, double mm_per_texel) {
  std::array<params::PoleParams, 2> tables{};
  for (int pass = 0; pass < 2; ++pass) {
    params::PoleParams& table = tables[pass];
    std::fill_n(table.rate, STATES, 1.0F);
    std::fill_n(table.other_rate, STATES, 1.0F);
    for (int k = 0; k < Recursion::pairs; ++k) {
      for (int function = 0; function < 2; ++function) {
        for (int c = 0; c < 3; ++c) {
          const PolePair& pair = (function == 0 ? recursion.main : recursion.correction)[c][k];
          const double sign = pass == 1 && function == 1 ? recursion.sign[c] : 1;
          set_pair(table, 8 * k + 4 * function + c, pair, sign, mm_per_texel);
        }
      }
    }
  }
  return tables;
}

struct RecursionMemory {
  TextureSizes sizes;
  TexturePlanes planes;      ///< the scattered light takes the place of the light
  cl::Buffer between;        ///< after the pass along u: main function and correction of each texel, four floats each
  double mm_per_texel = -1;  ///< that the poles are for; none yet
  std::array<cl::Buffer, 2> poles;  ///< of the pass along u, then along v

  RecursionMemory(const Device& device, const TextureSizes& wanted)
      : sizes(wanted),
        planes(device, sizes, 4, 1),
        between(device_buffer(device, "light between passes", 8 * sizes.texels() * sizeof(float))) {}
};

/// Poles that run along rows, then along columns.
class TextureRecursion final : public TextureScatter {
 public:
  TextureRecursion(const Device& device, const Profile& profile, const TextureDescription& images)
      : TextureScatter(device, images, true),
        recursion_(make_recursion(profile)),
        passes_(build_passes(device, images, "texture/recursion.cl", "")),
        lines_per_item_(item_is_pixel(device) ? 1 : 8) {}

  double predicted_rel_l2() const override { return recursion_.predicted_rel_l2; }
  TextureStats scatter(TextureRun& run) const override {
    return scatter_with(memories_, run, [&](auto& its_run, auto& memory) { launch(its_run, memory); });
  }
  void enqueue(TextureRun& run) const override {
    enqueue_with(memories_, run, [&](auto& its_run, auto& memory) { launch(its_run, memory); });
  }

 private:
  void launch(TextureRun& run, RecursionMemory& memory) const;

  Recursion recursion_;
  cl::Program passes_;
  mutable MemoryPool<RecursionMemory> memories_;
  int lines_per_item_;
};

void TextureRecursion::launch(TextureRun& run, RecursionMemory& memory) const {
  if (memory.mm_per_texel != run.mm_per_texel()) {
    const std::array<params::PoleParams, 2> tables = make_pole_tables(recursion_, run.mm_per_texel());
    for (std::size_t pass = 0; pass < 2; ++pass) {
      memory.poles[pass] = upload(run.context(), std::span(tables).subspan(pass, 1));
    }
    memory.mm_per_texel = run.mm_per_texel();
  }
  run.prepare(memory.planes);
  for (const bool along_v : {false, true}) {
    const cl::Buffer& poles = memory.poles[along_v ? 1 : 0];
    const int lines = along_v ? run.sizes().width : run.sizes().height;
    params::TexturePass pass = run.pass(along_v);
    pass.lines_per_item = lines_per_item_;
    cl::Kernel kernel(passes_, along_v ? "recurse_v" : "recurse_u");
    set_arguments(kernel, run.params(), pass, poles, run.stretch(along_v),
                  along_v ? memory.between : memory.planes.light, along_v ? memory.planes.light : memory.between,
                  memory.planes.counters);
    run.launch_lines(TextureRun::Step::scatter, kernel, parts_of(lines, lines_per_item_));
    run.count_parts(lines);
  }
  run.finish(memory.planes.light);
}

}  // namespace

std::unique_ptr<const TextureScatter> make_texture_recursion(const Device& device, const Profile& profile,
                                                             const TextureDescription& images) {
  return std::make_unique<TextureRecursion>(device, profile, images);
}

}  // namespace dermis
