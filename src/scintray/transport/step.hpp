#pragma once
/// One step of one photon, and what happened in it: the language between the tracer and the tallies.

#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "scintray/core/function_ref.hpp"
#include "scintray/core/philox.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/source/photon_records.hpp"

namespace scintray::transport {

struct Step {
  core::StepEvent event = core::StepEvent::escaped;
  bool from_back = false;                       ///< at a boundary: came from the interface's back region
  std::uint32_t segments = 1;                   ///< straight segments: one more than total reflections passed
  std::uint32_t resolved = 0;                   ///< ray queries that the exact query resolved
  core::RegionId region = {};                   ///< in which the step was made
  core::InterfaceId interface = {};             ///< at a boundary
  std::uint32_t triangle = scene::kNoTriangle;  ///< of the region's boundary; kNoTriangle: not at a boundary
  core::MediumId medium = {};                   ///< that absorbed it
  core::SurfaceId surface = {};                 ///< that absorbed it
  core::PartId sensor_part = {};                ///< the sensor's that it reached, detected or not
  double cos_before = 0.0;                      ///< at a boundary: |cosine| to its normal, before
  double cos_after = 0.0;                       ///< ... and after
};
static_assert(std::is_trivially_copyable_v<Step>);

/// Sees a step and the photon after it.
using StepVisitor = core::FunctionRef<void(const source::Photon&, const Step&)>;

/// Propagation goes on through total reflections at smooth boundaries, which nothing but geometry decides, as
/// long as the photon is within these limits. By default it ends at the first.
struct PropagationLimits {
  std::uint64_t interactions = 0;  ///< boundary interactions of the photon
  double time_ns = std::numeric_limits<double>::infinity();
  /// Sees every reflection passed, as a step of its own, and changes nothing. May be empty.
  StepVisitor passed;

  bool allow(std::uint64_t photon_interactions, double photon_time_ns) const {
    return photon_interactions < interactions && photon_time_ns <= time_ns;
  }
  /// The fate of a photon that has reached the limits; nothing within them.
  std::optional<core::Fate> reached(const source::Photon& photon) const {
    if (allow(photon.interactions, photon.time_ns)) return std::nullopt;
    return photon.interactions >= interactions ? core::Fate::cut_interactions : core::Fate::cut_time;
  }
};

/// Moves the photon to its next event - bulk absorption, bulk scattering, or a boundary - and lets it
/// happen. Depends on nothing but its arguments.
/// @param records  side tables of the photon; null: nothing is recorded
Step step(const scene::Scene& scene, source::Photon& photon, core::Rng& rng,
          const PropagationLimits& limits = {}, source::PhotonRecords* records = nullptr);

}  // namespace scintray::transport
