#pragma once
/// The optics of a GDML file: its materials as media, its optical surfaces as surface definitions.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "scintray/exchange/gdml/detail/definitions.hpp"
#include "scintray/exchange/gdml/detail/gdml_file.hpp"

namespace scintray::exchange::gdml {

/// A material as a medium of a scene.
struct ImportedMedium {
  std::string material;            ///< name in the GDML file
  std::string toml;                ///< the keys of [media.NAME], without the header; empty when opaque
  bool opaque = false;             ///< no RINDEX: Geant4 stops light that enters it
  bool scintillates = false;       ///< has yield, emission and decay times
  std::vector<std::string> notes;  ///< what was not carried over
};

/// Every <material>, in file order. Tables over energy become tables over wavelength, with added points where
/// they are coarse, since linear interpolation over energy is not linear over wavelength; outside its table
/// Geant4 uses the value at the end, so tables are extended at constant value over the range of all tables of
/// the file. Absorption from ABSLENGTH, Rayleigh scattering from RAYLEIGH (none where they are left out),
/// scintillation from SCINTILLATIONYIELD, SCINTILLATIONCOMPONENT1-3 and their constants, or their names
/// before Geant4 11. Emission: Geant4 samples the components per energy, S(E); here one spectrum per
/// wavelength, sum of f_i S_i(E) / int S_i dE times dE/dwavelength = E^2 / (h c). Throws InputError for
/// tables that are not in order of energy or do not have two columns.
std::vector<ImportedMedium> import_materials(const GdmlFile& file, const Definitions& definitions);

/// A table of an optical property: photon energies (eV) upwards, and the property.
struct EnergyTable {
  std::vector<double> energy_eV, value;
  bool empty() const { return value.empty(); }
};

/// The property of a material or surface; empty when it has none. Throws InputError as above.
EnergyTable property(Node owner, const std::string& name, const GdmlFile& file,
                     const Definitions& definitions);

/// { wavelength = [...], ... } of a table, or its one number when it has one value only; extended at constant
/// value to the two wavelengths when they lie beyond it (0: no extension).
std::string curve_toml(const EnergyTable& table, const std::string& unit, double low_nm, double high_nm);

struct ImportedSurface {
  std::string toml;                ///< the keys of [surfaces.NAME]; empty when it cannot be carried over
  std::vector<std::string> notes;  ///< what was not carried over, and why
};

/// An <opticalsurface>, in words or in Geant4's numbers: models glisur and unified, types
/// dielectric_dielectric and dielectric_metal, the six finishes polished to groundbackpainted, as presets
/// geant4_... of the material database. Tables (LUT, Davis, dichroic) are not in the file and cannot be
/// carried over.
ImportedSurface import_surface(Node surface, const GdmlFile& file, const Definitions& definitions);

}  // namespace scintray::exchange::gdml
