#pragma once
/// Events and their energy deposits, from which scintillation light is emitted.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/gamma_source.hpp"

namespace scintray::source {

/// The step of a particle along which energy was deposited.
struct ParticleStep {
  core::Vec3 displacement = core::Vec3::Zero();  ///< from the deposit's position to the step's end, mm
  double beta = 0.0, beta_end = 0.0;             ///< velocity over c at start and end; 0: not known
  double charge = 0.0;                           ///< elementary charges; 0: neutral, or not known
  optics::Particle particle = optics::Particle::electron;
  std::optional<double> kinetic_keV{};  ///< at the start
  /// Numbers of photons that another program sampled; nothing: sampled here.
  std::optional<std::uint64_t> scintillation{}, cherenkov{};
  double decay_ns = 0.0, rise_ns = 0.0;  ///< of the scintillation; decay 0: as of the medium
};

/// An energy deposit at one point, by one electron where the source resolves them, or along a step.
struct Deposit {
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  core::RegionId region = {};                ///< that contains the position
  double energy_keV = 0.0;
  double time_ns = 0.0;  ///< since the start of the event
  std::optional<ParticleStep> step{};
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
  /// True when deposits are steps of particles with their directions.
  virtual bool has_steps() const { return false; }
};

/// Event source of a specification in a built scene. Throws InputError with every contradiction: a region
/// without volume, media without composition, no scintillator where energy is deposited, invalid rows of
/// hits.
/// @param notes  receives warnings, none of which stops a run: hits out of order or outside every part
std::unique_ptr<EventSource> make_event_source(const scene_file::GammaSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes = nullptr);

}  // namespace scintray::source
