#include "lighting/highlight_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "dermis/error.hpp"
#include "opencl/linear_table.hpp"
#include "profile/quadrature.hpp"

namespace dermis {

namespace {

using std::numbers::pi;
constexpr double widest = 6;  ///< of tan a / m: e^-36 of the normals of the distribution lie beyond

double square(double x) { return x * x; }

/// Schlick 1994.
double fresnel(double reflectance, double cosine) {
  return reflectance + (1 - reflectance) * (1 - cosine) * square(square(1 - cosine));
}

/// The share that one lobe of weight 1 reflects of light at the angle theta. With half vectors of Beckmann's
/// distribution, dP = 2 t e^(-t^2) dt dphi / 2 pi for tan a = m t, and dl = 4 (l.h) dh,
///
///     rho = integral of F(v.h) max(0, 2 - cos theta / (v.h cos a)) dP
///
/// where v.h = cos a cos theta + sin a sin theta cos phi. The integrand is 0 for phi beyond some angle, to which it
/// falls steeply at grazing angles: phi = that (1 - x^4). It bends where that angle becomes pi or 0, at a = pi/4 -+
/// theta/2.
double reflected_share(double roughness, double reflectance, double cos_theta) {
  const double sin_theta = std::sqrt(1 - square(cos_theta));
  const auto ring = [&](double t) {
    const double cos_a = 1 / std::sqrt(1 + square(roughness * t));
    const double sin_a = roughness * t * cos_a;
    const double bound = cos_theta * (1 / (2 * cos_a) - cos_a);
    const double last = std::acos(std::clamp(bound / std::max(sin_a * sin_theta, 1e-300), -1.0, 1.0));
    const auto along = [&](double x) {
      const double v_h = cos_a * cos_theta + sin_a * sin_theta * std::cos(last * (1 - square(square(x))));
      if (!(v_h > 0)) return 0.0;
      return 4 * x * square(x) * fresnel(reflectance, v_h) * std::max(0.0, 2 - cos_theta / (v_h * cos_a));
    };
    return 2 * t * std::exp(-t * t) * last * panel_integral<24>(0, 1, along) / pi;
  };
  const double theta = std::acos(cos_theta);
  double sum = 0;
  double from = 0;
  const auto add = [&](double to) {
    constexpr int panels = 3;
    for (int i = 0; i < panels; ++i) {
      sum += panel_integral<16>(from + (to - from) * i / panels, from + (to - from) * (i + 1) / panels, ring);
    }
    from = to;
  };
  for (const double bend : {std::tan(pi / 4 - theta / 2) / roughness, std::tan(pi / 4 + theta / 2) / roughness}) {
    if (bend > from && bend < widest) add(bend);
  }
  add(widest);
  return sum;
}

double reflected(const ShadingOptions& options, double cosine) {
  double sum = 0;
  for (const auto& [roughness, weight] : options.lobes) {
    if (weight > 0) sum += weight * reflected_share(roughness, options.reflectance, cosine);
  }
  return sum;
}

LinearTable tabulate_lobes(const std::vector<SpecularLobe>& lobes) {
  double narrowest = 1;
  double broadest = 0.02;
  for (const SpecularLobe& lobe : lobes) {
    narrowest = std::min(narrowest, lobe.roughness);
    broadest = std::max(broadest, lobe.roughness);
  }
  const auto lobes_at = [&](int, double tangent) {
    double sum = 0;
    if (std::isinf(tangent)) return sum;
    for (const auto& [roughness, weight] : lobes) {
      sum += weight * std::exp(-square(tangent / roughness)) * square((1 + square(tangent)) / roughness);
    }
    return sum;
  };
  constexpr double first = 1e-4;  // of the narrowest lobe: its peak to 1e-8
  return tabulate_linear(lobes_at, first * narrowest, widest * broadest, log2_nodes_per_octave_of_lobes);
}

}  // namespace

HighlightTables make_highlight_tables(const ShadingOptions& options) {
  HighlightTables tables;
  tables.beckmann = append_table(tabulate_lobes(options.lobes), tables.nodes);
  for (int i = 0; i <= RHO_NODES; ++i) {
    const double share = reflected(options, square(static_cast<double>(i) / RHO_NODES));
    if (!(share < 1)) {
      throw Error(ErrorCode::usage, "lobes", "weights that reflect " + std::to_string(share) + " of some light",
                  "weights that leave something of light under every angle");
    }
    tables.reflected.push_back(static_cast<float>(share));
  }
  // c = x^2, in which the table is even.
  tables.mean_reflected =
      panel_integral<32>(0, 1, [&](double x) { return 4 * x * square(x) * reflected(options, square(x)); });
  return tables;
}

}  // namespace dermis
