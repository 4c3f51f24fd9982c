#include "opponents/opencl_passes.hpp"

#include <cstdint>

#include "dermis/error.hpp"

namespace dermis::bench {

namespace {

constexpr float background_depth = 1e10F;
constexpr std::uint16_t no_material = 65535;

// Without ids, which made scenes do not have, no kernel reads them: depth alone tells the background.
constexpr const char* materials_source = R"(
enum { no_material = 65535 };
#if HAS_IDS
int material_of(global const ushort* material, int pixel, float depth) { return material[pixel]; }
bool are_apart(global const ushort* material, int a, int b) { return material[a] != material[b]; }
#else
int material_of(global const ushort* material, int pixel, float depth) { return depth < 1e9f ? 0 : no_material; }
bool are_apart(global const ushort* material, int a, int b) { return false; }
#endif
)";

template <class Work>
auto with_device_errors(const Work& work) {
  try {
    return work();
  } catch (const cl::Error& error) {
    throw Error(ErrorCode::device, error.what(), "OpenCL error " + std::to_string(error.err()), "success");
  }
}

template <class Value>
cl::Buffer upload(const cl::Context& context, std::vector<Value> values) {
  return {context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, values.size() * sizeof(Value), values.data()};
}

std::vector<float> interleaved(const Scene& scene) {
  const std::size_t plane = scene.pixels();
  std::vector<float> pixels(4 * plane);
  for (std::size_t i = 0; i < plane; ++i) {
    for (std::size_t c = 0; c < 3; ++c) pixels[4 * i + c] = scene.light[scene.at(i, c)];
    pixels[4 * i + 3] = scene.is_background(i) ? background_depth : scene.depth[i];
  }
  return pixels;
}

std::vector<std::uint16_t> materials_of(const Scene& scene) {
  std::vector<std::uint16_t> materials(scene.pixels());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    materials[i] = static_cast<std::uint16_t>(scene.material_of(i).value_or(no_material));
  }
  return materials;
}

}  // namespace

OpenclPasses::OpenclPasses(const std::string& source, const std::vector<PassTaps>& taps, const Scene& scene,
                           const Device& device)
    : scene_(scene), context_(device.context(), true) {
  with_device_errors([&] {
    const cl::Device cl_device(device.id(), true);
    queue_ = cl::CommandQueue(context_, cl_device);
    std::vector<float> pixels = interleaved(scene);
    light_ = upload(context_, pixels);
    material_ = upload(context_, materials_of(scene));
    between_ = cl::Buffer(context_, CL_MEM_READ_WRITE, pixels.size() * sizeof(float));
    scattered_ = cl::Buffer(context_, CL_MEM_READ_WRITE, pixels.size() * sizeof(float));
    std::vector<float> packed, falloffs;
    for (const PassTaps& its : taps) {
      for (std::size_t i = 0; i < its.weights.size(); ++i) {
        packed.insert(packed.end(), its.weights[i].begin(), its.weights[i].end());
        packed.push_back(static_cast<float>(its.offsets_mm[i]));
      }
      falloffs.push_back(static_cast<float>(its.falloff));
    }
    taps_ = upload(context_, packed);
    falloffs_ = upload(context_, falloffs);
    cl::Program program(context_, materials_source + source);
    const std::string has_ids = scene.ids.empty() ? " -DHAS_IDS=0" : " -DHAS_IDS=1";
    program.build(cl_device, ("-cl-fast-relaxed-math" + has_ids).c_str());
    // Perspective: px_per_mm is that at depth 1 and falls as 1 / depth.
    const Camera& camera = scene.camera;
    const int falls = camera.projection == Camera::Projection::perspective ? 1 : 0;
    const int tap_count = static_cast<int>(taps.front().weights.size());
    const auto pass = [&](const cl::Buffer& from, const cl::Buffer& to, int step_x, int step_y) {
      cl::Kernel kernel(program, "pass");
      cl_uint index = 0;
      const auto set = [&](const auto&... arguments) { (kernel.setArg(index++, arguments), ...); };
      const double px_per_mm = (step_x > 0 ? camera.scale_x : camera.scale_y) / scene.mm_per_unit;
      set(from, to, material_, taps_, falloffs_, tap_count, scene.spec.width, scene.spec.height, step_x, step_y,
          static_cast<float>(px_per_mm), falls, static_cast<float>(scene.mm_per_unit));
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
