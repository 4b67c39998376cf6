#pragma once
/// How the carriers in a sensor fire avalanches: the sensor models.

#include <cstdint>
#include <memory>
#include <vector>

#include "scintray/core/function_ref.hpp"
#include "scintray/core/philox.hpp"
#include "scintray/core/shared.hpp"
#include "scintray/detector/avalanche.hpp"

namespace scintray::detector {

/// What may fire an avalanche: a converted photon, a dark count, or what another avalanche released.
struct Carrier {
  double time_ns;
  std::uint32_t cell;  ///< AvalancheProcess::cell
  AvalancheCause cause;
};

/// Takes one avalanche: its time (ns), its charge as a share of a full one, and its cause. The spreads of
/// both are not in it: they come after, the same for all models.
using AvalancheSink = core::FunctionRef<void(double time_ns, double charge, AvalancheCause cause)>;

/// The carriers of one sensor with one face. Immutable, so one serves all threads and events.
class AvalancheProcess {
 public:
  virtual ~AvalancheProcess() = default;

  /// Time (ns) after which a carrier has no effect on others: so long before an event dark counts begin.
  virtual double memory_ns() const { return 0.0; }
  /// The cell that a carrier is in, numbered as the model likes. Where the place of the arrival is not known
  /// it is drawn.
  virtual std::uint32_t cell(const Arrival&, core::Rng&) const { return 0; }
  /// Lets carriers fire, and what they release, up to a time.
  /// @param carriers  of one event, photons before dark counts, each in any order; may be reordered
  virtual void fire(std::vector<Carrier>& carriers, double end_ns, core::Rng& rng,
                    const AvalancheSink& deliver) const = 0;
};

/// A sensor model with its numbers.
class AvalancheModel {
 public:
  virtual ~AvalancheModel() = default;
  /// The same on a face. Throws InputError (without a place) when the face does not suit it.
  virtual std::unique_ptr<const AvalancheProcess> on(const SensorFace& face) const = 0;

 protected:
  AvalancheModel() = default;
  AvalancheModel(const AvalancheModel&) = default;
  AvalancheModel(AvalancheModel&&) = default;
  AvalancheModel& operator=(const AvalancheModel&) = default;
  AvalancheModel& operator=(AvalancheModel&&) = default;
};

/// Photomultipliers: every carrier gives one full avalanche, whatever the others do.
class ProportionalModel : public AvalancheModel {
 public:
  std::unique_ptr<const AvalancheProcess> on(const SensorFace& face) const override;
};

}  // namespace scintray::detector
