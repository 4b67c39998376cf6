#pragma once
/// What the list of detected photons in a results file has: columns, a sample, channels.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"

namespace scintray::scene_file {

/// Columns of the list that a scene may choose; "point" is always there.
inline constexpr const char* kPhotonOutputColumns[] = {
    "event",       "photon",      "part",        "face",          "x_mm",    "y_mm",    "z_mm",
    "direction_x", "direction_y", "direction_z", "wavelength_nm", "time_ns", "path_mm", "interactions"};

struct PhotonOutputSpec {
  std::vector<std::string> columns;       ///< of kPhotonOutputColumns; empty: all
  std::uint64_t every = 1;                ///< one photon in so many, chosen by event and photon number alone
  std::vector<config::NameRef> channels;  ///< readout channels, may have wildcards; empty: all

  /// True when the list has everything of every detected photon.
  bool is_whole() const { return columns.empty() && every == 1 && channels.empty(); }
};

/// `photon_columns`, `photon_sample` and `photon_channels` of [run]. Adds errors to the collector of the
/// table.
/// @param listed  a list is requested
PhotonOutputSpec read_photon_output(const config::TomlTable& run, bool listed);

}  // namespace scintray::scene_file
