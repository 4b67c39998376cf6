#pragma once
/// [run]: settings of the simulation of a scene. Lengths mm, times ns.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/scene_file/until.hpp"

namespace scintray::scene_file {

/// Columns of the list that a scene may choose; "point" is always there.
inline constexpr const char* kPhotonOutputColumns[] = {
    "event",       "photon",      "part",        "face",          "x_mm",    "y_mm",    "z_mm",
    "direction_x", "direction_y", "direction_z", "wavelength_nm", "time_ns", "path_mm", "interactions"};

struct PhotonOutputSpec {
  std::vector<std::string> columns;  ///< of kPhotonOutputColumns; empty: all
  std::uint64_t every = 1;           ///< one photon in this many, chosen by event and photon number alone
  std::vector<config::NameRef> channels;  ///< readout channels, may have wildcards; empty: all

  /// True when the list has all columns of every detected photon.
  bool is_whole() const { return columns.empty() && every == 1 && channels.empty(); }
};

/// `photon_columns`, `photon_sample` and `photon_channels` of [run]. Adds errors to the collector of the
/// table.
/// @param listed  a list is requested
PhotonOutputSpec read_photon_output(const config::TomlTable& run, bool listed);

/// Algorithm of ray queries.
enum class AcceleratorKind {
  automatic,  ///< planes where possible, else Embree
  embree,     ///< Embree's bounding volume hierarchy, single rays, corrected in double precision
  planes,     ///< the nearest plane ahead, for closed regions: all must be convex with few planes
};

inline constexpr core::Word<AcceleratorKind> kAcceleratorKinds[] = {{"auto", AcceleratorKind::automatic},
                                                                    {"embree", AcceleratorKind::embree},
                                                                    {"planes", AcceleratorKind::planes}};

/// Representation of a round face whose surface is known.
enum class CurvedFaces {
  exact,   ///< the surface itself
  facets,  ///< the triangles that approximate it
};

inline constexpr core::Word<CurvedFaces> kCurvedFaces[] = {{"exact", CurvedFaces::exact},
                                                           {"facets", CurvedFaces::facets}};

/// State of polarisation that a photon carries.
enum class PolarisationState {
  linear,      ///< phases between s and p at total reflection, films and metals are not retained
  elliptical,  ///< phases are retained
};

inline constexpr core::Word<PolarisationState> kPolarisationStates[] = {
    {"linear", PolarisationState::linear}, {"elliptical", PolarisationState::elliptical}};

struct RunSpec {
  std::uint64_t seed = 1;
  std::uint64_t max_interactions = 100000;  ///< boundary interactions per photon
  std::optional<double> max_time_ns;        ///< since the event; photons beyond it are cut
  std::optional<int> threads;               ///< nothing: all cores
  /// Photons propagated at once, of core::lane_widths(). No result depends on it, and no key sets it.
  std::optional<int> lane_width;
  double contact_tolerance_mm = 1e-4;
  AcceleratorKind accelerator = AcceleratorKind::automatic;
  CurvedFaces curved = CurvedFaces::exact;
  PolarisationState polarisation = PolarisationState::linear;
  bool efficiency_at_birth = true;  ///< photons that no sensor would convert are not traced, where not needed
  std::uint64_t paths = 0;          ///< photons whose paths are recorded, per point
  bool photon_list = false;         ///< write every detected photon to the results
  PhotonOutputSpec photons;         ///< selection of photons and columns
  bool photon_history = false;      ///< write the history of each, for reweighting
  std::optional<UntilSpec> until;   ///< ends a point before the photons or events of its source
  std::filesystem::path output;     ///< results file; empty: default of the command
  core::FileLocation where;
};

/// Run settings: [run] of a scene. Adds errors to the collector of the table.
RunSpec read_run(const config::TomlTable& scene);

}  // namespace scintray::scene_file
