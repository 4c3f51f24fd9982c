#include "files/camera_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "dermis/error.hpp"
#include "files/input_file.hpp"

namespace dermis::program {
namespace {

using nlohmann::json;

constexpr const char* forms =
    "{fov_deg}, {focal_px}, {focal_mm, sensor_width_mm}, {px_per_unit} or {worldToCamera, worldToNDC}";

class CameraFile {
 public:
  CameraFile(std::string name, json root) : name_(std::move(name)), root_(std::move(root)) {}

  void read(exr::CameraHint& camera) const {
    if (is({"fov_deg"})) {
      camera.fov_deg = number("fov_deg", 180, "degrees, above 0 and below 180");
    } else if (is({"focal_px"})) {
      camera.focal_px = length("focal_px");
    } else if (is({"px_per_unit"})) {
      camera.orthographic_px_per_unit = length("px_per_unit");
    } else if (is({"focal_mm", "sensor_width_mm"})) {
      camera.fov_deg = 360 / std::numbers::pi * std::atan(length("sensor_width_mm") / (2 * length("focal_mm")));
    } else if (is({"worldToCamera", "worldToNDC"})) {
      camera.matrices = exr::CameraMatrices{matrix("worldToCamera"), matrix("worldToNDC")};
    } else {
      std::vector<std::string> keys;
      if (root_.is_object())
        for (const auto& [key, value] : root_.items()) keys.push_back(key);
      fail("", root_.is_object() ? fmt::format("the keys {}", printed(json(keys))) : printed(root_), forms);
    }
    camera.name = name_;
  }

 private:
  [[noreturn]] void fail(std::string_view key, std::string_view seen, std::string_view wanted) const {
    throw Error(ErrorCode::input_unsupported, fmt::format("{}{}{}", name_, key.empty() ? "" : ": ", key), seen, wanted);
  }

  /// True if these are the keys, and no others.
  bool is(const std::vector<const char*>& keys) const {
    return root_.is_object() && root_.size() == keys.size() &&
           std::all_of(keys.begin(), keys.end(), [this](const char* key) { return root_.contains(key); });
  }

  double number(const char* key, double below, std::string_view wanted) const {
    const double value = root_[key].is_number() ? root_[key].get<double>() : NAN;
    if (!(value > 0 && value < below)) fail(key, printed(root_[key]), wanted);
    return value;
  }

  double length(const char* key) const { return number(key, HUGE_VAL, "a finite number > 0"); }

  std::array<double, 16> matrix(const char* key) const {
    constexpr std::string_view wanted = "16 finite numbers, row by row";
    const json& values = root_[key];
    if (!values.is_array() || values.size() != 16) fail(key, printed(values), wanted);
    std::array<double, 16> result{};
    for (std::size_t i = 0; i < 16; ++i) {
      result[i] = values[i].is_number() ? values[i].get<double>() : NAN;
      if (!std::isfinite(result[i])) fail(key, printed(values), wanted);
    }
    return result;
  }

  std::string name_;
  json root_;
};

}  // namespace

void read_camera_file(std::string_view argument, const std::string& path, exr::CameraHint& camera) {
  const json root = read_json(argument, path, "a JSON file with a camera");
  CameraFile(fmt::format("{} {}", argument, path), root).read(camera);
}

}  // namespace dermis::program
