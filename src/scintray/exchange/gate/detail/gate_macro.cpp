#include <cmath>
#include <cstdlib>
#include <sstream>

#include "scintray/exchange/gate/detail/gate.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gate {

namespace {

constexpr std::size_t kDeepest = 50;
constexpr std::size_t kMostCommands = 1'000'000;

class MacroReader {
 public:
  explicit MacroReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void read(const std::filesystem::path& file, const core::FileLocation& from) {
    if (++depth_ > kDeepest)
      throw core::InputError(core::Problem{from, "macros execute each other more than 50 deep",
                                           "remove the /control/execute that repeats"});
    std::istringstream lines(mesh::read_mesh_file(file));
    core::FileLocation where{file.string(), 0, 0};
    std::string line, whole;
    for (long number = 1; std::getline(lines, line); ++number) {
      if (whole.empty()) where.line = number;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      whole += line;
      if (!whole.empty() && whole.back() == '\\') {
        whole.back() = ' ';
        continue;
      }
      execute(whole, where);
      whole.clear();
    }
    if (!whole.empty()) execute(whole, where);
    --depth_;
  }

  std::vector<Command> take() { return std::move(commands_); }

 private:
  void execute(const std::string& line, const core::FileLocation& where) {
    std::istringstream words(with_aliases(line.substr(0, comment(line)), where));
    Command command;
    command.where = where;
    words >> command.path;
    if (command.path.empty()) return;
    for (std::string word; words >> word;) command.words.push_back(word);
    if (command.path == "/control/alias" && command.words.size() >= 2) {
      std::string value;
      for (std::size_t i = 1; i < command.words.size(); ++i) value += (i > 1 ? " " : "") + command.words[i];
      if (value.size() > 1 && value.front() == '"' && value.back() == '"')
        value = value.substr(1, value.size() - 2);
      aliases_[command.words[0]] = value;
    } else if (command.path == "/control/execute" && !command.words.empty()) {
      read(find_file(folder_, command.words[0], where), where);
    } else {
      if (commands_.size() >= kMostCommands)
        throw core::InputError(
            core::Problem{where, "more than a million commands", "check /control/execute and loops"});
      commands_.push_back(std::move(command));
    }
  }

  /// Place of a comment: a # at the beginning, or after white space.
  static std::size_t comment(const std::string& line) {
    for (std::size_t at = line.find('#'); at != std::string::npos; at = line.find('#', at + 1))
      if (at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t') return at;
    return line.size();
  }

  std::string with_aliases(std::string line, const core::FileLocation& where) const {
    // Aliases may be nested; the innermost braces come first.
    constexpr int kMostReplaced = 1000;
    for (int replaced = 0; replaced < kMostReplaced; ++replaced) {
      const std::size_t close = line.find('}');
      const std::size_t open = close == std::string::npos ? close : line.rfind('{', close);
      if (open == std::string::npos) return line;
      const std::string name = line.substr(open + 1, close - open - 1);
      const auto found = aliases_.find(name);
      if (found == aliases_.end())
        throw core::InputError(
            core::Problem{where, "no alias is called \"" + name + "\"",
                          "define it before this line, as: /control/alias " + name +
                              " VALUE (aliases of GATE's command line are not known here)"});
      line.replace(open, close - open + 1, found->second);
      if (line.size() > 100'000) break;
    }
    throw core::InputError(core::Problem{where, "aliases that stand for each other without end",
                                         "give an alias a value without {}"});
  }

  std::filesystem::path folder_;
  std::map<std::string, std::string> aliases_;
  std::vector<Command> commands_;
  std::size_t depth_ = 0;
};

}  // namespace

std::filesystem::path find_file(const std::filesystem::path& macro_folder, const std::string& name,
                                const core::FileLocation& where) {
  std::error_code error;
  for (const auto& folder : {macro_folder, macro_folder / ".."})
    if (const auto path = folder / name; std::filesystem::is_regular_file(path, error)) return path;
  throw core::InputError(core::Problem{where, "the file \"" + name + "\" does not exist",
                                       "expected in the folder of the macro, or in the folder above it"});
}

std::vector<Command> read_macro(const std::filesystem::path& macro) {
  MacroReader reader(macro.parent_path());
  reader.read(macro, {macro.string(), 0, 0});
  return reader.take();
}

double number(const Command& command, std::size_t index) {
  if (index >= command.words.size())
    throw core::InputError(core::Problem{
        command.where, command.path + " has " + std::to_string(command.words.size()) + " words after it",
        "it needs " + std::to_string(index + 1) + " at least"});
  const std::string& word = command.words[index];
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0' || !(std::abs(value) < 1e30))
    throw core::InputError(core::Problem{command.where,
                                         command.path + ": " + core::in_quotes(word) + " is no number",
                                         "write a number, then its unit"});
  return value;
}

double quantity(const Command& command, std::size_t index, core::Dimension dimension) {
  const double value = number(command, index);
  if (command.words.size() < 2 || index + 1 >= command.words.size())
    throw core::InputError(core::Problem{command.where, command.path + " has no unit after its numbers",
                                         "GATE requires it, as in: 10 mm"});
  const std::string& unit = command.words.back();
  static const std::map<std::string, std::string> spelled{
      {"degree", "deg"}, {"radian", "rad"},    {"millimeter", "mm"}, {"centimeter", "cm"},
      {"meter", "m"},    {"micrometer", "um"}, {"nanometer", "nm"},  {"milliradian", "mrad"}};
  const auto same = spelled.find(unit);
  try {
    return value * core::unit_factor(same == spelled.end() ? unit : same->second, dimension);
  } catch (const core::InputError& error) {
    throw core::InputError(core::Problem{command.where, command.path + ": " + error.problems().front().what,
                                         error.problems().front().hint});
  }
}

}  // namespace scintray::exchange::gate
