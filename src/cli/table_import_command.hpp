#pragma once

#include <CLI/App.hpp>

namespace scintray::cli {

/// Adds `import` to `scintray table`: makes a surface table of another program's.
void add_table_import_command(CLI::App& table);

}  // namespace scintray::cli
