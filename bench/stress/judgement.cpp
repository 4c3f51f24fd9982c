#include "stress/judgement.hpp"

#include <algorithm>
#include <cmath>

#include "inputs/half.hpp"
#include "stress/errors.hpp"

namespace dermis::bench {

namespace {

/// The share of the values that the oracle must be sure of. A frame of a few blocks may have most of them on the border
/// between two levels of taps.
double least_sure_share(const StressField& field) {
  constexpr int few_pixels = 40 * 256;
  return field.width_px * field.height_px < few_pixels ? 0.01 : 0.9;
}

/// Some columns of a plane.
StressField part_of(const StressField& field, StressWindow window) {
  StressField part = field;
  part.width_px = window.width_px;
  part.light.clear();
  for (int y = 0; y < field.height_px; ++y) {
    const auto row = field.light.begin() + (static_cast<std::ptrdiff_t>(y) * field.width_px + window.x_px) * 3;
    part.light.insert(part.light.end(), row, row + static_cast<std::ptrdiff_t>(window.width_px) * 3);
  }
  return part;
}

/// The change of constant light.
struct White {
  double change = 0;    ///< the largest, relative
  double of_bound = 0;  ///< change / the oracle's bound; 0 if not asked for
};

White white_through(const StressFilter& filter, StressField field, double white, bool with_bound) {
  std::fill(field.light.begin(), field.light.end(), static_cast<float>(white));
  const StressResult seen = filter.run(field);
  const auto exact = static_cast<double>(static_cast<float>(white));
  const double before = field.format == Format::f16 ? value_of_half(half_of(exact)) : exact;
  White result;
  for (const double after : seen.values.values) {
    if (!std::isfinite(after)) return {HUGE_VAL, HUGE_VAL};
    result.change = std::max(result.change, std::abs(after / before - 1));
  }
  if (with_bound) {
    StressRow row;
    StressErrors errors(field.format);
    errors.add(seen.values, 0, filter.reference(field), 0, field.width_px);
    errors.write_to(row, false);
    result.of_bound = row.of_bound;
  }
  return result;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

std::string text_of(const StressPromise& promise) {
  std::string text;
  if (std::isfinite(promise.rel_l2)) text += "L2 " + number(promise.rel_l2) + ", ";
  text += "bound";
  if (promise.white_within_bound)
    text += ", white too";
  else if (std::isfinite(promise.energy))
    text += ", white " + number(promise.energy);
  return promise.change == StressChange::keeps_bits ? text + ", keeps bits" : text;
}

double overshoot(const StressResult& seen, const StressField& field) {
  const auto [least, most] = std::minmax_element(field.light.begin(), field.light.end());
  const auto [low, high] = std::minmax_element(seen.values.values.begin(), seen.values.values.end());
  const auto before_low = static_cast<double>(*least);
  const auto before_high = static_cast<double>(*most);
  const double range = before_high - before_low;
  return range > 0 ? std::max({0.0, before_low - *low, *high - before_high}) / range : 0;
}

/// Counts the values that differ from those of the light by more than rounding.
long changed_values(const StressResult& seen, const StressField& field) {
  long changed = 0;
  for (std::size_t i = 0; i < field.light.size(); ++i) {
    const auto before = static_cast<double>(field.light[i]);
    if (!(std::abs(seen.values.values[i] - before) <= 1e-3 * std::abs(before))) ++changed;
  }
  return changed;
}

}  // namespace

void fail(StressRow& row, const std::string& text) { row.failure += (row.failure.empty() ? "" : "; ") + text; }

StressRow judged(const StressFilter& filter, const StressField& field, const std::string& group,
                 const std::string& name, const StressPromise& promise, const std::vector<StressWindow>& windows,
                 int margin_px) {
  StressRow row{.group = group, .name = name, .promised = text_of(promise)};
  const StressResult seen = filter.run(field);
  StressErrors errors(field.format);
  if (windows.empty()) errors.add(seen.values, 0, filter.reference(field), 0, field.width_px);
  for (const StressWindow window : windows) {
    const int begin = std::max(0, window.x_px - margin_px);
    const int end = std::min(field.width_px, window.x_px + window.width_px + margin_px);
    errors.add(seen.values, window.x_px, filter.reference(part_of(field, {begin, end - begin})), window.x_px - begin,
               std::min(window.width_px, field.width_px - window.x_px));
  }
  errors.write_to(row, promise.sure_values_only);
  // These see what lies outside the windows, too.
  row.non_finite = static_cast<long>(std::count_if(seen.values.values.begin(), seen.values.values.end(),
                                                   [](double value) { return !std::isfinite(value); }));
  row.overshoot = overshoot(seen, field);
  const White white = white_through(filter, field, promise.white, promise.white_within_bound);
  row.energy = white.change;

  if (row.non_finite > 0) fail(row, std::to_string(row.non_finite) + " values are not finite");
  if (!(row.rel_l2 <= promise.rel_l2)) fail(row, "relative L2 " + number(row.rel_l2));
  if (!(row.of_bound <= 1)) fail(row, number(row.of_bound) + " times the bound");
  if (promise.white_within_bound) {
    if (!(white.of_bound <= 1)) fail(row, "white is " + number(white.of_bound) + " times the bound off");
  } else if (!(row.energy <= promise.energy)) {
    fail(row, "white changes by " + number(row.energy));
  }
  if (promise.sure_values_only && errors.sure_share() < least_sure_share(field)) {
    fail(row, "the oracle is sure of " + number(errors.sure_share()) + " of the values only");
  }
  if (!(row.overshoot <= promise.overshoot)) fail(row, "overshoots by " + number(row.overshoot));
  const long changed = changed_values(seen, field);
  if (promise.change == StressChange::scatters && changed < static_cast<long>(field.light.size() / 8)) {
    fail(row, "only " + std::to_string(changed) + " values changed");
  }
  if (promise.change == StressChange::keeps_bits && seen.bits != seen.input_bits) fail(row, "bits changed");
  return row;
}

}  // namespace dermis::bench
