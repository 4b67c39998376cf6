#pragma once
/// The optics of a GDML file: its materials as media, its optical surfaces as surface definitions.

#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scintray/exchange/gdml/detail/definitions.hpp"
#include "scintray/exchange/gdml/detail/gdml_file.hpp"

namespace scintray::exchange::gdml {

/// A table of an optical property: photon energies (eV) upwards, and the property.
struct EnergyTable {
  std::vector<double> energy_eV, value;
  bool empty() const { return value.empty(); }
};

/// The value at an energy (eV) of a table that is not empty; 0 beyond its ends.
double interpolated(const EnergyTable& table, double energy_eV);

/// Integral over energy.
double integral(const EnergyTable& table);

/// The spectrum that Geant4 samples from a table per energy: it interpolates the table's integral (G4OpWLS,
/// G4Scintillation: BuildPhysicsTable), so that between two points all energies are equally likely.
EnergyTable as_sampled(const EnergyTable& table);

/// The spectrum that Geant4 samples from a table per energy, as one per wavelength, with added points.
EnergyTable per_wavelength(const EnergyTable& table);

/// Energies (eV) of a table, upwards, with added points. Geant4 interpolates linearly over energy, a curve
/// here over wavelength. Halfway between two points the energy is their arithmetic mean for one and the
/// harmonic mean for the other: between energies 2 % apart the values differ by 0.5 % of their step.
std::vector<double> refined(const std::vector<double>& energy_eV);

/// The value at an energy (eV) of a table that is not empty; beyond its ends the last value, as in Geant4.
double value_at(const EnergyTable& table, double energy_eV);

/// The properties of materials and surfaces, read as Geant4 11.4 reads them (G4GDMLReadMaterials,
/// G4GDMLReadSolids, G4MaterialPropertiesTable): a matrix of one column is a number, one of more columns a
/// table whose energies may come in any order; a property without a `ref` is ignored.
class OpticalTables {
 public:
  /// Determines the wavelengths spanned by all tables of the file together.
  OpticalTables(const GdmlFile& file, const Definitions& definitions);

  /// A table; empty when the owner has none of this name. Throws InputError for a `ref` without its matrix
  /// and for energies that are not above 0.
  EnergyTable property(Node owner, const std::string& name) const;
  /// The number of the first of these names that the owner has.
  std::optional<double> constant(Node owner, std::initializer_list<std::string> names) const;
  /// Names of properties that the owner lists without a `ref`.
  std::vector<std::string> passed_over(Node owner) const;
  /// True when the owner lists the first property before the second, and has both.
  static bool in_order(Node owner, const std::string& first, const std::string& second);

  /// Wavelengths (nm) of all tables of the file together; 0 without a table.
  double low_nm() const { return low_nm_; }
  double high_nm() const { return high_nm_; }
  const GdmlFile& file() const { return file_; }
  const Definitions& definitions() const { return definitions_; }

 private:
  const GdmlFile& file_;
  const Definitions& definitions_;
  double low_nm_ = 0.0, high_nm_ = 0.0;
};

/// Compositions of materials: the isotopes, elements and materials of a file by name.
class Substances {
 public:
  explicit Substances(const Definitions& definitions);
  /// Shares of the mass by element, as "Lu = 0.714467891, O = ..."; empty when a part of it is not stated.
  std::string mass_fractions(Node material) const;

 private:
  /// Mass by the symbol of each element, in grams for a mole or of a unit mass: only ratios count.
  using Masses = std::map<std::string, double>;

  Node find(Node reference) const;
  double molar_mass(Node element) const;
  std::string symbol_of(Node element) const;
  Masses masses_of(Node node, int depth) const;

  const Definitions& definitions_;
  std::map<std::string, Node> by_name_;
};

/// A material as a medium of a scene.
struct ImportedMedium {
  std::string material;  ///< name in the GDML file
  std::string toml;      ///< the keys of [media.NAME], without the header; empty when opaque
  std::string index;     ///< of these, its index
  /// Shortest length of absorption, scattering and wavelength shifting at any wavelength; infinite without.
  double shortest_mm = std::numeric_limits<double>::infinity();
  bool opaque = false;                     ///< no RINDEX: Geant4 stops light that enters it
  std::optional<core::Problem> problem{};  ///< why it cannot be converted: an error where it is used
  bool scintillates = false;               ///< has yield, emission and decay times
  std::vector<std::string> notes;          ///< what was not converted
};

/// Every <material>, in file order; of several of one name the first, as in Geant4. Tables over energy become
/// tables over wavelength, with added points where they are coarse, since linear interpolation over energy is
/// not linear over wavelength; outside its table Geant4 uses the value at the end, so tables are extended at
/// constant value over the range of all tables of the file. Absorption from ABSLENGTH, Rayleigh scattering
/// from RAYLEIGH (without one, from ISOTHERMAL_COMPRESSIBILITY and in "Water", where Geant4 computes it),
/// particles from MIEHG, group index from a GROUPVEL that follows RINDEX (else Geant4 computes it),
/// scintillation from SCINTILLATIONYIELD, SCINTILLATIONCOMPONENT1-3 and their constants, or their names
/// before Geant4 11, wavelength shifting from WLSABSLENGTH, WLSCOMPONENT, WLSTIMECONSTANT and
/// WLSMEANNUMBERPHOTONS, and the same with a 2. Spectra: Geant4 samples components per energy, S(E); here one
/// spectrum per wavelength, sum of f_i S_i(E) / int S_i dE times dE/dwavelength = E^2 / (h c). Between two
/// points of a spectrum S is their mean, as Geant4 samples it.
std::vector<ImportedMedium> import_materials(const OpticalTables& tables);

/// { wavelength = [...], ... } of a table, or its one number when it has one value only; extended at constant
/// value to the two wavelengths when they lie beyond it (0: no extension).
std::string curve_toml(const EnergyTable& table, const std::string& unit, double low_nm, double high_nm);

/// The elements of `particle_light` of a material with ELECTRONSCINTILLATIONYIELD, PROTON..., DEUTERON...,
/// TRITON..., ALPHA... or IONSCINTILLATIONYIELD, separated by commas; empty without any. Spectra and times
/// are those of the material's components, weighted by the particle's own yields as G4Scintillation does by
/// particle type.
std::string particle_light(const OpticalTables& tables, Node material);

/// Adds what the material's scintillation has to its medium: yield, resolution, emission, decay times and
/// light by particle.
void add_scintillation(const OpticalTables& tables, Node material, ImportedMedium& medium);

struct ImportedSurface {
  std::string toml;        ///< the keys of [surfaces.NAME]; empty when it cannot be converted
  std::string gap_index;   ///< of a gap with dispersion, the medium gap_name(surface); else empty
  std::string efficiency;  ///< EFFICIENCY above 0, as TOML: share of the absorbed light that is detected
  std::vector<std::string> notes;  ///< what was not converted, and why
};

/// Name of the medium of a surface's gap.
inline std::string gap_name(const std::string& surface) { return "gap of " + surface; }

/// An <opticalsurface>, in words or in Geant4's numbers: models glisur and unified, types
/// dielectric_dielectric, dielectric_metal and coated, the six finishes polished to groundbackpainted; types
/// dielectric_LUT and dielectric_LUTDAVIS with the finishes of their tables, and dielectric_dichroic, which
/// the scene names.
ImportedSurface import_surface(Node surface, const OpticalTables& tables);

}  // namespace scintray::exchange::gdml
