#pragma once
/// Which energy makes light.

#include "scintray/core/error.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// Throws InputError at `where` unless the medium of each region makes light of energy.
void require_scintillators(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                           const core::FileLocation& where);

/// True when energy left in the region makes light.
bool scintillates(const scene::Scene& scene, core::RegionId region);

/// Adds energy to an event: as a deposit where it makes light, else as non-scintillating. Nothing when it is
/// none.
void leave_energy(const scene::Scene& scene, const Deposit& deposit, Event& event);

}  // namespace scintray::source
