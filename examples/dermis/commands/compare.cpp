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
#include "commands/truth_comparison.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/message_text.hpp"
#include "files/channel_groups.hpp"
#include "files/mask_channel.hpp"
#include "files/output_file.hpp"
#include "files/picture_png.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

constexpr int differs = 1;  // exit code

struct CompareArguments {
  std::string a;
  std::string b;
  std::vector<std::string> truths;
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
  if (!(a == b)) print(fmt::format("windows: A {}, B {}; compared: {}\n", text_of(a), text_of(b), text_of(both)));
  return both;
}

void print_missing(std::string_view picture, const std::vector<std::string>& channels) {
  if (!channels.empty())
    print(
        fmt::format("only in {}: {}\n", picture, exr::escaped(fmt::format("{}", fmt::join(channels, " ")), SIZE_MAX)));
}

void print_difference(const ChannelGroup& group, const oracle::Difference& difference, const exr::Window& window) {
  const std::string& channel = group.channels[static_cast<std::size_t>(difference.max_channel)];
  print(fmt::format(
      "{:<24} rel_l2 {:<11.4g} rmse {:<11.4g} psnr {:<7.2f} max {:<11.4g} at ({}, {}) {}: {:.9g} and {:.9g}\n",
      group.name.empty() ? "-" : exr::escaped(group.name), difference.relative_l2, difference.rmse, difference.psnr_db,
      difference.max, window.x + difference.max_x, window.y + difference.max_y, exr::escaped(channel), difference.max_a,
      difference.max_b));
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
    write_file("--heatmap", path, heatmap_png(width_, height_, values_));
    print(fmt::format("heat map: brightest = {:.4g}\n", largest));
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
  if (!identical) print("not identical: data windows\n");
  for (const ChannelGroup& group : shared.groups) {
    for (const std::string& channel : group.channels) {
      const std::int64_t different = count_different_bits(a, b, channel, window, mask);
      if (different > 0) print(fmt::format("not identical: {}, {} values\n", exr::escaped(channel), different));
      identical = identical && different == 0;
    }
  }
  if (identical) print("identical\n");
  return identical;
}

int run_compare(const CompareArguments& arguments) {
  if (arguments.b.empty() == arguments.truths.empty())
    throw Error(ErrorCode::usage, "b", arguments.b.empty() ? "nothing to compare with" : "it with --truth",
                "a reference B, or --truth");
  if (arguments.truths.size() > 2)
    throw Error(ErrorCode::usage, "--truth", fmt::format("{} files", arguments.truths.size()), "one or two");
  if (!arguments.truths.empty()) {
    const double error = print_truth_error({arguments.a, arguments.truths, arguments.mask_channel});
    return !arguments.max_rel_l2 || error <= *arguments.max_rel_l2 ? 0 : differs;
  }
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
  if (!arguments.mask_channel.empty()) mask = read_mask(arguments.mask_channel, "B", b, window);

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
  app->add_option("b", arguments->b, "the reference, unless there is a truth")->type_name("B");
  auto* truth =
      app->add_option(
             "--truth", arguments->truths,
             "a path-traced picture of the view: how far the scattered light of A is from it, for each material; "
             "with a second one of another seed without the noise of both")
          ->allow_extra_args(false)
          ->type_name("FILE");
  app->add_option("--channels", arguments->channels, "only channels whose names start with this")
      ->excludes(truth)
      ->type_name("PREFIX");
  app->add_option("--mask-channel", arguments->mask_channel,
                  "only pixels where this channel of B (with --truth: of A) has this value")
      ->type_name("NAME=VALUE");
  app->add_option("--max-rel-l2", arguments->max_rel_l2, "exit with 1 if the relative L2 of any group is above this")
      ->check(real_number([](double limit) { return limit >= 0; }, "a finite number >= 0"));
  app->add_flag("--identical", arguments->identical, "exit with 1 if any bit of the common channels differs")
      ->excludes(truth);
  app->add_option("--heatmap", arguments->heatmap, "draw the largest difference of each pixel")
      ->check(file_name_ending({".png"}))
      ->excludes(truth)
      ->type_name("FILE.png");
  return {app, [arguments] { return run_compare(*arguments); }};
}

}  // namespace dermis::program
