// Times and errors of cases on one picture.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/exr.hpp"
#include "measure/picture_cases.hpp"

namespace dermis::bench {

/// The frame that everything is measured on, in memory.
struct Subject {
  std::string name;
  int width = 0;
  int height = 0;
  Camera camera;
  double mm_per_unit = 1;
  std::vector<float> light, depth, ids;
  std::vector<Material> materials;
  std::vector<std::string> material_names;

  /// Views of the images and of a place for the output.
  Frame frame(std::vector<float>& scattered) const;
};

/// Reads a Cycles picture with position and depth. `names` are the presets of the ids in `ids`.
Subject load_subject(const std::filesystem::path& path, double mm_per_unit, const std::vector<int>& ids,
                     const std::vector<std::string>& names);

struct PictureMeasurement {
  PictureRow exact;
  PictureRow rule_2012;  ///< of which only loads and errors are known: the oracle has it
  std::vector<PictureRow> rows;
  double copy_ms = 0;
  std::vector<long> pixels;  ///< per material
  long edge_pixels = 0;      ///< of any material, near an edge
};

/// Runs the exact method once, then every case in turn, `rounds` times after two that do not count.
/// `report` is told what is going on.
PictureMeasurement measure_picture(const Device& device, const Subject& subject, const std::vector<PictureCase>& cases,
                                   int rounds, const std::function<void(const std::string&)>& report);

}  // namespace dermis::bench
