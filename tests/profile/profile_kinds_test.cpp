// Each kind of profile agrees with its formula, written down again from the paper.
#include <cmath>
#include <numbers>

#include "dermis/profile.hpp"
#include "support/adaptive_quadrature.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Profile;
using dermis::Rgb;
using dermis::TableRow;

namespace {

using std::numbers::pi;

double gaussian(double x, double deviation) {
  return std::exp(-x * x / (2 * deviation * deviation)) / (std::sqrt(2 * pi) * deviation);
}

/// Returns the share of light from inside that a surface of relative index eta reflects, at the angle with this cosine.
double fresnel(double cosine, double eta) {
  const double sine = eta * std::sqrt(1 - cosine * cosine);
  if (sine >= 1) return 1;
  const double outside = std::sqrt(1 - sine * sine);
  const double s = (eta * cosine - outside) / (eta * cosine + outside);
  const double p = (eta * outside - cosine) / (eta * outside + cosine);
  return (s * s + p * p) / 2;
}

}  // namespace

TEST_CASE("Burley's width by mean free path, by Cycles radius and by albedo", "[profile]") {
  const double albedo = 0.55;
  const double s = 1.9 - albedo + 3.5 * (albedo - 0.8) * (albedo - 0.8);
  const Profile constant = Profile::burley_cycles({9, 9, 9}, {albedo, albedo, albedo});
  const double d = 9 / (4 * pi) / s;
  CHECK(constant.radial(0, 1.0) == Approx(Profile::burley({d, d, d}).radial(0, 1.0)));
  CHECK_FALSE(constant.width_follows_albedo());
  CHECK(constant.width_at(albedo) == 1);

  const Profile per_pixel = Profile::burley_cycles({9, 9, 9});
  CHECK(per_pixel.width_follows_albedo());
  const double k = per_pixel.width_at(albedo);
  CHECK(per_pixel.radial(0, 1.0 / k) / (k * k) == Approx(constant.radial(0, 1.0)));

  const Profile by_path = Profile::burley_mfp({3, 2, 1}, {albedo, 0.1, 1});
  CHECK_FALSE(by_path.width_follows_albedo());
  CHECK(by_path.radial(0, 1.0) == Approx(Profile::burley({3 / s, 1, 1}).radial(0, 1.0)));
  CHECK(by_path.radial(2, 1.0) == Approx(Profile::burley({1, 1, 1 / 1.04}).radial(2, 1.0)));  // s(1) = 1.04
}

TEST_CASE("profiles of a medium know its mean free path", "[profile]") {
  const Rgb ones = {1, 1, 1};
  CHECK(Profile::burley_mfp({3, 2, 1}, {0.5, 0.1, 1}).mfp_mm(1) == 2);
  CHECK(*Profile::burley_cycles({3, 2, 1}, ones).mfp_mm(2) == Approx(1 / (4 * pi)));
  CHECK(*Profile::burley_cycles({3, 2, 1}).mfp_mm(0) == Approx(3 / (4 * pi)));
  CHECK(*Profile::dipole({1, 2, 3}, {.5, 2, 1}).mfp_mm(1) == Approx(.25));
  CHECK(*Profile::better_dipole({1, 2, 3}, {.5, 2, 1}).mfp_mm(2) == Approx(.25));
  CHECK(Profile::random_walk_mfp({3, 2, 1}, {0.5, 0.1, 1}).mfp_mm(0) == 3);
  // The albedo of a scattering is 0 there.
  CHECK(*Profile::random_walk_cycles({3, 2, 1}, {0, 0.1, 1}).mfp_mm(0) == Approx(3 * std::sqrt(3.0)));
  CHECK_FALSE(Profile::burley(ones).mfp_mm(0));
  CHECK_FALSE(Profile::artist(ones, ones, 0.5).mfp_mm(0));
  // The same light, and not all of the same values.
  CHECK_FALSE(Profile::burley_mfp({1.04, 1.04, 1.04}, ones) == Profile::burley(ones));
}

TEST_CASE("Burley's profile and its spectrum", "[profile]") {
  const double d = 0.7;
  const Profile profile = Profile::burley({d, d, d});
  for (const double r : {1e-3, 0.1, 1.0, 30.0}) {
    CHECK(profile.radial(1, r) == Approx((std::exp(-r / d) + std::exp(-r / 3 / d)) / (8 * pi * d * r)).epsilon(1e-14));
    const double w = 1 / r;
    CHECK(profile.spectrum(1, w) ==
          Approx(0.25 / std::sqrt(1 + w * w * d * d) + 0.75 / std::sqrt(1 + 9 * w * w * d * d)).epsilon(1e-14));
  }
}

TEST_CASE("the artist's profile has the marginal of two Gaussians", "[profile]") {
  const Rgb near_mm = {.25, .08, .02};
  const Rgb far_mm = {1, .3, .05};
  const double w = .6;
  for (const Profile& profile : {Profile::artist(near_mm, far_mm, w), dermis::preset("artist-production").profile}) {
    for (int c = 0; c < 3; ++c) {
      for (const double x : {0.01, 0.2, 2.0}) {
        CHECK(profile.marginal(c, x) ==
              Approx(w * gaussian(x, near_mm[c]) + (1 - w) * gaussian(x, far_mm[c])).epsilon(1e-12));
      }
    }
  }
  CHECK(Profile::artist(near_mm, far_mm, 0).marginal(0, 0.5) == Approx(gaussian(0.5, 1)));
  CHECK(Profile::artist(near_mm, far_mm, 1).marginal(0, 0.5) == Approx(gaussian(0.5, 0.25)));
}

TEST_CASE("the dipole is Jensen's", "[profile]") {
  // This is eq. 4 and section 2.1 with skin1, red. Ratios do not depend on the scale to a unit integral.
  const double scattering = .74;
  const double absorption = .032;
  const double eta = 1.3;
  const double extinction = scattering + absorption;
  const double s = std::sqrt(3 * absorption * extinction);
  const double reflected = -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta;
  const double z_r = 1 / extinction;
  const double z_v = z_r * (1 + 4.0 / 3 * (1 + reflected) / (1 - reflected));
  const auto formula = [=](double r) {
    const double d_r = std::hypot(r, z_r);
    const double d_v = std::hypot(r, z_v);
    return z_r * (s * d_r + 1) * std::exp(-s * d_r) / std::pow(d_r, 3) +
           z_v * (s * d_v + 1) * std::exp(-s * d_v) / std::pow(d_v, 3);
  };
  const double all = adaptive_integral([&](double r) { return 2 * pi * r * formula(r); }, 0, 300);
  const Profile profile = Profile::dipole({scattering, 1, 1}, {absorption, 1, 1}, eta);
  for (const double r : {0.0, 0.3, 3.0, 60.0}) {
    CHECK(profile.radial(0, r) == Approx(formula(r) / all).epsilon(1e-9));
    CHECK(dermis::preset("dipole-skin1").profile.radial(0, r) == Approx(formula(r) / all).epsilon(1e-9));
  }
}

TEST_CASE("the better dipole is d'Eon's", "[profile]") {
  const double scattering = 2.19;
  const double absorption = .05;
  const double eta = 1.5;
  const double extinction = scattering + absorption;
  const double diffusion = (2 * absorption + scattering) / (3 * extinction * extinction);
  const double s = std::sqrt(absorption / diffusion);
  const double two_c1 = 2 * adaptive_integral([&](double m) { return fresnel(m, eta) * m; }, 0, 1, 1e-10);
  const double three_c2 = 3 * adaptive_integral([&](double m) { return fresnel(m, eta) * m * m; }, 0, 1, 1e-10);
  // These are the paper's polynomials for the same integrals.
  CHECK(two_c1 ==
        Approx(-9.23372 + 22.2272 * 1.5 - 20.9292 * 2.25 + 10.2291 * 3.375 - 2.54396 * 5.0625 + 0.254913 * 7.59375)
            .epsilon(1e-3));
  const double z_r = 1 / extinction;
  const double z_b = 2 * diffusion * (1 + three_c2) / (1 - two_c1);
  const double z_v = z_r + 2 * z_b;
  const auto formula = [=](double r) {
    const double d_r = std::hypot(r, z_r);
    const double d_v = std::hypot(r, z_v);
    const double fluence = (std::exp(-s * d_r) / d_r - std::exp(-s * d_v) / d_v) / (4 * pi * diffusion);
    const double flux = (z_r * (1 + s * d_r) * std::exp(-s * d_r) / std::pow(d_r, 3) +
                         z_v * (1 + s * d_v) * std::exp(-s * d_v) / std::pow(d_v, 3)) /
                        (4 * pi);
    return (1 - two_c1) / 4 * fluence + (1 - three_c2) / 2 * flux;
  };
  const double all = adaptive_integral([&](double r) { return 2 * pi * r * formula(r); }, 0, 200);
  const Profile profile = Profile::better_dipole({scattering, 1, 1}, {absorption, 1, 1}, eta);
  const Profile classical = Profile::dipole({scattering, 1, 1}, {absorption, 1, 1}, eta);
  for (const double r : {0.0, 0.3, 3.0, 30.0}) {
    CHECK(profile.radial(0, r) == Approx(formula(r) / all).epsilon(1e-8));
    CHECK(profile.radial(0, r) != Approx(classical.radial(0, r)).epsilon(1e-3));
  }
}

TEST_CASE("a table keeps its values, does not overshoot and is 0 beyond", "[profile]") {
  const std::vector<TableRow> rows = {
      {.5, {4, 0, 1e-8}}, {1, {4, 2, 0}}, {1.25, {1, 5, 0}}, {3, {0.9, 5, 0}}, {3.5, {0, 1, 1e-8}}};
  const Profile profile = Profile::tabulated(rows);
  for (int c = 0; c < 3; ++c) {
    // The scale is that of the first row that is not 0.
    const TableRow& known = c == 1 ? rows[1] : rows[0];
    const double scale = profile.radial(c, known.r_mm) / known.value[c];
    for (const TableRow& row : rows) {
      CHECK(profile.radial(c, row.r_mm) == Approx(scale * row.value[c]).epsilon(1e-13).margin(1e-16 * scale));
    }
    CHECK(profile.radial(c, 0.2) == profile.radial(c, 0.5));
    CHECK(profile.radial(c, 3.5000001) == 0);
    CHECK(profile.cdf(c, 3.5) == 1);
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
      const auto [low, high] = std::minmax({scale * rows[i].value[c], scale * rows[i + 1].value[c]});
      for (double t = 0; t <= 1; t += 0.05) {
        const double value = profile.radial(c, rows[i].r_mm + t * (rows[i + 1].r_mm - rows[i].r_mm));
        CHECK(value >= low - 1e-14 * scale * 5);
        CHECK(value <= high + 1e-14 * scale * 5);
      }
    }
  }
}

TEST_CASE("lines that touch a short steep segment of a table are summed exactly", "[profile]") {
  // Over the step the angle t in r = x cosh t runs to 0.1, and R is a polynomial of degree 6 in it.
  constexpr double step = 0.02;
  const Profile profile = Profile::tabulated({{0, {1, 1, 1}}, {4 - step, {1, 1, 1}}, {4, {0, 0, 0}}, {5, {0, 0, 0}}});
  for (const double x : {4 - step, 4 - step / 2, 4 - step / 10}) {
    CAPTURE(x);
    const double beyond = adaptive_integral([&](double t) { return profile.marginal(0, t); }, x, 4, 1e-13);
    CHECK(profile.edge_tail(0, x) == Approx(beyond).epsilon(1e-11));
    const double sum = 2 * adaptive_integral([&](double y) { return profile.radial(0, std::hypot(x, y)); }, 0,
                                             std::sqrt(4 * 4 - x * x), 1e-13);
    CHECK(profile.marginal(0, x) == Approx(sum).epsilon(1e-11));
  }
}

TEST_CASE("the table of a smooth profile comes near to it", "[profile]") {
  const Profile smooth = Profile::gaussians({{1.0, {1, 1, 1}}});
  std::vector<TableRow> rows;
  for (int i = 0; i <= 400; ++i) {
    const double r = i * 0.02;
    rows.push_back({r, {7 * smooth.radial(0, r), smooth.radial(1, r), smooth.radial(2, r)}});
  }
  const Profile table = Profile::tabulated(rows);
  // Fritsch and Carlson's slopes are of second order: rows that are h apart make an error of about h^2 R''.
  for (const double x : {0.0, 0.5, 1.5, 3.0}) {
    CHECK(table.radial(0, x) == Approx(smooth.radial(0, x)).epsilon(1e-3));
    CHECK(table.marginal(0, x) == Approx(smooth.marginal(0, x)).epsilon(1e-3));
    CHECK(table.edge_tail(0, x) == Approx(smooth.edge_tail(0, x)).epsilon(1e-3));
    CHECK(table.spectrum(0, x) == Approx(smooth.spectrum(0, x)).epsilon(1e-3));
  }
}

TEST_CASE("all of Jensen's materials are presets of their own", "[profile]") {
  for (const char* name : {"apple", "chicken1", "chicken2", "cream", "ketchup", "marble", "potato", "skim-milk",
                           "skin1", "skin2", "spectralon", "whole-milk"}) {
    CHECK(dermis::preset(std::string("dipole-") + name).source.find("Jensen") != std::string::npos);
  }
  for (std::size_t i = 1; i < dermis::presets().size(); ++i) {
    CHECK(dermis::presets()[i - 1].name < dermis::presets()[i].name);
  }
}
