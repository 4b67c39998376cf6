#pragma once
/// The group of one point in a results file, described in docs/results.md.

#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/id_vector.hpp"
#include "scintray/core/ids.hpp"
#include "scintray/tally/readout_channels.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::results::format {

/// Names that the datasets of a point refer to.
struct PointNames {
  std::vector<std::string> keys, media, surfaces;  ///< swept keys; names
  core::IdVector<core::FaceId, std::string> faces;
  core::IdVector<core::PartId, std::string> parts;
};

/// Writes the parameters, counts and sums of a point.
void put_point(core::h5::Group& group, const tally::PointResult& point, const PointNames& names);

/// Writes the optional records of a point: the energy of its events, the timing of its light, and the
/// effects that its results omit.
void put_point_facts(core::h5::Group& group, const tally::PointResult& point);

/// Writes the group analysis of a point.
void put_event_analysis(core::h5::Group& point, const analysis::EventAnalysis& analysis,
                        const core::IdVector<core::PartId, std::string>& parts);

/// Writes the group channels of a point.
void put_channels(core::h5::Group& point, const std::vector<tally::ReadoutChannel>& channels);

/// Writes texts along a dimension as its dimension scale.
void put_scale(core::h5::Group& group, const std::string& name, const std::vector<std::string>& values);

/// Names of all fates in their order.
std::vector<std::string> fate_names();

}  // namespace scintray::results::format
