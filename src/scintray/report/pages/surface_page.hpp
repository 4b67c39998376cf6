#pragma once
/// The surfaces of a library side by side.

#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/materials/database.hpp"

namespace scintray::report {

/// What was read of a surface that could be made.
struct SurfaceReadings {
  analysis::SampleSurface sample;
  std::vector<analysis::GoniometerReading> sweep;  ///< over incidence, increasing
  analysis::GoniometerReading profile;             ///< at one incidence
};

struct SurfaceEntry {
  std::string name;
  materials::SurfaceOutline outline;
  std::optional<SurfaceReadings> readings;
  std::string not_made;  ///< why there are no readings
};

/// One self-contained page: for each surface its model, sources and needs, and, where it was made,
/// reflectance and absorptance against incidence beside Fresnel, and the in-plane profile. `under` states
/// between what and at which wavelength.
std::string surface_page(const std::vector<SurfaceEntry>& entries, const std::string& under);

}  // namespace scintray::report
