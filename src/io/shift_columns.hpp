#pragma once
/// The columns of what wavelength shifters did in a results file, for its writer and its reader.

#include "scintray/medium/wavelength_shifter.hpp"

namespace scintray::results_format {

/// Calls `visit(name, member)` for each column; `member` points to the field of ShiftCount that it holds.
template <typename Visit>
void for_each_shift_column(Visit&& visit) {
  visit("shifter_absorbed", &ShiftCount::absorbed);
  visit("shifter_emitted", &ShiftCount::emitted);
  visit("energy_before", &ShiftCount::before_eV);
  visit("energy_after", &ShiftCount::after_eV);
  visit("energy_kept", &ShiftCount::kept_eV);
}

}  // namespace scintray::results_format
