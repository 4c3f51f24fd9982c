#include "files/mask_channel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "arguments/number_argument.hpp"
#include "dermis/error.hpp"
#include "files/channel_groups.hpp"

namespace dermis::program {

oracle::Picture read_mask(const std::string& text, std::string_view name_of_picture, const exr::Picture& picture,
                          const exr::Window& window) {
  const std::size_t equals = text.rfind('=');
  const auto value = equals == std::string::npos ? std::nullopt : parse_real(std::string_view(text).substr(equals + 1));
  if (!value) throw Error(ErrorCode::usage, "--mask-channel", text, "CHANNEL=VALUE, as ViewLayer.IndexMA.X=1");
  const std::string name = text.substr(0, equals);
  if (picture.find(name) == nullptr)
    throw Error(ErrorCode::role_missing, "--mask-channel",
                fmt::format("{}, which {} does not have", name, name_of_picture), "the full name of a channel");
  oracle::Picture mask = values_of(picture, {"", {name}}, window);
  for (double& found : mask.values) found = found == *value ? 1 : 0;
  if (std::count(mask.values.begin(), mask.values.end(), 1.0) == 0)
    throw Error(ErrorCode::usage, "--mask-channel", text + ", which no pixel has", "a value that occurs");
  return mask;
}

}  // namespace dermis::program
