#pragma once
/// Histories of detected photons, as required by reweighting (analysis/reweight.hpp).

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "scintray/scene/scene.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::tally {

/// A reflector behind a surface. One definition of a surface is one reflector, independent of the media on
/// its sides.
struct ReflectorSite {
  std::string surface;  ///< definition of the surface, a mixture's own
  std::string stack;  ///< definition of the stack with the reflector: the surface, or a share of its mixture
  std::string reflector;  ///< name of the reflector; that of the stack when its reflectance is defined there

  bool operator==(const ReflectorSite&) const = default;
};

/// Range of a property over the wavelengths in use.
struct TracedRange {
  double least = 0.0, most = 0.0;
};

/// The media and reflectors to which histories refer, with their properties in the run.
struct HistorySubjects {
  std::vector<std::string> media;  ///< of the regions that light can enter
  std::vector<TracedRange> absorption_per_mm;
  std::vector<ReflectorSite> reflectors;
  std::vector<TracedRange> reflectance;
  /// Names of reflectors that transmit light, of their stacks and surfaces: not among `reflectors`, since the
  /// reflectance of such a sheet does not change independently.
  std::vector<std::string> transmitting;
  std::vector<std::string> gap_media;  ///< also used in gaps with a thickness, where paths are not recorded
};

/// Histories of detected photons, one row for each, in the order of photons.
struct PhotonHistories {
  std::vector<std::uint32_t> point;
  std::vector<std::uint64_t> event, photon;
  std::vector<float> path_mm;              ///< rows x media
  std::vector<float> absorption_depth;     ///< rows x media: integral of 1 / absorption length along the path
  std::vector<std::uint32_t> reflections;  ///< rows x reflectors: survived
  std::vector<float> reflection_depth;     ///< rows x reflectors: sum of -ln(reflectance)

  std::size_t rows() const { return point.size(); }
};

/// A medium or reflector among HistorySubjects.
using HistoryColumn = core::Id<struct HistoryColumnTag>;

/// The subjects of a scene, and the columns of its regions and reflectors.
class HistoryPlan {
 public:
  explicit HistoryPlan(const scene::Scene& scene);

  const HistorySubjects& subjects() const { return subjects_; }
  /// Column of the medium of a region; none for an opaque one.
  HistoryColumn column_of_region(core::RegionId region) const { return column_of_region_[region]; }
  /// Column of a reflector; none for one that transmits light.
  HistoryColumn column_of(const optics::Reflector& reflector) const {
    const auto known = column_of_reflector_.find(&reflector);
    return known == column_of_reflector_.end() ? HistoryColumn::none() : known->second;
  }

 private:
  void add_media(const scene::Scene& scene);
  void add_surface(const scene::Scene& scene, const optics::Surface& surface, const std::string& within);

  HistorySubjects subjects_;
  core::IdVector<core::RegionId, HistoryColumn> column_of_region_;
  std::unordered_map<const optics::Reflector*, HistoryColumn> column_of_reflector_;
};

/// Recorder of histories, one photon after the other.
class HistoryRecorder {
 public:
  HistoryRecorder(const scene::Scene& scene, const HistoryPlan& plan);

  /// Starts the history of a photon, in its state at emission.
  void start(const source::Photon& emitted);
  /// Records any step, the last one included.
  void step(const source::Photon& photon, const transport::Step& step);
  /// Keeps the history of the present photon, which was detected.
  /// @param survived  its survived reflections
  void keep(std::uint32_t point, std::uint64_t event, std::uint64_t photon,
            const optics::ReflectionLog& survived);

  const PhotonHistories& kept() const { return kept_; }

 private:
  const scene::Scene& scene_;
  const HistoryPlan& plan_;
  double path_mm_ = 0.0, wavelength_nm_ = 0.0;  ///< at the end of the last step
  std::vector<double> path_in_mm_, depth_in_;   ///< per medium
  PhotonHistories kept_;
};

}  // namespace scintray::tally
