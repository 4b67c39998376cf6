#pragma once
/// The tables of Geant4's LUT model, measured by Janecek and Moses at LBNL (IEEE TNS 57(3), 964-970, 2010):
/// one file a finish, 91 incidences x 45 x 37 relative probabilities of a direction. docs/exchange.md
/// describes the layout.
///
/// Source of the layout and of the sampling: Geant4's own reader (G4OpticalSurface.cc,
/// G4OpBoundaryProcess::DielectricLUT, release 11).

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/tables/import_settings.hpp"
#include "scintray/tables/number_text.hpp"
#include "scintray/tables/table_side.hpp"

namespace scintray::tables {

/// Sizes of a table. Geant4 has only these; other numbers of incidences are for tests.
struct LbnlLayout {
  std::size_t incidences = 91;  ///< 0 to 90 deg, the incidence rounded to the nearest
  std::size_t thetas = 45;      ///< -90 to 86 deg: in the plane of incidence, 0 at the normal
  std::size_t phis = 37;        ///< -90 to 90 deg: out of the plane of incidence

  std::size_t numbers() const { return incidences * thetas * phis; }
  /// Index of a value; the incidence varies fastest.
  std::size_t at(std::size_t incidence, std::size_t theta, std::size_t phi) const {
    return incidence + incidences * (theta + thetas * phi);
  }
};

/// The values of a file, read from its content and checked. InputError on damaged, short or long files,
/// values that are not finite or outside 0 to 1 (Geant4 uses each as a probability), and incidences without
/// any direction that leaves the surface.
std::vector<float> parse_lbnl(std::string_view content, const std::string& file, LbnlLayout layout = {});

/// The table that Geant4 samples: nothing is transmitted, `settings.reflectance` is that of one trial, and
/// trials that end at the horizon are repeated with another chance of absorption.
optics::SurfaceTable lbnl_table(const std::vector<float>& values, const ImportSettings& settings,
                                const std::string& name);

/// The table of a file: parse_lbnl and lbnl_table. Throws InputError as these; the error for a missing file
/// with the name of one of the bare finishes, for which no data exist, states this.
optics::SurfaceTable read_lbnl(const std::filesystem::path& path, const ImportSettings& settings);

struct LbnlSettings {
  optics::Side side = optics::Side::inside;  ///< side of the light that Geant4 is to simulate
  std::size_t slice = 0;                     ///< of the table, as from slice_at
  std::uint64_t rays = 100'000;              ///< quasi-random points of the distribution, for each incidence
  std::uint64_t seed = 1;
};

/// Writes the reflected light of a table in this layout, X.z or X.dat: directions in steps of 4 by 5 deg. The
/// layout holds neither the reflectance nor transmitted light.
///
/// @return for the user, one sentence for each property of the table that the file does not hold, the first
///         with the reflectance to be set
/// @throws InputError for another name, a table that transmits more than 0.001 at an incidence, and as
/// TableSide
std::vector<std::string> write_lbnl(const std::filesystem::path& path, const optics::SurfaceTable& table,
                                    const LbnlSettings& settings);

}  // namespace scintray::tables
