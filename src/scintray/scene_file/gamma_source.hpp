#pragma once
/// Event sources in a scene file: [source] of the types "gamma_events", "gammas", "hits" and "photon_list".

#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/curve.hpp"
#include "scintray/optics/composition.hpp"
#include "scintray/scene_file/photon_list.hpp"
#include "scintray/scene_file/source.hpp"

namespace scintray::scene_file {

/// Particle that deposits the energy of an event of type = "gamma_events". The light of a scintillator whose
/// response is not proportional, and Cherenkov light, depend on it.
enum class Depositing {
  gamma,    ///< a gamma of this energy, absorbed in the medium: its Compton and photoelectrons
  electron  ///< one electron
};
inline constexpr core::Word<Depositing> kDepositing[] = {{"gamma", Depositing::gamma},
                                                         {"electron", Depositing::electron}};

/// type = "gamma_events": the energy of one event at one point, without transport of gammas.
struct SpectrumSpec {
  std::variant<RegionSpec, core::Vec3> origin;  ///< of the deposits
  core::FileLocation origin_where;
  std::optional<double> energy_keV;  ///< of every event; nothing: drawn from the spectrum
  core::Curve spectrum;              ///< relative number per keV against energy, keV
  Depositing particle = Depositing::gamma;
};

/// A parallelogram in the scene, mm.
struct PlaneSpec {
  core::Vec3 centre = core::Vec3::Zero();
  core::Vec3 x = core::Vec3::UnitX(), y = core::Vec3::UnitY();  ///< edges, from end to end
  core::FileLocation where;
};

/// Range of energies of gamma transport (docs/gamma_sources.md): below it a gamma's energy is deposited at
/// its position.
inline constexpr double kLowestGamma_keV = 10.0;
inline constexpr double kHighestGamma_keV = 3000.0;

/// Emission of one event of a source of gammas.
enum class Emission {
  gamma,    ///< one gamma
  pair,     ///< two of 511 keV, back to back
  sodium,   ///< a decay of 22Na
  caesium,  ///< a decay of 137Cs
  lutetium  ///< a decay of 176Lu, electrons included
};

inline constexpr core::Word<Emission> kEmissions[] = {{"gamma", Emission::gamma},
                                                      {"pair", Emission::pair},
                                                      {"Na22", Emission::sodium},
                                                      {"Cs137", Emission::caesium},
                                                      {"Lu176", Emission::lutetium}};

/// Composition of parts, for gammas, where that of their medium is not defined.
struct MatterSpec {
  config::NameRef part;             ///< may have wildcards; "ambient" is the medium around the parts
  optics::Composition composition;  ///< empty: empty space
  double density_g_per_cm3 = 0.0;
  core::FileLocation where;
};

/// Name of the ambient in MatterSpec::part.
inline constexpr const char* kAmbientName = "ambient";

/// type = "gammas": transport of gammas through the scene.
struct EmitterSpec {
  std::variant<RegionSpec, core::Vec3, PlaneSpec> origin;
  core::FileLocation origin_where;
  Emission emission = Emission::gamma;
  core::FileLocation emission_where;
  double energy_keV = 0.0;         ///< of Emission::gamma
  DirectionSpec direction;         ///< of the gamma, or of the first of the pair; nuclides are isotropic
  double acollinearity_rad = 0.0;  ///< of the pair: FWHM of either transverse deviation from 180 deg
  bool fluorescence = true;        ///< K X-rays after photoelectric absorption
  std::vector<MatterSpec> matter;  ///< the last one for a part applies
};

/// Columns of hits that are steps of particles, all optional.
enum class StepColumn {
  dx,  ///< with dy and dz the displacement from the start of the step to its end, mm
  dy,
  dz,
  beta,                   ///< velocity over that of light in vacuum at the start of the step
  beta_end,               ///< at its end; not given: as at its start
  charge,                 ///< of the particle, in elementary charges; not given: that of `particle`
  particle,               ///< code of the Particle Data Group
  kinetic,                ///< kinetic energy at the start of the step, keV
  scintillation_photons,  ///< number of photons, sampled by the other program
  cherenkov_photons,      ///< the same of Cherenkov photons
  decay,                  ///< decay time of the scintillation, ns; not given: as of the medium
  rise                    ///< rise time, ns
};
inline constexpr core::Word<StepColumn> kStepColumns[] = {
    {"dx", StepColumn::dx},
    {"dy", StepColumn::dy},
    {"dz", StepColumn::dz},
    {"beta", StepColumn::beta},
    {"beta_end", StepColumn::beta_end},
    {"charge", StepColumn::charge},
    {"particle", StepColumn::particle},
    {"kinetic", StepColumn::kinetic},
    {"scintillation_photons", StepColumn::scintillation_photons},
    {"cherenkov_photons", StepColumn::cherenkov_photons},
    {"decay", StepColumn::decay},
    {"rise", StepColumn::rise}};
/// One of each column, by StepColumn.
template <typename T>
using PerStepColumn = std::array<T, std::size(kStepColumns)>;

/// Deposits in memory, one row each: columns of equal length, in the order of another program.
struct HitColumns {
  std::vector<double> event;  ///< whole numbers from 0 on
  std::vector<double> x_mm, y_mm, z_mm;
  std::vector<double> energy_keV;
  std::vector<double> time_ns;                 ///< empty: no times
  PerStepColumn<std::vector<double>> steps{};  ///< empty where not given
};

/// type = "hits": deposits of another program, from a file or in memory.
struct HitsSpec {
  std::filesystem::path file;  ///< of config::ColumnFile; empty with `arrays`
  bool arrays = false;         ///< the calling program sets `columns`
  /// In place of a file; null until the calling program has set it (simulation::SimulationOptions::change).
  std::shared_ptr<const HitColumns> columns;
  core::FileLocation where;
  std::string group;  ///< of an HDF5 file, with the columns; empty: its root
  std::string event = "event", x = "x", y = "y", z = "z", energy = "energy", time = "time";  ///< columns
  PerStepColumn<std::string> steps{};  ///< names of the file's columns of steps; empty: the file has none
  double length_mm = 1.0;              ///< the file's unit of length
  double energy_keV = 1.0;             ///< the file's unit of energy
  std::optional<double> time_ns;       ///< the file's unit of time; nothing: the file has no times
};

struct GammaSpec {
  std::variant<SpectrumSpec, EmitterSpec, HitsSpec, PhotonListSpec> kind;
  std::uint64_t events = 0;                   ///< of a list: 0 for all, else the largest number
  std::optional<std::uint64_t> quick_events;  ///< replaces `events` in a quick run
  bool cherenkov = false;                     ///< Cherenkov light in addition to scintillation
  /// Shortest and longest wavelength of Cherenkov light; nothing: those of the scintillation.
  std::optional<std::array<double, 2>> cherenkov_nm;
  bool unpolarised = false;  ///< of the light, as in SourceSpec
  core::FileLocation where;
};

/// Types of [source] with events: of energy deposits, or of photons of another program.
enum class GammaSourceType {
  spectrum,  ///< SpectrumSpec
  emitter,   ///< EmitterSpec
  hits,      ///< HitsSpec
  photons    ///< PhotonListSpec
};
/// Values of `source.type` that read_gamma_source reads.
inline constexpr core::Word<GammaSourceType> kGammaSourceTypes[] = {
    {"gamma_events", GammaSourceType::spectrum},
    {"gammas", GammaSourceType::emitter},
    {"hits", GammaSourceType::hits},
    {"photon_list", GammaSourceType::photons}};
/// Values of `source.polarisation` of the other types.
inline constexpr core::Word<bool> kUnpolarised[] = {{"random", false}, {"unpolarised", true}};

/// Event source of the table [source], of one of the types (docs/gamma_sources.md); further and unknown
/// keys are left to the caller. Adds errors to the collector of the table.
/// @param source  its `type` is one of kGammaSourceTypes
/// @param parts   names of the scene's parts
GammaSpec read_gamma_source(const config::TomlTable& source, const std::vector<std::string>& parts);

}  // namespace scintray::scene_file
