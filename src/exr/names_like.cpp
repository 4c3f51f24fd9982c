#include "exr/names_like.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

constexpr std::size_t most_names = 3;

/// Levenshtein's distance: the least number of letters to add, remove or replace. Row by row of the table of all
/// beginnings of both.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j + 1] + 1, row[j] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string names_like(std::string_view wrong, std::span<const std::string> names) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const std::string& name : names) ranked.emplace_back(distance(lower(wrong), lower(name)), name);
  std::sort(ranked.begin(), ranked.end());
  ranked.erase(std::unique(ranked.begin(), ranked.end()), ranked.end());
  if (ranked.size() > most_names) ranked.resize(most_names);
  std::string out;
  for (const auto& [its_distance, name] : ranked) {
    out += out.empty() ? "" : " or ";
    out += '"' + escaped(name) + '"';
  }
  return out;
}

}  // namespace dermis::exr
