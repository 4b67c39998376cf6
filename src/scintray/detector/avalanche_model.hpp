#pragma once
/// Sensor models: how the carriers in a sensor trigger avalanches.

#include <cstdint>
#include <memory>
#include <vector>

#include "scintray/core/function_ref.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/shared.hpp"
#include "scintray/detector/avalanche.hpp"

namespace scintray::detector {

/// A carrier that may trigger an avalanche: of a converted photon, of a dark count, or released by another
/// avalanche.
struct Carrier {
  double time_ns;
  std::uint32_t cell;  ///< AvalancheProcess::cell
  AvalancheCause cause;
};

/// Receives one avalanche: its time (ns), its charge as a share of a full one, and its cause. The spreads of
/// time and charge are not included: they are applied afterwards, in the same way for all models.
using AvalancheSink = core::FunctionRef<void(double time_ns, double charge, AvalancheCause cause)>;

/// The avalanche process in one sensor with one face. Immutable: one serves all threads and events.
class AvalancheProcess {
 public:
  virtual ~AvalancheProcess() = default;

  /// Time (ns) after which a carrier has no effect on others: dark counts are generated from this long before
  /// an event.
  virtual double memory_ns() const { return 0.0; }
  /// Number of the cell that holds a carrier, in the numbering of the model. Without a position of the
  /// arrival the cell is drawn.
  virtual std::uint32_t cell(const Arrival&, core::Rng&) const { return 0; }
  /// Avalanches of the carriers, and of the carriers that these release, up to a time (ns).
  /// @param carriers  of one event, photons before dark counts, each in any order; may be reordered
  virtual void fire(std::vector<Carrier>& carriers, double end_ns, core::Rng& rng,
                    const AvalancheSink& deliver) const = 0;
};

/// A sensor model with its parameters.
class AvalancheModel {
 public:
  virtual ~AvalancheModel() = default;
  /// The avalanche process of this model on a face. Throws InputError (without a place) when the model cannot
  /// be applied to the face.
  virtual std::unique_ptr<const AvalancheProcess> on(const SensorFace& face) const = 0;

 protected:
  AvalancheModel() = default;
  AvalancheModel(const AvalancheModel&) = default;
  AvalancheModel(AvalancheModel&&) = default;
  AvalancheModel& operator=(const AvalancheModel&) = default;
  AvalancheModel& operator=(AvalancheModel&&) = default;
};

/// Photomultipliers: every carrier triggers one full avalanche, independently of the others.
class ProportionalModel : public AvalancheModel {
 public:
  std::unique_ptr<const AvalancheProcess> on(const SensorFace& face) const override;
};

}  // namespace scintray::detector
