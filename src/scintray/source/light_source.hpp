#pragma once
/// What a run traces: photons, and what emits them, event by event.

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "scintray/optics/fresnel.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/scene_file/spec.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// The state of one photon, as plain data: what only some scenes add lies beside it, in PhotonRecords.
struct Photon {
  core::PlainVec3 position;  ///< world, mm
  optics::Ray ray;           ///< direction and polarisation
  double wavelength_nm = 0.0;
  double time_ns = 0.0;
  double path_mm = 0.0;
  double optical_depth = 0.0;      ///< left until absorption or scattering in the bulk
  optics::MediumOptics optics;     ///< of the region's medium at this wavelength
  core::RegionId region = {};      ///< in which it is
  std::uint32_t interactions = 0;  ///< boundary interactions so far
  std::uint32_t scatterings = 0;   ///< bulk scatterings so far
};
static_assert(std::is_trivially_copyable_v<Photon>);

/// Photons of one event, to be traced one after the other.
struct PhotonSpan {
  std::uint64_t event = 0;
  std::uint64_t first = 0;
  std::uint64_t count = std::numeric_limits<std::uint64_t>::max();  ///< at most; else to the event's last
};

/// The light of one event. Filled by a LightSource, read by nothing else than it, but for `event`.
struct EventLight {
  std::uint64_t photons = 0;
  Event event;  ///< what made the light; empty when the source is one of photons
  /// Photons of a deposit: scintillation first, then Cherenkov light. Both count from the event's first.
  struct DepositEnd {
    std::uint64_t scintillation = 0, all = 0;
  };
  std::vector<DepositEnd> deposits;  ///< per deposit: one past its last photons
};

/// Makes the photons of a scene's [source]. Immutable; an event depends on its own random stream, and a
/// photon on its event and its own stream, so both can be made in any order and by any thread.
class LightSource {
 public:
  virtual ~LightSource() = default;
  /// Number of events there are.
  virtual std::uint64_t events() const = 0;
  /// True when events come from energy left in the scene: they then have records of their own.
  virtual bool has_energy() const = 0;
  /// Blocks of work, which make results reproducible: fixed by the source, not by the machine.
  virtual std::uint64_t blocks() const = 0;
  virtual std::vector<PhotonSpan> block(std::uint64_t number) const = 0;
  /// Photons there are over all events; 0 when only the events determine it.
  virtual std::uint64_t photons() const = 0;
  /// Begins an event.
  /// @param rng  the event's own stream
  virtual void begin(const scene::Scene& scene, std::uint64_t event, core::Rng& rng,
                     EventLight& light) const = 0;
  /// A photon of an event that was begun, as it starts.
  /// @param photon  0 to light.photons - 1
  /// @param rng     the photon's own stream
  virtual Photon emit(const scene::Scene& scene, const EventLight& light, std::uint64_t photon,
                      core::Rng& rng) const = 0;
  /// Regions in which photons may start.
  virtual std::vector<core::RegionId> regions() const = 0;
};

/// Binds the [source] of a specification to a built scene. Throws InputError with what does not fit.
/// @param notes  takes what a user should know, none of which stops a run
std::unique_ptr<LightSource> make_light_source(const scene_file::SceneSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes = nullptr);

}  // namespace scintray::source
