/// Words and file names on the command line. What a check refuses reads "--name: got SEEN, want WANTED".
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <string_view>

namespace dermis::program {

/// "got SEEN, want WANTED"
std::string refusal(std::string_view seen, std::string_view wanted);

CLI::Validator one_of(std::initializer_list<std::string_view> words);

/// A file name with one of these endings, in any case.
CLI::Validator file_name_ending(std::initializer_list<std::string_view> endings);

/// The same, or a folder that exists.
CLI::Validator folder_or_file_ending(std::initializer_list<std::string_view> endings);

}  // namespace dermis::program
