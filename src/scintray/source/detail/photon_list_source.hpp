#pragma once
/// Photons of another program as a source.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/plain_vec.hpp"
#include "scintray/scene_file/photon_list.hpp"
#include "scintray/source/light_source.hpp"

namespace scintray::source {

/// Numbers of photons of a list that start in a special place, with descriptions of the first few.
struct PhotonListReport {
  struct Count {
    std::uint64_t photons = 0;
    std::vector<std::string> first;
  };
  Count ambient;         ///< outside every part
  Count on_face;         ///< on a face: they start kBehindFace_mm along their direction
  Count opaque;          ///< left out, since they are in a part that absorbs all light
  Count polarised_here;  ///< of zero polarisation in a list of polarisations: drawn at random
};

/// Events of the photons of a list, in the order of their numbers there. Positions, directions,
/// polarisations, wavelengths and times are those of the list; a polarisation is made exactly perpendicular
/// to its direction. Immutable.
class PhotonListSource : public LightSource {
 public:
  /// A photon within this distance of a face, along its direction, is on it: Geant4 ends steps at faces, on
  /// either side by rounding. It starts this far along its direction, beyond the face.
  static constexpr double kBehindFace_mm = 1e-6;

  /// @param most  largest number of events; 0 for all
  /// Throws InputError as PhotonListSpec::photons does, for photons in opaque parts unless they are left out,
  /// and when no photon is left.
  PhotonListSource(const scene_file::PhotonListSpec& spec, std::uint64_t most, bool unpolarised,
                   const scene::Scene& scene);

  std::uint64_t events() const override { return first_.size() - 1; }
  bool has_energy() const override { return true; }
  std::uint64_t blocks() const override { return events(); }
  std::vector<PhotonSpan> block(std::uint64_t number) const override { return {{number}}; }
  std::uint64_t photons() const override { return first_.back(); }
  void begin(const scene::Scene& scene, std::uint64_t event, core::Rng& rng,
             EventLight& light) const override;
  Photon emit(const scene::Scene& scene, const EventLight& light, std::uint64_t photon,
              core::Rng& rng) const override;
  std::vector<core::RegionId> regions() const override { return regions_; }

  const PhotonListReport& report() const { return report_; }
  /// The report as warnings; empty without any.
  std::vector<std::string> notes() const;

 private:
  /// A photon before its random numbers are drawn.
  struct Listed {
    core::PlainVec3 position, direction, polarisation;  ///< zero polarisation: drawn, or unpolarised
    double wavelength_nm = 0.0, time_ns = 0.0;
    core::RegionId region = {};
  };

  bool place(const scene_file::PhotonColumns& photons, std::size_t row, const scene::Scene& scene,
             Listed& listed);
  core::RegionId locate(const scene::Scene& scene, const core::Vec3& point);

  std::vector<Listed> photons_;       ///< event after event
  std::vector<std::uint64_t> first_;  ///< of each event, then the number of all photons
  std::vector<core::RegionId> regions_;
  core::RegionId latest_ = scene::kAmbientRegion;  ///< of the photon before, where the search begins
  PhotonListReport report_;
  std::string origin_;
  bool unpolarised_ = false;
};

}  // namespace scintray::source
