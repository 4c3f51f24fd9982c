// dermis compare: how far a picture is from a reference, channel group by channel group.
#include "dermis/oracle/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "files/channel_groups.hpp"
#include "files/output_file.hpp"
#include "files/picture_png.hpp"

namespace dermis::program {
namespace {

constexpr int differs = 1;  // exit code

struct CompareArguments {
  std::string a;
  std::string b;
  std::string channels;
  std::string mask_channel;
  std::optional<double> max_rel_l2;
  bool identical = false;
  std::string heatmap;
};

std::string text_of(const exr::Window& window) {
  return fmt::format("{} x {} pixels at ({}, {})", window.width, window.height, window.x, window.y);
}

/// The pixels that both have, by their place on the display; said if they are not all there are.
exr::Window overlap_of(const exr::Window& a, const exr::Window& b) {
  const exr::Window both = common_window(a, b);
  if (both.width < 1 || both.height < 1)
    throw Error(ErrorCode::input_unsupported, "A", text_of(a), "a window that overlaps that of B, " + text_of(b));
  if (!(a == b)) fmt::print("windows: A {}, B {}; compared: {}\n", text_of(a), text_of(b), text_of(both));
  return both;
}

/// NAME=VALUE: 1 where the channel of `b` has the value.
oracle::Picture read_mask(const std::string& text, const exr::Picture& b, const exr::Window& window) {
  const std::size_t equals = text.rfind('=');
  const auto value = equals == std::string::npos ? std::nullopt : parse_real(std::string_view(text).substr(equals + 1));
  if (!value) throw Error(ErrorCode::usage, "--mask-channel", text, "CHANNEL=VALUE, as ViewLayer.IndexMA.X=1");
  const std::string name = text.substr(0, equals);
  if (b.find(name) == nullptr)
    throw Error(ErrorCode::role_missing, "--mask-channel", name + ", which B does not have",
                "the full name of a channel");
  oracle::Picture mask = values_of(b, {"", {name}}, window);
  for (double& found : mask.values) found = found == *value ? 1 : 0;
  if (std::count(mask.values.begin(), mask.values.end(), 1.0) == 0)
    throw Error(ErrorCode::usage, "--mask-channel", text + ", which no pixel has", "a value that occurs");
  return mask;
}

void print_missing(std::string_view picture, const std::vector<std::string>& channels) {
  if (!channels.empty()) fmt::print("only in {}: {}\n", picture, fmt::join(channels, " "));
}

void print_difference(const ChannelGroup& group, const oracle::Difference& difference, const exr::Window& window) {
  const std::string& channel = group.channels[static_cast<std::size_t>(difference.max_channel)];
  fmt::print("{:<24} rel_l2 {:<11.4g} rmse {:<11.4g} psnr {:<7.2f} max {:<11.4g} at ({}, {}) {}: {:.9g} and {:.9g}\n",
             group.name.empty() ? "-" : group.name, difference.relative_l2, difference.rmse, difference.psnr_db,
             difference.max, window.x + difference.max_x, window.y + difference.max_y, channel, difference.max_a,
             difference.max_b);
}

/// Values that are not finite in both and equal in kind count as equal, as in oracle::compare.
double distance(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  return std::abs(a - b);
}

/// The largest difference of each pixel over all groups.
class HeatMap {
 public:
  HeatMap(int width, int height)
      : width_(width), height_(height), values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  void add(const oracle::Picture& a, const oracle::Picture& b, const std::optional<oracle::Picture>& mask) {
    const std::size_t channels = static_cast<std::size_t>(a.channels);
    for (std::size_t i = 0; i < a.values.size(); ++i) {
      if (mask && mask->values[i / channels] == 0) continue;
      float& value = values_[i / channels];
      const float found = static_cast<float>(distance(a.values[i], b.values[i]));
      value = found <= value ? value : found;  // and not a number is larger than all
    }
  }

  /// White is the largest difference that is finite, or none at all.
  void write(const std::string& path) {
    float largest = 0;
    for (const float value : values_)
      if (std::isfinite(value)) largest = std::max(largest, value);
    for (float& value : values_) value = !std::isfinite(value) ? 1.0F : largest > 0 ? value / largest : 0.0F;
    TemporaryFile temporary(path, "--heatmap");
    write_heatmap_png(temporary, width_, height_, values_);
    temporary.commit();
    fmt::print("heat map: brightest = {:.4g}\n", largest);
  }

 private:
  int width_;
  int height_;
  std::vector<float> values_;
};

/// True if the channels are the same to the bit, and there are as many pixels.
bool print_different_bits(const exr::Picture& a, const exr::Picture& b, const SharedChannels& shared,
                          const exr::Window& window, const std::optional<oracle::Picture>& mask) {
  bool identical = a.data_window() == b.data_window();
  if (!identical) fmt::print("not identical: data windows\n");
  for (const ChannelGroup& group : shared.groups) {
    for (const std::string& channel : group.channels) {
      const std::int64_t different = count_different_bits(a, b, channel, window, mask);
      if (different > 0) fmt::print("not identical: {}, {} values\n", channel, different);
      identical = identical && different == 0;
    }
  }
  if (identical) fmt::print("identical\n");
  return identical;
}

int run_compare(const CompareArguments& arguments) {
  if (!arguments.heatmap.empty()) check_writable("--heatmap", arguments.heatmap);
  const exr::Picture a = exr::Picture::read(arguments.a);
  const exr::Picture b = exr::Picture::read(arguments.b);
  const SharedChannels shared = share_channels(a, b, arguments.channels);
  if (shared.groups.empty())
    throw Error(
        ErrorCode::input_unsupported, "A and B",
        "no channel that both have" + (arguments.channels.empty() ? "" : " and that starts with " + arguments.channels),
        "one at least");
  const exr::Window window = overlap_of(a.data_window(), b.data_window());
  std::optional<oracle::Picture> mask;
  if (!arguments.mask_channel.empty()) mask = read_mask(arguments.mask_channel, b, window);

  print_missing("A", shared.only_a);
  print_missing("B", shared.only_b);
  HeatMap heatmap(window.width, window.height);
  bool close = true;
  for (const ChannelGroup& group : shared.groups) {
    const oracle::Picture values_a = values_of(a, group, window);
    const oracle::Picture values_b = values_of(b, group, window);
    const oracle::Difference difference =
        mask ? oracle::compare(values_a, values_b, *mask) : oracle::compare(values_a, values_b);
    print_difference(group, difference, window);
    if (arguments.max_rel_l2 && !(difference.relative_l2 <= *arguments.max_rel_l2)) close = false;
    if (!arguments.heatmap.empty()) heatmap.add(values_a, values_b, mask);
  }
  if (arguments.identical && !print_different_bits(a, b, shared, window, mask)) close = false;
  if (!arguments.heatmap.empty()) heatmap.write(arguments.heatmap);
  return close ? 0 : differs;
}

}  // namespace

Command add_compare(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("compare", "how far a picture is from a reference, per group of channels");
  const auto arguments = std::make_shared<CompareArguments>();
  app->add_option("a", arguments->a, "the picture")->required()->type_name("A");
  app->add_option("b", arguments->b, "the reference")->required()->type_name("B");
  app->add_option("--channels", arguments->channels, "only channels whose names start with this")->type_name("PREFIX");
  app->add_option("--mask-channel", arguments->mask_channel, "only pixels where this channel of B has this value")
      ->type_name("NAME=VALUE");
  app->add_option("--max-rel-l2", arguments->max_rel_l2, "exit with 1 if the relative L2 of any group is above this")
      ->check(real_number([](double limit) { return limit >= 0; }, "a finite number >= 0"));
  app->add_flag("--identical", arguments->identical, "exit with 1 if any bit of the common channels differs");
  app->add_option("--heatmap", arguments->heatmap, "draw the largest difference of each pixel")
      ->check(file_name_ending({".png"}))
      ->type_name("FILE.png");
  return {app, [arguments] { return run_compare(*arguments); }};
}

}  // namespace dermis::program
