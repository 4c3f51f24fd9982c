#include "python/plan_arguments.hpp"

#include "dermis/dermis.hpp"
#include "python/arrays.hpp"

namespace dermis::python {

namespace {

/// A setting's value as text.
std::string text_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "on" : "off";
  if (value.is_none()) return "none";
  return py::str(value);
}

}  // namespace

Profile profile_of(const py::handle& profile) {
  if (py::isinstance<py::str>(profile)) return parse_profile("profile", profile.cast<std::string>());
  if (py::isinstance<Profile>(profile)) return profile.cast<Profile>();
  throw Error(ErrorCode::usage, "profile", "something else", "a Profile, or one as text");
}

Options options_of(const py::dict& settings) {
  Options options;
  for (const auto& [name, value] : settings) set(options, py::str(name).cast<std::string>(), text_of(value));
  return options;
}

std::vector<Material> materials_of(const py::object& materials, const std::map<int, double>& pixel_mm) {
  std::vector<Material> result;
  const auto add = [&](int id, const py::handle& profile) {
    const auto size = pixel_mm.find(id);
    result.push_back({.id = id, .profile = profile_of(profile), .pixel_mm = size == pixel_mm.end() ? 0 : size->second});
  };
  if (py::isinstance<py::dict>(materials)) {
    for (const auto& [id, profile] : materials.cast<py::dict>()) add(id.cast<int>(), profile);
  } else {
    add(0, materials);
  }
  return result;
}

FrameDescription description_of(const std::vector<std::string>& images) {
  Frame frame;
  static const char there = 0;
  for (const std::string& name : images) frame.*slot_of(name).image = {.host = &there};
  return FrameDescription::of(frame);
}

}  // namespace dermis::python
