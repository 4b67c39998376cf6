#include "scintray/cli/watched_surfaces.hpp"

#include <iostream>

#include "scintray/cli/interrupt.hpp"

namespace scintray::cli {

materials::SurfaceFactory::Hooks watched_surfaces(ProgressLine& line) {
  materials::SurfaceFactory::Hooks hooks;
  hooks.stop = [] { return InterruptGuard::requested().load(); };
  hooks.table_progress = [&line](const std::string& surface, double done) {
    line.show("building the table of " + surface, done, 1.0, "");
    if (done >= 1.0) line.restart();
  };
  hooks.table_waiting = [&line](const std::string& surface) {
    line.show("waiting for another run, which builds the table of " + surface, 0.0, 0.0, "");
  };
  hooks.cache_warning = [&line](const std::string& warning) {
    line.clear();
    std::cerr << "warning: " << warning << "\n";
  };
  return hooks;
}

}  // namespace scintray::cli
