// The weights of the taps of a level as functions of the surface under them.
#pragma once

#include <array>
#include <vector>

#include "dermis/profile.hpp"
#include "taps/designed_taps.hpp"
#include "taps/tables/radial_table.hpp"

namespace dermis {

/// f of one term, by distance.
struct TermCurves {
  bool normalised;
  std::array<double, 3> sum;
  RadialTable falloff;  ///< f(r), 1/mm
  RadialTable centre;   ///< integral of f over |x| < h, tabulated over sqrt(h) for resolution near 0
};

/// The tables of all terms of one radius have the same first exponents.
TermCurves make_term_curves(const Profile& profile, const ModelTerm& model, double radius_mm);

/// The weights that were fitted for a plane, carried over to other surfaces: a tap of a normalised term stands for a
/// length of surface and weighs that times f at its true distance. In a term that corrects another, f says little about
/// the weight where it changes its sign: there the tap has no more length than is sensible, and the rest of its weight
/// is a share of that in the first term, which falls with distance too.
class SurfaceWeights {
 public:
  /// Keeps references.
  SurfaceWeights(const SizedTaps& taps, const std::vector<TermCurves>& terms, double px_per_mm);

  std::size_t rows() const { return taps_.placed.offsets_px.size() + 1; }
  const std::vector<TermCurves>& terms() const { return terms_; }
  double px_per_mm() const { return px_per_mm_; }
  const std::vector<double>& offsets_px() const { return taps_.placed.offsets_px; }

  /// The functions of a row, three channels of one term after the other.
  std::size_t functions() const { return 3 * terms_.size(); }

  /// The weight on the plane, as it was fitted, of the centre (row 0) or of a pair.
  double fitted(std::size_t row, std::size_t term, int channel) const;

  /// The weights of a row, by function, on a surface where lengths and distances are longer than on the plane by these
  /// factors.
  void on_surface(std::size_t row, double length, double distance, double* weights) const;

  /// The same where both factors are 1.
  const double* on_plane(std::size_t row) const { return &on_plane_[row * functions()]; }

 private:
  struct Follower {
    double length_mm = 0;  ///< of a centre: its gain
    double share = 0;      ///< of the weight in the first term
  };
  double length_mm(std::size_t row) const;
  Follower follower(std::size_t row, std::size_t term, int channel, const RadialPlace& its_place) const;
  double distance_mm(std::size_t row) const;
  RadialPlace place(std::size_t row, double length, double distance) const;

  const SizedTaps& taps_;
  const std::vector<TermCurves>& terms_;
  double px_per_mm_;
  std::vector<Follower> followers_;  ///< by row and function
  std::vector<double> on_plane_;     ///< by row and function
};

}  // namespace dermis
