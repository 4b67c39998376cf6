#pragma once
/// Rows of a list of detected photons as bytes.

#include <algorithm>
#include <string>
#include <vector>

#include "scintray/results/photon_columns.hpp"
#include "scintray/results/photon_list_layout.hpp"
#include "scintray/simulation/detail/byte_archive.hpp"

namespace scintray::simulation::detail {

/// Rows with the columns of a list; without the point, which is that of their range.
class PhotonRows {
 public:
  explicit PhotonRows(const results::PhotonListLayout& layout) {
    results::format::for_each_column(kPhoton, [&](const std::string& column, auto) {
      stored_.push_back(column != "point" && layout.has(column));
    });
  }

  /// True when a row has no bytes, so that none can be read.
  bool are_empty() const { return std::find(stored_.begin(), stored_.end(), true) == stored_.end(); }

  template <typename A>
  void exchange(A& archive, tally::DetectedPhoton& photon) const {
    std::size_t column = 0;
    results::format::for_each_column(kPhoton, [&](const char*, auto member) {
      if (stored_[column++]) detail::pass(archive, member(photon));
    });
  }

 private:
  static constexpr const tally::DetectedPhoton* kPhoton = nullptr;

  std::vector<bool> stored_;  ///< by column, in the order of for_each_column
};

}  // namespace scintray::simulation::detail
