#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
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
constexpr std::array<std::string_view, 2> combined = {"combined", ""};  // "": R, G and B of the layer itself

/// How one pass of a role is called; a role is the sum of its passes.
struct Pass {
  Role role;
  Names names;
};

constexpr std::array<Pass, 11> passes = {{{Role::light, diffuse_direct},
                                          {Role::light, diffuse_indirect},
                                          {Role::albedo, diffuse_color},
                                          {Role::depth, depth},
                                          {Role::position, position},
                                          {Role::normal, normal},
                                          {Role::material, material_index},
                                          {Role::mask, mask},
                                          {Role::specular, glossy_direct},
                                          {Role::specular, glossy_indirect},
                                          {Role::beauty, combined}}};

/// The endings of a group of three, and those of a single channel ("": none).
using Endings = std::array<std::string_view, 3>;
constexpr std::array<Endings, 2> triple_endings = {{{"R", "G", "B"}, {"X", "Y", "Z"}}};
constexpr std::array<std::string_view, 6> single_endings = {"Z", "X", "V", "Y", "R", ""};

std::size_t values_of(Role role) { return role == Role::depth || role == Role::material || role == Role::mask ? 1 : 3; }

std::string with_dot(std::string_view prefix, std::string_view ending) {
  std::string out(prefix);
  if (!prefix.empty() && !ending.empty()) {
    out += '.';
  }
  return out += ending;
}

/// The channels of a picture by name in any case.
class Catalogue {
 public:
  explicit Catalogue(const Picture& picture) : picture_(picture) {
    for (const Channel& channel : picture.channels()) {
      lower_names_.push_back(lower(channel.name));
    }
  }

  const std::vector<std::string>& lower_names() const { return lower_names_; }
  std::string all() const { return channel_list(picture_); }

  /// The channel of this name in any case, the one most alike if several differ by case only; empty if there is none.
  std::string find(std::string_view name) const {
    const std::string wanted = lower(name);
    std::string best;
    std::ptrdiff_t best_alike = -1;
    for (std::size_t i = 0; i < lower_names_.size(); ++i) {
      if (lower_names_[i] != wanted) {
        continue;
      }
      const std::string& candidate = name_at(i);
      const auto alike = std::inner_product(name.begin(), name.end(), candidate.begin(), std::ptrdiff_t{0},
                                            std::plus<>(), std::equal_to<>());
      if (alike > best_alike) {
        best = candidate;
        best_alike = alike;
      }
    }
    return best;
  }

  const std::string& name_at(std::size_t index) const { return picture_.channels()[index].name; }

  /// The three channels that `prefix` stands for; empty if they are not all there.
  std::vector<std::string> triple(std::string_view prefix, std::span<const Endings> choices) const {
    for (const Endings& endings : choices) {
      std::vector<std::string> found;
      for (const std::string_view ending : endings) {
        if (std::string name = find(with_dot(prefix, ending)); !name.empty()) {
          found.push_back(std::move(name));
        }
      }
      if (found.size() == endings.size()) {
        return found;
      }
    }
    return {};
  }

  /// The one channel that `prefix` stands for; empty if there is none.
  std::vector<std::string> single(std::string_view prefix) const {
    for (const std::string_view ending : single_endings) {
      if (std::string name = find(with_dot(prefix, ending)); !name.empty()) {
        return {std::move(name)};
      }
    }
    return {};
  }

 private:
  const Picture& picture_;
  std::vector<std::string> lower_names_;
};

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
  for (std::size_t i = 0; i < catalogue.lower_names().size(); ++i) {
    for (const Pass& pass : passes) {
      std::string_view layer = catalogue.lower_names()[i];
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
  for (std::size_t i = 0; i < catalogue.lower_names().size(); ++i) {
    if (!catalogue.lower_names()[i].starts_with(prefix)) {
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

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end = text.find(separator); end != std::string_view::npos; end = text.find(separator)) {
    parts.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(end + 1);
  }
  parts.push_back(trimmed(text));
  return parts;
}

[[noreturn]] void malformed(std::string_view text, std::string_view wanted) {
  throw Error(ErrorCode::usage, "role", '"' + escaped(text) + '"', wanted);
}

std::string list_of_roles() {
  std::string out;
  for (const Role role : all_roles) {
    out += (out.empty() ? "" : ", ") + std::string(name_of(role));
  }
  return out;
}

/// What one role is, in the caller's words.
class Override {
 public:
  explicit Override(std::string_view text) : text_(text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) {
      malformed(text, "role=channels");
    }
    const std::string name = lower(trimmed(text.substr(0, equals)));
    const auto it = std::find_if(all_roles.begin(), all_roles.end(), [&name](Role r) { return name_of(r) == name; });
    if (it == all_roles.end()) {
      malformed(text, "one of " + list_of_roles() + " before the =");
    }
    role_ = *it;
    channels_ = text.substr(equals + 1);
  }

  Role role() const { return role_; }

  ChannelSum resolve(const Catalogue& catalogue) const {
    ChannelSum sum;
    for (const std::string_view group : split(channels_, '+')) {
      sum.push_back(resolve_group(catalogue, split(group, ',')));
    }
    return sum;
  }

 private:
  std::vector<std::string> resolve_group(const Catalogue& catalogue, const std::vector<std::string_view>& names) const {
    const std::size_t values = values_of(role_);
    const bool empty = std::any_of(names.begin(), names.end(), [](std::string_view name) { return name.empty(); });
    if (empty || (names.size() != 1 && names.size() != values)) {
      malformed(text_, values == 3 ? "three channels, or one prefix" : "one channel");
    }
    if (names.size() == 3) {
      return {existing(catalogue, names[0]), existing(catalogue, names[1]), existing(catalogue, names[2])};
    }
    if (values == 1) {
      if (std::string name = catalogue.find(names[0]); !name.empty()) {
        return {std::move(name)};
      }
    }
    std::vector<std::string> group =
        values == 3 ? catalogue.triple(names[0], triple_endings) : catalogue.single(names[0]);
    if (group.empty() && !catalogue.find(names[0]).empty()) {
      malformed(text_, "three channels, or a prefix of .R .G .B or .X .Y .Z");
    }
    return group.empty() ? std::vector<std::string>{existing(catalogue, names[0])} : group;
  }

  std::string existing(const Catalogue& catalogue, std::string_view wanted) const {
    std::string name = catalogue.find(wanted);
    if (name.empty()) {
      throw Error(ErrorCode::role_missing, name_of(role_), escaped(wanted), "channels among " + catalogue.all());
    }
    return name;
  }

  std::string_view text_;
  std::string_view channels_;
  Role role_ = Role::light;
};

}  // namespace

std::string_view name_of(Role role) {
  constexpr std::array<std::string_view, all_roles.size()> names = {
      "light", "albedo", "depth", "position", "normal", "material", "mask", "specular", "beauty"};
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
