// One channel of a dipole: two point sources, one below the surface and its mirror image above.
#pragma once

#include "profile/smooth_curve.hpp"

namespace dermis {

/// The light that leaves a half-space that is lit at a point, scaled to unit integral. With d_r and d_v the distances
/// to the two sources and s the transport coefficient, it is made of
///
///     flux     z_r (1 + s d_r) e^(-s d_r) / d_r^3 + z_v (1 + s d_v) e^(-s d_v) / d_v^3
///     fluence  e^(-s d_r) / d_r - e^(-s d_v) / d_v
///
/// Both are computed without cancellation, and so are their integrals over discs.
class DipoleCurve final : public SmoothCurve {
 public:
  struct Medium {
    double reduced_scattering;  ///< 1/mm
    double absorption;          ///< 1/mm
    double eta;                 ///< refractive index
  };

  struct Sources {
    double s;               ///< 1/mm
    double real_depth;      ///< z_r, mm
    double virtual_height;  ///< z_v, mm, > z_r
    double flux;            ///< weight; only its ratio to the other matters
    double fluence;         ///< weight, 1/mm
  };

  /// Jensen et al. 2001, section 2.1: flux only.
  static Sources classical(const Medium& medium);
  /// d'Eon 2012: Grosjean's diffusion coefficient; fluence and flux.
  static Sources better(const Medium& medium);

  explicit DipoleCurve(const Sources& sources);

  double radial(double r) const override;
  double disc(double r) const override;
  double disc_tail(double r) const override;
  double spectrum(double omega) const override;
  double scale() const override { return 1 / s_; }
  double reach() const override { return 740 / s_; }

 private:
  std::vector<double> numbers() const override { return {s_, z_r_, z_v_, flux_, fluence_}; }

  double s_;
  double z_r_;
  double z_v_;
  double flux_;
  double fluence_;
};

}  // namespace dermis
