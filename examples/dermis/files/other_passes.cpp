#include "files/other_passes.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "exr/message_text.hpp"

namespace dermis::program {
namespace {

/// Light, direct and indirect, and the colour that the renderer has divided it by. Names are those of Blender up to 4,
/// then of 5, in lower case.
struct PassNames {
  std::array<std::string_view, 4> light;
  std::array<std::string_view, 2> colour;
};

constexpr std::array passes = {
    PassNames{{"glossdir", "glossind", "glossy direct", "glossy indirect"}, {"glosscol", "glossy color"}},
    PassNames{{"transdir", "transind", "transmission direct", "transmission indirect"},
              {"transcol", "transmission color"}},
    PassNames{{"subsurfacedir", "subsurfaceind"}, {"subsurfacecol"}},
    PassNames{{"volumedir", "volumeind", "volume direct", "volume indirect"}, {}},
    PassNames{{"emit", "env", "emission", "environment"}, {}},
};

class Layer {
 public:
  Layer(const exr::Picture& picture, const exr::Roles& roles)
      : picture_(picture), prefix_(roles.layer.empty() ? "" : exr::lower(roles.layer) + ".") {
    for (const exr::Channel& channel : picture.channels()) names_.emplace(exr::lower(channel.name), channel.name);
  }

  /// Adds the values of a pass, if it is there.
  template <std::size_t N>
  void add(const std::array<std::string_view, N>& its_names, std::vector<float>& sum) const {
    for (const std::string_view name : its_names) {
      if (name.empty()) continue;
      std::array<const std::string*, 3> channels{};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto found = names_.find(prefix_ + std::string(name) + std::array{".r", ".g", ".b"}[c]);
        channels[c] = found != names_.end() ? &found->second : nullptr;
      }
      if (channels[0] == nullptr || channels[1] == nullptr || channels[2] == nullptr) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<float> plane = picture_.plane(*channels[c]);
        sum.resize(3 * plane.size());
        for (std::size_t i = 0; i < plane.size(); ++i) sum[3 * i + c] += plane[i];
      }
    }
  }

 private:
  const exr::Picture& picture_;
  std::string prefix_;
  std::map<std::string, std::string> names_;
};

void add_to(std::vector<float>& sum, const std::vector<float>& more) {
  if (sum.empty()) sum.resize(more.size());
  for (std::size_t i = 0; i < more.size(); ++i) sum[i] += more[i];
}

}  // namespace

std::vector<float> load_other_passes(const exr::Picture& picture, const exr::Roles& roles) {
  const Layer layer(picture, roles);
  std::vector<float> sum;
  for (const PassNames& names : passes) {
    std::vector<float> light;
    std::vector<float> colour;
    layer.add(names.light, light);
    const bool is_glossy = &names == &passes.front();
    if (light.empty() && is_glossy && roles.has(exr::Role::specular))
      light = exr::load(picture, roles, exr::Role::specular);
    if (light.empty()) continue;
    layer.add(names.colour, colour);
    for (std::size_t i = 0; i < colour.size(); ++i) light[i] *= colour[i];
    add_to(sum, light);
  }
  return sum;
}

}  // namespace dermis::program
