// What --filter chooses.
#pragma once

#include <functional>
#include <regex>
#include <string>
#include <vector>

#include "dermis/error.hpp"

namespace dermis::bench {

/// Those of `cases` whose `name` has a match of the regular expression (ECMAScript); all if it is empty. Throws
/// Error(usage) that names --filter if it is malformed or matches nothing.
template <class Named, class Name>
std::vector<Named> matching(std::vector<Named> cases, Name name, const std::string& expression) {
  try {
    const std::regex wanted(expression);
    std::erase_if(cases, [&](const Named& what) { return !std::regex_search(std::invoke(name, what), wanted); });
  } catch (const std::regex_error&) {
    throw Error(ErrorCode::usage, "--filter", expression, "a regular expression");
  }
  if (cases.empty()) throw Error(ErrorCode::usage, "--filter", expression, "a match of a name that --list prints");
  return cases;
}

}  // namespace dermis::bench
