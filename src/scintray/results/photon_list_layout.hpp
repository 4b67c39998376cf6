#pragma once
/// What the list of detected photons of a results file has.

#include <cstdint>
#include <string>
#include <vector>

namespace scintray::results {

/// What a list of detected photons has.
struct PhotonListLayout {
  std::vector<std::string> columns;   ///< empty: all; "point" is always there
  std::uint64_t every = 1;            ///< one photon in so many, chosen by event and photon number alone
  std::vector<std::string> channels;  ///< patterns of the readout channels; empty: all

  bool is_whole() const { return columns.empty() && every == 1 && channels.empty(); }
  bool has(const std::string& column) const;
};

}  // namespace scintray::results
