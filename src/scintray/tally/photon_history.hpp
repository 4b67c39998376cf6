#pragma once
/// What detected photons went through, as reweighting needs it (analysis/reweight.hpp).

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "scintray/scene/scene.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::tally {

/// A reflector behind a surface. One definition of a surface is one reflector, whatever media it lies
/// between.
struct ReflectorSite {
  std::string surface;    ///< definition of the surface, a mixture's own
  std::string stack;      ///< definition of the stack with the reflector: the surface, or what it is mixed of
  std::string reflector;  ///< name of the reflector; the stack's when its reflectance is written there

  bool operator==(const ReflectorSite&) const = default;
};

/// Least and most of a property over the wavelengths in use.
struct TracedRange {
  double least = 0.0, most = 0.0;
};

/// Which media and reflectors histories refer to, and how these were traced.
struct HistorySubjects {
  std::vector<std::string> media;  ///< of the regions that light can be in
  std::vector<TracedRange> absorption_per_mm;
  std::vector<ReflectorSite> reflectors;
  std::vector<TracedRange> reflectance;
  /// Names of reflectors that let light through, of their stacks and surfaces: not among `reflectors`, since
  /// the reflectance of such a sheet does not change alone.
  std::vector<std::string> transmitting;
  std::vector<std::string> gap_media;  ///< that also fill gaps with a thickness, where paths are not recorded
};

/// Histories of detected photons, a row each in the order of photons, row after row.
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

/// The subjects of a scene, and where to write down what.
class HistoryPlan {
 public:
  explicit HistoryPlan(const scene::Scene& scene);

  const HistorySubjects& subjects() const { return subjects_; }
  /// Column of the medium of a region; none for what is opaque.
  HistoryColumn column_of_region(core::RegionId region) const { return column_of_region_[region]; }
  /// None for one that lets light through.
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

/// Follows one photon after the other.
class HistoryRecorder {
 public:
  HistoryRecorder(const scene::Scene& scene, const HistoryPlan& plan);

  /// Begins a photon, as it was emitted.
  void start(const source::Photon& emitted);
  /// Any step, the last one included.
  void step(const source::Photon& photon, const transport::Step& step);
  /// Keeps the photon under way: it was detected.
  /// @param survived  its reflections
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
