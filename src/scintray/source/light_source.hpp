#pragma once
/// Photons, and the light sources that emit them, event by event.

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "scintray/optics/fresnel.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/scene_file/spec.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// The state of one photon, as plain data; records that only some scenes require are in PhotonRecords.
struct Photon {
  core::PlainVec3 position;  ///< world, mm
  optics::Ray ray;           ///< direction and polarisation
  double wavelength_nm = 0.0;
  double time_ns = 0.0;
  double path_mm = 0.0;
  double optical_depth = 0.0;  ///< remaining until absorption or scattering in the bulk
  double conversion_draw =
      0.0;                      ///< uniform on [0, 1): a sensor converts it when this is below its efficiency
  optics::MediumOptics optics;  ///< of the region's medium at this wavelength
  core::RegionId region = {};   ///< that contains the photon
  std::uint32_t interactions = 0;  ///< boundary interactions so far
  std::uint32_t scatterings = 0;   ///< bulk scatterings so far
  /// Triangle of the region's boundary on whose face the photon is, where that is of use: on an exact round
  /// face since its last reflection there, or on a flat face of a region with thin gaps; scene::kNoTriangle:
  /// on none.
  std::uint32_t on_triangle = 0xffffffffu;
};
static_assert(std::is_trivially_copyable_v<Photon>);

/// A photon that is emitted together with others.
struct EmittedPhoton {
  Photon photon;
  core::Rng rng{0, core::StreamKind::photon, 0};  ///< its own stream
  std::uint64_t number = 0;                       ///< in its event
};

/// Photons of one event, to be traced one after the other.
struct PhotonSpan {
  std::uint64_t event = 0;
  std::uint64_t first = 0;
  std::uint64_t count = std::numeric_limits<std::uint64_t>::max();  ///< at most; or to the event's last
};

/// The light of one event. Set by a LightSource and, apart from `event`, used by it alone.
struct EventLight {
  std::uint64_t photons = 0;
  Event event;  ///< whose deposits emit the light; empty for photons that have none
  /// Photons of a deposit: scintillation first, then Cherenkov light. Both are numbered from the event's
  /// first photon.
  struct DepositEnd {
    std::uint64_t scintillation = 0, all = 0;
  };
  std::vector<DepositEnd> deposits;  ///< per deposit: one past its last photons
  std::uint64_t first_listed = 0;    ///< of a list of photons: number of the event's first
};

/// Source of the photons of a scene's [source]. Immutable; an event depends on its own random stream, and a
/// photon on its event and its own stream, so that both can be generated in any order and by any thread.
class LightSource {
 public:
  virtual ~LightSource() = default;
  /// Number of events.
  virtual std::uint64_t events() const = 0;
  /// True for events of energy deposits, or of a list of photons: they have records of their own.
  virtual bool has_energy() const = 0;
  /// Number of blocks of work. Blocks make results reproducible: they are fixed by the source, not by the
  /// machine.
  virtual std::uint64_t blocks() const = 0;
  virtual std::vector<PhotonSpan> block(std::uint64_t number) const = 0;
  /// Number of photons of all events; 0 when it depends on the events.
  virtual std::uint64_t photons() const = 0;
  /// Generates an event and its number of photons.
  /// @param rng  the event's own stream
  virtual void begin(const scene::Scene& scene, std::uint64_t event, core::Rng& rng,
                     EventLight& light) const = 0;
  /// Initial state of a photon of an event.
  /// @param light   of its event; for a source of photons the light of any of its events
  /// @param photon  0 to light.photons - 1
  /// @param rng     the photon's own stream
  virtual Photon emit(const scene::Scene& scene, const EventLight& light, std::uint64_t photon,
                      core::Rng& rng) const = 0;
  /// Initial states of several photons: each as of emit() alone, to the last bit, with its stream where
  /// emit() leaves it.
  /// @param photons     with numbers as for emit(), and streams of which nothing is drawn
  /// @param lane_width  photons at once, of core::lane_widths()
  virtual void emit_together(const scene::Scene& scene, const EventLight& light,
                             std::span<EmittedPhoton* const> photons, int lane_width) const;
  /// Regions in which photons may start.
  virtual std::vector<core::RegionId> regions() const = 0;
};

/// Light source of a specification's [source] in a built scene. Throws InputError with every contradiction.
/// @param notes  receives warnings, none of which stops a run
std::unique_ptr<LightSource> make_light_source(const scene_file::SceneSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes = nullptr);

}  // namespace scintray::source
