#pragma once
/// Events and their energy deposits, from which scintillation light is emitted.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/gamma_source.hpp"

namespace scintray::source {

/// An energy deposit at one point, by one electron as far as sources know its electrons.
struct Deposit {
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  core::RegionId region = {};                ///< that contains the position
  double energy_keV = 0.0;
  double time_ns = 0.0;  ///< since the start of the event
};

/// Energy deposits of one event: of a decay, of a pair of gammas, or of one event of a list of hits.
struct Event {
  std::vector<Deposit> deposits;
  double energy_keV = 0.0;   ///< initial, of all particles; 0 when not available (lists of hits)
  double escaped_keV = 0.0;  ///< of it, carried out of the scene
  double non_scintillating_keV =
      0.0;  ///< in non-scintillating media; the sum with deposits and escaped is all
};

/// An event source. Immutable; an event depends on its own random stream only, so that events can be
/// generated in any order and by any thread.
class EventSource {
 public:
  virtual ~EventSource() = default;
  /// Number of events.
  virtual std::uint64_t events() const = 0;
  /// @param number  0 to events() - 1
  /// @param rng     the event's own stream
  virtual Event make(const scene::Scene& scene, std::uint64_t number, core::Rng& rng) const = 0;
};

/// Event source of a specification in a built scene. Throws InputError with every contradiction: a region
/// without volume, media without composition, no scintillator where energy is deposited, invalid rows of
/// hits.
/// @param notes  receives warnings, none of which stops a run: hits out of order or outside every part
std::unique_ptr<EventSource> make_event_source(const scene_file::GammaSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes = nullptr);

}  // namespace scintray::source
