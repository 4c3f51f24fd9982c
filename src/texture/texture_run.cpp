#include "texture/texture_run.hpp"

#include <limits>

#include "opencl/device_buffer.hpp"

namespace dermis {

namespace {

params::TextureParams texture_params(const TextureFrame& frame, const TextureSizes& sizes, double albedo_mix) {
  params::TextureParams p{};
  p.width = frame.width;
  p.height = frame.height;
  p.stride = sizes.stride();
  p.blocks_x = sizes.blocks_x();
  p.blocks_y = sizes.blocks_y();
  p.mm_per_texel = static_cast<float>(frame.mm_per_texel);
  p.albedo_mix = static_cast<float>(albedo_mix);
  p.writes_scattered = frame.scattered ? 1 : 0;
  p.writes_result = frame.result ? 1 : 0;
  return p;
}

}  // namespace

/// Recursion goes down columns: without a few texels more, all of a column might fall into one set of a cache.
int TextureSizes::stride() const {
  constexpr int apart = 16;
  return blocks_x() * BLOCK_WIDTH + apart;
}

int TextureSizes::blocks_x() const { return parts_of(width, BLOCK_WIDTH); }
int TextureSizes::blocks_y() const { return parts_of(height, BLOCK_HEIGHT); }
std::size_t TextureSizes::texels() const { return static_cast<std::size_t>(stride()) * height; }
std::size_t TextureSizes::blocks() const { return static_cast<std::size_t>(blocks_x()) * blocks_y(); }

TexturePlanes::TexturePlanes(const Device& device, const TextureSizes& sizes, int light_floats_per_texel, int lit_parts)
    : light(device_buffer(device, "light", light_floats_per_texel * sizes.texels() * sizeof(float))),
      objects(device_buffer(device, "objects", sizes.texels())),
      lit(device_buffer(device, "lit blocks", 3 * sizes.blocks() * lit_parts)),
      finest(device_buffer(device, "finest stretches", 2 * sizes.blocks() * sizeof(float))),
      counters(device_buffer(device, "counters", TEXTURE_COUNTERS * sizeof(cl_int))) {}

TextureRun::TextureRun(const Device& device, CommandChain& commands, const cl::Program& image_program,
                       const TextureFrame& frame, const TextureBuffers& images, double albedo_mix)
    : device_(device),
      commands_(commands),
      context_(device.context(), true),
      image_program_(image_program),
      images_(images),
      sizes_{frame.width, frame.height},
      params_(texture_params(frame, sizes_, albedo_mix)) {}

double TextureRun::mm_per_texel() const {
  return images_.has(TextureImage::stretch_u) ? 0 : static_cast<double>(params_.mm_per_texel);
}

params::TexturePass TextureRun::pass(bool along_v) const {
  const params::TextureLayouts& layouts = images_.layouts();
  return {along_v ? layouts.stretch_v : layouts.stretch_u, along_v ? 1 : 0, 0};
}

const cl::Buffer& TextureRun::stretch(bool along_v) const {
  return images_.buffer(along_v ? TextureImage::stretch_v : TextureImage::stretch_u);
}

void TextureRun::launch(Step step, const cl::Kernel& kernel, const Grid& grid) {
  events_[static_cast<std::size_t>(step)].push_back(commands_.launch(kernel, grid));
}

void TextureRun::launch_blocks(Step step, const cl::Kernel& kernel) {
  const int items = item_is_pixel(device_) ? BLOCK_WIDTH : 1;
  launch(step, kernel, {items * params_.blocks_x, params_.blocks_y, items, 1});
}

void TextureRun::prepare(const TexturePlanes& planes) {
  commands_.fill(planes.counters, cl_int{0}, 0, COUNTER_FINEST * sizeof(cl_int));
  commands_.fill(planes.counters, std::numeric_limits<cl_int>::max(), COUNTER_FINEST * sizeof(cl_int), sizeof(cl_int));
  cl::Kernel kernel(image_program_, "texture_prepare");
  set_arguments(kernel, params_, images_.layouts(), images_.buffer(TextureImage::light),
                images_.buffer(TextureImage::albedo), images_.buffer(TextureImage::mask),
                images_.buffer(TextureImage::stretch_u), images_.buffer(TextureImage::stretch_v), planes.light,
                planes.objects, planes.lit, planes.finest, planes.counters);
  launch_blocks(Step::prepare, kernel);
}

void TextureRun::finish(const cl::Buffer& scattered) {
  cl::Kernel kernel(image_program_, "texture_finish");
  set_arguments(kernel, params_, images_.layouts(), images_.buffer(TextureImage::light),
                images_.buffer(TextureImage::albedo), images_.buffer(TextureImage::mask),
                images_.buffer(TextureImage::stretch_u), images_.buffer(TextureImage::stretch_v), scattered,
                images_.buffer(TextureImage::scattered), images_.buffer(TextureImage::result));
  launch_blocks(Step::finish, kernel);
}

TextureStats TextureRun::wait(const TexturePlanes& planes) const {
  images_.read_back();
  std::array<cl_int, TEXTURE_COUNTERS> counters{};
  commands_.queue().enqueueReadBuffer(planes.counters, CL_TRUE, 0, sizeof(counters), counters.data());
  TextureStats stats;
  stats.prepare_ms = milliseconds_of(Step::prepare);
  stats.scatter_ms = milliseconds_of(Step::scatter);
  stats.finish_ms = milliseconds_of(Step::finish);
  stats.texels = static_cast<std::int64_t>(params_.width) * params_.height;
  stats.texels_empty = counters[COUNTER_EMPTY_TEXELS];
  stats.parts = parts_;
  stats.parts_empty = counters[COUNTER_EMPTY_PARTS];
  stats.parts_unlit = counters[COUNTER_UNLIT_PARTS];
  return stats;
}

}  // namespace dermis
