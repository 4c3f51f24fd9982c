#include "files/gaussian_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "dermis/error.hpp"
#include "files/input_file.hpp"

namespace dermis::program {
namespace {

using nlohmann::json;

class Reader {
 public:
  Reader(std::string_view argument, const std::string& path) : argument_(argument), path_(path) {}

  std::vector<GaussianTerm> read() const {
    const json root = read_json(argument_, path_, "a JSON file with the terms of a sum of Gaussians");
    if (!root.is_object() || !root.contains("terms") || !root["terms"].is_array() || root["terms"].empty())
      fail("no list of terms", R"({"terms": [{"variance_mm2": v, "weight": [r, g, b]}, ...]})");
    constexpr std::size_t most_terms = 256;
    if (root["terms"].size() > most_terms)
      fail(fmt::format("{} terms", root["terms"].size()), fmt::format("at most {}", most_terms));
    std::vector<GaussianTerm> terms;
    for (const json& term : root["terms"]) terms.push_back(read_term(term, fmt::format("terms[{}]", terms.size())));
    for (std::size_t channel = 0; channel < 3; ++channel)
      if (std::none_of(terms.begin(), terms.end(), [&](const auto& term) { return term.weight[channel] > 0; }))
        fail(fmt::format("no weight above 0 for channel {}", channel), "one in every channel");
    return terms;
  }

 private:
  GaussianTerm read_term(const json& term, const std::string& place) const {
    if (!term.is_object() || !term.contains("variance_mm2") || !term.contains("weight"))
      fail(place + " = " + printed(term), "an object with variance_mm2 and weight");
    const json& weight = term["weight"];
    if (!weight.is_array() || weight.size() != 3) fail(place + ".weight = " + printed(weight), "three numbers");
    GaussianTerm result{read_number(term["variance_mm2"], place + ".variance_mm2"), {}};
    if (!(result.variance_mm2 > 0)) fail(place + ".variance_mm2 = 0", "a number > 0");
    for (std::size_t channel = 0; channel < 3; ++channel)
      result.weight[channel] = read_number(weight[channel], fmt::format("{}.weight[{}]", place, channel));
    return result;
  }

  double read_number(const json& value, const std::string& place) const {
    const double number = value.is_number() ? value.get<double>() : -1;
    if (!std::isfinite(number) || number < 0) fail(place + " = " + printed(value), "a finite number >= 0");
    return number;
  }

  [[noreturn]] void fail(std::string_view seen, std::string_view wanted) const {
    throw Error(ErrorCode::input_unsupported, fmt::format("{} {}", argument_, path_), seen, wanted);
  }

  std::string argument_;
  std::string path_;
};

}  // namespace

std::vector<GaussianTerm> read_gaussians(std::string_view argument, const std::string& path) {
  return Reader(argument, path).read();
}

}  // namespace dermis::program
