#include "report/role_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "exr/message_text.hpp"

namespace dermis::program {
namespace {

using nlohmann::json;

/// Names that differ after the last dot only, or after that of a file: prefix.{R,G,B}, file.exr:{R,G,B}.
std::string text_of_group(const std::vector<std::string>& names) {
  const std::size_t last = names.front().find_last_of(".:");
  const std::size_t prefix = last == std::string::npos ? 0 : last + 1;
  std::vector<std::string> ends;
  for (const std::string& name : names) {
    if (name.compare(0, prefix, names.front(), 0, prefix) != 0) return fmt::format("{}", fmt::join(names, ","));
    ends.push_back(name.substr(prefix));
  }
  if (names.size() == 1 || prefix == 0) return fmt::format("{}", fmt::join(names, ","));
  return fmt::format("{}{{{}}}", names.front().substr(0, prefix), fmt::join(ends, ","));
}

bool is_perspective(const Camera& camera) { return camera.projection == Camera::Projection::perspective; }

}  // namespace

std::string text_of(const exr::ChannelSum& channels) {
  if (channels.empty()) return "missing";
  std::vector<std::string> groups;
  for (const auto& group : channels) groups.push_back(exr::escaped(text_of_group(group)));
  return fmt::format("{}", fmt::join(groups, " + "));
}

std::string text_of(const exr::FoundCamera& found) {
  const Camera& camera = found.camera;
  const std::string kind =
      is_perspective(camera) ? fmt::format("perspective, focal length {:.6g} x {:.6g} px, centre ({:.6g}, {:.6g})",
                                           camera.scale_x, camera.scale_y, camera.center_x, camera.center_y)
                             : fmt::format("orthographic, {:.6g} x {:.6g} px per unit", camera.scale_x, camera.scale_y);
  const std::string residual =
      found.doubt > 0 ? fmt::format(", off by {:.2g} units at most", found.residual_units) : "";
  const std::string depth =
      found.depth_type == exr::DepthType{} ? "" : fmt::format(", depth is {}", exr::text_of(found.depth_type));
  const std::string axis = found.axis && found.source != "position" ? ", depth is that of the positions" : "";
  return fmt::format("{}, from {}{}{}", kind, exr::escaped(found.source), residual, axis.empty() ? depth : axis);
}

json json_of(const exr::Roles& roles) {
  json result = {{"layer", roles.layer}, {"view", roles.view}, {"renderer", roles.renderer}};
  for (const exr::RoleInfo& info : exr::role_table) {
    json& entry = result[std::string(info.name)];
    if (roles.has(info.role)) entry = roles[info.role];
  }
  return result;
}

json json_of(const exr::FoundCamera& found) {
  return {{"projection", is_perspective(found.camera) ? "perspective" : "orthographic"},
          {"scale_x", found.camera.scale_x},
          {"scale_y", found.camera.scale_y},
          {"center_x", found.camera.center_x},
          {"center_y", found.camera.center_y},
          {"source", found.source},
          {"residual_units", found.residual_units},
          {"doubt", found.doubt},
          {"depth_type", exr::text_of(found.depth_type)},
          {"depth_from", found.axis ? "position" : "depth"},
          {"warnings", found.warnings}};
}

}  // namespace dermis::program
