#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/config/schema.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/text.hpp"
#include "scintray/core/units.hpp"
#include "scintray/materials/material_forms.hpp"
#include "scintray/scene_file/read_scene.hpp"

namespace scintray::cli {

namespace {

using config::KeySchema;
using config::KeyUse;
using config::TableSchema;
using Form = config::KeyUse::Form;

/// The tables of definitions in a scene.
constexpr const char* kDefinitions[] = {"media", "surfaces", "sensors", "reflectors"};

std::string definition_path(const std::string& tables) { return tables + ".NAME"; }

/// Definitions that may have a base, so that no key of theirs is needed.
bool may_have_base(const std::string& path) {
  return path.starts_with("surfaces.") || path.starts_with("sensors.");
}

std::string in_table(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// The key of a curve's positions.
std::string position_key(core::Dimension x) {
  return x == core::Dimension::dimensionless ? "x" : core::dimension_name(x);
}

// JSON schema.

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (std::string_view(".*+?()[]{}|^$\\").find(c) != std::string_view::npos) safe += '\\';
    safe += c;
  }
  return safe;
}

Json quantity_schema(core::Dimension dimension) {
  const std::string number = R"(^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*)";
  const std::string units = core::list_of(core::units_of(dimension), "|", escaped);
  if (dimension != core::Dimension::dimensionless)
    return {{"type", "string"}, {"pattern", number + "(" + units + R"()\s*$)"}};
  return {{"anyOf",
           {{{"type", "number"}}, {{"type", "string"}, {"pattern", number + "(" + units + R"()?\s*$)"}}}}};
}

Json list_schema(const Json& item, std::size_t count) {
  Json list = {{"type", "array"}, {"items", item}, {"minItems", count == 0 ? 1 : count}};
  if (count > 0) list["maxItems"] = count;
  return list;
}

Json curve_schema(const KeyUse& use) {
  const std::string x = position_key(use.x);
  const Json text = {{"type", "string"}};
  const auto column = [](core::Dimension dimension) -> Json {
    return list_schema({{"anyOf", {quantity_schema(dimension), {{"type", "number"}}}}}, 0);
  };
  Json table = {{"type", "object"},
                {"properties",
                 {{x, column(use.x)},
                  {"value", column(use.dimension)},
                  {x + "_unit", text},
                  {"value_unit", text},
                  {"file", text},
                  {x + "_column", text},
                  {"value_column", text}}},
                {"additionalProperties", false},
                {"oneOf", {{{"required", {x, "value"}}}, {{"required", {"file"}}}}}};
  return {{"anyOf", {quantity_schema(use.dimension), std::move(table)}}};
}

class SchemaWriter {
 public:
  explicit SchemaWriter(const std::vector<TableSchema>& tables) {
    for (const TableSchema& table : tables) tables_[table.path] = &table;
  }

  Json table(const std::string& path) const {
    Json schema = {{"type", "object"}};
    const auto found = tables_.find(path);
    if (found == tables_.end() || found->second->keys.empty()) return schema;
    const TableSchema& table = *found->second;
    Json properties = Json::object(), required = Json::array();
    for (const KeySchema& key : table.keys) {
      properties[key.key] = value(path, key);
      if (key.required && !may_have_base(path)) required.push_back(key.key);
    }
    schema["properties"] = std::move(properties);
    schema["additionalProperties"] = false;
    if (!required.empty()) schema["required"] = std::move(required);
    for (std::size_t i = 0; i < table.one_of.size(); ++i)
      schema["allOf"].push_back(group(table.one_of[i], table.one_needed[i] && !may_have_base(path)));
    return schema;
  }

 private:
  static Json group(const std::vector<std::string>& keys, bool needed) {
    Json each = Json::array();
    for (const std::string& key : keys) each.push_back({{"required", {key}}});
    Json one = {{"oneOf", each}};
    if (!needed) one["oneOf"].push_back({{"not", {{"anyOf", each}}}});
    return one;
  }

  Json value(const std::string& path, const KeySchema& key) const {
    const bool definitions = path.empty() && std::find(std::begin(kDefinitions), std::end(kDefinitions),
                                                       key.key) != std::end(kDefinitions);
    if (definitions) return {{"type", "object"}, {"additionalProperties", table(definition_path(key.key))}};
    Json forms = Json::array();
    for (const KeyUse& use : key.forms) {
      if (use.form == Form::raw) return described(Json::object(), key);
      Json form = one(in_table(path, key.key), use);
      if (std::find(forms.begin(), forms.end(), form) == forms.end()) forms.push_back(std::move(form));
    }
    if (forms.empty()) return described(Json::object(), key);
    return described(forms.size() == 1 ? forms.front() : Json{{"anyOf", forms}}, key);
  }

  static Json described(Json schema, const KeySchema& key) {
    std::string text;
    if (!key.fallback.empty()) text = "default: " + key.fallback;
    for (const std::string& rule : key.rules) text += (text.empty() ? "error: " : "; error: ") + rule;
    if (!text.empty()) schema["description"] = text;
    return schema;
  }

  Json one(const std::string& path, const KeyUse& use) const {
    switch (use.form) {
      case Form::table:
        return table(path);
      case Form::tables:
        return {{"type", "array"}, {"items", table(path)}};
      case Form::curve:
        return curve_schema(use);
      default:
        return use.list ? list_schema(scalar(use), use.count) : scalar(use);
    }
  }

  static Json scalar(const KeyUse& use) {
    switch (use.form) {
      case Form::boolean:
        return {{"type", "boolean"}};
      case Form::integer:
        return {{"type", "integer"}};
      case Form::number:
        return {{"type", "number"}};
      case Form::quantity:
        return quantity_schema(use.dimension);
      default:
        break;
    }
    if (!use.words.empty()) return {{"enum", use.words}};
    return {{"type", "string"}, {"minLength", 1}};
  }

  std::map<std::string, const TableSchema*> tables_;
};

// The page.

std::string code(const std::string& text) { return "`" + text + "`"; }

std::string cell_text(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string quantity_text(core::Dimension dimension) {
  return dimension == core::Dimension::dimensionless ? "number or %" : core::dimension_name(dimension);
}

std::string form_text(const std::string& path, const KeyUse& use) {
  const auto listed = [&](const std::string& one) {
    if (!use.list) return one;
    return use.count == 0 ? "list: " + one : fmt::format("list of {}: {}", use.count, one);
  };
  switch (use.form) {
    case Form::raw:
      return "any value";
    case Form::file:
      return "file";
    case Form::boolean:
      return "true or false";
    case Form::integer:
      return listed("whole number");
    case Form::number:
      return listed("number");
    case Form::quantity:
      return listed(quantity_text(use.dimension));
    case Form::curve:
      return quantity_text(use.dimension) + ", constant or a table over " + position_key(use.x);
    case Form::table:
      return "table " + code("[" + path + "]");
    case Form::tables:
      return "tables " + code("[[" + path + "]]");
    default:
      return listed(use.words.empty() ? "text" : core::list_of(use.words, ", ", code));
  }
}

std::string key_row(const std::string& path, const KeySchema& key) {
  std::vector<std::string> forms;
  for (const KeyUse& use : key.forms) {
    const std::string text = form_text(in_table(path, key.key), use);
    if (std::find(forms.begin(), forms.end(), text) == forms.end()) forms.push_back(text);
  }
  std::string notes;
  if (!key.beside.empty()) notes = "read with " + core::list_of(key.beside, ", ", code);
  for (const std::string& rule : key.rules) notes += (notes.empty() ? "" : "; ") + ("error: " + rule);
  const std::string fallback = key.required && !may_have_base(path) ? "needed"
                               : key.fallback.empty()               ? ""
                                                                    : code(key.fallback);
  return fmt::format("| `{}` | {} | {} | {} |\n", key.key, cell_text(core::list_of(forms, "; or ")), fallback,
                     cell_text(notes));
}

std::string heading(const std::string& path, const std::vector<TableSchema>& tables) {
  if (path.empty()) return "the top of the file";
  for (const TableSchema& table : tables)
    for (const KeySchema& key : table.keys)
      for (const KeyUse& use : key.forms)
        if (in_table(table.path, key.key) == path && use.form == Form::tables)
          return code("[[" + path + "]]");
  return code("[" + path + "]");
}

/// All tables of a scene: its own, and those of its definitions as "media.NAME" and the like.
std::vector<TableSchema> scene_tables() {
  std::vector<TableSchema> tables = config::explore_keys(scene_file::scene_key_uses);
  for (const char* const kind : kDefinitions) {
    const std::vector<TableSchema> definition = config::explore_keys(
        [&](const config::TomlNodePtr& document) { return materials::definition_key_uses(kind, document); },
        definition_path(kind));
    tables.insert(tables.end(), definition.begin(), definition.end());
  }
  return tables;
}

/// JSON Schema (draft 2020-12) of scenes. It accepts every scene that is read without an error; of errors it
/// refuses unknown keys, absent keys that are always needed, values of another type, quantities without a
/// unit or with one of another dimension, words that are not among those allowed, and keys that exclude each
/// other.
std::string json_schema(const std::vector<TableSchema>& tables) {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "A scene of ScintRay"}};
  schema.update(SchemaWriter(tables).table(""));
  return schema.dump(1) + "\n";
}

/// A page in Markdown: each table with its keys, what they accept, their defaults and the conditions on them.
std::string key_reference(const std::vector<TableSchema>& tables) {
  std::string page =
      "# Keys of scene files\n\nMade by `scintray schema --reference` from the code that reads them. "
      "[scene_files.md](scene_files.md), [materials.md](materials.md) and [surfaces.md](surfaces.md) say "
      "what they mean.\n";
  for (const TableSchema& table : tables) {
    if (table.keys.empty()) continue;
    page += "\n## " + heading(table.path, tables) + "\n\n";
    for (std::size_t i = 0; i < table.one_of.size(); ++i)
      page += fmt::format("{} of {}.\n\n",
                          table.one_needed[i] && !may_have_base(table.path) ? "One" : "At most one",
                          core::list_of(table.one_of[i], ", ", code));
    page += "| key | value | default | notes |\n| --- | --- | --- | --- |\n";
    for (const KeySchema& key : table.keys) page += key_row(table.path, key);
  }
  return page;
}

}  // namespace

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
