// One claim of the paper beside what was measured.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dermis::bench {

using Json = nlohmann::ordered_json;

struct Claim {
  std::string id;        ///< of the object in claims.json
  std::string where;     ///< in the paper
  std::string text;      ///< in a few own words
  std::string test;      ///< what counts as holding; of our choice where the paper gives no number
  std::string measured;  ///< the numbers, for the table
  std::string verdict;   ///< "holds", "does not hold", ...
  Json numbers;
};

using Claims = std::vector<Claim>;

inline std::string verdict_of(bool holds) { return holds ? "holds" : "does not hold"; }

/// The measurements for one claim, name by name.
class Evidence {
 public:
  void add(const std::string& name, const std::string& text, const Json& numbers, bool holds);

  /// The claim that they support or not. For the table, `introduction` stands above the texts, a line each; the verdict
  /// is "holds", "does not hold" or which of both for whom.
  Claim claim(const std::string& id, const std::string& where, const std::string& text, const std::string& test,
              const std::string& introduction = "") const;

 private:
  std::string verdict() const;

  std::vector<std::string> texts_, holds_for_, fails_for_;
  Json numbers_;
};

/// 0.0123 as "1.2 %".
std::string percent(double share);

/// "1.2 %, 3.4 %, 5.6 %".
std::string percents(const std::vector<double>& shares);

/// Claims as a Markdown table, and as JSON.
std::string table_of(const Claims& claims);
Json json_of(const Claims& claims);

}  // namespace dermis::bench
