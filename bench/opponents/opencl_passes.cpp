#include "opponents/opencl_passes.hpp"

#include "dermis/error.hpp"

namespace dermis::bench {

namespace {

template <class Work>
auto with_device_errors(const Work& work) {
  try {
    return work();
  } catch (const cl::Error& error) {
    throw Error(ErrorCode::device, error.what(), "OpenCL error " + std::to_string(error.err()), "success");
  }
}

cl::Buffer upload(const cl::Context& context, std::vector<float>& values) {
  return {context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, values.size() * sizeof(float), values.data()};
}

std::vector<float> interleaved(const Scene& scene) {
  const std::size_t plane = scene.pixels();
  std::vector<float> pixels(4 * plane);
  for (std::size_t i = 0; i < plane; ++i) {
    for (std::size_t c = 0; c < 3; ++c) pixels[4 * i + c] = scene.light[c * plane + i];
    pixels[4 * i + 3] = scene.depth[i];
  }
  return pixels;
}

}  // namespace

OpenclPasses::OpenclPasses(const std::string& source, const PassTaps& taps, float falloff, const Scene& scene,
                           const Device& device)
    : scene_(scene), context_(device.context(), true) {
  with_device_errors([&] {
    const cl::Device cl_device(device.id(), true);
    queue_ = cl::CommandQueue(context_, cl_device);
    std::vector<float> pixels = interleaved(scene);
    light_ = upload(context_, pixels);
    between_ = cl::Buffer(context_, CL_MEM_READ_WRITE, pixels.size() * sizeof(float));
    scattered_ = cl::Buffer(context_, CL_MEM_READ_WRITE, pixels.size() * sizeof(float));
    std::vector<float> packed;
    for (std::size_t i = 0; i < taps.weights.size(); ++i) {
      packed.insert(packed.end(), taps.weights[i].begin(), taps.weights[i].end());
      packed.push_back(static_cast<float>(taps.offsets_mm[i]));
    }
    taps_ = upload(context_, packed);
    cl::Program program(context_, source);
    program.build(cl_device, "-cl-fast-relaxed-math");
    // Perspective: px_per_mm is that at depth 1 and falls as 1 / depth.
    const int falls = scene.camera.projection == Camera::Projection::perspective ? 1 : 0;
    const auto pass = [&](const cl::Buffer& from, const cl::Buffer& to, int step_x, int step_y) {
      cl::Kernel kernel(program, "pass");
      cl_uint index = 0;
      const auto set = [&](const auto&... arguments) { (kernel.setArg(index++, arguments), ...); };
      set(from, to, taps_, static_cast<int>(taps.weights.size()), scene.spec.width, scene.spec.height, step_x, step_y,
          static_cast<float>(scene.px_per_mm()), falls, static_cast<float>(scene.mm_per_unit), falloff);
      return kernel;
    };
    along_x_ = pass(light_, between_, 1, 0);
    along_y_ = pass(between_, scattered_, 0, 1);
  });
}

void OpenclPasses::run() {
  with_device_errors([&] {
    const cl::NDRange pixels(scene_.spec.width, scene_.spec.height);
    queue_.enqueueNDRangeKernel(along_x_, cl::NullRange, pixels);
    queue_.enqueueNDRangeKernel(along_y_, cl::NullRange, pixels);
    queue_.finish();
  });
}

std::vector<float> OpenclPasses::result() {
  const std::size_t plane = scene_.pixels();
  std::vector<float> pixels(4 * plane);
  with_device_errors(
      [&] { queue_.enqueueReadBuffer(scattered_, CL_TRUE, 0, pixels.size() * sizeof(float), pixels.data()); });
  std::vector<float> planes(3 * plane);
  for (std::size_t i = 0; i < plane; ++i) {
    for (std::size_t c = 0; c < 3; ++c) planes[c * plane + i] = pixels[4 * i + c];
  }
  return planes;
}

}  // namespace dermis::bench
