// What must not change a single bit of the result.
#include <cstring>
#include <filesystem>

#include "dermis/plan.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"
#include "support/temporary_folder.hpp"

using dermis::Device;
using dermis::Format;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Method;
using dermis::Options;
using dermis::Plan;

namespace {

constexpr int width = 257;
constexpr int height = 89;

/// A frame with everything in it.
RandomFrame full_frame(unsigned salt, bool gaps, double jitter) {
  for (unsigned attempt = 0;; ++attempt) {
    Random random(salt + 1000 * attempt);
    RandomFrame frame(random, {.width = width, .height = height, .with_gaps = gaps, .materials = 3, .jitter = jitter});
    if (!frame.result || !frame.normal) continue;
    frame.materials[0].profile = dermis::Profile::random_walk_cycles({20, 12, 8}, {0.8, 0.6, 0.4});
    return frame;
  }
}

std::vector<std::uint32_t> bits_of(const GuardedImage& image) {
  std::vector<std::uint32_t> bits;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < image.channels(); ++c) bits.push_back(image.bits(x, y, c));
    }
  }
  return bits;
}

struct Outputs {
  std::vector<std::uint32_t> scattered, result;
  std::vector<dermis::TileKind> blocks;  ///< none of discs
  bool operator==(const Outputs&) const = default;
};

Outputs run(const Device& device, RandomFrame& random_frame, const Options& options) {
  const Frame frame = random_frame.frame();
  const auto stats = Plan(device, random_frame.materials, FrameDescription::of(frame), options).run(frame);
  CHECK(stats.pixels_scattered > 500);
  return {bits_of(*random_frame.scattered), bits_of(*random_frame.result), stats.blocks.kinds};
}

void copy_values(const GuardedImage& from, GuardedImage& to) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < from.channels(); ++c) to.set(x, y, c, from.get(x, y, c));
    }
  }
}

}  // namespace

TEST_CASE("the result does not depend on how it is computed", "[invariance]") {
  const auto [jitter, method] =
      GENERATE(table<double, Method>({{0.0, Method::separable}, {0.4, Method::separable}, {0.0, Method::disc}}));
  const Device device = Device::open();
  RandomFrame frame = full_frame(600, true, jitter);
  frame.options.method = method;
  frame.options.disc = {.prefiltered = true, .accumulate = 2};
  CAPTURE(test_seed(), jitter, static_cast<int>(method));
  const Outputs expected = run(device, frame, frame.options);
  CHECK(expected.blocks.size() == (method == Method::disc ? 0 : (width + 15) / 16 * ((height + 15) / 16)));
  CHECK(expected.result != bits_of(*frame.beauty));

  SECTION("run twice") { CHECK(run(device, frame, frame.options) == expected); }

  SECTION("any tile size") {
    for (const auto& [tile_width, tile_height] : {std::pair{16, 1}, {16, 200}, {48, 7}, {272, 90}, {1024, 1}}) {
      Options options = frame.options;
      options.tile_width = tile_width;
      options.tile_height = tile_height;
      CAPTURE(tile_width, tile_height);
      CHECK(run(device, frame, options) == expected);
    }
  }

  SECTION("any number of threads") {
    for (int threads = 1; threads <= device.info().compute_units; ++threads) {
      CAPTURE(threads);
      CHECK(run(Device::open({}, threads), frame, frame.options) == expected);
    }
  }

  SECTION("any vector width, a tile or a pixel to a work-item") {
    for (const int vector_width : {1, 4, 8, 16}) {
      CAPTURE(vector_width);
      CHECK(run(with_kernel_shape(device, vector_width, "CPU"), frame, frame.options) == expected);
    }
    CHECK(run(with_kernel_shape(device, 1, "GPU"), frame, frame.options) == expected);
  }

  SECTION("any strides") {
    for (unsigned salt = 0; salt < 3; ++salt) {
      Random random(700 + salt);
      RandomFrame other = frame;
      for (auto image :
           {&RandomFrame::light, &RandomFrame::albedo, &RandomFrame::depth, &RandomFrame::material, &RandomFrame::mask,
            &RandomFrame::normal, &RandomFrame::beauty, &RandomFrame::scattered, &RandomFrame::result}) {
        std::optional<GuardedImage>& moved = other.*image;
        if (!moved) continue;
        moved.emplace(width, height, moved->channels(), moved->layout().format, salt == 0 ? nullptr : &random);
        copy_values(*(frame.*image), *moved);
      }
      CHECK(run(device, other, frame.options) == expected);
    }
  }

  SECTION("in place") {
    RandomFrame other = frame;
    other.scattered.emplace(width, height, 3, other.light->layout().format);
    other.result.emplace(width, height, 3, other.beauty->layout().format);
    const Outputs apart = run(device, other, frame.options);
    Frame in_place = other.frame();
    in_place.scattered = other.light->output();
    in_place.result = other.beauty->output();
    Plan(device, other.materials, FrameDescription::of(in_place), frame.options).run(in_place);
    CHECK(bits_of(*other.light) == apart.scattered);
    CHECK(bits_of(*other.beauty) == apart.result);
  }

  SECTION("buffers on the caller's queue") {
    cl::Context context(device.context(), true);
    cl::CommandQueue queue(context, cl::Device(device.id(), true), CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    const Device adopted = Device::adopt(context(), device.id());
    Frame in_buffers = frame.frame();
    std::vector<cl::Buffer> buffers;
    const auto move_in = [&](GuardedImage& image, auto& view) {
      buffers.emplace_back(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, image.memory().size(),
                           const_cast<std::byte*>(image.memory().data()));
      view.host = nullptr;
      view.buffer = buffers.back()();
    };
    move_in(*frame.light, in_buffers.light);
    move_in(*frame.depth, in_buffers.depth);
    move_in(*frame.material, in_buffers.material);
    if (frame.albedo) move_in(*frame.albedo, in_buffers.albedo);
    if (frame.mask) move_in(*frame.mask, in_buffers.mask);
    if (frame.matte) move_in(*frame.matte, in_buffers.matte);
    move_in(*frame.normal, in_buffers.normal);
    move_in(*frame.beauty, in_buffers.beauty);
    move_in(*frame.scattered, in_buffers.scattered);
    const cl::Buffer scattered = buffers.back();
    move_in(*frame.result, in_buffers.result);
    const cl::Buffer result = buffers.back();
    const Plan plan(adopted, frame.materials, FrameDescription::of(in_buffers), frame.options);

    cl::UserEvent gate(context);
    const cl_event wait_for[] = {gate()};
    const dermis::Event done = plan.enqueue(in_buffers, queue(), wait_for);
    CHECK(cl::Event(done.handle(), true).getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() > CL_COMPLETE);
    gate.setStatus(CL_COMPLETE);
    done.wait();

    const auto same_bytes = [&](const cl::Buffer& buffer, const GuardedImage& image) {
      std::vector<std::byte> bytes(image.memory().size());
      queue.enqueueReadBuffer(buffer, CL_TRUE, 0, bytes.size(), bytes.data());
      return bytes == image.memory();
    };
    CHECK(same_bytes(scattered, *frame.scattered));
    CHECK(same_bytes(result, *frame.result));
  }
}

TEST_CASE("kept taps do not matter", "[invariance]") {
  const TemporaryFolder folder;
  RandomFrame frame = full_frame(71, false, 0);
  for (dermis::Material& material : frame.materials) material.taps.reset();
  Options options = frame.options;
  options.method = Method::separable;
  options.taps = dermis::design_within(0.02);
  const Outputs fitted = run(Device::open(), frame, options);
  options.cache_folder = folder / "kept";
  CHECK(run(Device::open(), frame, options) == fitted);  // another device has no taps in memory
  CHECK(run(Device::open(), frame, options) == fitted);
  CHECK(std::filesystem::exists(options.cache_folder));
}
