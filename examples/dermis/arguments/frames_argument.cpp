#include "arguments/frames_argument.hpp"

#include <charconv>
#include <set>
#include <string>
#include <system_error>

#include "arguments/word_argument.hpp"

namespace dermis::program {
namespace {

constexpr std::int64_t most_frames = 1'000'000;
constexpr std::int64_t largest_frame = 1'000'000'000'000;

constexpr const char* frames_wanted =
    "frames as 1001-1100x2,1200,-5--1 (first-last, x step), a million at most, from first to last";
constexpr const char* chunk_wanted = "I/N, the I-th of N parts, 1 <= I <= N <= 1000000";

/// Takes a whole number off the front of a text.
std::optional<std::int64_t> take_number(std::string_view& text) {
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || number < -largest_frame || number > largest_frame) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return number;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

struct Range {
  std::int64_t first, last, step;
  std::int64_t size() const { return (last - first) / step + 1; }
};

std::optional<Range> take_range(std::string_view& text) {
  const auto first = take_number(text);
  if (!first) return std::nullopt;
  if (!take(text, '-')) return Range{*first, *first, 1};
  const auto last = take_number(text);
  if (!last || *last < *first) return std::nullopt;
  if (!take(text, 'x')) return Range{*first, *last, 1};
  const auto step = take_number(text);
  if (!step || *step < 1) return std::nullopt;
  return Range{*first, *last, *step};
}

std::optional<Chunk> parse_chunk(std::string_view text) {
  const auto number = take_number(text);
  if (!number || !take(text, '/')) return std::nullopt;
  const auto of = take_number(text);
  if (!of || !text.empty() || *number < 1 || *number > *of || *of > most_frames) return std::nullopt;
  return Chunk{static_cast<std::size_t>(*number), static_cast<std::size_t>(*of)};
}

/// An option whose text `parse` makes a value of, or nothing if it is not as `wanted`.
template <class Value>
CLI::Option* add_parsed(CLI::App& app, const char* name, Value& value, const char* what, const char* wanted,
                        std::optional<Value> (*parse)(std::string_view)) {
  return app
      .add_option_function<std::string>(
          name, [&value, parse](const std::string& text) { value = parse(text).value_or(Value{}); }, what)
      ->check(CLI::Validator(
          [parse, wanted](const std::string& text) { return parse(text) ? std::string{} : refusal(text, wanted); },
          ""));
}

}  // namespace

std::optional<std::vector<std::int64_t>> parse_frames(std::string_view text) {
  std::vector<std::int64_t> frames;
  std::set<std::int64_t> taken;
  std::int64_t named = 0;
  do {
    const auto range = take_range(text);
    if (!range) return std::nullopt;
    named += range->size();
    if (named > most_frames) return std::nullopt;
    for (std::int64_t i = 0; i < range->size(); ++i) {
      const std::int64_t frame = range->first + i * range->step;
      if (taken.insert(frame).second) frames.push_back(frame);
    }
  } while (take(text, ','));
  return text.empty() ? std::optional(std::move(frames)) : std::nullopt;
}

void add_frames_arguments(CLI::App& app, FramesArguments& arguments) {
  add_parsed(app, "--frames", arguments.frames,
             "of an input with #### or %04d in its name these frames, as 1001-1100x2,1200,-5--1; else those that are "
             "there",
             frames_wanted, parse_frames)
      ->type_name("LIST");
  add_parsed(app, "--chunk", arguments.chunk,
             "of all frames, or pictures, the I-th of N parts, from 1: one for each task of a farm", chunk_wanted,
             parse_chunk)
      ->type_name("I/N");
}

}  // namespace dermis::program
