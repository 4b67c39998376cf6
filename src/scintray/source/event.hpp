#pragma once
/// What makes scintillation light: energy left in matter.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/gamma_source.hpp"

namespace scintray::source {

/// Energy left at one place.
struct Deposit {
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  core::RegionId region = {};                ///< in which it lies
  double energy_keV = 0.0;
  double time_ns = 0.0;  ///< since the event began
};

/// What one decay, or one pair of gammas, or one row of a list of hits leaves in the scene.
struct Event {
  std::vector<Deposit> deposits;
  double energy_keV = 0.0;   ///< of all particles as they started; 0 when not known (lists of hits)
  double escaped_keV = 0.0;  ///< of it, carried out of the scene
  double non_scintillating_keV =
      0.0;  ///< left in media that do not scintillate; with deposits and escaped, all
};

/// Makes events. Immutable; an event depends on its own random stream only, so events can be made in any
/// order and by any thread.
class EventSource {
 public:
  virtual ~EventSource() = default;
  /// Number of events there are.
  virtual std::uint64_t events() const = 0;
  /// @param number  0 to events() - 1
  /// @param rng     the event's own stream
  virtual Event make(const scene::Scene& scene, std::uint64_t number, core::Rng& rng) const = 0;
};

/// Binds a specification to a built scene. Throws InputError with what does not fit: a region of no
/// volume, media of unknown composition, nothing that scintillates where the energy is put, hits that
/// are not hits.
/// @param notes  takes what a user should know, none of which stops a run: hits out of order or outside
///               every part
std::unique_ptr<EventSource> make_event_source(const scene_file::GammaSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes = nullptr);

}  // namespace scintray::source
