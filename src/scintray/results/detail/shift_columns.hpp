#pragma once
/// The columns of what wavelength shifters did in a results file, for its writer and its reader.

#include "scintray/optics/wavelength_shifter.hpp"

namespace scintray::results::format {

/// Calls `visit(name, member)` for each column; `member` points to the field of ShiftCount that it holds.
template <typename Visit>
void for_each_shift_column(Visit&& visit) {
  visit("shifter_absorbed", &optics::ShiftCount::absorbed);
  visit("shifter_emitted", &optics::ShiftCount::emitted);
  visit("energy_before", &optics::ShiftCount::before_eV);
  visit("energy_after", &optics::ShiftCount::after_eV);
  visit("energy_kept", &optics::ShiftCount::kept_eV);
}

}  // namespace scintray::results::format
