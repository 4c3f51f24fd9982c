/// The part of dermis_exr and of the program that OpenImageIO does, behind an interface: it brings some 260 shared
/// libraries, so that the program loads it only when there is a picture to read or to write.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/pixel_block.hpp"

namespace dermis::exr {

/// The attributes of a picture but for its channels, windows and compression.
class PictureAttributes {
 public:
  virtual ~PictureAttributes() = default;
  virtual double pixel_aspect() const = 0;
  virtual void set_text(std::string_view name, std::string_view value) = 0;
  virtual std::shared_ptr<PictureAttributes> copy() const = 0;
};

/// All that a file says of one of its parts but for its pixels.
struct PartDescription {
  std::string name;  ///< empty if the file has one part without a name
  std::string view;  ///< of a stereo picture, or empty
  Window data;
  Window display;
  std::string compression;
  std::vector<ChannelName> channels;
  std::shared_ptr<PictureAttributes> attributes;
};

/// An open file. Functions throw std::runtime_error that says what is wrong with the file.
class PictureReader {
 public:
  virtual ~PictureReader() = default;
  virtual std::size_t parts() const = 0;
  virtual const PartDescription& description(std::size_t part) const = 0;
  virtual int tile_height(std::size_t part) const = 0;  ///< 0 if the part is not in tiles
  /// Reads packed rows of a part. They are whole tiles, if there are tiles, or end with the part.
  virtual void read_rows(std::size_t part, int first_row, int rows, std::byte* packed) = 0;
};

/// A file whose parts are written one after the other, and their rows from top to bottom. Functions throw as those of
/// PictureReader.
class PictureWriter {
 public:
  virtual ~PictureWriter() = default;
  virtual void begin_part(std::size_t part) = 0;
  virtual void write_rows(int first_row, int rows, const std::byte* packed) = 0;
  virtual void close() = 0;
};

class ImageLibrary {
 public:
  virtual ~ImageLibrary() = default;

  virtual std::shared_ptr<PictureAttributes> no_attributes() const = 0;

  /// `headers` hold the attributes of each part, so that those which OpenImageIO makes up are left out. Throws as
  /// PictureReader.
  virtual std::unique_ptr<PictureReader> open(const std::filesystem::path& path,
                                              std::span<const Header> headers) const = 0;

  /// A file whose bytes go to a stream, which outlives it, or, if there are several parts, to the file at `path`, which
  /// is that of the stream. Throws as PictureWriter.
  virtual std::unique_ptr<PictureWriter> create(std::FILE* stream, const std::filesystem::path& path,
                                                std::span<const PartDescription> parts) const = 0;

  /// The bytes of a PNG file of 8 bits, of packed RGB, 0..1 in sRGB. Throws as PictureWriter.
  virtual std::string png(int width, int height, const float* rgb) const = 0;

  /// The colours of values 0..1 in a ramp of even brightness steps, as packed RGB in sRGB; empty if that failed.
  virtual std::vector<float> heat_colours(int width, int height, std::span<const float> values) const = 0;
};

/// Throws Error(input_missing) if the program has to load it and cannot.
const ImageLibrary& image_library();

/// The same where it is linked; what the program loads exports it under this name.
extern "C" const ImageLibrary* dermis_image_library();

}  // namespace dermis::exr
