#include "scintray/cli/watched_surfaces.hpp"

#include "scintray/cli/interrupt.hpp"

namespace scintray::cli {

materials::SurfaceFactory::Hooks watched_surfaces(ProgressLine& line) {
  materials::SurfaceFactory::Hooks hooks;
  hooks.stop = [] { return InterruptGuard::requested().load(); };
  hooks.table_progress = [&line](const std::string& surface, double done) {
    line.show("building the table of " + surface, done, 1.0, "");
    if (done >= 1.0) line.restart();
  };
  return hooks;
}

}  // namespace scintray::cli
