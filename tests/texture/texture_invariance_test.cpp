// Ways of computing that must not change a single bit of a scattered texture.
#include <cmath>
#include <future>
#include <utility>

#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "texture/random_texture.hpp"

using dermis::Device;
using dermis::TextureDescription;
using dermis::TextureFrame;
using dermis::TextureMethod;
using dermis::TexturePlan;

namespace {

constexpr int width = 157;
constexpr int height = 89;

/// The device may turn a NaN into any other one when it converts to half.
std::vector<std::uint32_t> bits_of(const GuardedImage& image) {
  std::vector<std::uint32_t> bits;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < image.channels(); ++c) {
        bits.push_back(std::isnan(image.get(x, y, c)) ? ~0U : image.bits(x, y, c));
      }
    }
  }
  return bits;
}

struct Outputs {
  std::vector<std::uint32_t> scattered, result;
  bool operator==(const Outputs&) const = default;
};

Outputs run(const Device& device, RandomTexture& texture) {
  const TextureFrame frame = texture.frame();
  TexturePlan(device, texture.profile, TextureDescription::of(frame), texture.options).run(frame);
  return {bits_of(*texture.scattered), bits_of(*texture.result)};
}

void copy_values(const GuardedImage& from, GuardedImage& to) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < from.channels(); ++c) to.set(x, y, c, from.get(x, y, c));
    }
  }
}

}  // namespace

TEST_CASE("a scattered texture does not depend on how it is computed", "[texture][invariance]") {
  const TextureMethod method = GENERATE(TextureMethod::gaussians, TextureMethod::recursive);
  const bool stretch = GENERATE(true, false);
  const Device device = Device::open();
  Random random(1100);
  RandomTexture texture(
      random, {.width = width, .height = height, .method = method, .charts = true, .stretch = stretch, .albedo = true});
  CAPTURE(test_seed(), static_cast<int>(method), stretch);
  const Outputs expected = run(device, texture);
  CHECK(expected.scattered != bits_of(*texture.light));

  SECTION("run twice, any threads, any vectors, any strides") {
    CHECK(run(device, texture) == expected);
    for (int threads = 1; threads <= device.info().compute_units; ++threads) {
      CAPTURE(threads);
      CHECK(run(Device::open({}, threads), texture) == expected);
    }
    for (const int vector_width : {1, 4, 8, 16}) {
      CAPTURE(vector_width);
      CHECK(run(with_kernel_shape(device, vector_width, "CPU"), texture) == expected);
    }
    CHECK(run(with_kernel_shape(device, 1, "GPU"), texture) == expected);

    for (unsigned salt = 0; salt < 2; ++salt) {
      Random other_random(1110 + salt);
      RandomTexture other = texture;
      for (auto image : {&RandomTexture::light, &RandomTexture::albedo, &RandomTexture::mask, &RandomTexture::stretch_u,
                         &RandomTexture::stretch_v, &RandomTexture::scattered, &RandomTexture::result}) {
        std::optional<GuardedImage>& moved = other.*image;
        if (!moved) continue;
        moved.emplace(width, height, moved->channels(), moved->layout().format, salt == 0 ? nullptr : &other_random);
        copy_values(*(texture.*image), *moved);
      }
      CHECK(run(device, other) == expected);
    }
  }

  SECTION("in place") {
    RandomTexture other = texture;
    other.scattered.emplace(width, height, 3, other.light->layout().format);
    other.result.emplace(width, height, 3, other.albedo->layout().format);
    const Outputs apart = run(device, other);
    TextureFrame in_place = other.frame();
    in_place.scattered = other.light->output();
    in_place.result = other.albedo->output();
    TexturePlan(device, other.profile, TextureDescription::of(in_place), other.options).run(in_place);
    CHECK(bits_of(*other.light) == apart.scattered);
    CHECK(bits_of(*other.albedo) == apart.result);
  }

  SECTION("buffers") {
    const cl::Context context(device.context(), true);
    const cl::CommandQueue queue(context, cl::Device(device.id(), true));
    TextureFrame in_buffers = texture.frame();
    std::vector<cl::Buffer> buffers;
    const auto move_in = [&](std::optional<GuardedImage>& image, auto& view) {
      if (!image) return;
      buffers.emplace_back(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, image->memory().size(),
                           const_cast<std::byte*>(image->memory().data()));
      view.host = nullptr;
      view.buffer = buffers.back()();
    };
    move_in(texture.light, in_buffers.light);
    move_in(texture.albedo, in_buffers.albedo);
    move_in(texture.mask, in_buffers.mask);
    move_in(texture.stretch_u, in_buffers.stretch_u);
    move_in(texture.stretch_v, in_buffers.stretch_v);
    for (auto image : {&RandomTexture::scattered, &RandomTexture::result}) {
      GuardedImage cleared = *(texture.*image);
      for (int i = 0; i < 3 * width * height; ++i) cleared.set(i / 3 % width, i / 3 / width, i % 3, 0);
      buffers.emplace_back(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, cleared.memory().size(),
                           const_cast<std::byte*>(cleared.memory().data()));
    }
    const cl::Buffer scattered = buffers[buffers.size() - 2];
    const cl::Buffer result = buffers.back();
    in_buffers.scattered = {.buffer = scattered(), .layout = texture.scattered->layout()};
    in_buffers.result = {.buffer = result(), .layout = texture.result->layout()};
    TexturePlan(device, texture.profile, TextureDescription::of(in_buffers), texture.options).run(in_buffers);
    const auto same_bytes = [&](const cl::Buffer& buffer, const GuardedImage& image) {
      std::vector<std::byte> bytes(image.memory().size());
      queue.enqueueReadBuffer(buffer, CL_TRUE, 0, bytes.size(), bytes.data());
      return bytes == image.memory();
    };
    CHECK(same_bytes(scattered, *texture.scattered));
    CHECK(same_bytes(result, *texture.result));
  }
}

TEST_CASE("threads may share a plan for textures", "[texture][sharing]") {
  const TextureMethod method = GENERATE(TextureMethod::gaussians, TextureMethod::recursive);
  Random random(1120);
  RandomTexture first(random, {.width = width, .height = height, .method = method, .charts = true, .stretch = false});
  RandomTexture second = first;
  second.mm_per_texel *= 2;
  const TexturePlan plan(Device::open(), first.profile, TextureDescription::of(first.frame()), first.options);
  plan.run(first.frame());
  plan.run(second.frame());
  const auto expected = std::pair(bits_of(*first.scattered), bits_of(*second.scattered));
  CHECK(expected.first != expected.second);
  const auto run_often = [&plan](RandomTexture& texture, const std::vector<std::uint32_t>& its) {
    int different = 0;
    for (int round = 0; round < 4; ++round) {
      plan.run(texture.frame());
      if (bits_of(*texture.scattered) != its) ++different;
    }
    return different;
  };
  auto other = std::async(std::launch::async, [&] { return run_often(second, expected.second); });
  CHECK(run_often(first, expected.first) == 0);
  CHECK(other.get() == 0);
}
