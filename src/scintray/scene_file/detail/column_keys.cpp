#include "scintray/scene_file/detail/column_keys.hpp"

#include "scintray/config/columns.hpp"

namespace scintray::scene_file {

double read_unit(const config::TomlTable& table, const std::string& key, core::Dimension dimension) {
  const std::string unit = table.string(key);
  if (!table.good(key)) return 1.0;
  try {
    return core::unit_factor(unit, dimension);
  } catch (const core::InputError& error) {
    table.report(key, error.problems().front().what, error.problems().front().hint);
    return 1.0;
  }
}

std::string read_column_group(const config::TomlTable& table, const std::filesystem::path& file,
                              const std::string& rows) {
  const bool known = config::is_column_file(file);
  table.expect("file", known, "a file of " + rows + " ends in " + config::kColumnExtensions,
               "docs/exchange.md says how to read a ROOT file");
  const bool hdf5 = known && config::column_format(file) == config::ColumnFormat::hdf5;
  const std::string group = hdf5 || table.has("group") ? table.string("group", "") : "";
  table.expect("group", hdf5, "a file of this format has no groups", "remove group");
  return group;
}

}  // namespace scintray::scene_file
