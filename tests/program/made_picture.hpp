// Small G-buffers to run the program on, and a look at what came out.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dermis/exr.hpp"

/// A file that `dermis scene` made, and what it takes to filter it.
struct MadeScene {
  std::string path;
  std::vector<std::string> camera;  // arguments that give camera and scale
};

MadeScene make_scene(const std::string& path, const std::string& name, int width, int height, double px_per_mm,
                     bool orthographic = false);

/// `dermis filter` of a scene into `output` with more arguments.
std::vector<std::string> filter_arguments(const MadeScene& scene, const std::string& output,
                                          const std::vector<std::string>& more);

/// A copy of a picture, changed.
class PictureCopy {
 public:
  explicit PictureCopy(const std::string& path);

  /// Leaves out the channels whose names start with `prefix`.
  PictureCopy& without(const std::string& prefix);
  /// The channels of "ViewLayer." again under another prefix.
  PictureCopy& with_layer(const std::string& prefix);
  PictureCopy& with(const std::string& channel, const std::vector<float>& values);
  PictureCopy& attribute(const std::string& name, const std::string& value);
  void write(const std::string& path) const;

 private:
  struct Plane {
    std::string name;
    std::vector<float> values;
  };

  dermis::exr::Window data_;
  dermis::exr::Window display_;
  std::vector<Plane> planes_;
  std::vector<std::pair<std::string, std::string>> attributes_;
};

/// The bits of every value of a channel, in the format of the file.
std::vector<std::vector<std::byte>> bits_of(const dermis::exr::Picture& picture, const std::string& channel);

/// True if two files have the same channels with the same bits.
bool is_identical(const std::string& a, const std::string& b);

/// The relative L2 distance of file `a` from file `b` over channels prefix.R, .G and .B.
double relative_l2(const std::string& a, const std::string& b, const std::string& prefix);
