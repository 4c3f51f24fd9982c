#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/channel_catalogue.hpp"
#include "exr/message_text.hpp"
#include "exr/role_override.hpp"

namespace dermis::exr {
namespace {

/// One pass of a role. A role is the sum of its passes.
struct Pass {
  Role role;
  std::array<std::optional<std::string_view>, 2> names;  ///< in lower case: Blender up to 4, then 5 if that differs
};

/// The names that renderers give channels. "" stands for R, G and B of the layer itself.
constexpr std::array passes = {
    Pass{Role::light, {"diffdir", "diffuse direct"}},
    Pass{Role::light, {"diffind", "diffuse indirect"}},
    Pass{Role::albedo, {"diffcol", "diffuse color"}},
    Pass{Role::depth, {"depth", "z"}},
    Pass{Role::position, {"position"}},
    Pass{Role::normal, {"normal"}},
    Pass{Role::material, {"indexma", "material index"}},
    Pass{Role::mask, {"mask"}},
    Pass{Role::specular, {"glossdir", "glossy direct"}},
    Pass{Role::specular, {"glossind", "glossy indirect"}},
    Pass{Role::beauty, {"combined", ""}},
    Pass{Role::thickness, {"thickness"}},
};

std::vector<std::string> find_pass(const Catalogue& catalogue, std::string_view layer, const Pass& pass) {
  for (const auto& name : pass.names) {
    if (!name) break;
    const std::string prefix = with_dot(layer, *name);
    // Plain X, Y, Z outside passes are no picture.
    const auto choices = std::span(triple_endings).first(name->empty() ? 1 : 2);
    std::vector<std::string> group =
        info_of(pass.role).values == 3 ? catalogue.triple(prefix, choices) : catalogue.single(prefix);
    if (!group.empty()) return group;
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
    if (!sum.empty()) return sum;
  }
  return {};
}

/// Cuts "pass.ending" from the right of a lower-case name: a layer's name may hold dots and spaces. False if `name` is
/// not of the pass.
bool cut_pass(std::string_view& name, const Pass& pass) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return false;
  const std::string_view before_ending = name.substr(0, dot);
  for (const auto& pass_name : pass.names) {
    if (!pass_name || pass_name->empty() || !before_ending.ends_with(*pass_name)) continue;
    const std::size_t layer_size = before_ending.size() - pass_name->size();
    if (layer_size == 0 || name[layer_size - 1] == '.') {
      name = name.substr(0, layer_size == 0 ? 0 : layer_size - 1);
      return true;
    }
  }
  return false;
}

/// The layers that have a pass of the role, or of any role, in the order of the channels, each once.
std::vector<std::string> layers_with(const Catalogue& catalogue, std::optional<Role> role) {
  std::vector<std::string> layers;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    for (const Pass& pass : passes) {
      std::string_view layer = catalogue.lower_name_at(i);
      if ((!role || pass.role == *role) && cut_pass(layer, pass)) {
        std::string name = catalogue.name_at(i).substr(0, layer.size());
        if (std::find(layers.begin(), layers.end(), name) == layers.end()) layers.push_back(std::move(name));
      }
    }
  }
  return layers;
}

std::string listed(const std::vector<std::string>& layers) {
  std::string out;
  for (const std::string& layer : layers) {
    if (!layer.empty()) out += (out.empty() ? "" : ", ") + escaped(layer);
  }
  return out;
}

std::string named_layer(const Catalogue& catalogue, std::string_view wanted) {
  const std::string prefix = lower(wanted) + '.';
  std::string any_case;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    if (!catalogue.lower_name_at(i).starts_with(prefix)) continue;
    std::string name = catalogue.name_at(i).substr(0, wanted.size());
    if (name == wanted) return name;
    if (any_case.empty()) any_case = std::move(name);
  }
  if (any_case.empty()) {
    const std::string layers = listed(layers_with(catalogue, std::nullopt));
    throw Error(ErrorCode::role_missing, "layer", escaped(wanted),
                layers.empty() ? "none: there are " + catalogue.all() : "one of " + layers);
  }
  return any_case;
}

std::string chosen_layer(const Catalogue& catalogue, std::string_view wanted) {
  if (!wanted.empty()) return named_layer(catalogue, wanted);
  std::vector<std::string> layers = layers_with(catalogue, Role::light);
  if (layers.empty()) layers = layers_with(catalogue, std::nullopt);
  return layers.empty() ? "" : layers.front();
}

}  // namespace

static_assert([] {
  for (std::size_t i = 0; i < role_table.size(); ++i) {
    if (role_table[i].role != static_cast<Role>(i)) return false;
  }
  return true;
}());

std::string role_names() {
  std::string out;
  for (const RoleInfo& info : role_table) out += (out.empty() ? "" : ", ") + std::string(info.name);
  return out;
}

Roles find_roles(const Picture& picture, std::span<const std::string> overrides, std::string_view layer) {
  std::vector<Override> parsed;
  for (const std::string& text : overrides) parsed.emplace_back(text);
  const Catalogue catalogue(picture);
  Roles roles;
  roles.layer = chosen_layer(catalogue, layer);
  for (const RoleInfo& info : role_table) roles[info.role] = find_role(catalogue, roles.layer, info.role);
  for (const Override& change : parsed) roles[change.role()] = change.resolve(catalogue);
  return roles;
}

std::vector<float> load(const Picture& picture, const Roles& roles, Role role) {
  std::vector<float> out;
  for (const std::vector<std::string>& group : roles[role]) {
    if (group.size() != info_of(role).values) {
      throw Error(ErrorCode::usage, name_of(role), std::to_string(group.size()) + " channels",
                  std::to_string(info_of(role).values));
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
