#include "texture/texture_run.hpp"

#include <array>
#include <limits>
#include <utility>

namespace dermis {

namespace {

int parts(int whole, int part) { return (whole + part - 1) / part; }

params::TextureParams texture_params(const TexturePlan::State& plan, const TextureFrame& frame,
                                     const TextureSizes& sizes) {
  params::TextureParams p{};
  p.width = frame.width;
  p.height = frame.height;
  p.stride = sizes.stride();
  p.blocks_x = sizes.blocks_x();
  p.blocks_y = sizes.blocks_y();
  p.mm_per_texel = static_cast<float>(frame.mm_per_texel);
  p.albedo_mix = static_cast<float>(plan.options.albedo_mix);
  return p;
}

}  // namespace

/// Recursion goes down columns: without a few texels more all of a column might fall into one set of a cache.
int TextureSizes::stride() const {
  constexpr int apart = 16;
  return blocks_x() * BLOCK_WIDTH + apart;
}

int TextureSizes::blocks_x() const { return parts(width, BLOCK_WIDTH); }
int TextureSizes::blocks_y() const { return parts(height, BLOCK_HEIGHT); }
std::size_t TextureSizes::texels() const { return static_cast<std::size_t>(stride()) * height; }
std::size_t TextureSizes::blocks() const { return static_cast<std::size_t>(blocks_x()) * blocks_y(); }

TextureMemory::TextureMemory(const cl::Context& context, const TextureSizes& wanted) : sizes(wanted) {
  const auto allocate = [&](std::size_t bytes) { return cl::Buffer(context, CL_MEM_READ_WRITE, bytes); };
  const std::size_t plane_bytes = sizes.texels() * sizeof(float);
  light = allocate(plane_bytes * (sizes.recursive ? 4 : 3));
  between = allocate(plane_bytes * (sizes.recursive ? 8 : 3));
  sum = sizes.recursive ? light : allocate(3 * plane_bytes);
  last = sizes.recursive ? light : allocate(3 * plane_bytes);
  objects = allocate(sizes.texels());
  if (!sizes.recursive) {
    for (cl::Buffer& its : runs) its = allocate(sizes.texels() * sizeof(cl_int));
  }
  for (cl::Buffer* its : {&light_lit, &between_lit, &last_lit}) *its = allocate(3 * sizes.blocks());
  finest = allocate(2 * sizes.blocks() * sizeof(float));
  counters = allocate(TEXTURE_COUNTERS * sizeof(cl_int));
}

TextureRun::TextureRun(const TexturePlan::State& plan, const TextureFrame& frame, const TextureBuffers& images,
                       TextureMemory& memory, cl::CommandQueue queue)
    : plan_(plan),
      images_(images),
      memory_(memory),
      queue_(std::move(queue)),
      context_(plan.device.context(), true),
      params_(texture_params(plan, frame, memory.sizes)) {
  queue_.enqueueFillBuffer(memory_.counters, cl_int{0}, 0, COUNTER_FINEST * sizeof(cl_int));
  queue_.enqueueFillBuffer(memory_.counters, std::numeric_limits<cl_int>::max(), COUNTER_FINEST * sizeof(cl_int),
                           sizeof(cl_int));
}

cl::Event TextureRun::launch(cl::Kernel& kernel, int columns, int rows) {
  cl::Event event;
  queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(columns, rows), cl::NDRange(1, 1), nullptr, &event);
  return event;
}

cl::Event TextureRun::launch_blocks(cl::Kernel& kernel) { return launch(kernel, params_.blocks_x, params_.blocks_y); }

void TextureRun::prepare() {
  cl::Kernel kernel(plan_.image_program, "texture_prepare");
  set_arguments(kernel, params_,                                                                                  //
                images_.buffer(TextureImage::light), images_.layout(TextureImage::light),                         //
                images_.buffer(TextureImage::albedo), images_.layout(TextureImage::albedo),                       //
                images_.buffer(TextureImage::mask), images_.layout(TextureImage::mask),                           //
                images_.buffer(TextureImage::stretch_u), images_.layout(TextureImage::stretch_u),                 //
                images_.buffer(TextureImage::stretch_v), images_.layout(TextureImage::stretch_v), memory_.light,  //
                memory_.objects, memory_.light_lit, memory_.finest, memory_.counters);
  prepare_.push_back(launch_blocks(kernel));
  if (plan_.is_recursive()) return;
  cl::Kernel along_u(plan_.pass_program, "texture_runs_u");
  set_arguments(along_u, params_, memory_.objects, memory_.runs[0], memory_.runs[1]);
  prepare_.push_back(launch(along_u, params_.height));
  cl::Kernel along_v(plan_.pass_program, "texture_runs_v");
  set_arguments(along_v, params_, memory_.objects, memory_.runs[2], memory_.runs[3]);
  prepare_.push_back(launch(along_v, parts(params_.width, plan_.vector_width)));
}

void TextureRun::scatter() {
  if (plan_.is_recursive()) {
    recurse();
  } else {
    blur();
  }
}

void TextureRun::blur() {
  const double mm_per_texel = plan_.description.stretch ? 0 : static_cast<double>(params_.mm_per_texel);
  const BlurTables tables = make_blur_tables(plan_.chain, mm_per_texel);
  const cl::Buffer weights = upload(context_, tables.weights);
  for (std::size_t k = 0; k < tables.blurs.size() / 3; ++k) {
    const cl::Buffer level = upload(context_, std::span(tables.blurs).subspan(3 * k, 3));
    for (const int down : {0, 1}) {
      const TextureImage stretch = down == 0 ? TextureImage::stretch_u : TextureImage::stretch_v;
      cl::Kernel kernel(plan_.pass_program, "texture_blur");
      set_arguments(kernel, params_, level, weights, down, images_.buffer(stretch), images_.layout(stretch),
                    memory_.runs[2 * down], memory_.runs[2 * down + 1], memory_.finest, memory_.light_lit,
                    memory_.light, memory_.between_lit, memory_.between, memory_.last_lit, memory_.last, memory_.sum,
                    memory_.counters);
      scatter_.push_back(launch_blocks(kernel));
      parts_ += static_cast<std::int64_t>(memory_.sizes.blocks());
    }
  }
}

void TextureRun::recurse() {
  const double mm_per_texel = plan_.description.stretch ? 0 : static_cast<double>(params_.mm_per_texel);
  const std::array<params::PoleParams, 2> tables = make_pole_tables(plan_.recursion, mm_per_texel);
  const int lines_per_item = plan_.device.info().type == "GPU" ? 1 : 8;
  for (const int down : {0, 1}) {
    const cl::Buffer poles = upload(context_, std::span(tables).subspan(down, 1));
    const TextureImage stretch = down == 0 ? TextureImage::stretch_u : TextureImage::stretch_v;
    const int lines = down == 0 ? params_.height : params_.width;
    cl::Kernel kernel(plan_.pass_program, down == 0 ? "recurse_u" : "recurse_v");
    set_arguments(kernel, params_, poles, images_.buffer(stretch), images_.layout(stretch),
                  down == 0 ? memory_.light : memory_.between, down == 0 ? memory_.between : memory_.sum,
                  lines_per_item, memory_.counters);
    scatter_.push_back(launch(kernel, parts(lines, lines_per_item)));
    parts_ += lines;
  }
}

void TextureRun::finish() {
  const auto writes = [&](TextureImage image) { return images_.has(image) ? 1 : 0; };
  cl::Kernel kernel(plan_.image_program, "texture_finish");
  set_arguments(kernel, params_,                                                                                //
                images_.buffer(TextureImage::light), images_.layout(TextureImage::light),                       //
                images_.buffer(TextureImage::albedo), images_.layout(TextureImage::albedo),                     //
                images_.buffer(TextureImage::mask), images_.layout(TextureImage::mask),                         //
                images_.buffer(TextureImage::stretch_u), images_.layout(TextureImage::stretch_u),               //
                images_.buffer(TextureImage::stretch_v), images_.layout(TextureImage::stretch_v), memory_.sum,  //
                images_.buffer(TextureImage::scattered), images_.layout(TextureImage::scattered),
                writes(TextureImage::scattered),  //
                images_.buffer(TextureImage::result), images_.layout(TextureImage::result),
                writes(TextureImage::result));
  finish_.push_back(launch_blocks(kernel));
}

void TextureRun::add_to(TextureStats& stats) const {
  std::array<cl_int, TEXTURE_COUNTERS> counters{};
  queue_.enqueueReadBuffer(memory_.counters, CL_TRUE, 0, sizeof(counters), counters.data());
  stats.texels += static_cast<std::int64_t>(params_.width) * params_.height;
  stats.texels_empty += counters[COUNTER_EMPTY_TEXELS];
  stats.parts += parts_;
  stats.parts_empty += counters[COUNTER_EMPTY_PARTS];
  stats.parts_unlit += counters[COUNTER_UNLIT_PARTS];
  stats.prepare_ms += milliseconds(prepare_);
  stats.scatter_ms += milliseconds(scatter_);
  stats.finish_ms += milliseconds(finish_);
}

}  // namespace dermis
