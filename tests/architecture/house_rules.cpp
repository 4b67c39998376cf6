#include "house_rules.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace scintray::test {

namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// All files below a folder, sorted; hidden folders, build folders and the like are not entered.
std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator();
       ++entry) {
    const std::string name = entry->path().filename().string();
    const bool passed_over =
        name == ".git" || name == ".cache" || name == "out" || name.rfind("build", 0) == 0;
    if (entry->is_directory() && passed_over) entry.disable_recursion_pending();
    if (entry->is_regular_file()) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string at_line(const fs::path& file, std::size_t line) {
  return file.string() + ":" + std::to_string(line + 1) + ": ";
}

/// Order of a module among the layers; the number of layers when it is none of them.
std::size_t rank_of(const std::vector<std::string>& layers, const std::string& module) {
  return static_cast<std::size_t>(std::find(layers.begin(), layers.end(), module) - layers.begin());
}

/// What is wrong when `from` uses `to`, or nothing.
std::string wrong_direction(const std::vector<std::string>& layers, const std::string& from,
                            const std::string& to) {
  const std::size_t target = rank_of(layers, to);
  if (target == layers.size()) return "\"" + to + "\" is not a module";
  if (target > rank_of(layers, from))
    return from + " uses " + to + ", which stands below it in the list of layers";
  return {};
}

bool is_code(const fs::path& file) {
  static const std::set<std::string> endings{".c",  ".cc", ".cpp", ".cxx", ".h",  ".hh", ".hpp", ".hxx",
                                             ".py", ".sh", ".js",  ".jl",  ".pl", ".m",  ".mac", ".cmake"};
  return endings.count(file.extension().string()) > 0 || file.filename() == "CMakeLists.txt" ||
         file.filename() == "Makefile";
}

}  // namespace

std::vector<std::string> read_layers(const fs::path& source) {
  const std::string text = read_text(source / "CMakeLists.txt");
  std::smatch list;
  if (!std::regex_search(text, list, std::regex(R"(set\(SCINTRAY_MODULES\s+([a-z_\s]+)\))")))
    throw std::runtime_error("no SCINTRAY_MODULES in " + (source / "CMakeLists.txt").string());
  std::istringstream words(list[1].str());
  return {std::istream_iterator<std::string>(words), {}};
}

Violations find_upward_includes(const fs::path& source) {
  static const std::regex include(R"re(^\s*#\s*include\s*"([^"]*)")re");
  static const std::regex own_header(R"(scintray/([a-z_]+)/[A-Za-z0-9_/.]+)");
  const std::vector<std::string> layers = read_layers(source);
  Violations found;
  for (const fs::path& file : files_below(source)) {
    const std::string module = fs::relative(file, source).begin()->string();
    const std::vector<std::string> lines = lines_of(read_text(file));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch named, parts;
      if (!std::regex_search(lines[i], named, include)) continue;
      const std::string header = named[1].str();
      if (!std::regex_match(header, parts, own_header)) {
        found.push_back(at_line(file, i) + "write \"" + header + "\" as \"scintray/module/header.hpp\"");
        continue;
      }
      const std::string wrong = wrong_direction(layers, module, parts[1].str());
      if (!wrong.empty()) found.push_back(at_line(file, i) + wrong);
    }
  }
  return found;
}

Violations find_upward_links(const fs::path& source) {
  static const std::regex own_target(R"(scintray(?:::|_)([a-z]+))");
  const std::vector<std::string> layers = read_layers(source);
  Violations found;
  for (const std::string& module : layers) {
    const fs::path file = source / module / "CMakeLists.txt";
    if (!fs::exists(file)) continue;
    const std::vector<std::string> lines = lines_of(read_text(file));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string code = lines[i].substr(0, lines[i].find('#'));
      for (std::sregex_iterator match(code.begin(), code.end(), own_target), end; match != end; ++match) {
        const std::string target = (*match)[1].str();
        if (rank_of(layers, target) == layers.size())
          continue;  // not a module: scintray_module, scintray_version
        const std::string wrong = wrong_direction(layers, module, target);
        if (!wrong.empty()) found.push_back(at_line(file, i) + wrong);
      }
    }
  }
  return found;
}

Violations find_unlisted_modules(const fs::path& source) {
  const std::vector<std::string> layers = read_layers(source);
  Violations found;
  for (const fs::path& file : files_below(source)) {
    const fs::path relative = fs::relative(file, source);
    if (relative == "CMakeLists.txt") continue;
    if (rank_of(layers, relative.begin()->string()) == layers.size())
      found.push_back(file.string() + ": \"" + relative.begin()->string() + "\" is not one of the layers");
  }
  return found;
}

Violations find_code_among_data(const fs::path& folder) {
  Violations found;
  for (const fs::path& file : files_below(folder)) {
    const bool executable = (fs::status(file).permissions() & fs::perms::owner_exec) != fs::perms::none;
    if (is_code(file) || executable || read_text(file).rfind("#!", 0) == 0)
      found.push_back(file.string() + ": this folder holds data only");
  }
  return found;
}

Violations find_machine_paths(const fs::path& repository) {
  // The names are put together here, so that this file does not break its own rule.
  static const std::string tops =
      "(?:ho"
      "me|ro"
      "ot|Us"
      "ers|wo"
      "rk|fa"
      "rm|t"
      "mp|m"
      "nt|med"
      "ia)";
  static const std::regex path("(?:^|[^A-Za-z0-9_./})>-])/" + tops + "/[A-Za-z0-9_.-]");
  Violations found;
  for (const fs::path& file : files_below(repository)) {
    const std::string text = read_text(file);
    if (text.find('\0') != std::string::npos) continue;
    const std::vector<std::string> lines = lines_of(text);
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (lines[i].find('/') != std::string::npos && lines[i].size() < 2000 &&
          std::regex_search(lines[i], path))
        found.push_back(at_line(file, i) + "a path of somebody's machine");
  }
  return found;
}

}  // namespace scintray::test
