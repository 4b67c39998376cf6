#pragma once
/// What happened to a photon in one step: the language between the tracer and the tallies.

#include <cstdint>
#include <type_traits>

#include "scintray/core/ids.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/scene/scene.hpp"

namespace scintray::transport {

struct Step {
  core::StepEvent event = core::StepEvent::escaped;
  bool from_back = false;                       ///< at a boundary: came from the interface's back region
  std::uint32_t segments = 1;                   ///< straight segments: one more than total reflections passed
  std::uint32_t resolved = 0;                   ///< ray queries that the exact query resolved
  core::RegionId region;                        ///< in which the step was made
  core::InterfaceId interface;                  ///< at a boundary
  std::uint32_t triangle = scene::kNoTriangle;  ///< of the region's boundary; kNoTriangle: not at a boundary
  core::MediumId medium;                        ///< that absorbed it
  core::SurfaceId surface;                      ///< that absorbed it
  core::PartId sensor_part;                     ///< the sensor's that it reached, detected or not
  double cos_before = 0.0;                      ///< at a boundary: |cosine| to its normal, before
  double cos_after = 0.0;                       ///< ... and after
};
static_assert(std::is_trivially_copyable_v<Step>);

}  // namespace scintray::transport
