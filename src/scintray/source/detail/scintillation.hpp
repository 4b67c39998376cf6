#pragma once
/// Distinction of energy deposits in scintillators from non-scintillating energy.

#include "scintray/core/error.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// Throws InputError at `where` unless the medium of each region scintillates.
void require_scintillators(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                           const core::FileLocation& where);

/// True when the medium of the region scintillates.
bool scintillates(const scene::Scene& scene, core::RegionId region);

/// True when the light of a deposit in this medium depends on which electrons deposit the energy: for
/// Cherenkov light, or a response that is not proportional; and when the medium's composition is known.
bool depends_on_electrons(const optics::Medium& medium, bool cherenkov);

/// Adds energy to an event: as a deposit in a scintillator, else as non-scintillating energy. Zero energy is
/// not added.
void leave_energy(const scene::Scene& scene, const Deposit& deposit, Event& event);

}  // namespace scintray::source
