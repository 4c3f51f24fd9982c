// A caller with images of OpenImageIO: scatters the diffuse light of an EXR file of Cycles' passes by one profile.
#include <cstdio>
#include <cstdlib>
#include <dermis/dermis.hpp>
#include <dermis/image_buffer.hpp>

int main(int argc, char** argv) try {
  if (argc != 5) {
    std::fprintf(stderr, "usage: image_buffers IN.exr OUT.exr FOCAL_PX MM_PER_UNIT\n");
    return 2;
  }
  OIIO::ImageBuf picture(argv[1]);
  if (!picture.read(0, 0, /*force=*/true, OIIO::TypeFloat)) {
    std::fprintf(stderr, "%s\n", picture.geterror().c_str());
    return 3;
  }
  const OIIO::ImageSpec& spec = picture.spec();
  OIIO::ImageBuf scattered(OIIO::ImageSpec(spec.width, spec.height, 3, OIIO::TypeFloat));
  const double focal_px = std::atof(argv[3]);
  const dermis::Frame frame = {
      .width = spec.width,
      .height = spec.height,
      .light = dermis::image_of(picture, {"ViewLayer.DiffDir.R", "ViewLayer.DiffDir.G", "ViewLayer.DiffDir.B"}),
      .depth = dermis::image_of(picture, {"ViewLayer.Depth.Z"}),
      .camera = dermis::Camera::perspective(focal_px, focal_px, spec.width / 2.0, spec.height / 2.0),
      .mm_per_unit = std::atof(argv[4]),
      .scattered = dermis::output_of(scattered, {"R", "G", "B"})};
  const dermis::Plan plan(dermis::Device::open(), {{.profile = dermis::preset("skin").profile}},
                          dermis::FrameDescription::of(frame));
  plan.run(frame);
  if (!scattered.write(argv[2])) {
    std::fprintf(stderr, "%s\n", scattered.geterror().c_str());
    return 6;
  }
} catch (const dermis::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return static_cast<int>(error.code());
}
