/// The words for the values of enumerations: options, lists, help and reports are made from one table each.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace dermis {

/// A value of an enumeration and its word.
template <class Value>
struct Named {
  Value value;
  std::string_view name;
};

/// All values of an enumeration and their words, in the order of the values. Enumerations specialise it.
template <class Value>
inline constexpr std::array<Named<Value>, 0> word_table = {};

template <class Value>
concept HasWords = !word_table<Value>.empty();

/// The word for a value.
template <HasWords Value>
constexpr std::string_view name_of(Value value) {
  for (const Named<Value>& named : word_table<Value>)
    if (named.value == value) return named.name;
  return {};
}

/// The value that the word stands for; none if it is no word of the enumeration.
template <HasWords Value>
constexpr std::optional<Value> value_named(std::string_view name) {
  for (const Named<Value>& named : word_table<Value>)
    if (named.name == name) return named.value;
  return std::nullopt;
}

}  // namespace dermis
