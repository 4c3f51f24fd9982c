#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/catalogue.hpp"
#include "exr/override.hpp"
#include "exr/text.hpp"

namespace dermis::exr {
namespace {

using Names = std::span<const std::string_view>;

// Pass names in lower case: those of Blender up to 4, then those of Blender 5.
constexpr std::array<std::string_view, 2> diffuse_direct = {"diffdir", "diffuse direct"};
constexpr std::array<std::string_view, 2> diffuse_indirect = {"diffind", "diffuse indirect"};
constexpr std::array<std::string_view, 2> diffuse_color = {"diffcol", "diffuse color"};
constexpr std::array<std::string_view, 2> glossy_direct = {"glossdir", "glossy direct"};
constexpr std::array<std::string_view, 2> glossy_indirect = {"glossind", "glossy indirect"};
constexpr std::array<std::string_view, 2> depth = {"depth", "z"};
constexpr std::array<std::string_view, 1> position = {"position"};
constexpr std::array<std::string_view, 1> normal = {"normal"};
constexpr std::array<std::string_view, 2> material_index = {"indexma", "material index"};
constexpr std::array<std::string_view, 1> mask = {"mask"};
constexpr std::array<std::string_view, 1> thickness = {"thickness"};
constexpr std::array<std::string_view, 2> combined = {"combined", ""};  // "": R, G and B of the layer itself

/// How one pass of a role is called; a role is the sum of its passes.
struct Pass {
  Role role;
  Names names;
};

constexpr std::array<Pass, 12> passes = {{{Role::light, diffuse_direct},
                                          {Role::light, diffuse_indirect},
                                          {Role::albedo, diffuse_color},
                                          {Role::depth, depth},
                                          {Role::position, position},
                                          {Role::normal, normal},
                                          {Role::material, material_index},
                                          {Role::mask, mask},
                                          {Role::specular, glossy_direct},
                                          {Role::specular, glossy_indirect},
                                          {Role::beauty, combined},
                                          {Role::thickness, thickness}}};

std::vector<std::string> find_pass(const Catalogue& catalogue, std::string_view layer, const Pass& pass) {
  for (const std::string_view name : pass.names) {
    const std::string prefix = with_dot(layer, name);
    // Plain X, Y, Z outside passes are no picture.
    const auto choices = std::span(triple_endings).first(name.empty() ? 1 : 2);
    std::vector<std::string> group =
        values_of(pass.role) == 3 ? catalogue.triple(prefix, choices) : catalogue.single(prefix);
    if (!group.empty()) {
      return group;
    }
  }
  return {};
}

/// The passes of a role in a layer. What a layer lacks may stand outside all layers.
ChannelSum find_role(const Catalogue& catalogue, std::string_view layer, Role role) {
  for (const std::string_view place : {layer, std::string_view()}) {
    ChannelSum sum;
    for (const Pass& pass : passes) {
      if (pass.role == role) {
        if (std::vector<std::string> group = find_pass(catalogue, place, pass); !group.empty()) {
          sum.push_back(std::move(group));
        }
      }
    }
    if (!sum.empty()) {
      return sum;
    }
  }
  return {};
}

/// Cuts "pass.ending" from the right of a lower-case name: a layer's name may hold dots and spaces. False if `name` is
/// not of the pass.
bool cut_pass(std::string_view& name, const Pass& pass) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) {
    return false;
  }
  const std::string_view before_ending = name.substr(0, dot);
  for (const std::string_view pass_name : pass.names) {
    const bool ends = !pass_name.empty() && before_ending.ends_with(pass_name);
    const std::size_t layer_size = before_ending.size() - (ends ? pass_name.size() : 0);
    if (ends && (layer_size == 0 || name[layer_size - 1] == '.')) {
      name = name.substr(0, layer_size == 0 ? 0 : layer_size - 1);
      return true;
    }
  }
  return false;
}

/// The layers that have a pass of any of these roles, in the order of the channels, each once.
std::vector<std::string> layers_with(const Catalogue& catalogue, std::span<const Role> roles) {
  std::vector<std::string> layers;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    for (const Pass& pass : passes) {
      std::string_view layer = catalogue.lower_name_at(i);
      const bool wanted = std::find(roles.begin(), roles.end(), pass.role) != roles.end();
      if (wanted && cut_pass(layer, pass)) {
        std::string name = catalogue.name_at(i).substr(0, layer.size());
        if (std::find(layers.begin(), layers.end(), name) == layers.end()) {
          layers.push_back(std::move(name));
        }
      }
    }
  }
  return layers;
}

std::string listed(const std::vector<std::string>& layers) {
  std::string out;
  for (const std::string& layer : layers) {
    if (!layer.empty()) {
      out += (out.empty() ? "" : ", ") + escaped(layer);
    }
  }
  return out;
}

std::string named_layer(const Catalogue& catalogue, std::string_view wanted) {
  const std::string prefix = lower(wanted) + '.';
  std::string any_case;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    if (!catalogue.lower_name_at(i).starts_with(prefix)) {
      continue;
    }
    std::string name = catalogue.name_at(i).substr(0, wanted.size());
    if (name == wanted) {
      return name;
    }
    if (any_case.empty()) {
      any_case = std::move(name);
    }
  }
  if (any_case.empty()) {
    const std::string layers = listed(layers_with(catalogue, all_roles));
    throw Error(ErrorCode::role_missing, "layer", escaped(wanted),
                layers.empty() ? "none: there are " + catalogue.all() : "one of " + layers);
  }
  return any_case;
}

std::string chosen_layer(const Catalogue& catalogue, std::string_view wanted) {
  if (!wanted.empty()) {
    return named_layer(catalogue, wanted);
  }
  constexpr std::array<Role, 1> diffuse = {Role::light};
  std::vector<std::string> layers = layers_with(catalogue, diffuse);
  if (layers.empty()) {
    layers = layers_with(catalogue, all_roles);
  }
  return layers.empty() ? "" : layers.front();
}

}  // namespace

std::string_view name_of(Role role) {
  constexpr std::array<std::string_view, all_roles.size()> names = {
      "light", "albedo",   "depth",  "position",  "normal",    "material", "mask",
      "matte", "specular", "beauty", "stretch_u", "stretch_v", "thickness"};
  return names[static_cast<std::size_t>(role)];
}

Roles find_roles(const Picture& picture, std::span<const std::string> overrides, std::string_view layer) {
  std::vector<Override> parsed;
  for (const std::string& text : overrides) {
    parsed.emplace_back(text);
  }
  const Catalogue catalogue(picture);
  Roles roles;
  roles.layer = chosen_layer(catalogue, layer);
  for (const Role role : all_roles) {
    roles[role] = find_role(catalogue, roles.layer, role);
  }
  for (const Override& change : parsed) {
    roles[change.role()] = change.resolve(catalogue);
  }
  return roles;
}

std::vector<float> load(const Picture& picture, const Roles& roles, Role role) {
  std::vector<float> out;
  for (const std::vector<std::string>& group : roles[role]) {
    if (group.size() != values_of(role)) {
      throw Error(ErrorCode::usage, name_of(role), std::to_string(group.size()) + " channels",
                  std::to_string(values_of(role)));
    }
    const bool first = out.empty();
    for (std::size_t c = 0; c < group.size(); ++c) {
      const std::vector<float> plane = picture.plane(group[c]);
      out.resize(plane.size() * group.size());
      for (std::size_t i = 0; i < plane.size(); ++i) {
        float& value = out[i * group.size() + c];
        value = first ? plane[i] : value + plane[i];  // 0 + x is not x for x = -0
      }
    }
  }
  return out;
}

void require(const Picture& picture, const Roles& roles, Role role) {
  if (!roles.has(role)) {
    const std::string name(name_of(role));
    throw Error(ErrorCode::role_missing, name, "no such channel among " + channel_list(picture),
                "a Cycles pass for it, or --role " + name + "=CHANNELS");
  }
}

}  // namespace dermis::exr
