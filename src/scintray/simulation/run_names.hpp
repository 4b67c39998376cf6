#pragma once
/// Names over all points of a run, and the indices of a point's own names in them.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scintray/scene/scene.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/readout_channels.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::simulation {

/// Names of a kind over all points of a sweep: points may differ in their media and surfaces; results
/// have one list.
class NameList {
 public:
  /// Index of a name, which is added when it is new.
  std::uint32_t add(const std::string& name);
  /// Index of a name that was added.
  std::uint32_t index(const std::string& name) const { return index_.at(name); }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t> index_;
};

struct RunNames {
  NameList media, surfaces, parts, faces;

  void add(const scene::Scene& scene);
};

/// Conversion of a point's indices from its scene's lists to the run's.
class Renumbering {
 public:
  /// @param names  with those of the scene
  Renumbering(const scene::Scene& scene, const RunNames& names);

  void apply(tally::PointResult& result) const;
  std::vector<tally::ReadoutChannel> applied(std::vector<tally::ReadoutChannel> channels) const;
  std::vector<tally::EventRecord> applied(std::vector<tally::EventRecord> events) const;
  std::vector<tally::DetectedPhoton> applied(std::vector<tally::DetectedPhoton> photons) const;

 private:
  std::size_t media_count_ = 0, surface_count_ = 0;              ///< in the run's lists
  std::vector<std::uint32_t> media_, surfaces_, parts_, faces_;  ///< per index in the scene
};

}  // namespace scintray::simulation
