// Transmitted light equals the oracle and does not depend on how it is computed, and bad calls are refused.
#include "dermis/translucency.hpp"

#include <cmath>
#include <limits>

#include "dermis/error.hpp"
#include "dermis/oracle/lighting.hpp"
#include "lighting/random_lights.hpp"
#include "opencl/opencl.hpp"
#include "support/catch.hpp"

using dermis::Device;
using dermis::Format;
using dermis::Lighting;
using dermis::Material;
using dermis::Profile;
using dermis::Translucency;
using dermis::TranslucencyFrame;
using dermis::TranslucencyOptions;

namespace {

/// A frame, its lights, and the arguments for them.
struct Case {
  int width, height;
  RandomSurface surface;
  GuardedImage light, material, lit;
  std::optional<GuardedImage> mask, thickness, beauty, result;
  std::vector<RandomLight> sources;
  std::vector<dermis::Light> lights;
  std::vector<Material> materials;
  TranslucencyOptions options;
  double mm_per_unit = 1;

  Case(Random& random, int its_width, int its_height, bool gaps, bool everything = false)
      : width(its_width),
        height(its_height),
        surface(random, width, height, gaps),
        light(width, height, 3, random.coin() ? Format::f32 : Format::f16, gaps ? &random : nullptr),
        material(width, height, 1, random.coin() ? Format::f32 : Format::u8, gaps ? &random : nullptr),
        lit(width, height, 3, Format::f32, gaps ? &random : nullptr),
        sources(random_lights(random, width > 10 ? 6 : random.integer(1, 4), gaps)) {
    Random* strides = gaps ? &random : nullptr;
    if (everything || random.coin()) mask.emplace(width, height, 1, Format::f32, strides);
    if (everything || random.coin()) thickness.emplace(width, height, 1, Format::f32, strides);
    if (everything || random.coin()) {
      beauty.emplace(width, height, 3, Format::f32, strides);
      result.emplace(width, height, 3, Format::f32, strides);
    }
    mm_per_unit = std::exp(random.uniform(-1, 1));
    const double mm = 4 * mm_per_unit;
    materials = {{3, Profile::burley({0.3 * mm, 0.2 * mm, 0.1 * mm})},
                 {7, Profile::gaussians({{mm * mm, {1, 2, 3}}, {0.1 * mm * mm, {1, 1, 0}}})},
                 {200, Profile::burley_cycles({9 * mm, 5 * mm, 3 * mm})}};
    options.lighting = random.coin() ? Lighting::lit : Lighting::raw;
    options.softness_texels = random.coin() ? 0 : random.uniform(0.1, 3);
    options.thickness_scale = random.uniform(0.5, 2);
    options.shrink_units = random.uniform(0, 0.1);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) fill_pixel(random, x, y);
    }
  }

  void fill_pixel(Random& random, int x, int y) {
    constexpr int ids[] = {3, 7, 200, 0};
    material.set(x, y, 0, ids[random.integer(0, 3)]);
    for (int c = 0; c < 3; ++c) {
      light.set(x, y, c, random.uniform(0, 2));
      if (beauty) beauty->set(x, y, c, random.uniform(0, 2));
    }
    if (random.integer(0, 60) == 0) light.set(x, y, 1, std::numeric_limits<double>::infinity());
    if (mask) mask->set(x, y, 0, random.integer(0, 9) == 0 ? 0 : random.uniform(0.1, 1.1));
    if (thickness) {
      thickness->set(x, y, 0, random.integer(0, 9) == 0 ? -1 : random.uniform(0, 2 * mm_per_unit));
      if (random.integer(0, 60) == 0) thickness->set(x, y, 0, std::numeric_limits<double>::infinity());
    }
  }

  TranslucencyFrame frame() {
    lights = all_of(sources);
    TranslucencyFrame frame{.width = width,
                            .height = height,
                            .light = light.image(),
                            .albedo = surface.albedo.image(),
                            .position = surface.position.image(),
                            .normal = surface.normal.image(),
                            .material = material.image(),
                            .mm_per_unit = mm_per_unit,
                            .lights = lights,
                            .lit = lit.output()};
    if (mask) frame.mask = mask->image();
    if (thickness) frame.thickness = thickness->image();
    if (beauty) frame.beauty = beauty->image();
    if (result) frame.result = result->output();
    return frame;
  }
};

struct Outputs {
  std::vector<std::uint32_t> lit, result;
  bool operator==(const Outputs&) const = default;
};

Outputs run(const Device& device, Case& its) {
  const TranslucencyFrame frame = its.frame();
  Translucency(device, its.materials, frame.description(), its.options).run(frame);
  return {bits_of(its.lit, its.width, its.height),
          its.result ? bits_of(*its.result, its.width, its.height) : std::vector<std::uint32_t>{}};
}

std::vector<dermis::oracle::Slab> slabs_of(const std::vector<Material>& materials) {
  std::vector<dermis::oracle::Slab> slabs;
  for (const Material& material : materials) {
    slabs.push_back({material.id, material.profile.albedo_width(),
                     [profile = material.profile](int c, double s) { return profile.transmittance(c, s); }});
  }
  return slabs;
}

Case full_case(unsigned salt, int width, int height, bool gaps) {
  Random random(salt);
  return {random, width, height, gaps, true};
}

}  // namespace

TEST_CASE("transmitted light is that of the oracle", "[translucency]") {
  double worst_bound = 0;
  int loose = 0;
  int values = 0;
  int touched = 0;
  for (unsigned salt = 0; salt < 4; ++salt) {
    Random random(810 + salt);
    constexpr std::pair<int, int> sizes[] = {{1, 1}, {37, 19}, {7, 5}, {37, 19}};
    const auto [width, height] = sizes[salt];
    // Light comes through the last one wherever a light shines, as its thickness image holds where no map does.
    const bool everything = salt == 3;
    Case its(random, width, height, random.coin(), everything);
    CAPTURE(test_seed(), salt);
    run(Device::open(), its);
    const auto expected = dermis::oracle::transmit(its.frame(), slabs_of(its.materials), its.options);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        touched += expected.touched(x, y) > 0 ? 1 : 0;
        for (int c = 0; c < 3; ++c) {
          ++values;
          const double bound = expected.lit_bound(x, y, c);
          if (expected.touched(x, y) == 0 && bound == 0) {
            CHECK((its.lit.get(x, y, c) == its.light.get(x, y, c) || std::isnan(its.light.get(x, y, c))));
            continue;
          }
          if (!(std::abs(its.lit.get(x, y, c) - expected.lit(x, y, c)) <= bound)) {
            CAPTURE(x, y, c, its.lit.get(x, y, c), expected.lit(x, y, c), bound, its.light.get(x, y, c));
            CHECK(false);
          }
          if (its.result &&
              !(std::abs(its.result->get(x, y, c) - expected.result(x, y, c)) <= expected.result_bound(x, y, c))) {
            CAPTURE(x, y, c, its.result->get(x, y, c), expected.result(x, y, c));
            CHECK(false);
          }
          loose += bound > 1e-3 * (1 + expected.lit(x, y, c)) ? 1 : 0;
          if (std::isfinite(bound)) worst_bound = std::max(worst_bound, bound);
        }
      }
    }
    CHECK(its.lit.guards_intact());
  }
  CHECK(touched > 80);
  // Bounds are loose where float32 cannot tell which texel is nearest, or whether a point lies on the map.
  CAPTURE(loose, values, worst_bound);
  CHECK(loose < 0.02 * values);
}

TEST_CASE("transmitted light does not depend on how it is computed", "[translucency]") {
  constexpr int width = 257;
  constexpr int height = 89;
  const Device device = Device::open();
  Case its = full_case(830, width, height, true);
  CAPTURE(test_seed());
  const Outputs expected = run(device, its);
  CHECK(expected.lit != bits_of(its.light, width, height));
  CHECK(expected.result != bits_of(*its.beauty, width, height));

  SECTION("run twice") { CHECK(run(device, its) == expected); }

  SECTION("any number of threads") {
    for (int threads = 1; threads <= device.info().compute_units; ++threads) {
      CHECK(run(Device::open({}, threads), its) == expected);
    }
  }

  SECTION("any strides") {
    Case other = full_case(830, width, height, true);
    Random gaps(831);
    const auto replace = [&](GuardedImage& image) {
      GuardedImage moved(width, height, image.channels(), image.layout().format, &gaps);
      copy_values(image, moved, width, height);
      image = moved;
    };
    for (GuardedImage* image :
         {&other.light, &other.material, &other.lit, &other.surface.position, &other.surface.normal,
          &other.surface.albedo, &*other.mask, &*other.thickness, &*other.beauty, &*other.result}) {
      replace(*image);
    }
    CHECK(run(device, other) == expected);
    CHECK(other.lit.guards_intact());
    CHECK(other.result->guards_intact());
  }

  SECTION("buffers, of the maps too") {
    const cl::Context context(device.context(), true);
    std::vector<cl::Buffer> buffers;
    const auto move_in = [&](const GuardedImage& image, auto& view) {
      buffers.emplace_back(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, image.memory().size(),
                           const_cast<std::byte*>(image.memory().data()));
      view.host = nullptr;
      view.buffer = buffers.back()();
      return buffers.back();
    };
    TranslucencyFrame frame = its.frame();
    move_in(its.light, frame.light);
    move_in(its.surface.albedo, frame.albedo);
    move_in(its.surface.position, frame.position);
    move_in(its.surface.normal, frame.normal);
    move_in(its.material, frame.material);
    move_in(*its.mask, frame.mask);
    move_in(*its.thickness, frame.thickness);
    move_in(*its.beauty, frame.beauty);
    const cl::Buffer lit = move_in(its.lit, frame.lit);
    const cl::Buffer result = move_in(*its.result, frame.result);
    for (std::size_t i = 0; i < its.lights.size(); ++i)
      if (its.sources[i].map) move_in(*its.sources[i].map, its.lights[i].map.depth);
    const cl::CommandQueue queue(context, cl::Device(device.id(), true));
    for (const cl::Buffer& output : {lit, result})
      queue.enqueueFillBuffer(output, cl_uchar{0}, 0, output.getInfo<CL_MEM_SIZE>());
    queue.finish();
    Translucency(device, its.materials, frame.description(), its.options).run(frame);
    const auto written = [&](const cl::Buffer& buffer, const GuardedImage& like) {
      GuardedImage read = like;
      auto* bytes = const_cast<std::byte*>(read.memory().data());
      queue.enqueueReadBuffer(buffer, CL_TRUE, 0, read.memory().size(), bytes);
      return bits_of(read, width, height);
    };
    CHECK(written(lit, its.lit) == expected.lit);
    CHECK(written(result, *its.result) == expected.result);
  }

  SECTION("in place") {
    GuardedImage light(width, height, 3, Format::f32);
    copy_values(its.light, light, width, height);
    TranslucencyFrame frame = its.frame();
    frame.light = light.image();
    frame.lit = light.output();
    frame.result = its.beauty->output();
    Translucency(device, its.materials, frame.description(), its.options).run(frame);
    CHECK(bits_of(light, width, height) == expected.lit);
    CHECK(bits_of(*its.beauty, width, height) == expected.result);
  }
}

TEST_CASE("pixels that nothing comes through keep their bits", "[translucency]") {
  Random random(840);
  constexpr int width = 41;
  constexpr int height = 23;
  Case its(random, width, height, true, true);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) its.material.set(x, y, 0, x < width / 2 ? 0 : 7);
  }
  its.lit = GuardedImage(width, height, 3, its.light.layout().format, &random);
  run(Device::open(), its);
  int changed = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const bool same =
            its.lit.bits(x, y, c) == its.light.bits(x, y, c) && its.result->bits(x, y, c) == its.beauty->bits(x, y, c);
        if (x < width / 2) CHECK(same);
        changed += same ? 0 : 1;
      }
    }
  }
  CHECK(changed > 100);
}

TEST_CASE("the light of two lights is the sum of each one's", "[translucency]") {
  Random random(850);
  constexpr int width = 33;
  constexpr int height = 17;
  Case its(random, width, height, false, true);
  its.sources.clear();
  for (int i = 0; i < 2; ++i) {
    // The first of some random lights is from behind.
    its.sources.push_back(random_lights(random, 1).front());
    its.sources.back().light.colour = {1, 1, 1};
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) its.light.set(x, y, c, 0);
    }
  }
  const auto one_by_one = its.sources;
  run(Device::open(), its);
  const GuardedImage both = its.lit;
  std::vector<GuardedImage> each;
  for (const RandomLight& source : one_by_one) {
    its.sources = {source};
    run(Device::open(), its);
    each.push_back(its.lit);
  }
  int lit = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double sum = each[0].get(x, y, c) + each[1].get(x, y, c);
        // The sum of both is rounded, and with it the product with the albedo; alone each product with the albedo is
        // rounded, and the one with the irradiance too if the device fuses it with the sum of both.
        CHECK(std::abs(both.get(x, y, c) - sum) <= 4 * 0x1p-24 * sum);
        lit += each[0].get(x, y, c) > 0 && each[1].get(x, y, c) > 0 ? 1 : 0;
      }
    }
  }
  CHECK(lit > 100);
}

TEST_CASE("a slab lit from behind shows what its thickness lets through", "[translucency]") {
  // The map of a directional light sees the back of a slab, the frame its front. Slab and light are tilted at random.
  Random random(860);
  const Profile profile = dermis::preset("skin").profile;
  for (int i = 0; i < 6; ++i) {
    const double thickness_units = random.uniform(0.02, 0.3);
    const double mm_per_unit = random.uniform(2, 10);
    const double tilt = random.uniform(0, 1);
    // The front at z = 0 is seen from z > 0. Light comes from below, where the back lies at z = -thickness.
    const dermis::Light bare{.direction = {std::sin(tilt), 0, std::cos(tilt)},
                             .position = {-20 * std::sin(tilt), 0, -20 * std::cos(tilt)}};
    constexpr int texels = 512;
    constexpr double half_units = 0.12;  // Texels are 1/50 of the thinnest slab, as T is not linear.
    // Each texel holds the depth of the back along the light, at the point right u + up v of its plane.
    dermis::Light light = bare;
    light.map.width = light.map.height = texels;
    light.map.view_projection = orthographic_map(light.direction, light.position, half_units, 60);
    std::vector<float> depth(texels * texels);
    const auto& m = light.map.view_projection;
    const double scale = half_units * half_units;
    for (int v = 0; v < texels; ++v) {
      for (int u = 0; u < texels; ++u) {
        const double right = 2 * (u + 0.5) / texels - 1;
        const double up = 1 - 2 * (v + 0.5) / texels;
        // This is z of the point that projects there, on the plane through the light's position.
        const double z = light.position[2] + (m[2] * right + m[6] * up) * scale;
        depth[v * texels + u] = static_cast<float>((-thickness_units - z) / light.direction[2]);
      }
    }
    light.map.depth = {.host = depth.data()};
    const std::vector<float> position = {0, 0, 0, 0.03F, -0.02F, 0, -0.05F, 0.04F, 0};
    const std::vector<float> normal = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    std::vector<float> lit(9);
    const TranslucencyFrame frame{.width = 3,
                                  .height = 1,
                                  .light = {.host = lit.data()},
                                  .position = {.host = position.data()},
                                  .normal = {.host = normal.data()},
                                  .mm_per_unit = mm_per_unit,
                                  .lights = std::span(&light, 1),
                                  .lit = {.host = lit.data()}};
    // The look-up a little below the surface shortens the way by shrink sin(tilt)^2 / cos(tilt).
    const TranslucencyOptions options{.shrink_units = 0.001 * thickness_units, .softness_texels = 0.5};
    Translucency(Device::open(), {{.profile = profile}}, frame.description(), options).run(frame);
    for (int p = 0; p < 3; ++p) {
      for (int c = 0; c < 3; ++c) {
        const double expected =
            (0.3 + std::cos(tilt)) * profile.transmittance(c, thickness_units * mm_per_unit / std::cos(tilt));
        CAPTURE(i, p, c, tilt, thickness_units, mm_per_unit);
        CHECK(lit[3 * p + c] == Approx(expected).epsilon(0.01).margin(1e-4));
      }
    }
    CHECK(lit[0] > 0.01);
  }
}

TEST_CASE("what a map does not show", "[translucency]") {
  // The frame is one point at the origin, whose normal faces away from the light.
  const std::vector<float> position = {0, 0, 0};
  const std::vector<float> normal = {0, 0, 1};
  const std::vector<float> thickness_mm = {0.5F};
  std::vector<float> depth = {std::numeric_limits<float>::infinity()};
  dermis::Light light{.direction = {0, 0, 1}, .position = {0, 0, -10}};
  light.map = {.depth = {.host = depth.data()}, .width = 1, .height = 1};
  light.map.view_projection = orthographic_map(light.direction, light.position, 1, 60);
  const Profile profile = Profile::burley({1, 1, 1});
  const auto lit = [&](bool with_thickness) {
    const std::vector<float> dark(3);
    std::vector<float> result(3);
    TranslucencyFrame frame{.width = 1,
                            .height = 1,
                            .light = {.host = dark.data()},
                            .position = {.host = position.data()},
                            .normal = {.host = normal.data()},
                            .lights = std::span(&light, 1),
                            .lit = {.host = result.data()}};
    if (with_thickness) frame.thickness = {.host = thickness_mm.data()};
    Translucency(Device::open(), {{.profile = profile}}, frame.description()).run(frame);
    return static_cast<double>(result[0]) / 1.3;
  };
  const auto at = [&](double mm) { return Approx(profile.transmittance(0, mm)).epsilon(1e-4); };
  SECTION("a texel without a surface: thickness 0, or that of the image") {
    for (const float value : {std::numeric_limits<float>::infinity(), 1e10F, std::nanf("")}) {
      depth[0] = value;
      CHECK(lit(false) == at(0));
      CHECK(lit(true) == at(0.5));
    }
  }
  SECTION("a surface behind the point counts as none, one before it as the other side") {
    depth[0] = 12;
    CHECK(lit(false) == at(0));
    depth[0] = 9.75F;
    CHECK(lit(false) == at(0.25));
    CHECK(lit(true) == at(0.5));  // The larger thickness counts.
    depth[0] = 9;
    CHECK(lit(true) == at(1));
  }
  SECTION("off the map nothing comes through, or what the image says") {
    depth[0] = 9.75F;
    light.position = {0, 5, -10};
    light.map.view_projection = orthographic_map(light.direction, light.position, 1, 60);
    CHECK(lit(false) == 0);
    CHECK(lit(true) == at(0.5));
  }
  SECTION("so too behind a light with a position") {
    light.kind = dermis::Light::Kind::point;
    light.position = {0, 0, -10};
    light.attenuation = {1, 0, 0};
    light.map.view_projection = perspective_map({0, 0, -1}, light.position, 1, 0.1, 60);
    CHECK(lit(false) == 0);
    CHECK(lit(true) == at(0.5));
    light.map.view_projection = perspective_map({0, 0, 1}, light.position, 1, 0.1, 60);
    depth[0] = 9.5F;
    CHECK(lit(false) == at(0.5));
  }
}

TEST_CASE("malformed calls of Translucency are refused", "[translucency]") {
  Case its = full_case(870, 5, 4, false);
  const Device device = Device::open();
  const auto refuses = [&](const auto& spoil, const std::string& part) {
    Case spoiled = full_case(870, 5, 4, false);
    TranslucencyFrame frame = spoiled.frame();
    const auto description = frame.description();
    std::vector<dermis::Light> lights(frame.lights.begin(), frame.lights.end());
    const auto before = bits_of(spoiled.lit, 5, 4);
    spoil(spoiled, frame, lights);
    frame.lights = lights;
    INFO(part);
    try {
      Translucency(device, spoiled.materials, description, spoiled.options).run(frame);
      CHECK(false);
    } catch (const dermis::Error& error) {
      INFO(error.what());
      CHECK(std::string(error.what()).find(part) != std::string::npos);
    }
    CHECK(bits_of(spoiled.lit, 5, 4) == before);
  };
  using Lights = std::vector<dermis::Light>;
  refuses([](Case& c, auto&, Lights&) { c.options.shrink_units = -1; }, "shrink_units: got -1");
  refuses([](Case& c, auto&, Lights&) { c.options.thickness_scale = 0; }, "thickness_scale: got 0");
  refuses([](Case& c, auto&, Lights&) { c.options.softness_texels = 17; }, "softness_texels: got 17");
  refuses([](Case& c, auto&, Lights&) { c.materials.clear(); }, "materials: got 0");
  refuses([](Case& c, auto&, Lights&) { c.materials[0].id = 7; }, "material id: got 7");
  refuses([](Case&, auto& f, Lights&) { f.light = {}; }, "light: got no image");
  refuses([](Case&, auto& f, Lights&) { f.mask = {}; }, "frame: got");
  refuses([](Case&, auto& f, Lights&) { f.lit = f.result = {}; }, "outputs: got none");
  refuses([](Case&, auto& f, Lights&) { f.beauty = {}; }, "beauty: got no image");
  refuses([](Case&, auto& f, Lights&) { f.mm_per_unit = 0; }, "mm_per_unit: got 0");
  refuses([](Case& c, auto& f, Lights&) { f.lit.host = const_cast<void*>(c.surface.position.image().host); }, "lit:");
  refuses([](Case&, auto&, Lights& l) { l.clear(); }, "lights: got none");
  refuses(
      [](Case&, auto&, Lights& l) {
        l[0].kind = dermis::Light::Kind::spot;
        l[0].cone_outer_deg = 0;
      },
      "lights[0] cone: got");
  refuses([](Case&, auto&, Lights& l) { l[0].colour[1] = -1; }, "lights[0] colour: got");
  refuses([](Case&, auto&, Lights& l) { l[0].position[1] = std::nan(""); }, "lights[0] position: got");
  refuses(
      [](Case&, auto&, Lights& l) {
        l[0].kind = dermis::Light::Kind::spot;
        l[0].direction = {};
      },
      "lights[0] direction: got");
  refuses(
      [](Case&, auto&, Lights& l) {
        l[0].kind = dermis::Light::Kind::point;
        l[0].attenuation = {};
      },
      "lights[0] attenuation: got");
  refuses([](Case&, auto&, Lights& l) { l[0].map.width = 0; }, "lights[0] map size: got 0x");
  refuses([](Case&, auto&, Lights& l) { l[0].map.bias_units = -1; }, "lights[0] map bias: got -1");
  refuses([](Case&, auto&, Lights& l) { l[0].map.view_projection = {}; }, "lights[0] view_projection: got");
  refuses(
      [](Case&, auto&, Lights& l) {
        l[0].kind = dermis::Light::Kind::directional;
        l[0].map.view_projection = perspective_map(l[0].direction, l[0].position, 1, 1, 9);
      },
      "got a perspective projection");
  refuses(
      [](Case&, auto&, Lights& l) {
        l[0].kind = dermis::Light::Kind::point;
        l[0].map.view_projection = orthographic_map({0, 0, 1}, l[0].position, 1, 9);
      },
      "got an orthographic projection");
  refuses(
      [](Case&, auto&, Lights& l) {
        l[0].kind = dermis::Light::Kind::point;
        l[0].map.view_projection = perspective_map({0, 0, 1}, {1, 2, 3}, 1, 1, 9);
      },
      "got an eye that is not at the light's position");
}
