#include "arguments/word_argument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "exr/message_text.hpp"

namespace dermis::program {
namespace {

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

std::string refusal(std::string_view seen, std::string_view wanted) {
  return fmt::format("got {}, want {}", seen.empty() ? "nothing" : exr::shown(seen), wanted);
}

CLI::Validator one_of(std::vector<std::string> words) {
  return {[words = std::move(words)](const std::string& text) {
            return contains(words, text) ? std::string{} : refusal(text, fmt::format("{}", fmt::join(words, " or ")));
          },
          ""};
}

CLI::Validator file_name_ending(std::initializer_list<std::string_view> endings) {
  return {[endings = std::vector<std::string>(endings.begin(), endings.end())](const std::string& text) {
            const std::string ending = lower_case(std::filesystem::path(text).extension().string());
            if (contains(endings, ending)) return std::string{};
            return refusal(text, fmt::format("a file name that ends in {}", fmt::join(endings, " or ")));
          },
          ""};
}

CLI::Validator folder_or_file_ending(std::initializer_list<std::string_view> endings) {
  return {[is_file = file_name_ending(endings)](std::string& text) {
            return std::filesystem::is_directory(text) ? std::string{} : is_file(text);
          },
          ""};
}

}  // namespace dermis::program
