/// The look of `dermis COMMAND --help`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace dermis::program {

/// Puts the options that have no group yet when it goes, --help among them, into one group of the help.
class HelpGroup {
 public:
  HelpGroup(CLI::App& app, std::string name) : app_(app), name_(std::move(name)) {}
  ~HelpGroup();
  HelpGroup(const HelpGroup&) = delete;
  HelpGroup& operator=(const HelpGroup&) = delete;

 private:
  CLI::App& app_;
  std::string name_;
};

/// Help of lines of at most 100 columns, for the commands that are added afterwards too.
void wrap_help(CLI::App& app);

}  // namespace dermis::program
