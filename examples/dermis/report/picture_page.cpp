#include "report/picture_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "files/picture_png.hpp"
#include "report/html.hpp"
#include "report/tile_map.hpp"

namespace dermis::program {
namespace {

/// Pictures on a page have no side longer than this.
constexpr int most_px = 1600;

/// The mean of each factor x factor pixels of a plane or of packed channels.
std::vector<float> shrink(std::span<const float> values, int width, int height, int factor) {
  if (factor == 1) return {values.begin(), values.end()};
  const std::size_t channels = values.size() / (static_cast<std::size_t>(width) * height);
  const int columns = width / factor;
  const int rows = height / factor;
  std::vector<float> small(static_cast<std::size_t>(columns) * rows * channels);
  const float share = 1.0F / static_cast<float>(factor * factor);
  for (int y = 0; y < rows * factor; ++y) {
    for (int x = 0; x < columns * factor; ++x) {
      const float* from = &values[(static_cast<std::size_t>(y) * width + x) * channels];
      float* to = &small[(static_cast<std::size_t>(y / factor) * columns + x / factor) * channels];
      for (std::size_t c = 0; c < channels; ++c) to[c] += share * from[c];
    }
  }
  return small;
}

std::string image(const std::string& png, std::string_view attributes = "alt=\"\"") {
  return fmt::format("<img {} src=\"{}\">", attributes, address_of(png));
}

/// A map in false colours, with their ramp from 0 to `most` of `unit`.
std::string map_figure(const PageImages& images, std::vector<float> values, float most, std::string_view unit,
                       std::string_view caption) {
  for (float& value : values) value = most > 0 ? std::min(value / most, 1.0F) : 0.0F;
  std::vector<float> ramp(256);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<float>(i) / 255;
  return fmt::format("<figure>{}{}<figcaption>{}: 0 to {:.3g} {}</figcaption></figure>\n",
                     image(heatmap_png(images.width, images.height, values)),
                     image(heatmap_png(256, 1, ramp), "class=\"ramp\" alt=\"\""), caption, most, unit);
}

/// The change of each pixel, and the one that 99 % of those that change do not exceed.
struct Change {
  std::vector<float> values;
  float most = 0;
};

Change change_of(const PageImages& images) {
  Change change;
  change.values.resize(images.radius_px.size());
  std::vector<float> all;
  for (std::size_t i = 0; i < change.values.size(); ++i) {
    float sum = 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) sum += std::abs(images.after[c] - images.before[c]);
    change.values[i] = std::isfinite(sum) ? sum / 3 : 0;
    if (change.values[i] > 0) all.push_back(change.values[i]);
  }
  if (all.empty()) return change;
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), at, all.end());
  change.most = *at;
  return change;
}

std::string block_figure(const PageImages& images, const TileMap& blocks) {
  std::string caption;
  for (const KindShare& its : shares_of(blocks)) {
    if (its.blocks == 0) continue;
    std::string colour;  // as a browser has it; looks are of light, 0..1
    for (const float channel : its.rgb) colour += fmt::format("{:.0f} ", 255 * std::sqrt(channel));
    caption += fmt::format("<span class=\"swatch\" style=\"background: rgb({})\"></span>{} {:.1f} %", colour, its.name,
                           its.percent);
  }
  return fmt::format("<figure>{}<figcaption>What became of each block of {} x {} pixels:{}</figcaption></figure>\n",
                     image(srgb_png(images.width, images.height, images.blocks)), blocks.tile_width, blocks.tile_height,
                     caption);
}

std::string list_of(std::string_view title, const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string items;
  for (const std::string& line : lines) items += fmt::format("<li>{}</li>\n", html_of(line));
  return fmt::format("<h2>{}</h2>\n<ul>\n{}</ul>\n", title, items);
}

}  // namespace

PageImages page_images(int width, int height, std::span<const float> before, std::span<const float> after,
                       std::span<const float> radius_px, std::span<const float> blocks) {
  const int factor = std::min({(std::max(width, height) + most_px - 1) / most_px, width, height});
  const auto small = [&](std::span<const float> values) { return shrink(values, width, height, factor); };
  return {width / factor, height / factor,  small(before),
          small(after),   small(radius_px), blocks.empty() ? std::vector<float>() : small(blocks)};
}

std::string picture_page(const std::string& title, const std::string& command, const PageImages& images,
                         const StatsReport& report) {
  const auto shown = [&](const std::vector<float>& rgb, std::string_view attributes) {
    return image(srgb_png(images.width, images.height, rgb), attributes);
  };
  std::string body = fmt::format(
      "<div class=\"pair\">{}{}<div class=\"line\"></div><input type=\"range\" min=\"0\" max=\"100\" step=\"0.1\" "
      "value=\"50\" aria-label=\"before on the left, after on the right\" "
      "oninput=\"this.parentElement.style.setProperty('--at', this.value + '%')\"></div>\n"
      "<figcaption>Before on the left, after on the right: drag.</figcaption>\n<div class=\"maps\">\n",
      shown(images.before, "class=\"before\" alt=\"before\""), shown(images.after, "class=\"after\" alt=\"after\""));
  const Change change = change_of(images);
  body += map_figure(images, change.values, change.most, "of light, mean of the channels", "Change");
  const float widest =
      images.radius_px.empty() ? 0 : *std::max_element(images.radius_px.begin(), images.radius_px.end());
  body += map_figure(images, images.radius_px, widest, "pixels", "Radius of the kernel");
  if (!images.blocks.empty()) body += block_figure(images, report.stats.blocks);
  body += "</div>\n";
  body += list_of("Warnings", report.warnings) + list_of("Notes", report.notes) + list_of("Input", report.input);
  body += fmt::format("<h2>Times and counts</h2>\n<pre>{}</pre>\n<h2>Command</h2>\n<pre>dermis {}</pre>\n",
                      html_of(text_of(report)), html_of(command));
  return page_of(title, body);
}

}  // namespace dermis::program
