// Uncompressed OpenEXR files written byte by byte, so that tests share no code with the library, and files can be wrong
// on purpose.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dermis/exr.hpp"

namespace raw_exr {

inline std::string u32(std::uint32_t value) {
  std::string out;
  for (int shift = 0; shift < 32; shift += 8) {
    out += static_cast<char>(value >> shift & 0xFF);
  }
  return out;
}

inline std::string i32(int value) { return u32(std::bit_cast<std::uint32_t>(value)); }
inline std::string f32(float value) { return u32(std::bit_cast<std::uint32_t>(value)); }
inline std::string f64(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return u32(static_cast<std::uint32_t>(bits)) + u32(static_cast<std::uint32_t>(bits >> 32));
}
inline std::string text(const std::string& value) { return value + '\0'; }

inline std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return text(name) + text(type) + u32(static_cast<std::uint32_t>(value.size())) + value;
}

struct Channel {
  std::string name;
  dermis::Format format;
  std::string values;  ///< little-endian, row by row
  int sampling = 1;
};

struct File {
  dermis::exr::Window data;
  dermis::exr::Window display;
  std::vector<Channel> channels;  ///< sorted by name, as the format wants them
  std::string attributes = {};    ///< further ones
  std::uint32_t flags = 0;
  float pixel_aspect = 1;
  std::string end = std::string(1, '\0');  ///< of the header
};

inline std::string box(const dermis::exr::Window& w) {
  return i32(w.x) + i32(w.y) + i32(w.x + w.width - 1) + i32(w.y + w.height - 1);
}

inline std::string channel_list(const std::vector<Channel>& channels) {
  std::string out;
  for (const Channel& channel : channels) {
    const int type = channel.format == dermis::Format::u32 ? 0 : channel.format == dermis::Format::f16 ? 1 : 2;
    out += text(channel.name) + i32(type) + i32(0) + i32(channel.sampling) + i32(channel.sampling);
  }
  return out + '\0';
}

inline std::string header(const File& file) {
  return u32(20000630) + u32(2 | 0x400 | file.flags) + attribute("channels", "chlist", channel_list(file.channels)) +
         attribute("compression", "compression", std::string(1, '\0')) +
         attribute("dataWindow", "box2i", box(file.data)) + attribute("displayWindow", "box2i", box(file.display)) +
         attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
         attribute("pixelAspectRatio", "float", f32(file.pixel_aspect)) +
         attribute("screenWindowCenter", "v2f", f32(0) + f32(0)) + attribute("screenWindowWidth", "float", f32(1)) +
         file.attributes + file.end;
}

inline std::string bytes(const File& file) {
  std::size_t row_bytes = 0;
  for (const Channel& channel : file.channels) {
    row_bytes += dermis::bytes_of(channel.format) * static_cast<std::size_t>(file.data.width);
  }
  std::string out = header(file);
  const std::size_t first = out.size() + 8 * static_cast<std::size_t>(file.data.height);
  std::string rows;
  for (int y = 0; y < file.data.height; ++y) {
    const std::uint64_t offset = first + rows.size();
    out += u32(static_cast<std::uint32_t>(offset)) + u32(static_cast<std::uint32_t>(offset >> 32));
    rows += (file.flags & 0x1000) != 0 ? i32(0) : "";  // This is the number of the part.
    rows += i32(file.data.y + y) + u32(static_cast<std::uint32_t>(row_bytes));
    for (const Channel& channel : file.channels) {
      const std::size_t n = dermis::bytes_of(channel.format) * static_cast<std::size_t>(file.data.width);
      rows += channel.values.substr(static_cast<std::size_t>(y) * n, n);
    }
  }
  return out + rows;
}

/// A part, with the attributes that a part must have.
inline File part(File file, const std::string& name) {
  file.flags = 0x1000;
  file.attributes += attribute("name", "string", name) + attribute("type", "string", "scanlineimage") +
                     attribute("chunkCount", "int", i32(file.data.height));
  return file;
}

/// A file of several parts, whose names are in their attributes.
inline std::string bytes_of_parts(const std::vector<File>& parts) {
  std::string out = u32(20000630) + u32(2 | 0x400 | 0x1000);
  std::size_t chunks = 0;
  for (const File& file : parts) {
    out += header(file).substr(8);
    chunks += static_cast<std::size_t>(file.data.height);
  }
  out += '\0';
  const std::size_t first = out.size() + 8 * chunks;
  std::string rows;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const File& file = parts[p];
    std::size_t row_bytes = 0;
    for (const Channel& channel : file.channels)
      row_bytes += dermis::bytes_of(channel.format) * static_cast<std::size_t>(file.data.width);
    for (int y = 0; y < file.data.height; ++y) {
      const std::uint64_t offset = first + rows.size();
      out += u32(static_cast<std::uint32_t>(offset)) + u32(static_cast<std::uint32_t>(offset >> 32));
      rows += i32(static_cast<int>(p)) + i32(file.data.y + y) + u32(static_cast<std::uint32_t>(row_bytes));
      for (const Channel& channel : file.channels) {
        const std::size_t n = dermis::bytes_of(channel.format) * static_cast<std::size_t>(file.data.width);
        rows += channel.values.substr(static_cast<std::size_t>(y) * n, n);
      }
    }
  }
  return out + rows;
}

}  // namespace raw_exr
