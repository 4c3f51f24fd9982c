#include "arguments/help.hpp"

#include <memory>
#include <sstream>

namespace dermis::program {
namespace {

constexpr std::size_t line_columns = 100;
constexpr std::size_t text_column = 30;

class WrappedHelp : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string text = "  " + make_option_name(option, is_positional) + make_option_opts(option);
    std::size_t column = text.size();
    const auto new_line = [&] {
      text += "\n" + std::string(text_column, ' ');
      column = text_column;
    };
    if (column >= text_column)
      new_line();
    else
      text.append(text_column - column, ' ');
    column = text_column;
    std::istringstream words(make_option_desc(option));
    for (std::string word; words >> word;) {
      if (column > text_column && column + 1 + word.size() > line_columns) new_line();
      if (column > text_column) word.insert(0, 1, ' ');
      text += word;
      column += word.size();
    }
    return text + "\n";
  }
};

}  // namespace

HelpGroup::~HelpGroup() {
  for (CLI::Option* option : app_.get_options())
    if (option->get_group() == "Options") option->group(name_);
}

void wrap_help(CLI::App& app) { app.formatter(std::make_shared<WrappedHelp>()); }

}  // namespace dermis::program
