/// Words and file names on the command line. What a check refuses reads "--name: got SEEN, want WANTED".
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/words.hpp"

namespace dermis::program {

/// "got SEEN, want WANTED"
std::string refusal(std::string_view seen, std::string_view wanted);

CLI::Validator one_of(std::vector<std::string> words);

/// A file name with one of these endings, in any case.
CLI::Validator file_name_ending(std::initializer_list<std::string_view> endings);

/// A file name with one of these endings, or a folder that exists.
CLI::Validator folder_or_file_ending(std::initializer_list<std::string_view> endings);

/// The words of an enumeration.
template <HasWords Value>
std::vector<std::string> words_of() {
  std::vector<std::string> words;
  for (const Named<Value>& named : word_table<Value>) words.emplace_back(named.name);
  return words;
}

/// Adds an option that takes a word of an enumeration and puts its value into `target`, a Value or an optional one.
template <HasWords Value, class Target>
CLI::Option* add_word(CLI::App& app, const std::string& option, Target& target, const std::string& help,
                      Value otherwise) {
  return app
      .add_option_function<std::string>(
          option, [&target](const std::string& word) { target = *value_named<Value>(word); }, help)
      ->check(one_of(words_of<Value>()))
      ->type_name(CLI::detail::join(words_of<Value>(), "|"))
      ->default_str(std::string(name_of(otherwise)));
}

/// Adds an option that takes a word of an enumeration, whose default is what `target` holds.
template <HasWords Value>
CLI::Option* add_word(CLI::App& app, const std::string& option, Value& target, const std::string& help) {
  return add_word<Value>(app, option, target, help, target);
}

}  // namespace dermis::program
