#include "commands/result_channels.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dermis/error.hpp"
#include "files/pass_channels.hpp"

namespace dermis::program {
namespace {

using exr::Role;

/// The channels of the beauty, in place; empty if there is none.
std::vector<std::string> beauty_channels(const exr::Roles& roles) {
  if (!roles.has(Role::beauty)) return {};
  const exr::ChannelSum& sum = roles[Role::beauty];
  if (sum.size() != 1 || sum.front().size() != 3)
    throw Error(ErrorCode::usage, "--role beauty", fmt::format("{} groups of channels", sum.size()),
                "one group of three, for the result takes its place");
  return sum.front();
}

/// A file of dermis before there was the attribute has its pass under the first name.
bool is_own_pass(const exr::Picture& picture, const std::string& pass, bool is_first) {
  const auto own = picture.text_attribute(scattered_attribute);
  if (!own) return is_first && picture.text_attribute("dermis:version").has_value();
  return (", " + *own + ", ").find(", " + pass + ", ") != std::string::npos;
}

}  // namespace

std::vector<std::string> scattered_channels(const exr::Picture& picture, const exr::Roles& roles, Messages& messages) {
  const auto is_there = [&](const std::string& name) { return picture.find(name) != nullptr; };
  std::string taken;
  for (int number = 1;; ++number) {
    const std::string name = number == 1 ? "sss" : number == 2 ? "sss_dermis" : fmt::format("sss_dermis{}", number);
    std::vector<std::string> channels = channels_of_pass(roles, name);
    const std::string pass = pass_of(channels);
    if (std::none_of(channels.begin(), channels.end(), is_there)) {
      if (!taken.empty()) messages.note(fmt::format("{}: this pass is the renderer's; ours is {}", taken, pass));
      return channels;
    }
    if (is_own_pass(picture, pass, number == 1)) {
      messages.warn(ErrorCode::input_unsupported, channels.front(),
                    "is there already, from dermis; if the beauty holds scattered light, it is scattered again");
      return channels;
    }
    if (taken.empty()) taken = pass;
  }
}

std::string pass_of(const std::vector<std::string>& channels) {
  const std::size_t dot = channels.front().rfind('.');
  return dot == std::string::npos ? fmt::format("{}", fmt::join(channels, ",")) : channels.front().substr(0, dot);
}

ResultChannels result_channels(OutputLayers layers, const SurfaceInput& input, Messages& messages) {
  ResultChannels channels{scattered_channels(input.picture, input.roles, messages), beauty_channels(input.roles), {}};
  if (layers == OutputLayers::all) return channels;
  channels.written = channels.scattered;
  if (layers == OutputLayers::sss) return channels;
  for (const std::string& name : channels.beauty) {
    channels.written.push_back(name);
    // The alpha belongs to the beauty, whose colours are premultiplied by it.
    const std::string alpha = name.substr(0, name.rfind('.') + 1) + "A";
    if (input.picture.find(alpha) != nullptr) channels.written.push_back(alpha);
  }
  return channels;
}

}  // namespace dermis::program
