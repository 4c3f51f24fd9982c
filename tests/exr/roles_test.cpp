#include <algorithm>
#include <cstring>

#include "dermis/exr.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

using dermis::ErrorCode;
using dermis::Format;
using dermis::exr::ChannelSum;
using dermis::exr::find_roles;
using dermis::exr::Picture;
using dermis::exr::Role;
using dermis::exr::Roles;
using Names = std::vector<std::string>;

namespace {

Picture picture_of(const Names& names) {
  Picture picture({0, 0, 2, 2}, {0, 0, 2, 2});
  picture.add_channels(names, Format::f32);
  return picture;
}

Names of(const std::string& prefix, const std::string& endings) {
  Names names;
  for (const char ending : endings) {
    names.push_back(prefix + '.' + ending);
  }
  return names;
}

Names operator+(Names a, const Names& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Returns the channels of a Cycles view layer, by the names of one version.
Names view_layer(const std::string& layer, bool blender_5) {
  const auto pass = [&](const char* up_to_4, const char* from_5) {
    return layer + '.' + (blender_5 ? from_5 : up_to_4);
  };
  return of(pass("Combined", "Combined"), "RGBA") + of(pass("DiffDir", "Diffuse Direct"), "RGB") +
         of(pass("DiffInd", "Diffuse Indirect"), "RGB") + of(pass("DiffCol", "Diffuse Color"), "RGB") +
         of(pass("GlossDir", "Glossy Direct"), "RGB") + of(pass("GlossInd", "Glossy Indirect"), "RGB") +
         of(pass("GlossCol", "Glossy Color"), "RGB") + of(pass("Depth", "Depth"), "Z") + of(pass("Mist", "Mist"), "Z") +
         of(pass("Position", "Position"), "XYZ") + of(pass("Normal", "Normal"), "XYZ") +
         of(pass("Denoising Normal", "Denoising Normal"), "XYZ") + of(pass("IndexMA", "Material Index"), "X") +
         of(pass("IndexOB", "Object Index"), "X") + of(pass("CryptoMaterial00", "CryptoMaterial00"), "rgba");
}

void require_role(const Roles& roles, Role role, const ChannelSum& expected) {
  INFO(dermis::exr::name_of(role));
  REQUIRE(roles[role] == expected);
}

void require_view_layer(const Roles& roles, const std::string& layer, bool blender_5) {
  const auto name = [&](const char* up_to_4, const char* from_5) {
    return layer + '.' + (blender_5 ? from_5 : up_to_4);
  };
  REQUIRE(roles.layer == layer);
  require_role(roles, Role::light,
               {of(name("DiffDir", "Diffuse Direct"), "RGB"), of(name("DiffInd", "Diffuse Indirect"), "RGB")});
  require_role(roles, Role::albedo, {of(name("DiffCol", "Diffuse Color"), "RGB")});
  require_role(roles, Role::depth, {of(layer + ".Depth", "Z")});
  require_role(roles, Role::position, {of(layer + ".Position", "XYZ")});
  require_role(roles, Role::normal, {of(layer + ".Normal", "XYZ")});
  require_role(roles, Role::material, {of(name("IndexMA", "Material Index"), "X")});
  require_role(roles, Role::specular,
               {of(name("GlossDir", "Glossy Direct"), "RGB"), of(name("GlossInd", "Glossy Indirect"), "RGB")});
  require_role(roles, Role::beauty, {of(layer + ".Combined", "RGB")});
  REQUIRE_FALSE(roles.has(Role::mask));
}

Failure finding(const Picture& picture, const Names& overrides, std::string_view layer = {}) {
  return failure_of([&] { find_roles(picture, overrides, layer); });
}

}  // namespace

TEST_CASE("the passes of Cycles are found by the names of both eras, in layers of any name") {
  for (const char* layer : {"ViewLayer", "View Layer.001", "a.b c.DiffDir", "Depth"}) {
    for (const bool blender_5 : {false, true}) {
      require_view_layer(find_roles(picture_of(view_layer(layer, blender_5))), layer, blender_5);
    }
  }
}

TEST_CASE("names are matched in any case") {
  const Roles roles = find_roles(picture_of({"vl.diffdir.r", "vl.DIFFDIR.G", "vl.DiffDir.B", "vl.DEPTH.z"}));
  require_role(roles, Role::light, {{"vl.diffdir.r", "vl.DIFFDIR.G", "vl.DiffDir.B"}});
  require_role(roles, Role::depth, {{"vl.DEPTH.z"}});
}

TEST_CASE("the layer is the first with diffuse light, or the one asked for") {
  const Picture picture = picture_of(of("Sky.Combined", "RGB") + view_layer("Back", false) + view_layer("front", true));
  require_view_layer(find_roles(picture), "Back", false);
  require_view_layer(find_roles(picture, {}, "front"), "front", true);
  require_view_layer(find_roles(picture, {}, "FRONT"), "front", true);
  REQUIRE(find_roles(picture, {}, "Sky").layer == "Sky");
  REQUIRE_FALSE(find_roles(picture, {}, "Sky").has(Role::light));
  const Failure unknown = finding(picture, {}, "middle");
  REQUIRE(unknown.code == ErrorCode::role_missing);
  REQUIRE(unknown.says("Sky, Back, front"));

  const Picture alike = picture_of(view_layer("A", false) + view_layer("a", false));
  require_view_layer(find_roles(alike, {}, "a"), "a", false);
  require_view_layer(find_roles(alike, {}, "A"), "A", false);
}

TEST_CASE("passes may stand outside layers") {
  const Names passes = of("DiffDir", "RGB") + of("DiffCol", "RGB") + of("Position", "RGB") + Names{"IndexMA.V"};
  const Roles plain = find_roles(picture_of(Names{"R", "G", "B", "A"} + passes + Names{"Depth.V", "mask"}));
  REQUIRE(plain.layer.empty());
  require_role(plain, Role::light, {of("DiffDir", "RGB")});
  require_role(plain, Role::beauty, {{"R", "G", "B"}});
  require_role(plain, Role::position, {of("Position", "RGB")});
  require_role(plain, Role::depth, {{"Depth.V"}});
  require_role(plain, Role::material, {{"IndexMA.V"}});
  require_role(plain, Role::mask, {{"mask"}});
  for (const char* depth : {"Z", "z", "Depth.Z", "depth.Z", "depth"}) {
    require_role(find_roles(picture_of(passes + Names{depth})), Role::depth, {{depth}});
  }
  // A layer's own passes go before those outside.
  const Names layered = of("L.DiffDir", "RGB") + Names{"L.Depth.Z", "Z", "R", "G", "B", "Mask.R"};
  const Roles mixed = find_roles(picture_of(layered));
  REQUIRE(mixed.layer == "L");
  require_role(mixed, Role::depth, {{"L.Depth.Z"}});
  require_role(mixed, Role::beauty, {{"R", "G", "B"}});
  require_role(mixed, Role::mask, {{"Mask.R"}});
}

TEST_CASE("the mask has several names") {
  for (const char* name : {"L.mask.X", "L.Mask.R", "L.MASK.Y", "L.mask.V", "L.mask", "mask", "Mask.V"}) {
    INFO(name);
    require_role(find_roles(picture_of(of("L.DiffDir", "RGB") + Names{name})), Role::mask, {{name}});
  }
  REQUIRE_FALSE(find_roles(picture_of(of("L.DiffDir", "RGB") + Names{"L.unmask.X", "L.mask2.X"})).has(Role::mask));
}

TEST_CASE("half a group is no role") {
  REQUIRE_FALSE(find_roles(picture_of({"L.DiffDir.R", "L.DiffDir.G"})).has(Role::light));
  REQUIRE_FALSE(find_roles(picture_of({"X", "Y", "Z"})).has(Role::beauty));
}

TEST_CASE("overrides name channels, prefixes and sums") {
  const Picture picture =
      picture_of(view_layer("L", false) + of("my.light", "RGB") + of("V", "XYZ") + Names{"wax", "id.X"});
  const auto found = [&](const std::string& text) { return find_roles(picture, Names{text}); };
  require_role(found("light=my.light"), Role::light, {of("my.light", "RGB")});
  require_role(found("light=my.light.R, my.light.G ,my.light.B"), Role::light, {of("my.light", "RGB")});
  require_role(found("Light = L.DiffDir + MY.light"), Role::light, {of("L.DiffDir", "RGB"), of("my.light", "RGB")});
  require_role(found("normal=V"), Role::normal, {of("V", "XYZ")});
  require_role(found("mask=wax"), Role::mask, {{"wax"}});
  require_role(found("material=id"), Role::material, {{"id.X"}});
  require_role(found("depth=L.Mist.Z"), Role::depth, {{"L.Mist.Z"}});
  require_role(found("mask=wax"), Role::light, {of("L.DiffDir", "RGB"), of("L.DiffInd", "RGB")});
}

TEST_CASE("malformed overrides are usage errors, unknown channels missing roles") {
  const Picture picture = picture_of(view_layer("L", false));
  for (const char* text :
       {"light", "", "=L.DiffDir", "lamp=L.DiffDir", "light=", "light=L.DiffDir+", "light=L.DiffDir.R",
        "light=L.DiffDir.R,L.DiffDir.G", "depth=L.Depth.Z,L.Depth.Z,L.Depth.Z", "light=,,"}) {
    INFO(text);
    REQUIRE(finding(picture, {text}).code == ErrorCode::usage);
  }
  REQUIRE(finding(picture, {"lamp=x"})
              .says("light, albedo, depth, position, normal, material, mask, matte, specular, beauty"));
  for (const char* text : {"light=nope", "light=L.DiffDir.R,L.DiffDir.G,nope", "depth=L.DiffDir.Q", "depth=nope"}) {
    INFO(text);
    const Failure failure = finding(picture, {text});
    REQUIRE(failure.code == ErrorCode::role_missing);
    REQUIRE(failure.says("L.GlossInd.G"));
    REQUIRE(failure.says(std::string(text).substr(0, 5)));
  }
}

TEST_CASE("load sums the groups of a role pixel by pixel") {
  Random random(11);
  Picture picture({0, 0, 7, 5}, {0, 0, 7, 5});
  picture.add_channels(of("L.DiffDir", "RGB"), Format::f32);
  picture.add_channels(of("L.DiffInd", "RGB") + Names{"L.Depth.Z"}, Format::f32);
  std::vector<std::vector<float>> planes;
  for (const dermis::exr::Channel& channel : picture.channels()) {
    const dermis::OutputImage view = picture.view_to_write(Names{channel.name});
    std::vector<float>& plane = planes.emplace_back();
    for (int i = 0; i < 35; ++i) {
      plane.push_back(static_cast<float>(random.uniform(-2, 2)));
      std::memcpy(static_cast<std::byte*>(view.host) + view.layout.offset + i * view.layout.pixel_stride, &plane.back(),
                  4);
    }
  }
  const Roles roles = find_roles(picture);
  std::vector<float> expected;
  for (std::size_t i = 0; i < 35; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      expected.push_back(planes[c][i] + planes[3 + c][i]);
    }
  }
  REQUIRE(load(picture, roles, Role::light) == expected);
  REQUIRE(load(picture, roles, Role::depth) == planes[6]);
  REQUIRE(load(picture, roles, Role::mask).empty());
  Roles wrong = roles;
  wrong[Role::light][1].pop_back();
  REQUIRE(failure_of([&] { load(picture, wrong, Role::light); }).code == ErrorCode::usage);
}

TEST_CASE("a required role that is missing is named, with the channels there are") {
  const Picture picture = picture_of(of("L.DiffDir", "RGB") + Names{"odd\nname"});
  const Roles roles = find_roles(picture);
  REQUIRE_FALSE(failure_of([&] { require(picture, roles, Role::light); }).code);
  const Failure failure = failure_of([&] { require(picture, roles, Role::depth); });
  REQUIRE(failure.code == ErrorCode::role_missing);
  REQUIRE(failure.says("depth: "));
  REQUIRE(failure.says("L.DiffDir.R, L.DiffDir.G, L.DiffDir.B, odd\\x0aname"));
  REQUIRE(failure.says("--role depth="));
}

TEST_CASE("a Cycles file has all roles but the mask") {
  const Picture picture = Picture::read(std::filesystem::path(DERMIS_DATA) / "monkey_gbuffer.exr");
  const Roles roles = find_roles(picture);
  require_view_layer(roles, "ViewLayer", false);
  const std::vector<float> material = load(picture, roles, Role::material);
  for (const float id : {0.0F, 1.0F, 2.0F, 3.0F}) {
    REQUIRE(std::count(material.begin(), material.end(), id) > 1000);
  }
}
