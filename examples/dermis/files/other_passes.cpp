#include "files/other_passes.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "exr/channel_catalogue.hpp"

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

/// The passes of a layer and a view.
class Layer {
 public:
  Layer(const exr::Picture& picture, const exr::Roles& roles)
      : picture_(picture), layer_(roles.layer), catalogue_(picture, roles.view) {}

  /// Adds the values of a pass, if it is there.
  template <std::size_t N>
  void add(const std::array<std::string_view, N>& its_names, std::vector<float>& sum) const {
    for (const std::string_view name : its_names) {
      if (name.empty()) continue;
      const std::vector<std::string> channels =
          catalogue_.triple(exr::with_dot(layer_, name), std::span(exr::triple_endings).first(1));
      for (std::size_t c = 0; c < channels.size(); ++c) {
        const std::vector<float> plane = picture_.plane(channels[c]);
        sum.resize(3 * plane.size());
        for (std::size_t i = 0; i < plane.size(); ++i) sum[3 * i + c] += plane[i];
      }
    }
  }

 private:
  const exr::Picture& picture_;
  std::string layer_;
  exr::Catalogue catalogue_;
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
