#pragma once
/// A photon's way through one region.

#include <cstdint>
#include <limits>
#include <optional>

#include "scintray/core/function_ref.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/source/photon.hpp"
#include "scintray/transport/step_record.hpp"

namespace scintray::transport {

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

enum class PropagationEnd {
  bulk,      ///< the photon is where its medium absorbs or scatters it
  escape,    ///< it leaves the scene
  boundary,  ///< it is at a boundary, which decides what happens
  total,     ///< it was totally reflected, and the limits are reached
};

/// How a propagation ended.
struct Propagation {
  PropagationEnd end = PropagationEnd::escape;
  std::uint32_t triangle = scene::kNoTriangle;  ///< at a boundary: of the region's accelerator
  double cosine = 0.0;                          ///< of incidence, at a smooth boundary
  std::uint32_t segments = 0;                   ///< straight segments
  std::uint32_t resolved = 0;                   ///< ray queries that the exact query resolved
};

/// Moves the photon through the region that it is in, up to the next event. Depends on nothing but its
/// arguments.
Propagation propagate(const scene::Scene& scene, source::Photon& photon, const PropagationLimits& limits);

/// Moves the photon straight on. Time advances with the group velocity.
inline void advance(source::Photon& photon, double distance_mm) {
  photon.position += distance_mm * photon.ray.direction;
  photon.path_mm += distance_mm;
  photon.time_ns += distance_mm * photon.optics.group_index * (1.0 / core::kSpeedOfLight_mm_per_ns);
}

/// What a total reflection at this boundary of the photon's region is as a step.
Step total_reflection(const scene::Scene& scene, const source::Photon& photon, std::uint32_t triangle,
                      double cosine);

}  // namespace scintray::transport
