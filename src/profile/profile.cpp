#include "dermis/profile.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <typeinfo>
#include <utility>

#include "dermis/error.hpp"
#include "profile/burley_curve.hpp"
#include "profile/dipole_curve.hpp"
#include "profile/exponential_curve.hpp"
#include "profile/gaussian_curve.hpp"
#include "profile/profile_content.hpp"
#include "profile/random_walk.hpp"
#include "profile/table_curve.hpp"

namespace dermis {

namespace {

using std::numbers::pi;

void require_share(double share) {
  if (!(share >= 0 && share < 1)) throw Error(ErrorCode::usage, "share", std::to_string(share), "0 <= share < 1");
}

// float32 can hold the squares of these and of their reciprocals with room to spare.
constexpr double shortest_mm = 1e-9;
constexpr double longest_mm = 1e9;

constexpr double least_per_mm = 1e-9;
constexpr double most_per_mm = 1e9;

constexpr double largest_value = 1e100;  // of a table

std::string number_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void require_lengths(const Rgb& values, const char* argument) {
  for (const double value : values) {
    if (!(value >= shortest_mm && value <= longest_mm)) {
      throw Error(ErrorCode::usage, argument, number_text(value), "1e-9..1e9 mm per channel");
    }
  }
}

void require_shares(const Rgb& values, const char* argument) {
  for (const double value : values) {
    if (!(value >= 0 && value <= 1)) throw Error(ErrorCode::usage, argument, number_text(value), "0..1 per channel");
  }
}

void require_order(double from, double to, const char* argument) {
  if (!(from <= to)) throw Error(ErrorCode::usage, argument, number_text(to), number_text(from) + " or more");
}

void require_medium(const Rgb& reduced_scattering_per_mm, const Rgb& absorption_per_mm, double eta) {
  const auto require = [](const Rgb& values, const char* argument) {
    for (const double value : values) {
      if (!(value >= least_per_mm && value <= most_per_mm)) {
        throw Error(ErrorCode::usage, argument, number_text(value), "1e-9..1e9 1/mm per channel");
      }
    }
  };
  require(reduced_scattering_per_mm, "reduced_scattering_per_mm");
  require(absorption_per_mm, "absorption_per_mm");
  if (!(eta >= 1 && eta <= 2.5)) throw Error(ErrorCode::usage, "eta", number_text(eta), "1..2.5");
}

void require_rows(const std::vector<TableRow>& rows) {
  if (rows.size() < 2) throw Error(ErrorCode::usage, "rows", std::to_string(rows.size()), "2 or more");
  Rgb largest{};
  double last_mm = -1;
  for (const TableRow& row : rows) {
    if (!(row.r_mm == 0 || (row.r_mm >= shortest_mm && row.r_mm <= longest_mm))) {
      throw Error(ErrorCode::usage, "r_mm", number_text(row.r_mm), "0 or 1e-9..1e9 mm");
    }
    if (!(row.r_mm > last_mm)) {
      throw Error(ErrorCode::usage, "r_mm", number_text(row.r_mm) + " after " + number_text(last_mm),
                  "ascending distances");
    }
    last_mm = row.r_mm;
    for (int c = 0; c < 3; ++c) {
      if (!(row.value[c] >= 0 && row.value[c] <= largest_value)) {
        throw Error(ErrorCode::usage, "value", number_text(row.value[c]), "0..1e100 per channel");
      }
      largest[c] = std::max(largest[c], row.value[c]);
    }
  }
  for (const double value : largest) {
    if (value < 1 / largest_value) {
      throw Error(ErrorCode::usage, "value", "a channel with nothing above " + number_text(value),
                  "a value of 1e-100 or more in every channel");
    }
  }
}

/// Christensen and Burley 2015, eq. 6.
double shape_factor(double albedo) { return 1.9 - albedo + 3.5 * (albedo - 0.8) * (albedo - 0.8); }

/// 1 / s(A), with the brackets of s(A) opened.
constexpr AlbedoWidth burley_width = {{1, 0, 0, 0}, {1.9 + 3.5 * 0.8 * 0.8, -1 - 2 * 3.5 * 0.8, 3.5}};

/// The mean distance of a walk over that for `walk_middle`, fitted to walk_table.
constexpr double walk_middle = 0.6;
constexpr AlbedoWidth walk_width = {{0.965 / 0.295016, -2.11 / 0.295016, 2.42 / 0.295016, -1.274 / 0.295016},
                                    {1, 0, 0}};

/// The mean free path of a Cycles radius, of Burley's profile.
Rgb burley_path(const Rgb& radius_mm) {
  return {radius_mm[0] / (4 * pi), radius_mm[1] / (4 * pi), radius_mm[2] / (4 * pi)};
}

/// The mean free path of a medium.
Rgb medium_path(const Rgb& reduced_scattering_per_mm, const Rgb& absorption_per_mm) {
  Rgb mfp_mm{};
  for (std::size_t c = 0; c < 3; ++c) mfp_mm[c] = 1 / (reduced_scattering_per_mm[c] + absorption_per_mm[c]);
  return mfp_mm;
}

using Curves = std::array<std::shared_ptr<const RadialCurve>, 3>;

/// make(c) for each channel.
template <class Make>
Curves for_each_channel(const Make& make) {
  return {make(0), make(1), make(2)};
}

Curves burley_curves(const Rgb& mfp_mm, const Rgb& albedo) {
  return for_each_channel([&](int c) { return std::make_shared<BurleyCurve>(mfp_mm[c] / shape_factor(albedo[c])); });
}

Curves walk_curves(const Rgb& mfp_mm, const Rgb& albedo) {
  return for_each_channel([&](int c) { return std::make_shared<ExponentialCurve>(walk_terms(mfp_mm[c], albedo[c])); });
}

}  // namespace

Profile::Profile(std::array<std::shared_ptr<const RadialCurve>, 3> curves, std::optional<Rgb> mfp_mm)
    : curves_(std::move(curves)), mfp_mm_(mfp_mm) {}

Profile Profile::burley(const Rgb& d_mm) {
  require_lengths(d_mm, "d_mm");
  return Profile(for_each_channel([&](int c) { return std::make_shared<BurleyCurve>(d_mm[c]); }));
}

Profile Profile::burley_mfp(const Rgb& mfp_mm, const Rgb& albedo) {
  require_lengths(mfp_mm, "mfp_mm");
  require_shares(albedo, "albedo");
  return Profile(burley_curves(mfp_mm, albedo), mfp_mm);
}

Profile Profile::burley_cycles(const Rgb& radius_mm, const Rgb& albedo) {
  require_lengths(radius_mm, "radius_mm");
  require_shares(albedo, "albedo");
  const Rgb mfp_mm = burley_path(radius_mm);
  return Profile(burley_curves(mfp_mm, albedo), mfp_mm);
}

Profile Profile::burley_cycles(const Rgb& radius_mm) {
  require_lengths(radius_mm, "radius_mm");
  const Rgb mfp_mm = burley_path(radius_mm);
  Profile profile(for_each_channel([&](int c) { return std::make_shared<BurleyCurve>(mfp_mm[c]); }), mfp_mm);
  profile.albedo_width_ = burley_width;
  return profile;
}

Profile Profile::random_walk_cycles(const Rgb& radius_mm, const Rgb& albedo) {
  require_lengths(radius_mm, "radius_mm");
  require_shares(albedo, "albedo");
  Rgb mfp_mm{};
  for (std::size_t c = 0; c < 3; ++c) mfp_mm[c] = walk_mfp(radius_mm[c], albedo[c]);
  return walk_of(mfp_mm, albedo);
}

Profile Profile::random_walk_cycles(const Rgb& radius_mm) {
  Profile profile = random_walk_cycles(radius_mm, {walk_middle, walk_middle, walk_middle});
  profile.albedo_width_ = walk_width;
  return profile;
}

Profile Profile::random_walk_mfp(const Rgb& mfp_mm, const Rgb& albedo) {
  require_lengths(mfp_mm, "mfp_mm");
  require_shares(albedo, "albedo");
  return walk_of(mfp_mm, albedo);
}

Profile Profile::walk_of(const Rgb& mfp_mm, const Rgb& albedo) {
  Profile profile(walk_curves(mfp_mm, albedo), mfp_mm);
  profile.scattering_albedo_.emplace();
  for (std::size_t c = 0; c < 3; ++c) (*profile.scattering_albedo_)[c] = single_scattering_albedo(albedo[c]);
  return profile;
}

Profile Profile::projected() const {
  Profile profile = *this;
  profile.is_projected_ = true;
  return profile;
}

Profile Profile::gaussians(const std::vector<GaussianTerm>& terms) {
  Rgb total{};
  for (const GaussianTerm& term : terms) {
    if (!(term.variance_mm2 >= shortest_mm * shortest_mm && term.variance_mm2 <= longest_mm * longest_mm)) {
      throw Error(ErrorCode::usage, "variance_mm2", number_text(term.variance_mm2), "1e-18..1e18 mm^2");
    }
    for (int c = 0; c < 3; ++c) {
      if (!(term.weight[c] >= 0 && std::isfinite(term.weight[c]))) {
        throw Error(ErrorCode::usage, "weight", number_text(term.weight[c]), "0 or more per channel");
      }
      total[c] += term.weight[c];
    }
  }
  return Profile(for_each_channel([&](int c) {
    if (!(total[c] > 0 && std::isfinite(total[c]))) {
      throw Error(ErrorCode::usage, "weight", "a sum of " + number_text(total[c]),
                  "a positive, finite sum in every channel");
    }
    std::vector<GaussianCurve::Term> of_channel;
    for (const GaussianTerm& term : terms) {
      if (term.weight[c] > 0) of_channel.push_back({term.weight[c] / total[c], term.variance_mm2});
    }
    return std::make_shared<GaussianCurve>(std::move(of_channel));
  }));
}

Profile Profile::artist(const Rgb& near_mm, const Rgb& far_mm, double near_weight) {
  require_lengths(near_mm, "near_mm");
  require_lengths(far_mm, "far_mm");
  if (!(near_weight >= 0 && near_weight <= 1)) {
    throw Error(ErrorCode::usage, "near_weight", number_text(near_weight), "0..1");
  }
  return Profile(for_each_channel([&](int c) {
    std::vector<GaussianCurve::Term> pair;
    if (near_weight > 0) pair.push_back({near_weight, near_mm[c] * near_mm[c]});
    if (near_weight < 1) pair.push_back({1 - near_weight, far_mm[c] * far_mm[c]});
    return std::make_shared<GaussianCurve>(std::move(pair));
  }));
}

Profile Profile::dipole(const Rgb& reduced_scattering_per_mm, const Rgb& absorption_per_mm, double eta) {
  require_medium(reduced_scattering_per_mm, absorption_per_mm, eta);
  return Profile(for_each_channel([&](int c) {
                   return std::make_shared<DipoleCurve>(
                       DipoleCurve::classical({reduced_scattering_per_mm[c], absorption_per_mm[c], eta}));
                 }),
                 medium_path(reduced_scattering_per_mm, absorption_per_mm));
}

Profile Profile::better_dipole(const Rgb& reduced_scattering_per_mm, const Rgb& absorption_per_mm, double eta) {
  require_medium(reduced_scattering_per_mm, absorption_per_mm, eta);
  return Profile(for_each_channel([&](int c) {
                   return std::make_shared<DipoleCurve>(
                       DipoleCurve::better({reduced_scattering_per_mm[c], absorption_per_mm[c], eta}));
                 }),
                 medium_path(reduced_scattering_per_mm, absorption_per_mm));
}

Profile Profile::tabulated(const std::vector<TableRow>& rows) {
  require_rows(rows);
  std::vector<double> radii(rows.size());
  std::transform(rows.begin(), rows.end(), radii.begin(), [](const TableRow& row) { return row.r_mm; });
  return Profile(for_each_channel([&](int c) {
    std::vector<double> values(rows.size());
    std::transform(rows.begin(), rows.end(), values.begin(), [&](const TableRow& row) { return row.value[c]; });
    return std::make_shared<TableCurve>(radii, values);
  }));
}

bool Profile::operator==(const Profile& other) const {
  const auto same = [](const auto& a, const auto& b) { return a == b || *a == *b; };
  return albedo_width_ == other.albedo_width_ && is_projected_ == other.is_projected_ && mfp_mm_ == other.mfp_mm_ &&
         scattering_albedo_ == other.scattering_albedo_ &&
         std::equal(curves_.begin(), curves_.end(), other.curves_.begin(), same);
}

ProfileContent content_of(const Profile& profile) {
  ProfileContent content;
  for (std::size_t c = 0; c < 3; ++c) {
    const RadialCurve& curve = *profile.curves_[c];
    content.kinds[c] = typeid(curve).name();
    content.numbers[c] = curve.numbers();
  }
  if (const auto& width = profile.albedo_width_) {
    content.albedo_width.assign(width->numerator.begin(), width->numerator.end());
    content.albedo_width.insert(content.albedo_width.end(), width->denominator.begin(), width->denominator.end());
  }
  content.is_projected = profile.is_projected_;
  return content;
}

double Profile::radial(int channel, double r_mm) const { return curve(channel).radial(r_mm); }

double Profile::marginal(int channel, double x_mm) const { return curve(channel).marginal(std::abs(x_mm)); }

double Profile::edge(int channel, double x_mm) const { return edge_tail(channel, -x_mm); }

double Profile::edge_tail(int channel, double x_mm) const {
  if (x_mm < 0) return 1 - edge_tail(channel, -x_mm);
  return x_mm == 0 ? 0.5 : curve(channel).edge_tail(x_mm);
}

double Profile::strip(int channel, double from_mm, double to_mm) const {
  require_order(from_mm, to_mm, "to_mm");
  return curve(channel).strip(from_mm, to_mm);
}

double Profile::rectangle(int channel, double x0_mm, double x1_mm, double y0_mm, double y1_mm) const {
  require_order(x0_mm, x1_mm, "x1_mm");
  require_order(y0_mm, y1_mm, "y1_mm");
  return curve(channel).rectangle(x0_mm, x1_mm, y0_mm, y1_mm);
}

double Profile::spectrum(int channel, double omega_per_mm) const { return curve(channel).spectrum(omega_per_mm); }

double Profile::cdf(int channel, double r_mm) const { return curve(channel).disc(r_mm); }

double Profile::transmittance(int channel, double thickness_mm) const {
  if (!(thickness_mm >= 0)) throw Error(ErrorCode::usage, "thickness_mm", number_text(thickness_mm), "0 mm or more");
  if (thickness_mm == 0) return 1;
  return thickness_mm < curve(channel).reach() ? curve(channel).disc_tail(thickness_mm) : 0;
}

double Profile::radius(int channel, double share) const {
  require_share(share);
  return curve(channel).radius(share);
}

double Profile::half_width(int channel, double share) const {
  require_share(share);
  return curve(channel).half_width(share);
}

std::optional<double> Profile::mfp_mm(int channel) const {
  if (!mfp_mm_) return std::nullopt;
  return (*mfp_mm_)[static_cast<std::size_t>(channel)];
}

std::optional<double> Profile::scattering_albedo(int channel) const {
  if (!scattering_albedo_) return std::nullopt;
  return (*scattering_albedo_)[static_cast<std::size_t>(channel)];
}

int Profile::widest_channel() const {
  constexpr double share = 0.95;
  int widest = 0;
  for (int c = 1; c < 3; ++c) {
    if (half_width(c, share) > half_width(widest, share)) widest = c;
  }
  return widest;
}

double Profile::width_at(double albedo) const {
  if (!albedo_width_) return 1;
  const auto& [over, under] = *albedo_width_;
  const double a = std::clamp(albedo, 0.0, 1.0);
  return (over[0] + a * (over[1] + a * (over[2] + a * over[3]))) / (under[0] + a * (under[1] + a * under[2]));
}

}  // namespace dermis
