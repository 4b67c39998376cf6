#pragma once
/// What happened to a photon in one step: the language between the tracer and the tallies.

#include <cstdint>

#include "scintray/scene/scene.hpp"

namespace scintray {

enum class StepKind : std::uint8_t {
  scattered,  ///< in the bulk
  shifted,    ///< in the bulk, absorbed and given back at another wavelength
  returned,   ///< stayed in its region at a boundary
  crossed,    ///< went into the neighbouring region
  // Ends:
  detected,
  unconverted,
  absorbed_in_medium,
  absorbed_at_surface,
  escaped,
};

inline bool is_end(StepKind kind) { return kind >= StepKind::detected; }

struct Step {
  StepKind kind = StepKind::escaped;
  bool from_back = false;                ///< at a boundary: came from the interface's back region
  std::uint32_t segments = 1;            ///< straight pieces: one more than total reflections passed
  std::uint32_t resolved = 0;            ///< ray queries that the exact search settled
  std::uint32_t region = 0;              ///< in which the step was made
  std::uint32_t interface = 0;           ///< at a boundary
  std::uint32_t triangle = kNoTriangle;  ///< of the region's boundary; kNoTriangle: not at a boundary
  std::uint32_t where = 0;  ///< absorbed: medium or surface; detected, unconverted: sensor's part
  double cos_before = 0.0;  ///< at a boundary: |cosine| to its normal, before
  double cos_after = 0.0;   ///< ... and after
};

}  // namespace scintray
