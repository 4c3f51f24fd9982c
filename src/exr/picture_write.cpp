#include <algorithm>
#include <array>
#include <exception>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/image_library.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"
#include "exr/temporary_file.hpp"

namespace dermis::exr {
namespace {

constexpr std::array<std::string_view, 5> lossless = {"none", "rle", "zips", "zip", "piz"};
constexpr std::array<std::string_view, 5> lossy = {"pxr24", "b44", "b44a", "dwaa", "dwab"};
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

/// A part as it is written: those of its channels that are wanted, in its order.
struct PartToWrite {
  PartDescription description;
  Packing packing;
};

std::vector<PartToWrite> parts_to_write(const std::vector<Part>& parts, const PixelBlock& pixels,
                                        std::span<const std::string> names, std::string_view compression) {
  std::vector<PartToWrite> out;
  for (const Part& part : parts) {
    if (!part.is_written) continue;
    PartDescription description = part.description;
    std::vector<Channel> chosen;
    for (const auto& [name, name_in_part] : part.channels) {
      if (!names.empty() && std::find(names.begin(), names.end(), name) == names.end()) continue;
      chosen.push_back(*pixels.find(name));
      description.channels.push_back({name_in_part, chosen.back().format});
    }
    if (chosen.empty()) continue;
    description.compression = chosen_compression(compression, description.compression);
    out.push_back({std::move(description), Packing(chosen)});
  }
  return out;
}

void write_pixels(PictureWriter& writer, const PixelBlock& pixels, const Packing& packing, const Area& area) {
  const int step = std::min(batch_rows, area.rows);
  const auto packed = std::make_unique_for_overwrite<std::byte[]>(
      packing.pixel_bytes() * static_cast<std::size_t>(area.width) * static_cast<std::size_t>(step));
  for (int row = 0; row < area.rows; row += step) {
    const int rows = std::min(step, area.rows - row);
    pixels.pack(packing, packed.get(), {area.x, area.y + row, area.width, rows});
    writer.write_rows(row, rows, packed.get());
  }
}

}  // namespace

void Picture::write(const std::filesystem::path& path, std::string_view compression,
                    std::span<const std::string> names) const {
  for (const std::string& name : names) {
    if (find(name) == nullptr)
      throw Error(ErrorCode::role_missing, "channel", escaped(name), "one of " + channel_list(*this));
  }
  const std::vector<PartToWrite> parts = parts_to_write(state_->parts, state_->pixels, names, compression);
  if (parts.empty())
    throw Error(ErrorCode::output, escaped(path.string()), "a picture without channels", "a channel at least");
  std::vector<PartDescription> descriptions;
  descriptions.reserve(parts.size());
  for (const PartToWrite& part : parts) descriptions.push_back(part.description);
  TemporaryFile file(path);
  try {
    const auto writer = image_library().create(file.stream(), file.path(), descriptions);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      writer->begin_part(p);
      write_pixels(*writer, state_->pixels, parts[p].packing, state_->area_of(descriptions[p].data));
    }
    writer->close();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    file.fail(error.what());
  }
  file.commit();
}

}  // namespace dermis::exr
