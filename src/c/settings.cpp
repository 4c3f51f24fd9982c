#include "dermis/settings.hpp"

#include "c/call.hpp"
#include "c/handles.hpp"

using dermis::c::call;
using dermis::c::require;

dermis_code dermis_settings_create(dermis_settings** settings) {
  return call([&] {
    require(settings, "settings");
    *settings = new dermis_settings{};
  });
}

dermis_code dermis_settings_set(dermis_settings* settings, const char* name, const char* value) {
  return call([&] {
    require(settings, "settings");
    require(name, "name");
    require(value, "value");
    dermis::set(settings->options, name, value);
  });
}

dermis_code dermis_settings_add_material(dermis_settings* settings, int id, const dermis_profile* profile,
                                         double pixel_mm) {
  return call([&] {
    require(settings, "settings");
    require(profile, "profile");
    settings->materials.push_back({.id = id, .profile = profile->profile, .pixel_mm = pixel_mm});
  });
}

const char* dermis_setting_name(size_t number) {
  return number < dermis::settings().size() ? dermis::settings()[number].name : nullptr;
}

const char* dermis_setting_help(size_t number) {
  return number < dermis::settings().size() ? dermis::settings()[number].help : nullptr;
}

void dermis_settings_release(dermis_settings* settings) { delete settings; }
