#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"
#include "exr/quiet_oiio.hpp"
#include "exr/temporary_file.hpp"

namespace dermis::exr {
namespace {

constexpr std::array<std::string_view, 5> lossless = {"none", "rle", "zips", "zip", "piz"};
constexpr std::array<std::string_view, 5> lossy = {"pxr24", "b44", "b44a", "dwaa", "dwab"};
constexpr const char* dwa_level = "openexr:dwaCompressionLevel";
constexpr int batch_rows = 256;  // the rows of the largest block that OpenEXR compresses at once

bool among(std::span<const std::string_view> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string chosen_compression(std::string_view wanted, const std::string& of_file) {
  if (wanted.empty()) return among(lossless, of_file) ? of_file : "zip";
  std::string name = lower(wanted);
  if (!among(lossless, name) && !among(lossy, name)) {
    throw Error(ErrorCode::usage, "compression", escaped(wanted),
                "none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab");
  }
  return name;
}

OIIO::ImageSpec spec_to_write(OIIO::ImageSpec spec, const PixelBlock& pixels, const std::string& compression) {
  spec.nchannels = static_cast<int>(pixels.channels().size());
  for (const Channel& channel : pixels.channels()) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.push_back(type_of(channel.format));
  }
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

/// Empty if it worked, else what went wrong.
std::string write_pixels(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec, const PixelBlock& pixels) {
  const int step = std::min(batch_rows, pixels.height());
  const auto packed =
      std::make_unique_for_overwrite<std::byte[]>(pixels.packed_row_bytes() * static_cast<std::size_t>(step));
  for (int row = 0; row < pixels.height(); row += step) {
    const int rows = std::min(step, pixels.height() - row);
    pixels.pack(packed.get(), row, rows);
    const int y = spec.y + row;
    if (!output.write_scanlines(y, y + rows, 0, OIIO::TypeUnknown, packed.get())) return output.geterror();
  }
  return output.close() ? "" : output.geterror();
}

std::string write_to(std::FILE* stream, const OIIO::ImageSpec& spec, const PixelBlock& pixels) {
  OIIO::Filesystem::IOFile proxy(stream, OIIO::Filesystem::IOProxy::Write);
  const auto output = OIIO::ImageOutput::create("openexr");
  if (!output) return OIIO::geterror();
  if (!output->set_ioproxy(&proxy) || !output->open("picture.exr", spec)) return output->geterror();
  return write_pixels(*output, spec, pixels);
}

}  // namespace

void Picture::write(const std::filesystem::path& path, std::string_view compression) const {
  const PixelBlock& pixels = state_->pixels;
  const std::string method = chosen_compression(compression, state_->compression);
  const auto fail = [&path](std::string_view why) {
    throw Error(ErrorCode::output, escaped(path.string()), escaped(why), "a file that can be written");
  };
  if (pixels.channels().empty()) fail("a picture without channels");
  const Quiet quiet;
  try {
    TemporaryFile file(path);
    const std::string error = write_to(file.stream(), spec_to_write(state_->spec, pixels, method), pixels);
    if (!error.empty()) fail(error);
    file.commit();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

}  // namespace dermis::exr
