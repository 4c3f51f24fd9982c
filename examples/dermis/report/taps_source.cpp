#include "report/taps_source.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "dermis/version.hpp"

namespace dermis::program {
namespace {

using Triple = std::array<float, 3>;

/// How a language writes what the arrays need.
struct Grammar {
  std::string_view constant;       ///< before a declaration
  std::string_view number_suffix;  ///< of a float
};

constexpr Grammar c_grammar{"static const ", "F"};
constexpr Grammar glsl_grammar{"const ", ""};
constexpr Grammar hlsl_grammar{"static const ", ""};

/// The shortest text that restores the float and is one in all three languages.
std::string number(float value, const Grammar& grammar) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + std::string(grammar.number_suffix);
}

std::string_view offset_type(Fetch fetch) { return fetch == Fetch::linear ? "float" : "int"; }

std::string offset(const TapSet& set, std::size_t i, const Grammar& grammar) {
  const double offset_px = set.offsets_px[i];
  return set.fetch == Fetch::linear ? number(static_cast<float>(offset_px), grammar) : offset_text(offset_px);
}

/// Rows of an array: one element a line.
std::string rows(std::size_t count, const std::function<std::string(std::size_t)>& row,
                 std::string_view indent = "    ") {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += fmt::format("{}{}{}\n", indent, row(i), i + 1 < count ? "," : "");
  return text;
}

std::string triple(const Triple& value, const Grammar& grammar) {
  return fmt::format("{}, {}, {}", number(value[0], grammar), number(value[1], grammar), number(value[2], grammar));
}

/// Line ends and comment ends in a name must not end the comment.
std::string in_comment(std::string_view text) {
  std::string result;
  for (const char c : text) result.push_back(static_cast<unsigned char>(c) < 0x20 || c == '*' || c == '\\' ? '_' : c);
  return result;
}

Triple scale_of(const TapTerm& term) {
  return {static_cast<float>(term.scale[0]), static_cast<float>(term.scale[1]), static_cast<float>(term.scale[2])};
}

std::string comment_of(const TapsReport& report, std::string_view weight, std::string_view between) {
  return fmt::format(
      "/* {}\n"
      "   Made by dermis {}.\n"
      "\n"
      "   Horizontal pass, one image per term t:  h[t](x, y) = sum over i of {} * light(x + offset[i], y)\n"
      "   Vertical pass, one image from all:      sum over t of scale[t] * (sum over i of {} * h[t](x, y + "
      "offset[i]))\n"
      "   per channel R, G, B. Offsets are in pixels{}. The light is without its albedo. */\n",
      in_comment(title_of(report)), DERMIS_VERSION, weight, weight, between);
}

std::string_view between_pixels(Fetch fetch) {
  return fetch == Fetch::linear ? "; between pixels, read by linear interpolation of the two neighbours" : "";
}

constexpr std::string_view c_integer_read =
    R"(/* The pixel of a row at tap i from pixel x; beyond its ends the row goes on as they are. */
static inline float dermis_read(const float* row, int count, int x, int i) {
  int at = x + dermis_offset_px[i];
  at = at < 0 ? 0 : at >= count ? count - 1 : at;
  return row[at];
}
)";

constexpr std::string_view c_linear_read =
    R"(/* The row at tap i from pixel x; beyond its ends the row goes on as they are. */
static inline float dermis_read(const float* row, int count, int x, int i) {
  float at = (float)x + dermis_offset_px[i];
  int left = 0;
  if (at <= 0) return row[0];
  if (at >= (float)(count - 1)) return row[count - 1];
  left = (int)at;
  at -= (float)left;
  return row[left] * (1 - at) + row[left + 1] * at;
}
)";

constexpr std::string_view c_passes = R"(
/* One channel of pixel x of a row of `count` pixels (or of a column) after a pass of term t. */
static inline float dermis_pass(const float* row, int count, int x, int t, int channel) {
  float sum = 0;
  for (int i = 0; i < dermis_taps; ++i) sum += dermis_weight[t][i][channel] * dermis_read(row, count, x, i);
  return sum;
}

/* The result, from one channel of every term after both passes. */
static inline float dermis_sum(const float* of_terms, int channel) {
  float sum = 0;
  for (int t = 0; t < dermis_terms; ++t) sum += dermis_scale[t][channel] * of_terms[t];
  return sum;
}
)";

std::string c_source(const TapsReport& report) {
  const TapSet& set = report.set;
  const Grammar& grammar = c_grammar;
  const std::size_t taps = set.offsets_px.size();
  std::string text = comment_of(report, "weight[t][i]", between_pixels(set.fetch));
  text += fmt::format("enum {{ dermis_terms = {}, dermis_taps = {} }};\n\n", set.terms.size(), taps);
  text += fmt::format("{}{} dermis_offset_px[dermis_taps] = {{\n{}}};\n\n", grammar.constant, offset_type(set.fetch),
                      rows(taps, [&](auto i) { return offset(set, i, grammar); }));
  text +=
      fmt::format("{}float dermis_scale[dermis_terms][3] = {{\n{}}};\n\n", grammar.constant,
                  rows(set.terms.size(), [&](auto t) { return "{" + triple(scale_of(set.terms[t]), grammar) + "}"; }));
  const auto weights_of = [&](std::size_t t) {
    const auto& weights = set.terms[t].weights;
    return "{\n" +
           rows(
               taps, [&](auto i) { return "{" + triple(weights[i], grammar) + "}"; }, "        ") +
           "    }";
  };
  text += fmt::format("{}float dermis_weight[dermis_terms][dermis_taps][3] = {{\n{}}};\n\n", grammar.constant,
                      rows(set.terms.size(), weights_of));
  return text + std::string(set.fetch == Fetch::linear ? c_linear_read : c_integer_read) + std::string(c_passes);
}

/// What GLSL and HLSL differ in: how an array of `type` is written.
using ArrayText = std::function<std::string(std::string_view type, std::string_view name, std::string_view size,
                                            const std::string& elements)>;

/// Weights in one row, term after term: arrays of arrays came late to GLSL.
std::string shader_source(const TapsReport& report, const Grammar& grammar, std::string_view vector,
                          const ArrayText& array) {
  const TapSet& set = report.set;
  const std::size_t taps = set.offsets_px.size();
  const std::size_t terms = set.terms.size();
  const auto element = [&](const Triple& value) { return fmt::format("{}({})", vector, triple(value, grammar)); };
  std::string text = comment_of(report, "weight[t * taps + i]", between_pixels(set.fetch));
  text += fmt::format("{0}int dermis_terms = {1};\n{0}int dermis_taps = {2};\n\n", grammar.constant, terms, taps);
  text += array(offset_type(set.fetch), "dermis_offset_px", std::to_string(taps),
                rows(taps, [&](auto i) { return offset(set, i, grammar); }));
  text += array(vector, "dermis_scale", std::to_string(terms),
                rows(terms, [&](auto t) { return element(scale_of(set.terms[t])); }));
  text += array(vector, "dermis_weight", std::to_string(terms * taps),
                rows(terms * taps, [&](auto k) { return element(set.terms[k / taps].weights[k % taps]); }));
  return text;
}

std::string glsl_source(const TapsReport& report) {
  const auto array = [](auto type, auto name, auto size, auto& elements) {
    return fmt::format("{0}{1} {2}[{3}] = {1}[{3}](\n{4});\n\n", glsl_grammar.constant, type, name, size, elements);
  };
  return "/* For GLSL 1.20 and later and GLSL ES 3.00 and later; goes behind #version. */\n" +
         shader_source(report, glsl_grammar, "vec3", array);
}

std::string hlsl_source(const TapsReport& report) {
  const auto array = [](auto type, auto name, auto size, auto& elements) {
    return fmt::format("{}{} {}[{}] = {{\n{}}};\n\n", hlsl_grammar.constant, type, name, size, elements);
  };
  return shader_source(report, hlsl_grammar, "float3", array);
}

}  // namespace

std::string source_of(const TapsReport& report, Language language) {
  switch (language) {
    case Language::glsl:
      return glsl_source(report);
    case Language::hlsl:
      return hlsl_source(report);
    case Language::c:
      break;
  }
  return c_source(report);
}

}  // namespace dermis::program
