// dermis texture: what is written, and what is refused.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using dermis::exr::Picture;
using Words = std::vector<std::string>;

namespace {

constexpr int width = 60;
constexpr int height = 40;

/// A layout with a chart on its left half, a shadow edge on it, positions on a card whose texels span 0.5 mm by 1 mm.
std::string make_layout(const TemporaryFolder& folder) {
  const dermis::exr::Window window{0, 0, width, height};
  Picture picture(window, window);
  const Words names = {"bake.R", "bake.G", "bake.B", "skin.R", "skin.G", "skin.B",
                       "card.X", "card.Y", "card.Z", "charts", "su",     "sv"};
  picture.add_channels(names, dermis::Format::f32);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string one[] = {names[k]};
    const dermis::OutputImage image = picture.view_to_write(one);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const bool chart = x < width / 2;
        const float values[] = {chart ? (y < height / 2 ? 1.0F : 0.0F) : 5.0F,
                                0.5F,
                                0.05F * static_cast<float>(x),
                                chart ? 1.0F : 0.0F,
                                0.5F,
                                1.0F};
        const int kind = k < 3 ? 0 : k < 6 ? 1 : k == 6 ? 2 : k < 9 ? -1 : static_cast<int>(k) - 6;
        const float value = kind >= 0 ? values[kind] : k == 7 ? 0.1F * static_cast<float>(y) : 0;
        auto* at = static_cast<std::byte*>(image.host) + image.layout.offset + y * image.layout.row_stride +
                   x * image.layout.pixel_stride;
        *reinterpret_cast<float*>(at) = value;
      }
    }
  }
  const std::string path = folder / "layout.exr";
  picture.write(path);
  return path;
}

Words command(const std::string& input, const std::string& output, const Words& more) {
  Words words = {"texture", input, "-o", output, "--profile", "skin", "--role", "light=bake", "--role", "mask=charts"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("a texture is scattered by stretches, by positions, and by the millimetre") {
  const TemporaryFolder folder;
  const std::string input = make_layout(folder);
  for (const std::string method : {"gaussians", "recursive"}) {
    const std::string by_roles = folder / "roles.exr";
    const std::string by_positions = folder / "positions.exr";
    const std::string by_mm = folder / "mm.exr";
    run_well(
        command(input, by_roles,
                {"--method", method, "--role", "stretch_u=su", "--role", "stretch_v=sv", "--role", "albedo=skin"}));
    run_well(command(input, by_positions,
                     {"--method", method, "--role", "position=card", "--mm-per-unit", "10", "--albedo-mix", "0"}));
    run_well(command(input, by_mm, {"--method", method, "--mm-per-texel", "1"}));
    const Picture roles = Picture::read(by_roles);
    const Picture positions = Picture::read(by_positions);
    const Picture mm = Picture::read(by_mm);
    CAPTURE(method);
    for (const char* c : {"R", "G", "B"}) {
      const std::vector<float> light = roles.plane(std::string("bake.") + c);
      const std::vector<float> scattered = roles.plane(std::string("sss.") + c);
      const std::vector<float> from_positions = positions.plane(std::string("sss.") + c);
      const std::vector<float> from_mm = mm.plane(std::string("sss.") + c);
      const std::vector<float> with_albedo = roles.plane(std::string("sss_albedo.") + c);
      CHECK(scattered != light);
      int spread = 0;
      for (std::size_t i = 0; i < light.size(); ++i) {
        const bool chart = i % width < width / 2;
        // Light varies along v only, where all three say 1 mm; positions are rounded to float32.
        CHECK(std::abs(scattered[i] - from_positions[i]) < 1e-5F);
        CHECK(std::abs(scattered[i] - from_mm[i]) < 2e-4F);
        CHECK(with_albedo[i] == (chart ? 0.5F * scattered[i] : light[i]));
        if (!chart) CHECK(scattered[i] == 5);
        if (chart && scattered[i] > 0.001F && scattered[i] < 0.999F) ++spread;
      }
      CHECK(spread > width / 2);
    }
    CHECK(positions.find("sss_albedo.R") == nullptr);
  }
}

TEST_CASE("what a texture's filter did") {
  const TemporaryFolder folder;
  const std::string output =
      run_well(command(make_layout(folder), folder / "out.exr", {"--mm-per-texel", "1", "--stats-json", "-"}));
  const nlohmann::json stats = nlohmann::json::parse(output);
  CHECK(stats["method"] == "gaussians");
  CHECK(stats["stretch"] == "--mm-per-texel");
  CHECK(stats["texels"] == width * height);
  CHECK(stats["texels_empty"] == width * height / 2);
  CHECK(stats["predicted_rel_l2"].get<double>() < 1e-3);
  CHECK(run_well(command(make_layout(folder), folder / "out.exr", {"--mm-per-texel", "1", "--stats"}))
            .find("texels_empty") != std::string::npos);
}

TEST_CASE("a renderer's own pass sss is kept beside that of a texture") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 40, 30, 4);
  const std::vector<float> theirs(std::size_t{40} * 30, 0.25F);
  PictureCopy(scene.path).with("ViewLayer.sss.R", theirs).write(scene.path);
  const Outcome outcome =
      run_program({"texture", scene.path, "-o", folder / "out.exr", "--profile", "skin", "--mm-per-texel", "0.25"});
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.errors == "dermis: note: ViewLayer.sss: this pass is the renderer's; ours is ViewLayer.sss_dermis\n");
  const Picture out = Picture::read(folder / "out.exr");
  CHECK(out.plane("ViewLayer.sss.R") == theirs);
  CHECK(out.plane("ViewLayer.sss_dermis.R") != theirs);
  check_refused(run_program({"texture", scene.path, "-o", folder / "lossy.exr", "--profile", "skin", "--mm-per-texel",
                             "0.25", "--compression", "dwaa"}),
                2, {"--compression"});
}

TEST_CASE("what makes no sense of a texture is refused") {
  const TemporaryFolder folder;
  const std::string input = make_layout(folder);
  const std::string output = folder / "out.exr";
  const auto refused = [&](const Words& more, int code, const Words& parts) {
    check_refused(run_program(command(input, output, more)), code, parts);
  };
  refused({}, 2, {"--mm-per-texel: got nothing"});
  refused({"--mm-per-texel", "0"}, 2, {"--mm-per-texel", "1e-9..1e9"});
  refused({"--mm-per-texel", "1", "--mm-per-unit", "1"}, 2, {"--mm-per-texel: got it with --mm-per-unit"});
  refused({"--mm-per-texel", "1", "--role", "stretch_u=su"}, 2, {"--mm-per-texel", "stretch_u"});
  refused({"--role", "stretch_u=su"}, 5, {"stretch_v"});
  refused({"--mm-per-unit", "1"}, 5, {"position"});
  refused({"--mm-per-texel", "1", "--method", "separable"}, 2,
          {"--method: got separable, want gaussians or recursive"});
  for (const Words& of_the_screen : std::vector<Words>{{"--taps", "17"},
                                                       {"--quality", "final"},
                                                       {"--fov", "30"},
                                                       {"--cryptomatte", "head=1"},
                                                       {"--seed", "7"},
                                                       {"--translucency"},
                                                       {"--lights", "l.json"},
                                                       {"--samples", "9"},
                                                       {"--prefilter"}}) {
    Words more = {"--mm-per-texel", "1"};
    more.insert(more.end(), of_the_screen.begin(), of_the_screen.end());
    refused(more, 2, {of_the_screen.front()});
  }
  refused({"--mm-per-texel", "1", "--albedo-mix", "0.82"}, 5, {"albedo"});
  const Words of_the_screen = {"filter", input, "-o", output, "--profile", "skin", "--mm-per-unit", "1"};
  const auto screen_refuses = [&](const Words& more, const Words& parts) {
    Words words = of_the_screen;
    words.insert(words.end(), more.begin(), more.end());
    check_refused(run_program(words), 2, parts);
  };
  screen_refuses({"--method", "recursive"}, {"--method: got recursive, want separable or exact or disc"});
  screen_refuses({"--mm-per-texel", "1"}, {"--mm-per-texel"});
  screen_refuses({"--space", "texture"}, {"--space"});
  check_refused(run_program({"texture", input, "-o", output, "--mm-per-texel", "1"}), 2, {"--profile"});
  CHECK_THROWS(Picture::read(output));
}
