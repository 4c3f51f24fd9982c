#include "paper/claim.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dermis::bench {

namespace {

/// "a, b and c".
std::string listed(std::vector<std::string> names) {
  const std::string last = names.back();
  names.pop_back();
  return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

}  // namespace

void Evidence::add(const std::string& name, const std::string& text, const Json& numbers, bool holds) {
  texts_.push_back(name + ": " + text);
  numbers_[name] = numbers;
  (holds ? holds_for_ : fails_for_).push_back(name);
}

std::string Evidence::verdict() const {
  if (fails_for_.empty() || holds_for_.empty()) return verdict_of(fails_for_.empty());
  return fmt::format("holds for {}, not for {}", listed(holds_for_), listed(fails_for_));
}

Claim Evidence::claim(const std::string& id, const std::string& where, const std::string& text, const std::string& test,
                      const std::string& introduction) const {
  const std::string measured =
      fmt::format("{}{}{}", introduction, introduction.empty() ? "" : "<br>", fmt::join(texts_, "<br>"));
  return {id, where, text, test, measured, verdict(), numbers_};
}

std::string percent(double share) {
  // Two digits, and three of what would be rounded to 100.
  return share < 0.995 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.1f} %", 100 * share);
}

std::string percents(const std::vector<double>& shares) {
  std::vector<std::string> texts;
  texts.reserve(shares.size());
  for (const double share : shares) texts.push_back(percent(share));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string table_of(const Claims& claims) {
  std::string text =
      "| where | the claim | counts as holding if | measured | verdict |\n"
      "|---|---|---|---|---|\n";
  for (const Claim& claim : claims) {
    text += fmt::format("| {} | {} | {} | {} | **{}** |\n", claim.where, claim.text, claim.test, claim.measured,
                        claim.verdict);
  }
  return text;
}

Json json_of(const Claims& claims) {
  Json all;
  for (const Claim& claim : claims) {
    all[claim.id] = {{"where", claim.where},
                     {"claim", claim.text},
                     {"test", claim.test},
                     {"measured", claim.numbers},
                     {"verdict", claim.verdict}};
  }
  return all;
}

}  // namespace dermis::bench
