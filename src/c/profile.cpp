#include <string>

#include "c/call.hpp"
#include "c/handles.hpp"
#include "dermis/profile_text.hpp"

using dermis::Error;
using dermis::ErrorCode;
using dermis::c::call;
using dermis::c::require;

namespace {

/// value = f(profile) of a channel.
template <class Function>
dermis_code evaluate(const dermis_profile* profile, int channel, double* value, const Function& f) {
  return call([&] {
    require(profile, "profile");
    require(value, "value");
    if (channel < 0 || channel > 2) throw Error(ErrorCode::usage, "channel", std::to_string(channel), "0, 1 or 2");
    *value = f(profile->profile);
  });
}

}  // namespace

dermis_code dermis_profile_create(const char* text, dermis_profile** profile) {
  return call([&] {
    require(text, "text");
    require(profile, "profile");
    *profile = new dermis_profile{dermis::parse_profile("profile", text)};
  });
}

dermis_code dermis_profile_radial(const dermis_profile* profile, int channel, double r_mm, double* value_per_mm2) {
  return evaluate(profile, channel, value_per_mm2, [&](const auto& its) { return its.radial(channel, r_mm); });
}

dermis_code dermis_profile_cdf(const dermis_profile* profile, int channel, double r_mm, double* share) {
  return evaluate(profile, channel, share, [&](const auto& its) { return its.cdf(channel, r_mm); });
}

dermis_code dermis_profile_radius(const dermis_profile* profile, int channel, double share, double* r_mm) {
  return evaluate(profile, channel, r_mm, [&](const auto& its) { return its.radius(channel, share); });
}

void dermis_profile_release(dermis_profile* profile) { delete profile; }
