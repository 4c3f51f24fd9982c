#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/any_renderer.hpp"
#include "exr/channel_catalogue.hpp"
#include "exr/message_text.hpp"
#include "exr/role_override.hpp"

namespace dermis::exr {
namespace {

std::vector<std::string> find_pass(const Catalogue& catalogue, std::string_view layer, const Renderer::Pass& pass) {
  const bool is_triple = info_of(pass.role).values == 3;
  for (const std::string& name : pass.names) {
    const std::string prefix = with_dot(layer, name);
    // Plain X, Y, Z outside passes are no picture.
    const auto choices = std::span(triple_endings).first(name.empty() ? 1 : 2);
    if (name.empty() && !is_triple) continue;
    std::vector<std::string> group = is_triple ? catalogue.triple(prefix, choices) : catalogue.single(prefix);
    if (!group.empty()) return group;
  }
  return {};
}

/// The passes of the renderer's light that a sum of others lacks, each by its first name.
std::vector<std::string> missing_light(const Catalogue& catalogue, std::string_view layer, const Renderer& renderer) {
  std::vector<std::string> missing;
  for (const Renderer::Pass& pass : renderer.passes) {
    if (pass.role == Role::light && find_pass(catalogue, layer, pass).empty() && find_pass(catalogue, {}, pass).empty())
      missing.push_back(pass.names.front());
  }
  return missing;
}

/// Passes of light, where the layer has any of them, or else outside all layers. `missing` are their names if none is
/// there, or those that are not.
ChannelSum find_light(const Catalogue& catalogue, std::string_view layer,
                      const std::vector<std::vector<std::string>>& passes, std::vector<std::string>& missing) {
  ChannelSum sum;
  std::vector<std::string> lacking;
  for (const std::string_view place : {layer, std::string_view()}) {
    lacking.clear();
    for (const std::vector<std::string>& names : passes) {
      std::vector<std::string> group = find_pass(catalogue, place, {Role::beauty, names});
      if (group.empty()) {
        lacking.push_back(names.front());
      } else {
        sum.push_back(std::move(group));
      }
    }
    if (!sum.empty()) break;
  }
  missing.insert(missing.end(), lacking.begin(), lacking.end());
  return sum;
}

/// What a renderer says of the beauty beside the diffuse light. A specular role that the caller gives is all of it.
void find_others(const Catalogue& catalogue, const Renderer& renderer, bool is_specular_told, Roles& roles) {
  const auto add = [&](ChannelSum light, const std::vector<std::string>& colour_names) {
    if (light.empty()) return;
    std::vector<std::string> unused;
    ChannelSum colour;
    if (!colour_names.empty()) colour = find_light(catalogue, roles.layer, {colour_names}, unused);
    roles.others.push_back({std::move(light), colour.empty() ? std::vector<std::string>() : colour.front()});
  };
  add(roles[Role::specular], is_specular_told ? std::vector<std::string>() : renderer.specular_colour);
  for (const Renderer::OtherLight& other : renderer.others)
    add(find_light(catalogue, roles.layer, other.passes, roles.missing_others), other.colour);
  if (roles.has(Role::specular)) return;
  for (const Renderer::Pass& pass : renderer.passes)
    if (pass.role == Role::specular) roles.missing_others.push_back(pass.names.front());
}

/// "diffuse_direct or diffuse_indirect (arnold)"; empty if the renderer has no pass for the role.
std::string names_sought(const Renderer& renderer, Role role) {
  std::string names;
  for (const Renderer::Pass& pass : renderer.passes) {
    if (pass.role != role) continue;
    const std::string& name = pass.names.front();
    names += (names.empty() ? "" : " or ") + (name.empty() ? "R, G, B" : name);
  }
  return names.empty() ? names : names + " (" + renderer.name + ")";
}

/// The passes of a role in a layer. What a layer lacks may stand outside all layers.
ChannelSum find_role(const Catalogue& catalogue, std::string_view layer, const Renderer& renderer, Role role) {
  for (const std::string_view place : {layer, std::string_view()}) {
    ChannelSum sum;
    for (const Renderer::Pass& pass : renderer.passes) {
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
bool cut_pass(std::string_view& name, const Renderer::Pass& pass) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return false;
  const std::string_view before_ending = name.substr(0, dot);
  for (const std::string& pass_name : pass.names) {
    const std::string wanted = lower(pass_name);
    if (wanted.empty() || !before_ending.ends_with(wanted)) continue;
    const std::size_t layer_size = before_ending.size() - wanted.size();
    if (layer_size == 0 || name[layer_size - 1] == '.') {
      name = name.substr(0, layer_size == 0 ? 0 : layer_size - 1);
      return true;
    }
  }
  return false;
}

/// The layers that have a pass of the role, or of any role, in the order of the channels, each once.
std::vector<std::string> layers_with(const Catalogue& catalogue, const Renderer& renderer, std::optional<Role> role) {
  std::vector<std::string> layers;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    if (catalogue.is_joined(i)) continue;
    for (const Renderer::Pass& pass : renderer.passes) {
      std::string_view layer = catalogue.lower_name_at(i);
      if ((!role || pass.role == *role) && cut_pass(layer, pass)) {
        std::string name = catalogue.short_name_at(i).substr(0, layer.size());
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

std::string named_layer(const Catalogue& catalogue, const Renderer& renderer, std::string_view wanted) {
  const std::string prefix = lower(wanted) + '.';
  std::string any_case;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    if (!catalogue.lower_name_at(i).starts_with(prefix)) continue;
    std::string name = catalogue.short_name_at(i).substr(0, wanted.size());
    if (name == wanted) return name;
    if (any_case.empty()) any_case = std::move(name);
  }
  if (any_case.empty()) {
    const std::string layers = listed(layers_with(catalogue, renderer, std::nullopt));
    throw Error(ErrorCode::role_missing, "layer", escaped(wanted),
                layers.empty() ? "none: there are " + catalogue.all() : "one of " + layers);
  }
  return any_case;
}

/// The layer that a renderer's passes are in: the first with its light, else with any of its passes, else with any
/// pass.
std::string chosen_layer(const Catalogue& catalogue, const Renderer& renderer) {
  std::vector<std::string> layers = layers_with(catalogue, renderer, Role::light);
  if (layers.empty()) layers = layers_with(catalogue, renderer, std::nullopt);
  if (layers.empty()) layers = layers_with(catalogue, any_renderer, std::nullopt);
  return layers.empty() ? "" : layers.front();
}

bool may_be_of(const Catalogue& catalogue, const Renderer& renderer) {
  return renderer.marks.empty() || std::any_of(renderer.marks.begin(), renderer.marks.end(),
                                               [&](const std::string& mark) { return !catalogue.find(mark).empty(); });
}

/// How many of a renderer's passes are there; 0 without its light.
std::size_t count_passes(const Catalogue& catalogue, std::string_view layer, const Renderer& renderer) {
  if (!may_be_of(catalogue, renderer) || find_role(catalogue, layer, renderer, Role::light).empty()) return 0;
  std::size_t count = 0;
  for (const RoleInfo& info : role_table) count += find_role(catalogue, layer, renderer, info.role).size();
  return count;
}

/// The renderer that has most of its passes there, the earlier one of two that have as many; nullptr if none has light.
const Renderer* likeliest_renderer(const Catalogue& catalogue, std::string_view layer) {
  const Renderer* best = nullptr;
  std::size_t most = 0;
  for (const Renderer& renderer : renderers()) {
    const std::string its_layer = layer.empty() ? chosen_layer(catalogue, renderer) : std::string(layer);
    const std::size_t count = count_passes(catalogue, its_layer, renderer);
    if (count > most) {
      most = count;
      best = &renderer;
    }
  }
  return best;
}

/// The passes of the layer, by the names of the renderer, or else by those that mean the same whoever writes them.
void find_passes(const Catalogue& catalogue, const Renderer& renderer, Roles& roles) {
  for (const Renderer* names : {&renderer, &any_renderer}) {
    for (const RoleInfo& info : role_table) {
      if (roles.has(info.role)) continue;
      roles[info.role] = find_role(catalogue, roles.layer, *names, info.role);
      if (roles.has(info.role)) roles.rules[static_cast<std::size_t>(info.role)] = names->name;
    }
  }
}

void check_view(const Picture& picture, std::string_view view) {
  if (view.empty()) return;
  const std::vector<std::string> views = picture.views();
  if (std::find(views.begin(), views.end(), view) == views.end())
    throw Error(ErrorCode::role_missing, "view", escaped(view),
                views.empty() ? "none, for the picture has no views" : "one of " + listed(views));
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

Roles find_roles(const Picture& picture, const RoleRequest& request) {
  std::vector<Override> parsed;
  for (const std::string& text : request.overrides) parsed.emplace_back(text);
  check_view(picture, request.view);
  const Catalogue catalogue(picture, request.view);
  const Renderer* likeliest =
      request.renderer != nullptr ? request.renderer : likeliest_renderer(catalogue, request.layer);
  // A picture without light may still be lit, or looked at.
  const Renderer& renderer = likeliest != nullptr ? *likeliest : renderers().front();
  const std::vector<std::string> views = picture.views();
  Roles roles;
  roles.view = request.view.empty() && !views.empty() ? views.front() : request.view;
  roles.layer =
      request.layer.empty() ? chosen_layer(catalogue, renderer) : named_layer(catalogue, renderer, request.layer);
  find_passes(catalogue, renderer, roles);
  if (roles.has(Role::light)) {
    roles.renderer = renderer.name;
    roles.lighting = renderer.lighting;
    roles.missing_light = missing_light(catalogue, roles.layer, renderer);
  }
  if (likeliest != nullptr) {
    for (const RoleInfo& info : role_table) {
      std::string& sought = roles.sought[static_cast<std::size_t>(info.role)];
      sought = names_sought(renderer, info.role);
      if (sought.empty()) sought = names_sought(any_renderer, info.role);
    }
  }
  bool is_specular_told = false;
  for (const Override& change : parsed) {
    is_specular_told = is_specular_told || change.role() == Role::specular;
    roles[change.role()] = change.resolve(catalogue);
    roles.rules[static_cast<std::size_t>(change.role())] = "--role";
    if (change.role() != Role::light) continue;
    roles.renderer.clear();
    roles.missing_light.clear();
  }
  find_others(catalogue, renderer, is_specular_told, roles);
  return roles;
}

std::vector<std::string> files_of(std::span<const std::string> overrides) {
  std::vector<std::string> files;
  for (const std::string& text : overrides) {
    for (std::string& file : Override(text).files()) {
      if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(std::move(file));
    }
  }
  return files;
}

std::vector<float> load(const Picture& picture, const ChannelSum& sum) {
  std::vector<float> out;
  for (const std::vector<std::string>& group : sum) {
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

std::vector<float> load(const Picture& picture, const Roles& roles, Role role) {
  for (const std::vector<std::string>& group : roles[role]) {
    if (group.size() != info_of(role).values) {
      throw Error(ErrorCode::usage, name_of(role), std::to_string(group.size()) + " channels",
                  std::to_string(info_of(role).values));
    }
  }
  return load(picture, roles[role]);
}

void require(const Picture& picture, const Roles& roles, Role role) {
  if (roles.has(role)) return;
  const std::string name(name_of(role));
  const bool has_renderer =
      std::any_of(roles.sought.begin(), roles.sought.end(), [](const std::string& sought) { return !sought.empty(); });
  std::string wanted = roles.sought[static_cast<std::size_t>(role)];
  if (!has_renderer) wanted = "a pass for it by the names of " + renderer_names();
  if (!wanted.empty()) wanted += ", or ";
  wanted += "--role " + name + "=CHANNELS (FILE:CHANNELS if another file has it)";
  if (role == Role::material) wanted += ", or --profile (one material for everything)";
  throw Error(ErrorCode::role_missing, name, "no such channel among " + channel_list(picture), wanted);
}

}  // namespace dermis::exr
