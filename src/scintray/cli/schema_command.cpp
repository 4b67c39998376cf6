#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "scintray/cli/scene_schema.hpp"
#include "scintray/core/output_file.hpp"

namespace scintray::cli {

void add_schema_command(CLI::App& app) {
  auto output = std::make_shared<std::filesystem::path>();
  auto reference = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "schema", "Print the JSON schema of scene files, with which editors complete and check keys");
  command->add_option("-o,--output", *output, "file to write instead of printing");
  command->add_flag("--reference", *reference, "a page of all keys (Markdown) instead of the schema");
  command->footer(
      "Example: scintray schema -o scene.schema.json\n"
      "Put \"#:schema scene.schema.json\" in the first line of a scene: editors with taplo then use it.");
  command->callback([output, reference] {
    const std::vector<config::TableSchema> tables = scene_tables();
    const std::string text = *reference ? key_reference(tables) : json_schema(tables);
    if (output->empty())
      std::cout << text;
    else
      core::write_whole_file(*output, text);
  });
}

}  // namespace scintray::cli
