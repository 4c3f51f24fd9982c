// The error that a call throws.
#pragma once

#include <optional>
#include <string>

#include "dermis/error.hpp"

struct Failure {
  std::optional<dermis::ErrorCode> code;  ///< none if nothing was thrown
  std::string message;

  bool says(const std::string& part) const { return message.find(part) != std::string::npos; }
};

template <typename Call>
Failure failure_of(Call&& call) {
  try {
    call();
  } catch (const dermis::Error& error) {
    return {error.code(), error.what()};
  }
  return {};
}
