#pragma once
/// Selection of photons and columns in the photon list of a results file.

#include <cstdint>
#include <string>
#include <vector>

namespace scintray::results {

/// Selection of photons and columns in a list of detected photons.
struct PhotonListLayout {
  std::vector<std::string> columns;   ///< empty: all; "point" is always there
  std::uint64_t every = 1;            ///< one photon in this many, chosen by event and photon number alone
  std::vector<std::string> channels;  ///< patterns of the readout channels; empty: all

  bool is_whole() const { return columns.empty() && every == 1 && channels.empty(); }
  bool has(const std::string& column) const;
};

}  // namespace scintray::results
