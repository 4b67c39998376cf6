#pragma once
/// The pair of files of Geant4's LUTDAVIS model: X_LUTR (reflectances) and X_LUT (directions), as text
/// (.dat, Geant4's data up to 2.1) or that text in a zlib stream (.z, from 2.2 on). docs/exchange.md
/// describes the layout and what the format cannot hold.
///
/// Source of the layout: Geant4's own reader (G4OpticalSurface.cc,
/// G4OpBoundaryProcess::DielectricLUTDAVIS, release 11).

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/tables/import_settings.hpp"
#include "scintray/tables/number_text.hpp"
#include "scintray/tables/table_side.hpp"

namespace scintray::tables {

inline constexpr int kDavisDegrees = 90;  ///< reflectances: incidence rounded down to 0 ... 89 deg
inline constexpr int kDavisBlocks = 91;   ///< blocks of directions, reflected and again transmitted

/// Sizes within X_LUT. Geant4 has one size of sample only; others are for tests.
struct DavisLayout {
  std::size_t samples = 20000;  ///< pairs (azimuth, elevation) in a block

  std::size_t block() const { return 2 * samples; }
  std::size_t half() const { return kDavisBlocks * block(); }
  /// One more than two halves, as Geant4 reads.
  std::size_t numbers() const { return 2 * half() + 1; }
  /// Offset of the directions of a degree. Geant4 reads reflected ones one block lower than
  /// transmitted ones, and reflected ones of degree 0 not at all.
  std::size_t reflected(int degree) const { return static_cast<std::size_t>(degree - 1) * block(); }
  std::size_t transmitted(int degree) const { return half() + static_cast<std::size_t>(degree) * block(); }
};

/// The two names of a pair.
struct DavisFiles {
  std::filesystem::path directions, reflectances;
  bool packed = false;  ///< .z
};

/// The names from that of the directions' file, X_LUT.z or X_LUT.dat; InputError for other names.
DavisFiles davis_files(const std::filesystem::path& directions);

struct DavisSettings {
  optics::Side side = optics::Side::inside;  ///< side of the light that Geant4 is to simulate
  std::size_t slice = 0;                     ///< of the table, as from slice_at
  std::uint64_t seed = 1;
  DavisLayout layout;
};

/// Writes a table as a pair. Each number represents the incidences of one whole degree, weighted as diffuse
/// light is incident on a surface (sin x cos). Light absorbed in the table appears as transmitted.
///
/// @return for the user, one sentence for each property of the table that the pair does not hold
/// @throws InputError as davis_files and TableSide, SystemError when a file cannot be written
std::vector<std::string> write_davis(const std::filesystem::path& directions,
                                     const optics::SurfaceTable& table, const DavisSettings& settings = {});

/// The numbers of a pair.
struct DavisPair {
  std::vector<float> reflectances;  ///< kDavisDegrees
  std::vector<float> directions;    ///< layout.numbers(), or one less; (azimuth, elevation), rad
  DavisLayout layout;
};

/// The numbers of a pair, read and checked from the contents of the two files. InputError on damaged, short
/// or long files, numbers that are not finite or out of range, light on the wrong side, and degrees for
/// which Geant4 would search endlessly for a direction; `files` is for messages.
DavisPair parse_davis(std::string_view directions, std::string_view reflectances, const DavisFiles& files,
                      Unreflected unreflected, DavisLayout layout = {});

/// The table that Geant4 samples from a pair: constant within each degree, back-reflection and straight
/// transmission below 1 deg.
optics::SurfaceTable davis_table(const DavisPair& pair, const ImportSettings& settings,
                                 const std::string& name);

/// The table of a pair of files: parse_davis and davis_table. Throws InputError as these.
optics::SurfaceTable read_davis(const std::filesystem::path& directions, const ImportSettings& settings);

}  // namespace scintray::tables
