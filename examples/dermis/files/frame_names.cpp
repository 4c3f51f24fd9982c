#include "files/frame_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <utility>

#include "dermis/error.hpp"

namespace dermis::program {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The place of a number in a name, and how many characters it takes at least.
struct NumberPlace {
  std::size_t at;
  std::size_t size;
  int width;
};

std::optional<NumberPlace> place_in(std::string_view name) {
  if (const std::size_t at = name.find('#'); at != std::string_view::npos) {
    const std::size_t size = std::min(name.find_first_not_of('#', at), name.size()) - at;
    return NumberPlace{at, size, static_cast<int>(size)};
  }
  for (std::size_t at = name.find('%'); at != std::string_view::npos; at = name.find('%', at + 1)) {
    const std::size_t end = name.find_first_not_of("0123456789", at + 1);
    if (end == std::string_view::npos || name[end] != 'd' || end > at + 3) continue;
    int width = 1;
    std::from_chars(name.data() + at + 1, name.data() + end, width);
    return NumberPlace{at, end + 1 - at, width};
  }
  return std::nullopt;
}

std::string number_text(std::int64_t number, int width) { return fmt::format("{:0{}}", number, width); }

/// The name with a number in all of its places.
std::string numbered(std::string name, std::int64_t number) {
  std::size_t done = 0;
  while (const auto place = place_in(std::string_view(name).substr(done))) {
    const std::string text = number_text(number, place->width);
    name.replace(done + place->at, place->size, text);
    done += place->at + text.size();
  }
  return name;
}

std::optional<std::int64_t> number_in(std::string_view text) {
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && stop != text.data() ? std::optional(number) : std::nullopt;
}

std::string name_in(const std::string& path) { return fs::path(path).filename().string(); }

}  // namespace

FrameFile frame_file(std::string path) {
  const std::string stem = fs::path(path).stem().string();
  const auto last = std::find_if(stem.rbegin(), stem.rend(), is_digit);
  auto first = std::find_if_not(last, stem.rend(), is_digit).base();
  if (first != stem.begin() && first[-1] == '-') {
    const bool stands_alone = first - 1 == stem.begin() || std::string_view("._ ").find(first[-2]) != std::string::npos;
    if (stands_alone) --first;
  }
  return {std::move(path), number_in({first, last.base()})};
}

bool is_pattern(const std::string& path) { return place_in(name_in(path)).has_value(); }

std::string with_frame_number(std::string_view argument, const std::string& pattern, const FrameFile& frame) {
  if (!is_pattern(pattern)) return pattern;
  if (!frame.number)
    throw Error(ErrorCode::usage, argument, fmt::format("{} for {}, which has no number", pattern, frame.path),
                "a picture with the number of a frame in its name");
  return (fs::path(pattern).parent_path() / numbered(name_in(pattern), *frame.number)).string();
}

std::vector<std::int64_t> frames_there(const std::string& pattern) {
  const std::string name = name_in(pattern);
  const auto place = place_in(name);
  const fs::path folder = fs::path(pattern).parent_path();
  std::vector<std::int64_t> numbers;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string its = entry->path().filename().string();
    const auto number =
        place && its.size() > place->at ? number_in(std::string_view(its).substr(place->at)) : std::nullopt;
    if (number && numbered(name, *number) == its) numbers.push_back(*number);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::string ranges_text(std::span<const std::int64_t> numbers) {
  std::string text;
  for (std::size_t first = 0, last = 0; first < numbers.size(); first = ++last) {
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (!text.empty()) text += ", ";
    text += std::to_string(numbers[first]);
    if (last > first) text += fmt::format("-{}", numbers[last]);
  }
  return text;
}

}  // namespace dermis::program
