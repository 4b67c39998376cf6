#pragma once
/// The tables of photon paths of a results file: /paths, /path_steps and /step_texts.

#include <map>
#include <string>
#include <vector>

#include "scintray/core/h5.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/tally/photon_path.hpp"

namespace scintray::results::format {

/// Writer of photon paths.
class PathTables {
 public:
  /// Creates the groups.
  explicit PathTables(core::h5::Group& root);
  void add(std::size_t point, const std::vector<tally::PhotonPath>& paths);
  /// Writes what waits, and the texts of all steps.
  void finish();

 private:
  core::h5::Group root_;
  RowWriter<PathRow> paths_;
  RowWriter<PathStepRow> steps_;
  std::map<std::string, std::uint32_t> numbers_;  ///< of texts, by first appearance
  std::vector<std::string> texts_;
};

}  // namespace scintray::results::format
