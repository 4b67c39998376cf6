#pragma once
/// One step of one photon and its event: the interface between transport and tallies.

#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "scintray/core/function_ref.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/source/photon_records.hpp"

namespace scintray::transport {

struct Step {
  core::StepEvent event = core::StepEvent::escaped;
  bool from_back = false;                       ///< at a boundary: incident from the interface's back region
  std::uint32_t segments = 1;                   ///< straight segments: one more than total reflections passed
  std::uint32_t resolved = 0;                   ///< ray queries resolved by the exact query
  core::RegionId region = {};                   ///< in which the step was made
  core::InterfaceId interface = {};             ///< at a boundary
  std::uint32_t triangle = scene::kNoTriangle;  ///< of the region's boundary; kNoTriangle: not at a boundary
  core::MediumId medium = {};                   ///< that absorbed it
  core::SurfaceId surface = {};                 ///< that absorbed it
  core::PartId sensor_part = {};                ///< of the sensor that the photon reached, detected or not
  double cos_before = 0.0;  ///< at a boundary: |cosine| to its normal before the interaction
  double cos_after = 0.0;   ///< and after it
};
static_assert(std::is_trivially_copyable_v<Step>);

/// Receives a step and the photon after it.
using StepVisitor = core::FunctionRef<void(const source::Photon&, const Step&)>;

/// Limits of a photon's propagation. Within them propagation continues through total reflections at smooth
/// boundaries, which depend on geometry alone. By default it ends at the first.
struct PropagationLimits {
  std::uint64_t interactions = 0;  ///< boundary interactions of the photon
  double time_ns = std::numeric_limits<double>::infinity();
  /// Receives every total reflection passed, as a step of its own, without any effect on the propagation. May
  /// be empty.
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

/// One step of the photon: propagation to its next event (bulk absorption, bulk scattering, or interaction
/// with a boundary) and the event itself. Depends on its arguments alone.
/// @param records  side tables of the photon; null: nothing is recorded
Step step(const scene::Scene& scene, source::Photon& photon, core::Rng& rng,
          const PropagationLimits& limits = {}, source::PhotonRecords* records = nullptr);

/// The interaction of a photon that is on a triangle of its region's boundary and heads out of the region.
/// The photon may also be in an opaque region, whose light starts at its boundary; photon.optics then has the
/// index with which it arrives.
/// @param triangle  of the region's boundary, on which photon.position lies
Step interact_at(const scene::Scene& scene, std::uint32_t triangle, source::Photon& photon, core::Rng& rng);

}  // namespace scintray::transport
