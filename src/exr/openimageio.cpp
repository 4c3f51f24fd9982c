// The image library. All that includes OpenImageIO stands here, for it is built once for dermis_exr and once as the
// module that the program loads.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "exr/image_library.hpp"
#include "exr/quiet_oiio.hpp"

namespace dermis::exr {
namespace {

constexpr const char* part_name = "oiio:subimagename";
constexpr const char* dwa_level = "openexr:dwaCompressionLevel";

struct SpecAttributes final : PictureAttributes {
  OIIO::ImageSpec spec;  ///< no channels; its windows mean nothing

  explicit SpecAttributes(OIIO::ImageSpec its_spec) : spec(std::move(its_spec)) {}
  double pixel_aspect() const override {
    return static_cast<double>(spec.get_float_attribute("PixelAspectRatio", 1.0F));
  }
  void set_text(std::string_view name, std::string_view value) override {
    spec.attribute({name.data(), name.size()}, OIIO::string_view(value.data(), value.size()));
  }
  std::shared_ptr<PictureAttributes> copy() const override { return std::make_shared<SpecAttributes>(spec); }
};

Format format_of(const OIIO::TypeDesc& type) {
  switch (type.basetype) {
    case OIIO::TypeDesc::HALF:
      return Format::f16;
    case OIIO::TypeDesc::UINT:
      return Format::u32;
    default:
      return Format::f32;
  }
}

/// The OpenImageIO name of a format that OpenEXR has.
OIIO::TypeDesc type_of(Format format) {
  switch (format) {
    case Format::f16:
      return OIIO::TypeHalf;
    case Format::u32:
      return OIIO::TypeUInt32;
    default:
      return OIIO::TypeFloat;
  }
}

std::vector<ChannelName> channels_of(const OIIO::ImageSpec& spec) {
  std::vector<ChannelName> channels;
  channels.reserve(static_cast<std::size_t>(spec.nchannels));
  for (int c = 0; c < spec.nchannels; ++c) {
    channels.push_back({spec.channelnames[static_cast<std::size_t>(c)], format_of(spec.channelformat(c))});
  }
  return channels;
}

bool has_attribute(const Header& header, std::string_view name) {
  return std::any_of(header.begin(), header.end(),
                     [name](const HeaderAttribute& attribute) { return attribute.name == name; });
}

/// The part of a file's description that the next file keeps: it has no channels, no tiles and no attributes that the
/// reader made up.
OIIO::ImageSpec kept_attributes(OIIO::ImageSpec spec, const Header& header) {
  spec.nchannels = 0;
  spec.channelnames.clear();
  spec.channelformats.clear();
  spec.alpha_channel = spec.z_channel = -1;
  if (spec.tile_width > 0 && !has_attribute(header, "envmap")) {
    spec.erase_attribute("textureformat");  // would make a mip map of it
  }
  spec.tile_width = spec.tile_height = spec.tile_depth = 0;
  for (const char* name : {"compression", "openexr:lineOrder", "openexr:levelmode", "openexr:roundingmode",
                           "oiio:subimages", "openexr:chunkCount"}) {
    spec.erase_attribute(name);
  }
  if (!has_attribute(header, "ResolutionUnit")) spec.erase_attribute("ResolutionUnit");
  return spec;
}

PartDescription description_of(const OIIO::ImageSpec& spec, const Header& header) {
  return {.name = std::string(spec.get_string_attribute(part_name)),
          .view = std::string(spec.get_string_attribute("view")),
          .data = {spec.x, spec.y, spec.width, spec.height},
          .display = {spec.full_x, spec.full_y, spec.full_width, spec.full_height},
          .compression = std::string(spec.get_string_attribute("compression", "zip")),
          .channels = channels_of(spec),
          .attributes = std::make_shared<SpecAttributes>(kept_attributes(spec, header))};
}

class OpenedPicture final : public PictureReader {
 public:
  OpenedPicture(const std::filesystem::path& path, std::span<const Header> headers)
      : input_(OIIO::ImageInput::create("openexr")) {
    if (!input_) throw std::runtime_error(OIIO::geterror());
    OIIO::ImageSpec first;
    if (!input_->open(path.string(), first)) throw std::runtime_error(input_->geterror());
    for (std::size_t part = 0; part < headers.size(); ++part) {
      specs_.push_back(input_->spec(static_cast<int>(part)));
      if (specs_.back().undefined()) throw std::runtime_error("part " + std::to_string(part) + " cannot be read");
      descriptions_.push_back(description_of(specs_.back(), headers[part]));
    }
  }

  std::size_t parts() const override { return specs_.size(); }

  const PartDescription& description(std::size_t part) const override { return descriptions_[part]; }

  int tile_height(std::size_t part) const override {
    return specs_[part].tile_width > 0 ? specs_[part].tile_height : 0;
  }

  void read_rows(std::size_t part, int first_row, int rows, std::byte* packed) override {
    const OIIO::ImageSpec& spec = specs_[part];
    const int index = static_cast<int>(part);
    const int y = spec.y + first_row;
    const bool ok = spec.tile_width > 0 ? input_->read_tiles(index, 0, spec.x, spec.x + spec.width, y, y + rows, 0, 1,
                                                             0, spec.nchannels, OIIO::TypeUnknown, packed)
                                        : input_->read_scanlines(index, 0, y, y + rows, 0, 0, spec.nchannels,
                                                                 OIIO::TypeUnknown, packed);
    if (!ok) throw std::runtime_error(input_->geterror());
  }

 private:
  Quiet quiet_;
  std::unique_ptr<OIIO::ImageInput> input_;
  std::vector<OIIO::ImageSpec> specs_;
  std::vector<PartDescription> descriptions_;
};

OIIO::ImageSpec spec_to_write(const PartDescription& description) {
  OIIO::ImageSpec spec = static_cast<const SpecAttributes&>(*description.attributes).spec;
  const Window& data = description.data;
  const Window& display = description.display;
  spec.x = data.x;
  spec.y = data.y;
  spec.width = data.width;
  spec.height = data.height;
  spec.full_x = display.x;
  spec.full_y = display.y;
  spec.full_width = display.width;
  spec.full_height = display.height;
  spec.nchannels = static_cast<int>(description.channels.size());
  for (const ChannelName& channel : description.channels) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.push_back(type_of(channel.format));
  }
  if (!description.name.empty()) spec.attribute(part_name, description.name);
  const std::string& compression = description.compression;
  const float level = spec.get_float_attribute(dwa_level, 0.0F);
  const bool keeps_level = compression.starts_with("dwa") && level >= 1.0F;
  spec.attribute("compression",
                 keeps_level ? compression + ":" + std::to_string(static_cast<int>(level)) : compression);
  if (spec.find_attribute("DateTime") == nullptr) {
    // OpenImageIO adds the time of writing where there is no such attribute, and drops one of the wrong type.
    spec.attribute("DateTime", 0);
  }
  return spec;
}

std::vector<OIIO::ImageSpec> specs_to_write(std::span<const PartDescription> parts) {
  std::vector<OIIO::ImageSpec> specs;
  for (const PartDescription& part : parts) specs.push_back(spec_to_write(part));
  return specs;
}

class CreatedPicture final : public PictureWriter {
 public:
  CreatedPicture(std::FILE* stream, const std::filesystem::path& path, std::span<const PartDescription> parts)
      : path_(path.string()),
        specs_(specs_to_write(parts)),
        proxy_(stream, OIIO::Filesystem::IOProxy::Write),
        output_(OIIO::ImageOutput::create("openexr")) {
    if (!output_) throw std::runtime_error(OIIO::geterror());
    // OpenImageIO 2.4 writes several parts past the proxy.
    if (parts.size() == 1) check(output_->set_ioproxy(&proxy_));
  }

  void begin_part(std::size_t part) override {
    const int count = static_cast<int>(specs_.size());
    if (part > 0)
      check(output_->open(path_, specs_[part], OIIO::ImageOutput::AppendSubimage));
    else
      check(count > 1 ? output_->open(path_, count, specs_.data()) : output_->open(path_, specs_[0]));
    first_row_ = specs_[part].y;
  }

  void write_rows(int first_row, int rows, const std::byte* packed) override {
    const int y = first_row_ + first_row;
    check(output_->write_scanlines(y, y + rows, 0, OIIO::TypeUnknown, packed));
  }

  void close() override { check(output_->close()); }

 private:
  void check(bool ok) const {
    if (!ok) throw std::runtime_error(output_->geterror());
  }

  Quiet quiet_;
  std::string path_;
  std::vector<OIIO::ImageSpec> specs_;
  OIIO::Filesystem::IOFile proxy_;
  std::unique_ptr<OIIO::ImageOutput> output_;
  int first_row_ = 0;
};

class OpenImageIO final : public ImageLibrary {
 public:
  std::shared_ptr<PictureAttributes> no_attributes() const override {
    return std::make_shared<SpecAttributes>(OIIO::ImageSpec(OIIO::TypeFloat));
  }

  std::unique_ptr<PictureReader> open(const std::filesystem::path& path,
                                      std::span<const Header> headers) const override {
    return std::make_unique<OpenedPicture>(path, headers);
  }

  std::unique_ptr<PictureWriter> create(std::FILE* stream, const std::filesystem::path& path,
                                        std::span<const PartDescription> parts) const override {
    return std::make_unique<CreatedPicture>(stream, path, parts);
  }

  std::string png(int width, int height, const float* rgb) const override {
    OIIO::Filesystem::IOVecOutput memory;
    const auto output = OIIO::ImageOutput::create("png");
    if (!output) throw std::runtime_error(OIIO::geterror());
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    const bool ok = output->set_ioproxy(&memory) && output->open("picture.png", spec) &&
                    output->write_image(OIIO::TypeDesc::FLOAT, rgb) && output->close();
    if (!ok) throw std::runtime_error(output->geterror());
    return {memory.buffer().begin(), memory.buffer().end()};
  }

  std::vector<float> heat_colours(int width, int height, std::span<const float> values) const override {
    OIIO::ImageBuf grey(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT));
    grey.set_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, values.data());
    const OIIO::ImageBuf coloured = OIIO::ImageBufAlgo::color_map(grey, 0, "inferno");
    const OIIO::ROI all(0, width, 0, height, 0, 1, 0, 3);
    std::vector<float> rgb(values.size() * 3);
    if (coloured.has_error() || !coloured.get_pixels(all, OIIO::TypeDesc::FLOAT, rgb.data())) rgb.clear();
    return rgb;
  }
};

}  // namespace

extern "C" const ImageLibrary* dermis_image_library() {
  static const OpenImageIO library;
  return &library;
}

}  // namespace dermis::exr
