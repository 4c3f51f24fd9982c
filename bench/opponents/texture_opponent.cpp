// dermis in texture space: the scene is a texture whose texels all span as much.
#include "dermis/texture.hpp"
#include "measure/aligned_floats.hpp"
#include "opponents/opponents.hpp"

namespace dermis::bench {

namespace {

class Texture final : public Opponent {
 public:
  Texture(const Case& what, const Scene& scene, const Device& device)
      : scene_(scene),
        plan_(
            device, skin(), {},
            {.method = what.family == Family::texture_recursive ? TextureMethod::recursive : TextureMethod::gaussians}),
        scattered_(3 * scene.pixels()) {}

  void run() override {
    plan_.run({.width = scene_.spec.width,
               .height = scene_.spec.height,
               .light = {.host = scene_.light.data(), .layout = scene_.layout},
               .mm_per_texel = 1 / scene_.px_per_mm(),
               .scattered = {.host = scattered_.data(), .layout = scene_.layout}});
  }

  std::vector<float> result() override { return {scattered_.begin(), scattered_.end()}; }

 private:
  const Scene& scene_;
  TexturePlan plan_;
  AlignedFloats scattered_;
};

}  // namespace

std::unique_ptr<Opponent> make_texture(const Case& what, const Scene& scene, const Device& device) {
  return std::make_unique<Texture>(what, scene, device);
}

}  // namespace dermis::bench
