// dermis completion: what a shell has to know to complete command lines of dermis.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

/// What options that take one of a few words say of their value: draft|preview|final. Others say NAME, FILE.png,
/// N|auto.
bool is_list_of_words(const std::string& type) {
  return type.find('|') != std::string::npos &&
         std::none_of(type.begin(), type.end(), [](unsigned char c) { return std::isupper(c) != 0; });
}

std::string words_of(const CLI::Option& option) {
  std::string words = option.get_type_name();
  if (!is_list_of_words(words)) return {};
  std::replace(words.begin(), words.end(), '|', ' ');
  return words;
}

/// The help without what a single-quoted string of any of the shells would end at or take for something else.
std::string quotable(std::string text) {
  std::erase_if(text, [](char c) { return c == '\'' || c == '\\' || c == '[' || c == ']' || c == ':'; });
  return text;
}

std::vector<const CLI::Option*> named_options(const CLI::App& command) {
  std::vector<const CLI::Option*> options = command.get_options();
  std::erase_if(options, [](const CLI::Option* option) { return option->get_lnames().empty(); });
  return options;
}

std::string names_of(const std::vector<const CLI::App*>& commands) {
  std::string names;
  for (const CLI::App* command : commands) names += (names.empty() ? "" : " ") + command->get_name();
  return names;
}

std::string bash(const std::vector<const CLI::App*>& commands) {
  std::string options;
  std::string words;
  for (const CLI::App* command : commands) {
    std::string names;
    for (const CLI::Option* option : named_options(*command)) {
      const std::string& name = option->get_lnames().front();
      names += " --" + name;
      if (const std::string its = words_of(*option); !its.empty())
        words += fmt::format("    {}/--{}) words='{}' ;;\n", command->get_name(), name, its);
    }
    options += fmt::format("    {}/-*) words='{}' ;;\n", command->get_name(),
                           names.substr(std::min<std::size_t>(names.size(), 1)));
  }
  return fmt::format(R"(# Completes command lines of dermis in bash.
_dermis() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} command=${{COMP_WORDS[1]}} words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    words='{} --help --version'
  else
    case $command/${{COMP_WORDS[COMP_CWORD - 1]}} in
{}    *) case $command/$word in
{}    esac ;;
    esac
  fi
  [ -z "$words" ] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}}
complete -o bashdefault -o default -F _dermis dermis
)",
                     names_of(commands), words, options);
}

std::string zsh(const std::vector<const CLI::App*>& commands) {
  std::string text =
      "#compdef dermis\n# Completes command lines of dermis in zsh.\n_dermis() {\n  local -a commands=(\n";
  for (const CLI::App* command : commands)
    text += fmt::format("    '{}:{}'\n", command->get_name(), quotable(command->get_description()));
  text += "  )\n  if ((CURRENT == 2)); then\n    _describe command commands\n    return\n  fi\n  case $words[2] in\n";
  for (const CLI::App* command : commands) {
    text += fmt::format("    {}) _arguments", command->get_name());
    for (const CLI::Option* option : named_options(*command)) {
      const std::string words = words_of(*option);
      const char* repeats = option->get_expected_max() > 1 ? "*" : "";
      text += fmt::format(" \\\n      '{}--{}[{}]", repeats, option->get_lnames().front(),
                          quotable(option->get_description()));
      if (option->get_expected_max() > 0 && option->get_type_size() > 0)
        text += words.empty() ? ":value:_files" : ":value:(" + words + ")";
      text += "'";
    }
    text += " \\\n      '*:file:_files' ;;\n";
  }
  return text + "  esac\n}\n_dermis \"$@\"\n";
}

std::string fish(const std::vector<const CLI::App*>& commands) {
  std::string text = "# Completes command lines of dermis in fish.\n";
  for (const CLI::App* command : commands) {
    text += fmt::format("complete -c dermis -n __fish_use_subcommand -f -a {} -d '{}'\n", command->get_name(),
                        quotable(command->get_description()));
    for (const CLI::Option* option : named_options(*command)) {
      const std::string words = words_of(*option);
      text += fmt::format("complete -c dermis -n '__fish_seen_subcommand_from {}' -l {} -d '{}'", command->get_name(),
                          option->get_lnames().front(), quotable(option->get_description()));
      if (!words.empty())
        text += " -x -a '" + words + "'";
      else if (option->get_type_size() > 0 && option->get_expected_max() > 0)
        text += " -r";
      text += "\n";
    }
  }
  return text;
}

}  // namespace

Command add_completion(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("completion", "what bash, zsh or fish needs to complete command lines");
  const auto shell = std::make_shared<std::string>();
  app->add_option("shell", *shell, "the shell that is to know; packages install the text for all three")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}))
      ->type_name("bash|zsh|fish");
  return {app, [shell, &parent] {
            const std::vector<const CLI::App*> commands = std::as_const(parent).get_subcommands({});
            print(*shell == "bash" ? bash(commands) : *shell == "zsh" ? zsh(commands) : fish(commands));
            return 0;
          }};
}

}  // namespace dermis::program
