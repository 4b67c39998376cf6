#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/commands.hpp"
#include "scintray/cli/word_option.hpp"

namespace scintray::cli {

namespace {

enum class Shell { bash, zsh, fish };
constexpr core::Word<Shell> kShells[] = {{"bash", Shell::bash}, {"zsh", Shell::zsh}, {"fish", Shell::fish}};

/// Words that may follow a command: its subcommands and options.
std::string words_after(const CLI::App& command) {
  std::string words;
  for (const CLI::App* one : subcommands_of(command)) words += one->get_name() + " ";
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_snames()) words += "-" + name + " ";
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
  }
  return words;
}

/// A line for each command, with the words that may follow it, as "scintray table build".
std::string bash_cases(const CLI::App& command, const std::string& before) {
  const std::string line = before.empty() ? command.get_name() : before + " " + command.get_name();
  std::string cases = fmt::format("    \"{}\") words=\"{}\" ;;\n", line, words_after(command));
  for (const CLI::App* one : subcommands_of(command)) cases += bash_cases(*one, line);
  return cases;
}

/// Completion for bash, which zsh reads as well: the words of the command so far, without options and their
/// values, determine the command; any other word is completed as a file.
std::string bash_script(const CLI::App& app) {
  // clang-format off
  return R"bash(_scintray() {
  local current=${COMP_WORDS[COMP_CWORD]} command=scintray word
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case "$(_scintray_words "$command")" in
      *" $word "*) [[ $word == -* ]] || command="$command $word" ;;
    esac
  done
  COMPREPLY=($(compgen -W "$(_scintray_words "$command")" -- "$current"))
}
_scintray_words() {
  local words=
  case "$1" in
)bash" + bash_cases(app, "") + R"bash(  esac
  printf ' %s' "$words"
}
complete -o bashdefault -o default -F _scintray scintray
)bash";
  // clang-format on
}

/// A string of fish in single quotes.
std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

std::string fish_lines(const CLI::App& command, const std::string& condition) {
  const auto commands = subcommands_of(command);
  std::string names, lines;
  for (const CLI::App* one : commands) names += (names.empty() ? "" : " ") + one->get_name();
  const std::string here = commands.empty() ? condition
                                            : condition + (condition.empty() ? "" : "; and ") +
                                                  "not __fish_seen_subcommand_from " + names;
  for (const CLI::App* one : commands)
    lines += fmt::format("complete -c scintray -n {} -f -a {} -d {}\n", fish_quoted(here), one->get_name(),
                         fish_quoted(one->get_description()));
  for (const CLI::Option* option : command.get_options()) {
    std::string line = "complete -c scintray" + (here.empty() ? "" : " -n " + fish_quoted(here));
    if (option->get_lnames().empty() && option->get_snames().empty()) continue;
    for (const std::string& name : option->get_snames()) line += " -s " + name;
    for (const std::string& name : option->get_lnames()) line += " -l " + name;
    lines += line + " -d " + fish_quoted(option->get_description()) + "\n";
  }
  for (const CLI::App* one : commands)
    lines += fish_lines(*one, condition + (condition.empty() ? "" : "; and ") +
                                  "__fish_seen_subcommand_from " + one->get_name());
  return lines;
}

std::string script(const CLI::App& app, Shell shell) {
  switch (shell) {
    case Shell::bash:
      return bash_script(app);
    case Shell::zsh:
      return "#compdef scintray\nautoload -U +X bashcompinit && bashcompinit\n" + bash_script(app);
    case Shell::fish:
      return fish_lines(app, "");
  }
  return "";
}

}  // namespace

void add_completion_command(CLI::App& app) {
  auto shell = std::make_shared<Shell>(Shell::bash);
  CLI::App* command =
      app.add_subcommand("completion", "Print a script that completes commands and options in a shell");
  add_word_option(*command, "SHELL", *shell, kShells, "shell to print it for")->required();
  command->footer(
      "Examples: scintray completion bash > ~/.local/share/bash-completion/completions/scintray\n"
      "          scintray completion fish > ~/.config/fish/completions/scintray.fish");
  command->callback([shell, &app] { std::cout << script(app, *shell); });
}

}  // namespace scintray::cli
