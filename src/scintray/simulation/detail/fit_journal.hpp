#pragma once
/// Points of simulated curves as pieces of a journal.

#include <memory>
#include <optional>
#include <vector>

#include "scintray/core/input_file.hpp"
#include "scintray/simulation/fit.hpp"

namespace scintray::simulation::detail {

/// The journal of a fit; null where the settings have none.
/// @param inputs  files that were read for it
std::unique_ptr<core::Journal> fit_journal(const FitModelSettings& settings,
                                           const scene_file::SceneFile& file, const scene_file::FitSpec& fit,
                                           const core::InputRecord& inputs);

/// A point of the curve of some parameters and draw; nothing when the journal does not have it, or is null.
std::optional<analysis::ModelPoint> journal_point(const core::Journal* journal,
                                                  const std::vector<double>& parameters, std::uint64_t draw,
                                                  std::size_t point);
/// Does nothing without a journal.
void add_to_journal(core::Journal* journal, const std::vector<double>& parameters, std::uint64_t draw,
                    std::size_t point, const analysis::ModelPoint& traced);

}  // namespace scintray::simulation::detail
