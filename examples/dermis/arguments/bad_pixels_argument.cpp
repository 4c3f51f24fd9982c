#include "arguments/bad_pixels_argument.hpp"

#include <fmt/format.h>

#include <string_view>

#include "arguments/word_argument.hpp"

namespace dermis::program {

void add_bad_pixels_argument(CLI::App& app, BadPixels& what) {
  add_word(app, "--bad-pixels", what,
           "pixels whose light or albedo is not finite, which never give light to others: keep leaves them as they "
           "are, zero makes them black, error writes nothing");
}

Error bad_pixels_named_as_option(const Error& error) {
  constexpr std::string_view before_seen = ": got ";
  constexpr std::string_view before_wanted = ", want ";
  constexpr std::string_view option = "bad_pixels ";
  const std::string_view line = error.what();
  const std::size_t seen = line.find(before_seen);
  const std::size_t wanted = line.rfind(before_wanted);
  const std::size_t at = line.rfind(option);
  if (seen == std::string_view::npos || wanted == std::string_view::npos || at == std::string_view::npos || at < wanted)
    return error;
  const std::size_t seen_at = seen + before_seen.size();
  const std::size_t wanted_at = wanted + before_wanted.size();
  return {error.code(), line.substr(0, seen), line.substr(seen_at, wanted - seen_at),
          fmt::format("{}--bad-pixels {}", line.substr(wanted_at, at - wanted_at), line.substr(at + option.size()))};
}

void warn_of_bad_pixels(const Stats& stats, BadPixels what, Messages& messages) {
  if (stats.pixels_bad > 0)
    messages.warn(ErrorCode::input_unsupported, "light and albedo",
                  fmt::format("{} pixels are not finite; they {}", stats.pixels_bad,
                              what == BadPixels::zero ? "are black now" : "stay as they are"));
}

}  // namespace dermis::program
