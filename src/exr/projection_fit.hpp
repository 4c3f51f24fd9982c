/// The projection that saw some points, and how well they determine it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exr/projection.hpp"
#include "exr/seen_points.hpp"

namespace dermis::exr {

/// What is fitted, and what a file's depths are taken for.
struct FitModel {
  bool is_parallel = false;
  enum class Depth { unused, along_axis, distance } depth = Depth::unused;
  std::vector<double> depths = {};  ///< of each point, in units, unless unused
};

struct Fit {
  Projection projection;
  double noise_px = 0;     ///< standard deviation on the picture beyond what the formats round, along an axis
  double off_px = 0;       ///< median of the distances on the picture
  double score = 0;        ///< mean of score_of: of two fits the one with the lower score shows more points
  double relief = 0;       ///< how far the points that count reach across their plane, over how far along it
  double relief_px = 0;    ///< the same as seen from the side
  double share = 0;        ///< of the points that the fit is made of, 0..1; the others are false
  double scale_doubt = 0;  ///< relative standard error of the focal length (parallel: pixels per unit), or of depth at
                           ///< the picture's edge for want of the centre, if that is larger
  double foreshortening = 0;        ///< of the scene: closeness times half its extent along the view axis
  double foreshortening_doubt = 0;  ///< its standard error
  double residual_units = 0;        ///< the largest distance of a point of the fit from where it is seen, scene units
};

/// Least squares over all points, each weighted by what its format rounds and by Tukey's biweight, whose width follows
/// the noise that the points show: false points drop out. Standard errors are those of errors that depend on each other
/// within a patch of the picture, as blocks of a lossy file and steps of halves do (the sandwich of White 1980, by
/// clusters). None if there are too few points to tell.
std::optional<Fit> fit_projection(const SeenPoints& points, const Projection& start, const FitModel& model);

}  // namespace dermis::exr
