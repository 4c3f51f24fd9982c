// A caller with its pixels in memory: float RGB light and float depth in, scattered light out.
#include <cstdio>
#include <dermis/dermis.hpp>
#include <vector>

int main() try {
  // A wall 100 mm away, lit from the left up to a hard shadow edge just before the middle; 4 px to the millimetre.
  const int width = 160, height = 90;
  std::vector<float> light(3 * width * height, 0.02F), depth(width * height, 100.0F), scattered(light.size());
  for (int y = 0; y < height; ++y)
    for (int i = 0; i < 3 * (width / 2 - 2); ++i) light[3 * width * y + i] = 1.0F;

  const dermis::Frame frame = {.width = width,
                               .height = height,
                               .light = {.host = light.data()},
                               .depth = {.host = depth.data()},
                               .camera = dermis::Camera::perspective(400, 400, width / 2.0, height / 2.0),
                               .mm_per_unit = 1,
                               .scattered = {.host = scattered.data()}};
  // A pixel spans 0.25 mm of the wall, which decides how many taps the quality takes.
  const dermis::Plan plan(dermis::Device::open(), {{.profile = dermis::preset("skin").profile, .pixel_mm = 0.25}},
                          dermis::FrameDescription::of(frame), {.quality = dermis::Quality::final});
  plan.run(frame);

  const int centre = 3 * (width * (height / 2) + width / 2);
  std::printf("before %.3f %.3f %.3f\n", light[centre], light[centre + 1], light[centre + 2]);
  std::printf("after  %.3f %.3f %.3f\n", scattered[centre], scattered[centre + 1], scattered[centre + 2]);
} catch (const dermis::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return static_cast<int>(error.code());
}
