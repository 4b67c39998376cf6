#pragma once

#include <CLI/CLI.hpp>

namespace scintray::cli {

/// `scintray import FILE -o SCENE`: a GDML, CAD or mesh file becomes a scene.
void add_import_command(CLI::App& app);

}  // namespace scintray::cli
