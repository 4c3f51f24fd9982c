#include "c/call.hpp"

#include <exception>
#include <new>
#include <string>

namespace dermis::c {

namespace {

struct LastError {
  std::string message, argument, seen, wanted;
};

thread_local LastError last;

/// Memory may be short: then there are no words.
void keep(std::string_view message, std::string_view argument = {}, std::string_view seen = {},
          std::string_view wanted = {}) noexcept {
  try {
    last = {std::string(message), std::string(argument), std::string(seen), std::string(wanted)};
  } catch (...) {
    last = LastError{};
  }
}

}  // namespace

dermis_code keep_error() noexcept {
  try {
    throw;
  } catch (const Error& error) {
    keep(error.what(), error.argument(), error.seen(), error.wanted());
    return static_cast<dermis_code>(error.code());
  } catch (const std::bad_alloc&) {
    keep("memory: got none, want more", "memory", "none", "more");
    return DERMIS_DEVICE;
  } catch (const std::exception& error) {
    keep(error.what());
    return DERMIS_INTERNAL;
  } catch (...) {
    keep("an exception of an unknown kind");
    return DERMIS_INTERNAL;
  }
}

}  // namespace dermis::c

using dermis::c::last;

const char* dermis_error_message(void) { return last.message.c_str(); }
const char* dermis_error_argument(void) { return last.argument.c_str(); }
const char* dermis_error_seen(void) { return last.seen.c_str(); }
const char* dermis_error_wanted(void) { return last.wanted.c_str(); }
