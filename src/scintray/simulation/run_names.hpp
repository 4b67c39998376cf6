#pragma once
/// Names over all points of a run, and the indices of a point's own names in them.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scintray/scene/scene.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/point_sums.hpp"
#include "scintray/tally/readout_channels.hpp"

namespace scintray::simulation {

/// Names of a kind over all points of a sweep: points may differ in their media and surfaces; results
/// have one list.
template <typename IdType>
class NameList {
 public:
  /// Adds a name when it is new.
  void add(const std::string& name) {
    if (ids_.try_emplace(name, names_.next_id()).second) names_.push_back(name);
  }
  /// Of a name that was added.
  IdType id(const std::string& name) const { return ids_.at(name); }
  const core::IdVector<IdType, std::string>& names() const { return names_; }

 private:
  core::IdVector<IdType, std::string> names_;
  std::map<std::string, IdType> ids_;
};

struct RunNames {
  NameList<core::MediumId> media;
  NameList<core::SurfaceId> surfaces;
  NameList<core::PartId> parts;
  NameList<core::FaceId> faces;

  void add(const scene::Scene& scene);
};

/// Conversion of a point's ids from its scene's lists to the run's.
class Renumbering {
 public:
  /// @param names  with those of the scene
  Renumbering(const scene::Scene& scene, const RunNames& names);

  tally::PointSums applied(tally::PointSums sums) const;
  std::vector<tally::ReadoutChannel> applied(std::vector<tally::ReadoutChannel> channels) const;
  std::vector<tally::EventRecord> applied(std::vector<tally::EventRecord> events) const;
  std::vector<tally::DetectedPhoton> applied(std::vector<tally::DetectedPhoton> photons) const;

 private:
  std::size_t media_count_ = 0, surface_count_ = 0;  ///< in the run's lists
  core::IdVector<core::MediumId, core::MediumId> media_;
  core::IdVector<core::SurfaceId, core::SurfaceId> surfaces_;
  core::IdVector<core::PartId, core::PartId> parts_;
  core::IdVector<core::FaceId, core::FaceId> faces_;
};

}  // namespace scintray::simulation
