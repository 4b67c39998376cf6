#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "scintray/core/data_folder.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/core/text.hpp"

namespace scintray::cli {

namespace {

namespace fs = std::filesystem;

/// A template of a scene: a file of scenes/templates, whose first line describes it in a comment.
struct SceneTemplate {
  std::string name;
  fs::path file;
  std::string title;
};

std::vector<SceneTemplate> scene_templates() {
  std::vector<SceneTemplate> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(core::data_folder() / "scenes/templates")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string text = core::read_whole_file(entry.path()).value_or("");
    const std::string title = text.substr(0, text.find('\n'));
    found.push_back({entry.path().stem(), entry.path(),
                     title.substr(std::min(title.size(), title.find_first_not_of("# ")))});
  }
  std::sort(found.begin(), found.end(),
            [](const SceneTemplate& a, const SceneTemplate& b) { return a.name < b.name; });
  return found;
}

void print_list(const std::vector<SceneTemplate>& templates) {
  std::size_t widest = 0;
  for (const SceneTemplate& one : templates) widest = std::max(widest, one.name.size());
  for (const SceneTemplate& one : templates)
    std::cout << fmt::format("{:<{}}  {}\n", one.name, widest, one.title);
  std::cout << "\nscintray new NAME writes NAME.toml\n";
}

const SceneTemplate& find(const std::vector<SceneTemplate>& templates, const std::string& name) {
  const auto found = std::find_if(templates.begin(), templates.end(),
                                  [&](const SceneTemplate& one) { return one.name == name; });
  if (found != templates.end()) return *found;
  std::vector<std::string> names;
  for (const SceneTemplate& one : templates) names.push_back(one.name);
  const std::string near = core::nearest_word(name, names);
  throw core::InputError(
      {{},
       "there is no template " + core::in_quotes(name) + "; there are " + core::list_of(names),
       near.empty() ? "scintray new lists them" : "did you mean " + near + "?"});
}

void write_scene(const SceneTemplate& from, const fs::path& file) {
  // A scene refers to no file beside it, so its text alone is the whole of it.
  std::error_code error;
  if (!fs::copy_file(from.file, file, error)) {
    if (error == std::errc::file_exists || fs::exists(file))
      throw core::InputError(
          {{file.string()}, "this file exists, and is not replaced", "name another with -o"});
    throw core::SystemError("cannot write " + file.string() + ": " + error.message());
  }
  const std::string name = file.string();
  std::cout << fmt::format(
      "wrote {0}: {1}\n\nscintray check {0} --picture scene.svg   # what is in it, and whether light can "
      "leak\n"
      "scintray run {0}                           # results in a file and on a page\n",
      name, from.title);
}

}  // namespace

void add_new_command(CLI::App& app) {
  struct Arguments {
    std::string name;
    fs::path file;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("new", "Write a scene to begin with; without a name, list them");
  command->add_option("name", arguments->name, "template: crystal, array, slab, light_guide, tile");
  command->add_option("-o,--output", arguments->file, "scene file to write (default: NAME.toml)");
  command->footer("Example: scintray new array -o my_module.toml");
  command->callback([arguments] {
    const std::vector<SceneTemplate> templates = scene_templates();
    if (arguments->name.empty()) return print_list(templates);
    const SceneTemplate& from = find(templates, arguments->name);
    write_scene(from, arguments->file.empty() ? fs::path(from.name + ".toml") : arguments->file);
  });
}

}  // namespace scintray::cli
