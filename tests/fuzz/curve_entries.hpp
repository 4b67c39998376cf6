#pragma once
/// Entries for tables of numbers in CSV files: curves of media, measurements for fits, profiles of
/// goniometers, responses over a sensor's face, power spectra, measured BRDFs; and for other text that a
/// command reads.

#include "entries.hpp"

namespace scintray::fuzz {

std::span<const Entry> curve_entries();

}  // namespace scintray::fuzz
