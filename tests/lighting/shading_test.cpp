// Diffuse light and highlights equal the oracle, keep energy, and do not depend on how they are computed.
#include "dermis/shading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "dermis/error.hpp"
#include "dermis/oracle/lighting.hpp"
#include "lighting/random_lights.hpp"
#include "support/catch.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Format;
using dermis::Light;
using dermis::Shading;
using dermis::ShadingFrame;
using dermis::ShadingOptions;

namespace {

ShadingOptions random_options(Random& random) {
  ShadingOptions options;
  if (random.integer(0, 3) != 0) {
    options.lobes.clear();
    for (int i = random.integer(1, 2); i > 0; --i)
      options.lobes.push_back({random.uniform(0.05, 0.6), random.uniform(0.05, 0.25)});
  }
  options.reflectance = random.uniform(0.02, 0.2);
  options.normal_offset_texels = random.uniform(0, 2);
  options.softness_texels = random.coin() ? 0 : random.uniform(0.1, 3);
  return options;
}

struct Case {
  int width, height;
  RandomSurface surface;
  GuardedImage light, seen, specular, beauty;
  std::vector<RandomLight> sources;
  std::vector<Light> lights;
  ShadingOptions options;
  dermis::Viewer viewer;

  Case(Random& random, int its_width, int its_height, bool gaps)
      : width(its_width),
        height(its_height),
        surface(random, width, height, gaps),
        light(width, height, 3, Format::f32, gaps ? &random : nullptr),
        seen(width, height, 3, Format::f32, gaps ? &random : nullptr),
        specular(width, height, 3, Format::f32, gaps ? &random : nullptr),
        beauty(width, height, 3, Format::f32, gaps ? &random : nullptr),
        sources(random_lights(random, width > 10 ? 4 : random.integer(1, 4), gaps, true)),
        options(random_options(random)) {
    if (random.coin()) {
      viewer = {Camera::Projection::orthographic, {random.uniform(-1, 1), random.uniform(-1, 1), -2}};
    } else {
      viewer = {Camera::Projection::perspective, {random.uniform(-9, 9), random.uniform(-9, 9), 30}};
    }
  }

  /// Adds a light without shadows that what is level mirrors to the viewer, and makes the first lobe so wide that a
  /// quarter of any wave of the surface shines.
  void add_highlight(Random& random) {
    const auto& [x, y, z] = viewer.place;
    const double side = viewer.projection == Camera::Projection::perspective ? 1 : -1;  // a place, or where to
    sources.push_back({Light{.direction = {side * x, side * y, -side * z}, .colour = {1, 1, 1}}, {}});
    options.lobes.resize(std::max<std::size_t>(options.lobes.size(), 1));
    options.lobes[0] = {random.uniform(0.3, 0.6), 0.25};
  }

  ShadingFrame frame() {
    lights = all_of(sources);
    return {.width = width,
            .height = height,
            .position = surface.position.image(),
            .normal = surface.normal.image(),
            .albedo = surface.albedo.image(),
            .viewer = viewer,
            .lights = lights,
            .light = light.output(),
            .seen = seen.output(),
            .specular = specular.output(),
            .beauty = beauty.output()};
  }
};

using Outputs = std::vector<std::vector<std::uint32_t>>;

Outputs run(const Device& device, Case& its) {
  Shading(device, its.options).run(its.frame());
  Outputs outputs;
  for (const GuardedImage* image : {&its.light, &its.seen, &its.specular, &its.beauty})
    outputs.push_back(bits_of(*image, its.width, its.height));
  return outputs;
}

/// One point at the origin, whose normal is along z.
struct Point {
  double light, seen, specular;
};

Point shade_point(const Shading& shading, const std::array<double, 3>& to_viewer, const std::vector<Light>& lights) {
  const std::array<float, 3> position{};
  const std::array<float, 3> normal{0, 0, 1};
  const std::array<float, 3> albedo{1, 1, 1};
  std::array<float, 3> light{};
  std::array<float, 3> seen{};
  std::array<float, 3> specular{};
  const dermis::Viewer viewer{Camera::Projection::orthographic, {-to_viewer[0], -to_viewer[1], -to_viewer[2]}};
  shading.run({.width = 1,
               .height = 1,
               .position = {.host = position.data()},
               .normal = {.host = normal.data()},
               .albedo = {.host = albedo.data()},
               .viewer = viewer,
               .lights = lights,
               .light = {.host = light.data()},
               .seen = {.host = seen.data()},
               .specular = {.host = specular.data()}});
  return {light[0], seen[0], specular[0]};
}

}  // namespace

TEST_CASE("lit frames are those of the oracle", "[shading]") {
  int touched = 0;
  int shining = 0;
  int loose = 0;
  int values = 0;
  for (unsigned salt = 0; salt < 3; ++salt) {
    Random random(880 + salt);
    constexpr std::pair<int, int> sizes[] = {{1, 1}, {43, 19}, {7, 5}};
    const int width = sizes[salt % 3].first;
    const int height = sizes[salt % 3].second;
    Case its(random, width, height, random.coin());
    if (width > 10) its.add_highlight(random);
    CAPTURE(test_seed(), salt);
    run(Device::open(), its);
    const auto expected = dermis::oracle::shade(its.frame(), its.options);
    const auto compare = [&](const GuardedImage& image, const dermis::oracle::Picture& value,
                             const dermis::oracle::Picture& bound, const char* name) {
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          touched += expected.touched(x, y) > 0 ? 1 : 0;
          for (int c = 0; c < 3; ++c) {
            ++values;
            loose += bound(x, y, c) > 1e-3 * (1 + value(x, y, c)) ? 1 : 0;
            if (std::abs(image.get(x, y, c) - value(x, y, c)) <= bound(x, y, c)) continue;
            CAPTURE(name, x, y, c, image.get(x, y, c), value(x, y, c), bound(x, y, c), its.lights.size());
            CHECK(false);
          }
        }
      }
      CHECK(image.guards_intact());
    };
    compare(its.light, expected.light, expected.light_bound, "light");
    compare(its.seen, expected.seen, expected.seen_bound, "seen");
    compare(its.specular, expected.specular, expected.specular_bound, "specular");
    for (const double value : expected.specular.values) shining += value > 1e-3 ? 1 : 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < 3; ++c) {
          const auto f = [&](const GuardedImage& image) { return static_cast<float>(image.get(x, y, c)); };
          CHECK(f(its.beauty) == f(its.light) * f(its.seen) + f(its.specular));
        }
      }
    }
  }
  CHECK(touched > 700);
  CHECK(shining > 20);
  CAPTURE(loose, values);
  CHECK(loose < 0.05 * values);
}

TEST_CASE("one lobe is that of the papers to 1e-5", "[shading]") {
  // The formulas are those of Beckmann, Schlick, and Kelemen and Szirmay-Kalos, in double precision.
  Random random(890);
  double worst = 0;
  int shining = 0;
  double m = 0;
  double f0 = 0;
  ShadingOptions options;
  std::optional<Shading> shading;
  for (int i = 0; i < 60; ++i) {
    if (i % 10 == 0) {
      m = random.uniform(0.05, 0.7);
      f0 = random.uniform(0.01, 0.5);
      options.lobes = {{m, 0.5}};
      options.reflectance = f0;
      shading.emplace(Device::open(), options);
    }
    // Half of the lights lie near the mirrored view.
    const auto direction = [](double theta, double phi) {
      return std::array{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    };
    const double view_theta = random.uniform(0, 1.4);
    const auto v = direction(view_theta, 0.3);
    const double around = i % 2 == 0 ? m : 1;
    const double light_theta = std::min(std::abs(view_theta + random.uniform(-around, around)), 1.45);
    const auto l = direction(light_theta, 0.3 + std::numbers::pi + random.uniform(-around, around));
    const std::array<double, 3> h{l[0] + v[0], l[1] + v[1], l[2] + v[2]};
    const double square = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
    const double cosine = h[2] / std::sqrt(square);
    const double tangent_squared = (h[0] * h[0] + h[1] * h[1]) / (h[2] * h[2]);
    const double lobe = 0.5 * std::exp(-tangent_squared / (m * m)) / (m * m * std::pow(cosine, 4));
    const double v_h = (v[0] * h[0] + v[1] * h[1] + v[2] * h[2]) / std::sqrt(square);
    const double expected = l[2] * (f0 + (1 - f0) * std::pow(1 - v_h, 5)) * lobe / square;
    const double peak = l[2] * (f0 + (1 - f0) * std::pow(1 - v_h, 5)) * 0.5 / (m * m) / square;
    const Light light{.direction = {-l[0], -l[1], -l[2]}};
    const Point point = shade_point(*shading, v, {light});
    const double rho = dermis::oracle::reflected_share(options, l[2]);
    CAPTURE(m, f0, view_theta, light_theta, expected, point.specular);
    CHECK(std::abs(point.specular - expected) <= 1e-5 * peak);
    CHECK(std::abs(point.light - l[2] * (1 - rho)) <= 1e-5);
    worst = std::max(worst, std::abs(point.specular - expected) / peak);
    shining += expected > 0.01 * peak ? 1 : 0;
  }
  CHECK(shining > 20);
  CHECK(worst > 0);
  const Point dull = shade_point(Shading(Device::open(), {.lobes = {}}), {0, 0, 1}, {Light{.direction = {0, 0, -1}}});
  CHECK(dull.light == 1);
  CHECK(dull.seen == 1);
  CHECK(dull.specular == 0);
}

TEST_CASE("a white surface under white light from all sides is white", "[shading]") {
  // Lights lie at the nodes of a grid over the hemisphere, which is the midpoint rule in the angle and around. Under a
  // grazing view lobes are as narrow around as 2 m cos, which for 0.05 and 0.1 is 1.1 times the distance of two nodes.
  constexpr int rings = 120;
  constexpr int turns = 360;  // They cover one half, as the view is symmetric.
  constexpr double least_cosine = 0.1;
  constexpr double ring = std::numbers::pi / 2 / rings;
  std::vector<Light> lights;
  for (int i = 0; i < rings; ++i) {
    const double theta = (i + 0.5) * ring;
    const double solid_angle = std::sin(theta) * ring * 2 * std::numbers::pi / turns;
    for (int k = 0; k < turns; ++k) {
      const double phi = std::numbers::pi * (k + 0.5) / turns;
      // For a radiance of 1 the irradiance is the solid angle, and the colour is 1 / pi of it.
      const double colour = solid_angle / std::numbers::pi;
      lights.push_back(
          {.direction = {-std::sin(theta) * std::cos(phi), -std::sin(theta) * std::sin(phi), -std::cos(theta)},
           .colour = {colour, colour, colour}});
    }
  }
  Random random(895);
  ShadingOptions strong;
  strong.lobes = {{0.1, 0.5}, {0.4, 0.4}};
  strong.reflectance = 0.3;
  // The points lie on a plane, each seen under another angle by an eye at (0, 0, 1).
  constexpr int points = 16;
  std::vector<double> cosine;
  std::vector<float> position(3 * points);
  std::vector<float> normal(3 * points);
  for (int i = 0; i < points; ++i) {
    cosine.push_back(i == 0 ? 1 : random.uniform(least_cosine, 1));
    position[3 * i] = static_cast<float>(-std::sqrt(1 - cosine[i] * cosine[i]) / cosine[i]);
    normal[3 * i + 2] = 1;
  }
  const std::vector<float> albedo(3 * points, 1);
  for (const ShadingOptions& options : {ShadingOptions{}, strong}) {
    std::vector<float> beauty(3 * points);
    std::vector<float> specular(3 * points);
    Shading(Device::open(), options)
        .run({.width = points,
              .height = 1,
              .position = {.host = position.data()},
              .normal = {.host = normal.data()},
              .albedo = {.host = albedo.data()},
              .viewer = {Camera::Projection::perspective, {0, 0, 1}},
              .lights = lights,
              .specular = {.host = specular.data()},
              .beauty = {.host = beauty.data()}});
    double most = 0;
    for (int i = 0; i < points; ++i) {
      CAPTURE(cosine[i], beauty[3 * i], specular[3 * i]);
      CHECK(beauty[3 * i] <= 1 + 1e-3);  // This covers the midpoint rule and 43200 roundings.
      CHECK(beauty[3 * i] == Approx(1).epsilon(0.02));
      CHECK(specular[3 * i] == Approx(dermis::oracle::reflected_share(options, cosine[i])).epsilon(0.02));
      most = std::max(most, static_cast<double>(specular[3 * i]));
    }
    CHECK(most > 0.03);
  }
}

TEST_CASE("lit frames do not depend on how they are computed", "[shading]") {
  constexpr int width = 257;
  constexpr int height = 89;
  const Device device = Device::open();
  const auto make = [] {
    Random random(900);
    return Case(random, width, height, true);
  };
  Case its = make();
  CAPTURE(test_seed());
  const Outputs expected = run(device, its);
  CHECK(expected[0] != expected[2]);

  SECTION("run twice") { CHECK(run(device, its) == expected); }

  SECTION("any number of threads") {
    for (int threads = 1; threads <= device.info().compute_units; ++threads) {
      CHECK(run(Device::open({}, threads), its) == expected);
    }
  }

  SECTION("any strides") {
    Case other = make();
    Random gaps(901);
    for (GuardedImage* image : {&other.surface.position, &other.surface.normal, &other.surface.albedo, &other.light,
                                &other.seen, &other.specular, &other.beauty}) {
      GuardedImage moved(width, height, 3, image->layout().format, &gaps);
      copy_values(*image, moved, width, height);
      *image = moved;
    }
    CHECK(run(device, other) == expected);
    CHECK(other.beauty.guards_intact());
  }

  SECTION("the albedo in place") {
    GuardedImage albedo(width, height, 3, Format::f32);
    copy_values(its.surface.albedo, albedo, width, height);
    ShadingFrame frame = its.frame();
    frame.albedo = albedo.image();
    frame.seen = albedo.output();
    Shading(device, its.options).run(frame);
    int changed = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < 3; ++c) {
          // Where nothing is lit the output keeps its values, which are the albedo or 0.
          const bool is_lit = its.seen.get(x, y, c) != 0;
          if (is_lit) CHECK(albedo.bits(x, y, c) == its.seen.bits(x, y, c));
          changed += is_lit ? 1 : 0;
        }
      }
    }
    CHECK(changed > width * height);
  }

  SECTION("some of the outputs") {
    ShadingFrame frame = its.frame();
    frame.light = frame.seen = frame.specular = {};
    GuardedImage beauty(width, height, 3, Format::f32);
    frame.beauty = beauty.output();
    Shading(device, its.options).run(frame);
    CHECK(bits_of(beauty, width, height) == expected[3]);
  }
}

TEST_CASE("what is not lit keeps its bits", "[shading]") {
  Random random(910);
  constexpr int width = 37;
  constexpr int height = 21;
  Case its(random, width, height, true);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        its.beauty.set(x, y, c, 17);
        if (x < width / 2) its.surface.normal.set(x, y, c, 0);
      }
    }
  }
  run(Device::open(), its);
  int changed = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (x < width / 2) CHECK(its.beauty.get(x, y, 1) == 17);
      changed += its.beauty.get(x, y, 1) != 17 ? 1 : 0;
    }
  }
  CHECK(changed > 100);
}

TEST_CASE("malformed calls of Shading are refused", "[shading]") {
  const auto refuses = [&](const auto& spoil, const std::string& part) {
    Random random(920);
    Case its(random, 5, 4, false);
    ShadingFrame frame = its.frame();
    spoil(its, frame);
    INFO(part);
    try {
      Shading(Device::open(), its.options).run(frame);
      CHECK(false);
    } catch (const dermis::Error& error) {
      INFO(error.what());
      CHECK(std::string(error.what()).find(part) != std::string::npos);
    }
    CHECK(bits_of(its.beauty, 5, 4) == std::vector<std::uint32_t>(60));
  };
  refuses([](Case& c, auto&) { c.options.lobes = std::vector<dermis::SpecularLobe>(5, {0.1, 0.1}); }, "lobes: got 5");
  refuses([](Case& c, auto&) { c.options.lobes = {{0.01, 0.1}}; }, "roughness: got 0.01");
  refuses([](Case& c, auto&) { c.options.lobes = {{0.1, -1}}; }, "weight: got -1");
  refuses(
      [](Case& c, auto&) {
        c.options = {.lobes = {{0.3, 2}}, .reflectance = 1};
      },
      "lobes: got weights that reflect");
  refuses([](Case& c, auto&) { c.options.reflectance = 2; }, "reflectance: got 2");
  refuses([](Case& c, auto&) { c.options.normal_offset_texels = -1; }, "normal_offset_texels: got -1");
  refuses([](Case& c, auto&) { c.options.softness_texels = 17; }, "softness_texels: got 17");
  refuses([](Case&, auto& f) { f.normal = {}; }, "normal: got no image");
  refuses([](Case&, auto& f) { f.light = f.seen = f.specular = f.beauty = {}; }, "outputs: got none");
  refuses([](Case&, auto& f) { f.lights = {}; }, "lights: got none");
  refuses([](Case&, auto& f) { f.light = f.beauty; }, "light: got memory of beauty");
  refuses([](Case&, auto& f) { f.viewer.place[1] = std::nan(""); }, "viewer: got");
  refuses([](Case&, auto& f) { f.viewer = {Camera::Projection::orthographic, {0, 0, 0}}; }, "viewer direction length");
}
