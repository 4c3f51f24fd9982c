/// --strict and --quiet.
#pragma once

#include <CLI/CLI.hpp>

#include "report/messages.hpp"

namespace dermis::program {

void add_message_arguments(CLI::App& app, MessageArguments& arguments);

}  // namespace dermis::program
