#include "arguments/message_arguments.hpp"

namespace dermis::program {

void add_message_arguments(CLI::App& app, MessageArguments& arguments) {
  app.add_flag("--strict", arguments.strict, "a warning is an error, and nothing is written");
  app.add_flag("--quiet", arguments.quiet, "print neither notes nor how far it is; warnings and errors are printed");
}

}  // namespace dermis::program
