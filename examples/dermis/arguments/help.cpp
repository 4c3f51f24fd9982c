#include "arguments/help.hpp"

#include <memory>
#include <sstream>

namespace dermis::program {
namespace {

constexpr std::size_t line_columns = 100;
constexpr std::size_t text_column = 30;

/// The words in lines of at most 100 columns, beside or below what stands on the left; from the left edge if that is
/// empty.
std::string wrapped(std::string left, const std::string& text) {
  const std::size_t indent = left.empty() ? 0 : text_column;
  std::size_t column = left.size();
  const auto new_line = [&] {
    left += "\n" + std::string(indent, ' ');
    column = indent;
  };
  if (indent > 0 && column >= indent) new_line();
  left.append(indent - column, ' ');
  column = indent;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > line_columns) new_line();
    if (column > indent) word.insert(0, 1, ' ');
    left += word;
    column += word.size();
  }
  return left + "\n";
}

class WrappedHelp : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return wrapped("  " + make_option_name(option, is_positional) + make_option_opts(option), make_option_desc(option));
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return wrapped("  " + command->get_name(), command->get_description());
  }
  std::string make_description(const CLI::App* app) const override { return wrapped({}, app->get_description()); }
};

}  // namespace

HelpGroup::~HelpGroup() {
  for (CLI::Option* option : app_.get_options())
    if (option->get_group() == "Options") option->group(name_);
}

void wrap_help(CLI::App& app) { app.formatter(std::make_shared<WrappedHelp>()); }

}  // namespace dermis::program
