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
  constexpr std::string_view option = "bad_pixels ";
  const std::string_view wanted = error.wanted();
  const std::size_t at = wanted.rfind(option);
  if (at == std::string_view::npos) return error;
  return {error.code(), error.argument(), error.seen(),
          fmt::format("{}--bad-pixels {}", wanted.substr(0, at), wanted.substr(at + option.size()))};
}

void warn_of_bad_pixels(const Stats& stats, BadPixels what, Messages& messages) {
  if (stats.pixels_bad > 0)
    messages.warn(ErrorCode::input_unsupported, "light and albedo",
                  fmt::format("{} pixels are not finite; they {}", stats.pixels_bad,
                              what == BadPixels::zero ? "are black now" : "stay as they are"));
}

}  // namespace dermis::program
