// One claim of the paper beside what was measured.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dermis::bench {

struct Claim {
  std::string id;        ///< of the object in claims.json
  std::string where;     ///< in the paper
  std::string text;      ///< in a few own words
  std::string test;      ///< what counts as holding; of our choice where the paper gives no number
  std::string measured;  ///< the numbers, for the table
  std::string verdict;   ///< "holds", "does not hold", ...
  nlohmann::ordered_json numbers;
};

using Claims = std::vector<Claim>;

inline std::string verdict_of(bool holds) { return holds ? "holds" : "does not hold"; }

/// "holds", "does not hold" or which of both for whom.
std::string verdict_of(const std::vector<std::string>& holds_for, const std::vector<std::string>& fails_for);

/// 0.0123 as "1.2 %".
std::string percent(double share);

/// "1.2 %, 3.4 %, 5.6 %".
std::string percents(const std::vector<double>& shares);

/// Claims as a Markdown table, and as JSON.
std::string table_of(const Claims& claims);
nlohmann::ordered_json json_of(const Claims& claims);

}  // namespace dermis::bench
