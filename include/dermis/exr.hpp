/// OpenEXR files in and out (target dermis_exr): pictures with all their channels, roles by channel name, and the
/// camera.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/frame.hpp"
#include "dermis/words.hpp"

namespace dermis::exr {

/// A rectangle in pixels: (x, y) is its upper left corner.
struct Window {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  bool operator==(const Window&) const = default;
};

/// One channel of a picture.
struct Channel {
  std::string name;         ///< as in the file, for instance "ViewLayer.DiffDir.R"
  Format format;            ///< f16, f32 or u32
  std::size_t byte_offset;  ///< from the start of a pixel
};

/// All channels and attributes of the parts of a flat EXR file; the pixels lie interleaved in the formats of the file,
/// so that what is not touched is written back bit for bit, part by part. If there are several parts, a channel without
/// a dot in its name is called after its part, as "DiffDir.R".
class Picture {
 public:
  /// Reads a file. Throws Error(input_missing) if it is not there, Error(input_unsupported) if it is damaged, not EXR
  /// or deep, or is larger than 65536 pixels on a side or 1024 channels. So many channels of four bytes can then be
  /// added without a copy of all pixels as there is `room`.
  static Picture read(const std::filesystem::path& path, std::size_t room = 0);

  /// Adds the channels of another file, which are read and never written, under the names "PATH:CHANNEL"; where its
  /// data window does not reach they are zero. Does nothing if that was done before. Throws as read, and
  /// Error(input_unsupported) if its display window is another one. Invalidates views. Returns in a line what says that
  /// the file is of another frame, if an attribute does: Blender's "Frame", or "imageCounter" of SMPTE ST 2065-4.
  std::string join(const std::filesystem::path& path);

  /// A picture without channels, black outside `data`.
  Picture(Window data, Window display);
  ~Picture();
  Picture(Picture&&) noexcept;
  Picture& operator=(Picture&&) noexcept;

  int width() const;           ///< of the data window: the pixels there are
  int height() const;          ///< of the data window
  Window data_window() const;  ///< around those of all parts
  Window display_window() const;
  double pixel_aspect() const;  ///< width of a pixel / its height
  std::string compression() const;
  std::span<const Channel> channels() const;

  /// The views of a stereo picture, the default one first: by the attributes "multiView" or "view", else "left" and
  /// "right" if channels have both in their names. None if it has no views.
  std::vector<std::string> views() const;

  const Channel* find(std::string_view name) const;  ///< nullptr if there is none

  /// The values of one channel, as float. Throws Error(role_missing) if there is none.
  std::vector<float> plane(std::string_view name) const;

  /// Adds channels of one format, filled with zeros; a channel that is there already keeps its format and values.
  /// Invalidates views.
  void add_channels(std::span<const std::string> names, Format format);

  /// A view of three channels (or one) in the picture's own pixels. Throws Error(input_unsupported) if they are not of
  /// one format or not evenly spaced.
  Image view(std::span<const std::string> names) const;
  OutputImage view_to_write(std::span<const std::string> names);

  /// The names of all attributes in the file's header, and of those that were set.
  std::vector<std::string> attribute_names() const;

  /// The value of a text attribute; none if there is no such attribute or it is no text.
  std::optional<std::string> text_attribute(std::string_view name) const;

  /// The numbers of an attribute: int, float, double, vectors, and matrices row by row; of a text the numbers that it
  /// lists with blanks or commas between them. Empty if there is no such attribute or it is anything else.
  std::vector<double> number_attribute(std::string_view name) const;

  /// Gives channels other values, packed as `load` returns them; values that do not change keep their bits. If a half
  /// channel cannot hold one that is finite (65520 or more), the channels become float32; with `keeps_formats` it holds
  /// 65504 instead. Returns how many values were too large. Throws Error(role_missing) if there is no channel of a
  /// name, Error(input_unsupported) if one holds whole numbers. Invalidates views if channels become float32.
  std::int64_t store(std::span<const std::string> names, std::span<const float> values, bool keeps_formats = false);

  /// Makes channels float32, with the values that they have. Invalidates views if any was not.
  void make_float(std::span<const std::string> names);

  /// Sets a text attribute.
  void set_attribute(std::string_view name, std::string_view value);

  /// Writes to a temporary file beside `path`, then renames it: symbolic links are followed, and a file that is
  /// replaced leaves its mode, and as far as the process may its owner. `compression` is an OpenEXR name ("zip", "piz",
  /// "dwaa",
  /// ...); if empty that of the file that was read, or "zip" if that loses data. Throws Error(usage) for another name,
  /// Error(output) that says why if the file cannot be written or is write-protected, leaving what was at `path`. With
  /// `names` the file has these channels alone, in the picture's order, and all attributes; throws Error(role_missing)
  /// if there is none of a name.
  void write(const std::filesystem::path& path, std::string_view compression = {},
             std::span<const std::string> names = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What a channel is for. Its name, number of values and description are in role_table.
enum class Role {
  light,
  albedo,
  depth,
  position,
  normal,
  material,
  mask,
  matte,
  specular,
  beauty,
  stretch_u,
  stretch_v,
  thickness,
};

/// One row of role_table.
struct RoleInfo {
  Role role;
  std::string_view name;  ///< as a caller spells it
  std::size_t values;     ///< channels of a group: 3 (RGB or XYZ) or 1
  std::string_view what;  ///< for help texts
};

/// All roles, in the order of Role. The names that renderers give the channels are in src/exr/roles.cpp.
inline constexpr std::array role_table = {
    RoleInfo{Role::light, "light", 3, "diffuse light, without or with the albedo"},
    RoleInfo{Role::albedo, "albedo", 3, "diffuse colour"},
    RoleInfo{Role::depth, "depth", 1, "distance along the view axis, scene units"},
    RoleInfo{Role::position, "position", 3, "world space, scene units"},
    RoleInfo{Role::normal, "normal", 3, "world space"},
    RoleInfo{Role::material, "material", 1, "material ids"},
    RoleInfo{Role::mask, "mask", 1, "factor of the profile's width"},
    RoleInfo{Role::matte, "matte", 1, "share of the pixel that its material covers"},
    RoleInfo{Role::specular, "specular", 3, "highlights"},
    RoleInfo{Role::beauty, "beauty", 3, "the finished picture"},
    RoleInfo{Role::stretch_u, "stretch_u", 1, "of a texture: mm of surface per texel along u"},
    RoleInfo{Role::stretch_v, "stretch_v", 1, "of a texture: mm of surface per texel along v"},
    RoleInfo{Role::thickness, "thickness", 1, "mm along the normal"},
};

constexpr const RoleInfo& info_of(Role role) { return role_table[static_cast<std::size_t>(role)]; }
constexpr std::string_view name_of(Role role) { return info_of(role).name; }

/// The names of all roles with commas between them, for help and messages.
std::string role_names();

/// The channels of one role: a sum of groups of three (RGB or XYZ) or one.
using ChannelSum = std::vector<std::vector<std::string>>;

/// How a renderer, or a studio, names its passes. The names are without layer, view and channel ("DiffDir"), in any
/// case;
/// "" stands for the layer's own R, G and B. A role is the sum of its passes.
struct Renderer {
  /// A pass by its names, the first of which that is there counts.
  struct Pass {
    Role role;
    std::vector<std::string> names;
  };

  /// Light that the beauty has beside the diffuse and the specular one: a sum of passes, each by its names.
  struct OtherLight {
    std::vector<std::vector<std::string>> passes;
    std::vector<std::string> colour = {};  ///< names of what the renderer has divided it by; none if it has not
  };

  std::string name;
  Lighting lighting;  ///< whether the albedo is in the light
  std::vector<Pass> passes;
  /// If there are any, only pictures are of this renderer that have one of these channels.
  std::vector<std::string> marks = {};
  std::vector<std::string> specular_colour = {};  ///< as OtherLight::colour
  std::vector<OtherLight> others = {};            ///< none if its passes do not add up to the beauty
};

/// The renderers that dermis knows by name.
std::span<const Renderer> renderers();

/// The one of that name, or nullptr.
const Renderer* find_renderer(std::string_view name);

/// Their names with commas between them, for help and messages.
std::string renderer_names();

/// The caller's word on roles.
struct RoleRequest {
  /// Each is "role=channels": channels are full names separated by commas (1 or 3), or one prefix that stands for its
  /// .R .G .B or .X .Y .Z (or single) channels; "+" adds several; nothing unsets the role. A channel of a file that was
  /// joined is "PATH:CHANNEL", and "PATH" alone a prefix.
  std::vector<std::string> overrides = {};
  std::string layer = {};              ///< if there are several; empty: the first one with diffuse light
  std::string view = {};               ///< if there are several; empty: the first
  const Renderer* renderer = nullptr;  ///< nullptr: the one most of whose passes are there
};

/// A part of the beauty beside the diffuse light.
struct OtherLight {
  ChannelSum light;
  std::vector<std::string> colour = {};  ///< the channels of what it is multiplied by; none if it is all of the light
};

/// Which channels of a picture play which role.
struct Roles {
  std::string layer = {};             ///< the view layer, without the dot; may be empty
  std::string view = {};              ///< or empty
  std::string renderer = {};          ///< whose names the light has; empty if it has none or an override says it
  Lighting lighting = Lighting::raw;  ///< as the renderer writes it; raw if there is none
  std::array<ChannelSum, role_table.size()> channels = {};
  std::array<std::string, role_table.size()> rules =
      {};                                       ///< what gave the role: a renderer, "any renderer" or "--role"
  std::vector<std::string> missing_light = {};  ///< passes of the renderer's light that are not there

  /// By which names each role was sought, for messages; empty if there is no renderer to know them from.
  std::array<std::string, role_table.size()> sought = {};
  std::vector<OtherLight> others = {};           ///< what makes up the beauty beside the light
  std::vector<std::string> missing_others = {};  ///< passes of it that the renderer has and the picture has not

  /// What contradicts them, each in one line; find_roles leaves it empty.
  std::vector<std::string> warnings = {};

  const ChannelSum& operator[](Role role) const { return channels[static_cast<std::size_t>(role)]; }
  ChannelSum& operator[](Role role) { return channels[static_cast<std::size_t>(role)]; }
  bool has(Role role) const { return !(*this)[role].empty(); }
};

/// Finds roles by the names of the renderer in any case, in a layer or else outside all layers; what the renderer has
/// no channel for (but light, albedo and ids) by the names that any renderer gives it. Throws Error(usage) for a
/// malformed override, Error(role_missing) that lists the channels there are if one names a channel that is not, or the
/// layers or views if there is no such layer or view.
Roles find_roles(const Picture& picture, const RoleRequest& request = {});

/// The files that overrides name and that have to be joined for them.
std::vector<std::string> files_of(std::span<const std::string> overrides);

/// The summed values of a role, packed, as float; empty if the picture does not have it.
std::vector<float> load(const Picture& picture, const Roles& roles, Role role);

/// The same of any groups of three or one.
std::vector<float> load(const Picture& picture, const ChannelSum& sum);

/// Throws Error(role_missing) that names the role and lists the channels there are, if the picture does not have it.
void require(const Picture& picture, const Roles& roles, Role role);

/// The id that Cryptomatte gives a name: MurmurHash3 of it, as a float that is a number.
float cryptomatte_id(std::string_view name);

/// A name in a Cryptomatte, and how many pixels it covers more than half of.
struct CryptomatteName {
  std::string name;
  std::int64_t pixels;
};

/// A Cryptomatte of a picture: its objects, its materials or its assets.
struct Cryptomatte {
  std::string name;  ///< as "ViewLayer.CryptoMaterial"
  /// Those of its manifest; none if the picture has none. It may be in the header, or in a file that the header names
  /// and that lies in `folder`.
  std::vector<CryptomatteName> names;
};

/// The Cryptomattes of the layer and view of the roles, those of materials first, then assets, then objects.
std::vector<Cryptomatte> find_cryptomattes(const Picture& picture, const Roles& roles,
                                           const std::filesystem::path& folder = {});

/// Which of some names covers most of each pixel (-1: none does), and how much of it, 0..1.
struct Mattes {
  std::string cryptomatte;  ///< the one that was read
  std::vector<int> name;
  std::vector<float> share;
};

/// Reads the first Cryptomatte of find_cryptomattes in which all names cover pixels. Throws Error(role_missing) if
/// there is none, with the names that are like one that is missing; Error(input_unsupported) if ids are not float32.
Mattes load_cryptomatte(const Picture& picture, const Roles& roles, std::span<const std::string> names,
                        const std::filesystem::path& folder = {});

/// What the values of a depth pass are.
enum class DepthKind {
  z,           ///< distance along the view axis, scene units
  distance,    ///< distance from the eye, scene units
  inverse,     ///< 1 / z
  normalized,  ///< 0 at one depth, 1 at another, even between them
};

struct DepthType {
  DepthKind kind = DepthKind::z;
  bool is_negative = false;  ///< the values are the negatives of these
  double near = 0;           ///< normalized: the depth whose value is 0, scene units
  double far = 0;            ///< normalized: the depth whose value is 1; less than `near` if 1 is in front
  bool operator==(const DepthType&) const = default;
};

/// As --depth-type spells it: "z", "distance-" or "normalized:10,40".
std::string text_of(const DepthType& type);

/// Two matrices for row vectors, (x, y, z, 1) M, row by row, as OpenEXR's standard attributes of these names.
struct CameraMatrices {
  std::array<double, 16> world_to_camera;  ///< the camera looks along +z or -z
  std::array<double, 16> world_to_ndc;  ///< the display window is 0..1 from its upper left corner, or -1..1 with y up
};

/// The caller's word on the camera, and on depth; at most one of those on the camera.
struct CameraHint {
  std::optional<double> fov_deg = {};   ///< horizontal, of the display window; in (0, 180)
  std::optional<double> focal_px = {};  ///< along x; > 0
  std::optional<double> orthographic_px_per_unit = {};
  std::optional<CameraMatrices> matrices = {};
  std::optional<DepthType> depth_type = {};
  std::string name = {};  ///< what messages call the word on the camera, for instance "--camera shot.json"; if empty,
                          ///< by the option of the program
};

/// The depth of a position P: direction . P + offset, scene units.
struct ViewAxis {
  std::array<double, 3> direction;  ///< unit length, world space
  double offset;
};

/// A camera and where it comes from.
struct FoundCamera {
  Camera camera;                      ///< in pixels of the data window
  std::string source;                 ///< "position and depth", "position", the hint's name, or that of an attribute
  double residual_units = 0;          ///< largest distance of a recovered point from its position, if recovered
  std::optional<ViewAxis> axis = {};  ///< if depth is to be taken from the positions
  /// World space, if known: the eye, scene units, or the direction in which an orthographic camera looks.
  std::optional<std::array<double, 3>> eye = {};
  /// Row by row the 3 x 4 matrix that takes positions to the axes of the camera, as View::to_camera, if known.
  std::optional<std::array<double, 12>> world_to_camera = {};
  DepthType depth_type = {};  ///< of the depth pass, if there is one that can be used
  double doubt = 0;           ///< relative standard error of the focal length, or of pixels per unit, if recovered
  /// What contradicts the camera or could not be used, each in one line.
  std::vector<std::string> warnings = {};
};

/// The camera of a picture. What comes first counts:
///
/// 1. Its positions, if it has some, alone or together with its depth, by least squares over all pixels that are not
///    background; false ones drop out. A hint, an attribute or a depth that contradicts them is warned of. What the
///    depth is (DepthKind, its sign) is recognised. Without a depth that can be used, or with one in half beside
///    positions that are not, depth comes from the positions. The camera is refused unless the focal length is known to
///    0.1 %, or 0.5 % if the positions are half or lossy.
/// 2. The hint.
/// 3. The attributes worldToCamera and worldToNDC.
/// 4. Attributes of renderers: those that src/exr/camera_attributes.cpp lists.
///
/// Throws Error(role_missing) if none of them works, or if a depth without positions cannot be what the hint says, or
/// along the view axis if that says nothing; Error(usage) if the hint is not finite or out of range.
FoundCamera find_camera(const Picture& picture, const Roles& roles, const CameraHint& hint = {});

/// The depth of each pixel along the view axis: that of the picture, or that of its positions if the camera has an
/// axis; infinite where there is nothing. Terraces that halves make of a depth are smoothed, within what they round.
/// Empty if there is neither.
std::vector<float> load_depth(const Picture& picture, const Roles& roles, const FoundCamera& camera);

}  // namespace dermis::exr

namespace dermis {

template <>
inline constexpr std::array<Named<exr::DepthKind>, 4> word_table<exr::DepthKind> = {{
    {exr::DepthKind::z, "z"},
    {exr::DepthKind::distance, "distance"},
    {exr::DepthKind::inverse, "inverse"},
    {exr::DepthKind::normalized, "normalized"},
}};

}  // namespace dermis
