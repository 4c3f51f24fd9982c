#include "texture/texture_scatter.hpp"

#include "opencl/program.hpp"

namespace dermis {

namespace {

std::string build_options(const Device& device, const TextureDescription& images) {
  return "-cl-std=CL1.2" + build_constant("LIT", 0) + build_constant("V", device.info().vector_width) +
         build_constant("HAS_ALBEDO", images.albedo ? 1 : 0) + build_constant("HAS_MASK", images.mask ? 1 : 0) +
         build_constant("HAS_STRETCH", images.stretch ? 1 : 0);
}

}  // namespace

TextureScatter::TextureScatter(const Device& device, const TextureDescription& images, bool interleaved)
    : image_program_(build_program(device, {"texture/texture_prepare.cl", "texture/texture_finish.cl"},
                                   build_options(device, images) + build_constant("INTERLEAVED", interleaved))) {}

cl::Program TextureScatter::build_passes(const Device& device, const TextureDescription& images, const char* file,
                                         const std::string& constants) {
  // Where there is no light the states of a recursion fade away, and numbers below the normal ones are slow.
  return build_program(device, {file},
                       build_options(device, {.stretch = images.stretch}) + constants + " -cl-denorms-are-zero");
}

}  // namespace dermis
