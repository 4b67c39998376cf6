#pragma once
/// Optional content of results files: records of a point; the tables of photon paths, /paths, /path_steps and
/// /step_texts.

#include <map>
#include <string>
#include <vector>

#include "scintray/core/h5.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/tally/photon_path.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::results::format {

/// Readers of a point's group that has the record. @throws std::invalid_argument for a contradiction
tally::LightTiming get_light_timing(const core::h5::Group& point);
std::vector<tally::OmittedEffect> get_omitted_effects(const core::h5::Group& point);
tally::UntilResult get_until(const core::h5::Group& point);
tally::EventFates get_event_fates(const core::h5::Group& point);

/// Sums over events of photons at `size` places, "NAME_event_squares" and "NAME_event_products"; empty in
/// files without them. @throws std::invalid_argument when their number is not `size`
std::vector<tally::EventShare> get_event_shares(const core::h5::Group& point, const std::string& name,
                                                std::size_t size);

/// Writer of photon paths.
class PathTables {
 public:
  /// Creates the groups.
  explicit PathTables(core::h5::Group& root);
  void add(std::size_t point, const std::vector<tally::PhotonPath>& paths);
  /// Writes the buffered rows, and the texts of all steps.
  void finish();

 private:
  core::h5::Group root_;
  RowWriter<PathRow> paths_;
  RowWriter<PathStepRow> steps_;
  std::map<std::string, std::uint32_t> numbers_;  ///< of texts, by first appearance
  std::vector<std::string> texts_;
};

}  // namespace scintray::results::format
