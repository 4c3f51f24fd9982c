#include "report/view_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "files/picture_png.hpp"

namespace dermis::program {
namespace {

struct ViewLook {
  std::string_view colour;
  std::array<float, 3> rgb;  ///< scene-linear
};

/// People who do not see red and green apart can tell these apart. They begin anew for further views.
constexpr std::array<ViewLook, 6> view_looks = {{{"orange", {1, 0.25F, 0}},
                                                 {"blue", {0, 0.15F, 1}},
                                                 {"yellow", {1, 0.85F, 0.05F}},
                                                 {"cyan", {0, 0.75F, 0.8F}},
                                                 {"violet", {0.5F, 0.05F, 0.8F}},
                                                 {"white", {1, 1, 1}}}};

const ViewLook& view_look_of(std::size_t view) { return view_looks[view % view_looks.size()]; }

float luminance(const float* rgb) { return 0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2]; }

/// What a view brings to a pixel, as a share of the light there with it: 0..1, and 0 where that is not known.
float share_of(const ViewReport& report, std::size_t view, std::size_t pixel) {
  const float gain = std::abs(luminance(&report.gains[view][3 * pixel]));
  const float light = luminance(&report.light[3 * pixel]) + gain;
  return gain > 0 && light > 0 ? std::min(gain / light, 1.0F) : 0;
}

}  // namespace

ViewReport measure_views(const Plan& plan, const Frame& frame) {
  const std::size_t values = 3 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  const auto light_with = [&](std::vector<View> views) {
    std::vector<float> light(values);
    Frame alone = frame;
    alone.views = std::move(views);
    alone.scattered = {.host = light.data()};
    alone.beauty = {};
    alone.result = {};
    plan.run(alone);
    return light;
  };
  ViewReport report{light_with({}), {}};
  for (const View& view : frame.views) {
    std::vector<float> gain = light_with({view});
    for (std::size_t i = 0; i < values; ++i) gain[i] -= report.light[i];
    report.gains.push_back(std::move(gain));
  }
  return report;
}

std::string legend_of(const ViewReport& report, const std::vector<std::string>& names) {
  constexpr float least_share = 0.01F;
  const std::size_t pixels = report.light.size() / 3;
  std::string text = "view report pixels whose light a view changes by 1 % and more\n";
  for (std::size_t view = 0; view < report.gains.size(); ++view) {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
      if (share_of(report, view, i) >= least_share) ++count;
    }
    text += fmt::format("  {:<8}{:>9}  {}\n", view_look_of(view).colour, count, names[view]);
  }
  return text;
}

std::string view_report_png(int width, int height, const ViewReport& report) {
  constexpr float grey_share = 0.35F;  // of white, for the light that the views have not brought
  std::vector<float> rgb(report.light.size());
  for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
    float none = 1;  // the share of the light that no view has brought
    float all = 0;
    std::array<float, 3> mixed{};
    for (std::size_t view = 0; view < report.gains.size(); ++view) {
      const float share = share_of(report, view, i);
      none *= 1 - share;
      all += share;
      for (std::size_t c = 0; c < 3; ++c) mixed[c] += share * view_look_of(view).rgb[c];
    }
    const float light = luminance(&report.light[3 * i]);
    const float grey = light > 0 ? grey_share * std::min(light, 1.0F) : 0;
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = none * grey + (all > 0 ? (1 - none) * mixed[c] / all : 0);
  }
  return srgb_png(width, height, rgb);
}

}  // namespace dermis::program
