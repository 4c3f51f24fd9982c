/// Roles in the caller's words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/channel_catalogue.hpp"

namespace dermis::exr {

/// "role=channels", see RoleRequest.
class Override {
 public:
  /// Keeps no copy of `text`. Throws Error(usage) if it names no role.
  explicit Override(std::string_view text);

  Role role() const { return role_; }

  /// Throws Error(usage) if the channels are malformed, Error(role_missing) if one is not there.
  ChannelSum resolve(const Catalogue& catalogue) const;

  /// The files that its channels are of, if they are of others than the picture.
  std::vector<std::string> files() const;

 private:
  std::vector<std::string> resolve_group(const Catalogue& catalogue, std::vector<std::string_view> names) const;
  std::string existing(const Catalogue& catalogue, std::string_view wanted) const;

  std::string_view text_;
  std::string_view channels_;
  Role role_ = Role::light;
};

}  // namespace dermis::exr
