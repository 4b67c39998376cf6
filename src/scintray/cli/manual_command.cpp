#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "scintray/cli/commands.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/version.hpp"

namespace scintray::cli {

namespace {

constexpr const char* kExitStatus = R"(.SH EXIT STATUS
.TP
0
done
.TP
1
the input is wrong
.TP
2
the command line is wrong
.TP
3
the system failed: a disk is full, a file cannot be read
.TP
4
a defect in ScintRay
.TP
130
interrupted; the finished part is in the results file
)";

/// Text for roff (groff_man(7)): its escape character and leading control characters are protected.
std::string roff(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const bool line_begins = safe.empty() || safe.back() == '\n';
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else if (line_begins && (c == '.' || c == '\''))
      safe += std::string("\\&") + c;
    else
      safe += c;
  }
  return safe;
}

/// "scintray-table-build".
std::string page_name(const CLI::App& command) {
  return command.get_parent() ? page_name(*command.get_parent()) + "-" + command.get_name()
                              : command.get_name();
}

/// "scintray table build".
std::string command_line(const CLI::App& command) {
  return command.get_parent() ? command_line(*command.get_parent()) + " " + command.get_name()
                              : command.get_name();
}

std::string synopsis(const CLI::App& command) {
  std::string text = ".B " + roff(command_line(command)) + "\n";
  if (!subcommands_of(command).empty()) text += ".I COMMAND\n";
  text += "[\\fIOPTIONS\\fR]";
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) {
      const std::string name = "\\fI" + roff(option->get_name(true)) + "\\fR";
      text += option->get_required() ? " " + name : " [" + name + "]";
    }
  return text + "\n";
}

/// "-t, --threads INT".
std::string option_names(const CLI::Option& option) {
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  if (names.empty()) names = option.get_name(true);
  std::string text = "\\fB" + roff(names) + "\\fR";
  if (!option.get_positional() && !option.get_type_name().empty())
    text += " \\fI" + roff(option.get_type_name()) + "\\fR";
  return text;
}

std::string page(const CLI::App& command) {
  std::string text = fmt::format(".TH \"{}\" 1 \"\" \"ScintRay {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n",
                                 roff(page_name(command)), roff(core::version()), roff(page_name(command)),
                                 roff(command.get_description()));
  text += ".SH SYNOPSIS\n" + synopsis(command);
  if (const auto commands = subcommands_of(command); !commands.empty()) {
    text += ".SH COMMANDS\n";
    for (const CLI::App* one : commands)
      text += fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", roff(page_name(*one)), roff(one->get_description()));
  }
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : command.get_options())
    text += ".TP\n" + option_names(*option) + "\n" + roff(option->get_description()) + "\n";
  if (!command.get_footer().empty()) text += ".SH EXAMPLES\n" + roff(command.get_footer()) + "\n";
  text += kExitStatus;
  if (command.get_parent())
    text += fmt::format(".SH SEE ALSO\n.BR {} (1)\n", roff(page_name(*command.get_parent())));
  return text;
}

std::size_t write_pages(const CLI::App& command, const std::filesystem::path& folder) {
  core::write_whole_file(folder / (page_name(command) + ".1"), page(command));
  std::size_t pages = 1;
  for (const CLI::App* one : subcommands_of(command)) pages += write_pages(*one, folder);
  return pages;
}

/// A cell of a table in Markdown.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

/// "-t, --threads INT", without marks.
std::string plain_names(const CLI::Option& option) {
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  if (names.empty()) return option.get_name(true);
  return option.get_type_name().empty() ? names : names + " " + option.get_type_name();
}

/// A command and those in it as sections of a page in Markdown.
std::string markdown(const CLI::App& command, const std::string& level) {
  std::string usage = command_line(command);
  if (!subcommands_of(command).empty()) usage += " COMMAND";
  std::string rows;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) {
      const std::string name = option->get_name(true);
      usage += option->get_required() ? " " + name : " [" + name + "]";
    }
    rows += fmt::format("| `{}` | {}{} |\n", cell(plain_names(*option)), cell(option->get_description()),
                        option->get_required() ? " (needed)" : "");
  }
  std::string text = fmt::format("{} {}\n\n{}\n\n```text\n{} [OPTIONS]\n```\n\n", level,
                                 command_line(command), command.get_description(), usage);
  text += "| option | meaning |\n| --- | --- |\n" + rows + "\n";
  if (!command.get_footer().empty()) text += "```text\n" + command.get_footer() + "\n```\n\n";
  for (const CLI::App* one : subcommands_of(command))
    text += markdown(*one, command.get_parent() ? "###" : "##");
  return text;
}

}  // namespace

void add_manual_command(CLI::App& app) {
  auto folder = std::make_shared<std::filesystem::path>();
  auto one_page = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("manual", "Write the manual pages of all commands, for man(1)");
  command->add_option("FOLDER", *folder, "folder to write them in; made when it is not there")->required();
  command->add_flag("--markdown", *one_page, "write one page, commands.md, instead");
  command->footer("Example: scintray manual ~/.local/share/man/man1");
  command->callback([folder, one_page, &app] {
    std::filesystem::create_directories(*folder);
    if (*one_page) {
      core::write_whole_file(
          *folder / "commands.md",
          "# Commands\n\nAs `scintray COMMAND --help` prints them.\n\n" + markdown(app, "##"));
      std::cout << (*folder / "commands.md").string() << "\n";
      return;
    }
    std::cout << fmt::format("{} manual pages in {}\n", write_pages(app, *folder), folder->string());
  });
}

}  // namespace scintray::cli
