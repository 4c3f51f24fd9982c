#include "dermis/settings.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "dermis/error.hpp"

namespace dermis {

namespace {

template <class Value>
void parse_number(std::string_view name, std::string_view text, Value& value) {
  Value parsed{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (problem != std::errc() || end != text.data() + text.size()) {
    throw Error(ErrorCode::usage, name, text, std::is_integral_v<Value> ? "a whole number" : "a number");
  }
  value = parsed;
}

void parse(std::string_view name, std::string_view text, double& value) { parse_number(name, text, value); }
void parse(std::string_view name, std::string_view text, int& value) { parse_number(name, text, value); }
void parse(std::string_view name, std::string_view text, std::uint32_t& value) { parse_number(name, text, value); }
void parse(std::string_view, std::string_view text, std::string& value) { value = text; }

void parse(std::string_view name, std::string_view text, bool& value) {
  if (text != "on" && text != "off") throw Error(ErrorCode::usage, name, text, "on or off");
  value = text == "on";
}

template <HasWords Value>
void parse(std::string_view name, std::string_view text, Value& value) {
  const auto named = value_named<Value>(text);
  if (!named) {
    std::string words;
    for (const auto& [ignored, word] : word_table<Value>) words += (words.empty() ? "" : ", ") + std::string(word);
    throw Error(ErrorCode::usage, name, text, words);
  }
  value = *named;
}

template <class Value>
void parse(std::string_view name, std::string_view text, std::optional<Value>& value) {
  if (text == "none") {
    value.reset();
    return;
  }
  parse(name, text, value.emplace());
}

/// Sets what a pointer to a member of Options, or of a member of it, leads to.
template <auto member>
void set_one(Options& options, std::string_view name, std::string_view text) {
  parse(name, text, options.*member);
}

template <auto group, auto member>
void set_in(Options& options, std::string_view name, std::string_view text) {
  parse(name, text, options.*group.*member);
}

struct Row {
  Setting setting;
  void (*set)(Options& options, std::string_view name, std::string_view text);
};

constexpr std::array rows = {
    Row{{"method", "separable, exact or disc"}, set_one<&Options::method>},
    Row{{"quality", "of the separable method: draft, preview, final or reference; none: by taps"},
        set_one<&Options::quality>},
    Row{{"tolerance", "in place of a quality: predicted error to be content with, below 1; 0: none"},
        set_one<&Options::tolerance>},
    Row{{"model", "of taps: pre-integrated, artist, guided, svd, gaussians, optimised"},
        set_in<&Options::taps, &TapsDesign::model>},
    Row{{"rank", "of taps: separable terms"}, set_in<&Options::taps, &TapsDesign::rank>},
    Row{{"taps", "per pass, odd, 3..2047"}, set_in<&Options::taps, &TapsDesign::count>},
    Row{{"placement", "of taps: uniform, importance, quadratic, optimised"},
        set_in<&Options::taps, &TapsDesign::placement>},
    Row{{"disc_samples", "of the disc method, 1..1024; 0: by the width of the kernel"},
        set_in<&Options::disc, &DiscOptions::samples>},
    Row{{"disc_accumulate", "results of further seeds to take the mean of"},
        set_in<&Options::disc, &DiscOptions::accumulate>},
    Row{{"disc_prefiltered", "on or off: samples read as much as they stand for"},
        set_in<&Options::disc, &DiscOptions::prefiltered>},
    Row{{"sheared", "on or off: the vertical pass crosses the horizontal one on the surface"},
        set_one<&Options::sheared>},
    Row{{"jitter", "share of the kernel radius within which taps turn, 0..1"}, set_one<&Options::jitter>},
    Row{{"seed", "of taps or discs that turn"}, set_one<&Options::seed>},
    Row{{"lighting", "raw: the light is without albedo; lit: it is in it"}, set_one<&Options::lighting>},
    Row{{"albedo_mix", "m: albedo^m goes in before the passes, albedo^(1-m) after"}, set_one<&Options::albedo_mix>},
    Row{{"curvature", "on or off: random walks gain where a surface bends; needs normals"},
        set_one<&Options::curvature>},
    Row{{"sums_weights", "on or off: sums are not divided by those of weights"}, set_one<&Options::sums_weights>},
    Row{{"bad_pixels", "keep, zero or error"}, set_one<&Options::bad_pixels>},
    Row{{"skip_uniform_light", "on or off"}, set_one<&Options::skip_uniform_light>},
    Row{{"device_memory_mb", "of device memory that a run may take, else it goes band by band; 0: all"},
        set_one<&Options::device_memory_mb>},
    Row{{"cache_folder", "in which taps are kept for later processes"}, set_one<&Options::cache_folder>},
};

}  // namespace

std::span<const Setting> settings() {
  static const auto all = [] {
    std::array<Setting, rows.size()> result{};
    std::transform(rows.begin(), rows.end(), result.begin(), [](const Row& row) { return row.setting; });
    return result;
  }();
  return all;
}

void set(Options& options, std::string_view name, std::string_view value) {
  std::string names;
  for (const Row& row : rows) {
    if (name == row.setting.name) return row.set(options, name, value);
    names += (names.empty() ? "" : ", ") + std::string(row.setting.name);
  }
  throw Error(ErrorCode::usage, "setting", name, names);
}

}  // namespace dermis
