// One frame under stress, the filter it goes through, and how far what comes out is from the oracle.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "dermis/plan.hpp"
#include "stress/stress.hpp"

namespace dermis::bench {

/// The frame. One scene unit is `mm_per_unit`.
struct StressField {
  int width_px = 0;
  int height_px = 0;
  Camera camera;
  double mm_per_unit = 1;
  Format format = Format::f32;    ///< of light and output: f32 or f16
  std::vector<float> light = {};  ///< RGB; rounded to half if the format is f16
  std::vector<float> depth = {};  ///< scene units; none if empty
  std::vector<float> ids = {};    ///< of materials; none if empty

  std::size_t pixels() const { return static_cast<std::size_t>(width_px) * height_px; }
};

/// What a run made of it.
struct StressResult {
  oracle::Picture values;
  std::vector<std::uint32_t> bits;        ///< of each value
  std::vector<std::uint32_t> input_bits;  ///< of the light
  Stats stats;
};

/// Columns of a frame.
struct StressWindow {
  int x_px = 0;
  int width_px = 0;
};

/// A plan, and the same for the oracle. The frames have depth and ids as the description says.
class StressFilter {
 public:
  StressFilter(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
               const Options& options = {});

  StressResult run(const StressField& field) const;
  oracle::Reference reference(const StressField& field) const;
  const oracle::Material& material(std::size_t index) const { return for_oracle_[index]; }

 private:
  Options options_;
  std::vector<oracle::Material> for_oracle_;
  Plan plan_;
};

/// Errors of a result, collected over parts of a frame.
class StressErrors {
 public:
  explicit StressErrors(Format format) : format_(format) {}

  /// Takes in the pixels of `seen` from column `seen_x` on, `width` of them a row, that `expected` has from column
  /// `expected_x` on.
  void add(const oracle::Picture& seen, int seen_x, const oracle::Reference& expected, int expected_x, int width);

  /// Writes rel_l2, max_rel, max_ulp, of_bound and non_finite: the first three of all values or of those that the
  /// oracle is sure of. Of others float32 cannot tell which level of taps is meant, or whether the kernel is half a
  /// pixel wide, and the bound takes in both outcomes.
  void write_to(StressRow& row, bool sure_values_only) const;

  /// Share of the values that rel_l2 speaks of.
  double sure_share() const { return values_ > 0 ? static_cast<double>(sure_) / static_cast<double>(values_) : 0; }

 private:
  struct Sums {
    double errors2 = 0;
    double truths2 = 0;
    double max_rel = 0;
    double max_ulp = 0;

    void add(double error, double truth, double last_place);
  };

  Format format_;
  Sums all_, of_sure_;
  double of_bound_ = 0;
  long non_finite_ = 0;
  long values_ = 0;
  long sure_ = 0;
};

enum class StressChange { scatters, any, keeps_bits };

/// What a case promises besides the oracle's bound. Infinite: nothing.
struct StressPromise {
  double rel_l2 = 4e-6;
  double energy = 2e-6;
  double overshoot = 0.5;
  double white = 0.7;  ///< the constant light
  StressChange change = StressChange::scatters;
  bool sure_values_only = true;     ///< for rel_l2; see StressErrors
  bool white_within_bound = false;  ///< instead of `energy`: where corrections weigh far more than the mean
};

/// Notes that a promise does not hold.
void fail(StressRow& row, const std::string& text);

/// Runs a field and the same with constant light. `windows`: the oracle does only those columns and what they need,
/// `margin_px` to each side; both multiples of 16; the frame has an orthographic camera and no depth. All of it if
/// empty.
StressRow judged(const StressFilter& filter, const StressField& field, const std::string& group,
                 const std::string& name, const StressPromise& promise = {},
                 const std::vector<StressWindow>& windows = {}, int margin_px = 0);

/// A plane parallel to the screen, lit by patches and noise in 0.02..1.5.
StressField stress_plane(std::mt19937& engine, int width_px, int height_px, double px_per_mm);

/// A bumpy surface `depth_units` away under a perspective camera, a sixtieth of it background; the bumps are
/// `bump_units` high.
StressField stress_surface(std::mt19937& engine, int width_px, int height_px, double focal_px, double depth_units,
                           double bump_units);

double uniform(std::mt19937& engine, double low, double high);

// The groups of cases.
void add_light_cases(std::vector<StressRow>& rows, const StressFilter& flat, std::mt19937& engine);
void add_frame_cases(std::vector<StressRow>& rows, const StressFilter& flat, std::mt19937& engine);
void add_depth_cases(std::vector<StressRow>& rows, const StressFilter& deep, std::mt19937& engine);
void add_camera_cases(std::vector<StressRow>& rows, const StressFilter& deep, std::mt19937& engine);
void add_bad_light_cases(std::vector<StressRow>& rows, const Device& device, const StressFilter& deep,
                         std::mt19937& engine);
void add_width_cases(std::vector<StressRow>& rows, const Device& device, std::mt19937& engine);

}  // namespace dermis::bench
