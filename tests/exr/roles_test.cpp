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
  return failure_of([&] { find_roles(picture, {.overrides = overrides, .layer = std::string(layer)}); });
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
  require_view_layer(find_roles(picture, {.layer = "front"}), "front", true);
  require_view_layer(find_roles(picture, {.layer = "FRONT"}), "front", true);
  REQUIRE(find_roles(picture, {.layer = "Sky"}).layer == "Sky");
  REQUIRE_FALSE(find_roles(picture, {.layer = "Sky"}).has(Role::light));
  const Failure unknown = finding(picture, {}, "middle");
  REQUIRE(unknown.code == ErrorCode::role_missing);
  REQUIRE(unknown.says("Sky, Back, front"));

  const Picture alike = picture_of(view_layer("A", false) + view_layer("a", false));
  require_view_layer(find_roles(alike, {.layer = "a"}), "a", false);
  require_view_layer(find_roles(alike, {.layer = "A"}), "A", false);
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
  const auto found = [&](const std::string& text) { return find_roles(picture, {.overrides = {text}}); };
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
  for (const char* text : {"light", "", "=L.DiffDir", "lamp=L.DiffDir", "light=L.DiffDir+", "light=L.DiffDir.R",
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
    REQUIRE(failure.says("L.GlossInd.{R,G,B}"));
    REQUIRE(failure.says(std::string(text).substr(0, 5)));
  }
}

TEST_CASE("a role is unset by an override of nothing") {
  const Picture picture = picture_of(view_layer("L", false));
  REQUIRE(find_roles(picture).has(Role::depth));
  const Roles roles = find_roles(picture, {.overrides = {"depth=", "albedo= "}});
  REQUIRE_FALSE(roles.has(Role::depth));
  REQUIRE_FALSE(roles.has(Role::albedo));
  REQUIRE(roles.has(Role::light));
}

TEST_CASE("each renderer's passes are found by its table, with the light raw or lit as it writes it") {
  // Names as the documents of the renderers, and files of theirs, have them; not those of the tables.
  struct Written {
    std::string renderer;
    dermis::Lighting lighting;
    Names channels;
    ChannelSum light;
    ChannelSum albedo;
    Names without;  ///< roles that the picture does not have
  };
  const auto lit = dermis::Lighting::lit;
  const auto raw = dermis::Lighting::raw;
  const Names rgba = {"R", "G", "B", "A"};
  const std::vector<Written> all = {
      {"arnold",
       lit,
       rgba + of("diffuse_direct", "RGB") + of("diffuse_indirect", "RGB") + of("diffuse_albedo", "RGB") +
           of("specular_direct", "RGB") + Names{"Z"} + of("N", "XYZ") + of("P", "XYZ"),
       {of("diffuse_direct", "RGB"), of("diffuse_indirect", "RGB")},
       {of("diffuse_albedo", "RGB")},
       {"material"}},
      {"karma",
       lit,
       of("C", "RGBA") + of("diffuse_direct", "rgb") + of("diffuse_indirect", "rgb") + of("albedo", "rgb") +
           Names{"depth"} + of("N", "xyz") + of("P", "xyz"),
       {of("diffuse_direct", "rgb"), of("diffuse_indirect", "rgb")},
       {of("albedo", "rgb")},
       {"material"}},
      {"redshift",
       raw,
       rgba + of("DiffuseLightingRaw", "RGB") + of("GlobalIlluminationRaw", "RGB") + of("DiffuseFilter", "RGB") +
           Names{"Depth.Z", "ObjectID.R"} + of("Normals", "RGB"),
       {of("DiffuseLightingRaw", "RGB"), of("GlobalIlluminationRaw", "RGB")},
       {of("DiffuseFilter", "RGB")},
       {"position"}},
      {"vray",
       raw,
       rgba + of("VRayRawLighting", "RGB") + of("VRayRawGlobalIllumination", "RGB") + of("VRayDiffuseFilter", "RGB") +
           Names{"VRayZDepth.R", "VRayMtlID.R"} + of("VRayNormals", "XYZ"),
       {of("VRayRawLighting", "RGB"), of("VRayRawGlobalIllumination", "RGB")},
       {of("VRayDiffuseFilter", "RGB")},
       {"position"}},
      {"vray",
       raw,
       rgba + of("rawLight", "RGB") + of("rawGI", "RGB") + of("diffuse", "RGB") + Names{"zDepth.R", "mtlID.R"},
       {of("rawLight", "RGB"), of("rawGI", "RGB")},
       {of("diffuse", "RGB")},
       {"position", "normal"}},
      {"renderman",
       lit,
       rgba + of("diffuse", "rgb") + of("indirectdiffuse", "rgb") + of("albedo", "rgb") + Names{"z", "id"} +
           of("Nn", "xyz") + of("P", "xyz"),
       {of("diffuse", "rgb"), of("indirectdiffuse", "rgb")},
       {of("albedo", "rgb")},
       {}},
      {"unreal",
       raw,
       rgba + of("FinalImageMovieRenderQueue_DiffuseLighting", "RGBA") +
           of("FinalImageMovieRenderQueue_BaseColor", "RGBA") + of("FinalImageMovieRenderQueue_WorldDepth", "RGBA"),
       {of("FinalImageMovieRenderQueue_DiffuseLighting", "RGB")},
       {of("FinalImageMovieRenderQueue_BaseColor", "RGB")},
       {"position", "normal", "material"}},
      {"mitsuba",
       lit,
       of("path", "RGBA") + of("albedo", "RGB") + Names{"dd.T", "mat.I"} + of("pos", "XYZ") + of("nn", "XYZ"),
       {of("path", "RGB")},
       {of("albedo", "RGB")},
       {}},
      {"pbrt",
       lit,
       Names{"R", "G", "B", "dzdx", "dzdy"} + of("Albedo", "RGB") + of("P", "XYZ") + of("N", "XYZ"),
       {{"R", "G", "B"}},
       {of("Albedo", "RGB")},
       {"depth", "material"}},
  };
  for (const Written& written : all) {
    INFO(written.renderer);
    const Picture picture = picture_of(written.channels);
    const Roles roles = find_roles(picture);
    REQUIRE(roles.renderer == written.renderer);
    REQUIRE(roles.lighting == written.lighting);
    REQUIRE(roles.rules[static_cast<std::size_t>(Role::light)] == written.renderer);
    require_role(roles, Role::light, written.light);
    require_role(roles, Role::albedo, written.albedo);
    for (const Role role : {Role::depth, Role::position, Role::normal, Role::material}) {
      const std::string name(dermis::exr::name_of(role));
      INFO(name);
      const bool expected = std::find(written.without.begin(), written.without.end(), name) == written.without.end();
      REQUIRE(roles.has(role) == expected);
    }
    REQUIRE(roles.has(Role::beauty));
    // By its name it is found as well, in a picture that holds another renderer's passes too.
    const Picture both = picture_of(written.channels + view_layer("L", false));
    REQUIRE(find_roles(both).renderer == "blender");
    const dermis::exr::Renderer* renderer = dermis::exr::find_renderer(written.renderer);
    require_role(find_roles(both, {.renderer = renderer}), Role::light, written.light);
  }
}

TEST_CASE("a map of a studio's own names finds roles as a renderer's table does") {
  const dermis::exr::Renderer studio{.name = "studio",
                                     .lighting = dermis::Lighting::lit,
                                     .passes = {{Role::light, {"key_light"}},
                                                {Role::light, {"fill", "bounce"}},
                                                {Role::albedo, {"tex"}},
                                                {Role::material, {"mid"}}}};
  const Picture picture = picture_of(of("Shot.key_light", "RGB") + of("Shot.bounce", "RGB") + of("Shot.tex", "RGB") +
                                     Names{"Shot.mid.X", "Shot.Depth.Z"});
  const Roles roles = find_roles(picture, {.renderer = &studio});
  REQUIRE(roles.layer == "Shot");
  REQUIRE(roles.lighting == dermis::Lighting::lit);
  require_role(roles, Role::light, {of("Shot.key_light", "RGB"), of("Shot.bounce", "RGB")});
  require_role(roles, Role::material, {{"Shot.mid.X"}});
  require_role(roles, Role::depth, {{"Shot.Depth.Z"}});
  REQUIRE_FALSE(find_roles(picture).has(Role::light));
}

TEST_CASE("each view of a stereo picture has its own roles") {
  const auto with_view = [](const Names& names, const std::string& view, bool first) {
    Names out;
    for (const std::string& name : names) {
      const std::size_t dot = name.rfind('.');
      out.push_back(first ? view + '.' + name : name.substr(0, dot) + '.' + view + name.substr(dot));
    }
    return out;
  };
  const Names passes = of("L.DiffDir", "RGB") + of("L.DiffCol", "RGB") + of("L.Depth", "Z");
  for (const bool first : {false, true}) {
    const Picture picture = picture_of(with_view(passes, "left", first) + with_view(passes, "right", first));
    REQUIRE(picture.views() == Names{"left", "right"});
    for (const std::string view : {"left", "right"}) {
      const Roles roles = find_roles(picture, {.view = view});
      REQUIRE(roles.view == view);
      REQUIRE(roles.layer == "L");
      require_role(roles, Role::light, {with_view(of("L.DiffDir", "RGB"), view, first)});
      require_role(roles, Role::depth, {with_view({"L.Depth.Z"}, view, first)});
    }
    REQUIRE(find_roles(picture).view == "left");
    const Failure failure = failure_of([&] { find_roles(picture, {.view = "middle"}); });
    REQUIRE(failure.code == ErrorCode::role_missing);
    REQUIRE(failure.says("one of left, right"));
    const std::string view_of_test = "right";
    // A whole name is found whatever the view.
    const Names other = with_view(of("L.DiffCol", "RGB"), "right", first);
    const std::string text = "albedo=" + other[0] + "," + other[1] + "," + other[2];
    REQUIRE_FALSE(failure_of([&] { find_roles(picture, {.overrides = {text}, .view = view_of_test}); }).code);
  }
  // Channels that name no view are of the default one alone.
  const Picture mixed =
      picture_of(passes + with_view(passes, "left", false) + with_view(of("L.DiffDir", "RGB"), "right", false));
  REQUIRE_FALSE(find_roles(mixed, {.view = "right"}).has(Role::depth));
  REQUIRE(picture_of(view_layer("left", false)).views().empty());
}

TEST_CASE("a role may lie in another file, which is read and not written") {
  const TemporaryFolder folder;
  Picture depth({2, 1, 3, 2}, {0, 0, 8, 4});
  depth.add_channels(Names{"Z"}, Format::f32);
  const dermis::OutputImage view = depth.view_to_write(Names{"Z"});
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      const auto value = static_cast<float>(10 * y + x + 1);
      std::memcpy(static_cast<std::byte*>(view.host) + view.layout.offset + y * view.layout.row_stride +
                      x * view.layout.pixel_stride,
                  &value, sizeof value);
    }
  }
  const std::string path = folder / "depth.0007.exr";
  depth.write(path);
  Picture picture({0, 0, 4, 4}, {0, 0, 8, 4});
  picture.add_channels(of("DiffDir", "RGB"), Format::f16);
  for (const std::string& text : {"depth=" + path + ":Z", "depth=" + path, "depth= " + path + ":z "}) {
    INFO(text);
    const Names overrides = {text};
    REQUIRE(dermis::exr::files_of(overrides) == Names{path});
    picture.join(path);
    const Roles roles = find_roles(picture, {.overrides = overrides});
    require_role(roles, Role::depth, {{path + ":Z"}});
    const std::vector<float> values = load(picture, roles, Role::depth);
    REQUIRE(values == std::vector<float>{0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 11, 12, 0, 0, 0, 0});
    picture.add_channels(Names{"sss.R"}, Format::f32);
  }
  picture.write(folder / "out.exr");
  const Picture written = Picture::read(folder / "out.exr");
  REQUIRE(written.channels().size() == 4);
  REQUIRE(written.data_window() == picture.data_window());

  Picture other({0, 0, 4, 4}, {0, 0, 7, 4});
  other.add_channels(of("DiffDir", "RGB"), Format::f32);
  const Failure failure = failure_of([&] { other.join(path); });
  REQUIRE(failure.code == ErrorCode::input_unsupported);
  REQUIRE(failure.says("a display window of 8 x 4 at (0, 0)"));
  REQUIRE(failure_of([&] { other.join(folder / "none.exr"); }).code == ErrorCode::input_missing);
}

TEST_CASE("a file that is joined says if it is of another frame") {
  const TemporaryFolder folder;
  const auto saved = [&](const std::string& name, const char* attribute, const char* value) {
    Picture picture = picture_of(of("Depth", "Z"));
    if (attribute != nullptr) picture.set_attribute(attribute, value);
    picture.write(folder / name);
    return folder / name;
  };
  Picture picture = picture_of(of("DiffDir", "RGB"));
  picture.set_attribute("Frame", "0012");
  picture.set_attribute("imageCounter", "12");
  const std::string path = saved("13.exr", "Frame", "0013");
  REQUIRE(picture.join(path) == path + " is of another frame: its Frame is 0013, that of the picture 0012");
  REQUIRE(picture.join(path).empty());  // as it was said
  REQUIRE_FALSE(picture.join(saved("14.exr", "imageCounter", "14")).empty());
  REQUIRE(picture.join(saved("12.exr", "Frame", "0012")).empty());
  REQUIRE(picture.join(saved("none.exr", nullptr, nullptr)).empty());
}

TEST_CASE("what makes up the beauty beside the diffuse light is found by the names of the renderer") {
  const Names arnold = of("diffuse_direct", "RGB") + of("diffuse_albedo", "RGB") + of("specular_direct", "RGB") +
                       of("coat", "RGB") + of("coat_indirect", "RGB") + of("emission", "RGB") + of("GlossCol", "RGB");
  const Roles roles = find_roles(picture_of(arnold));
  REQUIRE(roles.others.size() == 2);
  REQUIRE(roles.others[0].light == ChannelSum{of("specular_direct", "RGB")});
  REQUIRE(roles.others[1].light == ChannelSum{of("coat", "RGB"), of("coat_indirect", "RGB"), of("emission", "RGB")});
  for (const dermis::exr::OtherLight& other : roles.others) REQUIRE(other.colour.empty());
  const Names& missing = roles.missing_others;
  REQUIRE(std::find(missing.begin(), missing.end(), "sss_direct") != missing.end());
  REQUIRE(std::find(missing.begin(), missing.end(), "emission") == missing.end());

  const Roles cycles = find_roles(picture_of(view_layer("L", true)));
  REQUIRE(cycles.others.size() == 1);
  REQUIRE(cycles.others[0].light == cycles[Role::specular]);
  REQUIRE(cycles.others[0].colour == of("L.Glossy Color", "RGB"));
  // What the caller says is all of the light.
  const Names specular = {"specular=L.Glossy Direct"};
  REQUIRE(find_roles(picture_of(view_layer("L", true)), {.overrides = specular}).others[0].colour.empty());
}

TEST_CASE("a role that is missing is asked for by the names of the renderer that was named") {
  const Picture picture = picture_of(view_layer("L", false));
  const Roles roles = find_roles(picture, {.renderer = dermis::exr::find_renderer("arnold")});
  const Failure light = failure_of([&] { require(picture, roles, Role::light); });
  REQUIRE(light.code == ErrorCode::role_missing);
  REQUIRE(light.says("want diffuse_direct or diffuse_indirect (arnold), or --role light=CHANNELS"));
  REQUIRE_FALSE(light.says("blender"));
  REQUIRE(failure_of([&] { require(picture, roles, Role::mask); }).says("want Mask (any renderer), or --role mask="));
  const Failure material = failure_of([&] { require(picture, roles, Role::material); });
  REQUIRE(material.says("want --role material=CHANNELS"));
  REQUIRE(material.says("--profile (one material for everything)"));
  const Picture none = picture_of(of("x", "RGB"));
  REQUIRE(failure_of([&] { require(none, find_roles(none), Role::light); }).says(dermis::exr::renderer_names()));
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

TEST_CASE("passes that a sum of light lacks are told, unless the caller says what the light is") {
  const auto missing = [](const Names& names, const dermis::exr::RoleRequest& request = {}) {
    return find_roles(picture_of(names), request).missing_light;
  };
  CHECK(missing(of("L.DiffDir", "RGB") + of("L.DiffInd", "RGB")).empty());
  CHECK(missing(of("L.DiffInd", "RGB")) == Names{"DiffDir"});
  CHECK(missing(of("L.DiffDir", "RGB")) == Names{"DiffInd"});
  CHECK(missing(of("diffuse_indirect", "RGB") + of("diffuse_albedo", "RGB")) == Names{"diffuse_direct"});
  CHECK(missing(of("L.DiffInd", "RGB"), {.overrides = {"light=L.DiffInd"}}).empty());
  CHECK(missing(of("L.Combined", "RGB")).empty());
}

TEST_CASE("a required role that is missing is named, with the channels there are") {
  const Picture picture = picture_of(of("L.DiffDir", "RGB") + Names{"odd\nname"});
  const Roles roles = find_roles(picture);
  REQUIRE_FALSE(failure_of([&] { require(picture, roles, Role::light); }).code);
  const Failure failure = failure_of([&] { require(picture, roles, Role::depth); });
  REQUIRE(failure.code == ErrorCode::role_missing);
  REQUIRE(failure.says("depth: "));
  REQUIRE(failure.says("L.DiffDir.{R,G,B}, odd\\x0aname"));
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
