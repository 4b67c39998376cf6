#include "scintray/materials/power_spectrum.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scintray/config/csv.hpp"
#include "scintray/core/units.hpp"

namespace scintray::materials {

namespace {

/// Factor from the unit of the densities to um^4.
double density_factor(const std::string& unit, const core::FileLocation& where) {
  std::string length = unit.ends_with("^4")  ? unit.substr(0, unit.size() - 2)
                       : unit.ends_with("4") ? unit.substr(0, unit.size() - 1)
                                             : "";
  const core::InputError wrong(
      {where,
       "unit of the power spectral density is \"" + unit +
           "\"; expected a length to the fourth power, as \"um4\" or \"nm4\"",
       "a density over one spatial frequency only, as um3, is that of profiles: convert it"});
  try {
    return std::pow(core::unit_factor(length, core::Dimension::length) * 1e3, 4);
  } catch (const core::InputError&) {
    throw wrong;
  }
}

double frequency_factor(const std::string& unit, const core::FileLocation& where) {
  try {
    return core::unit_factor(unit, core::Dimension::inverse_length) * 1e-3;
  } catch (const core::InputError&) {
    throw core::InputError(
        {where, "unit of the spatial frequency is \"" + unit + "\"; expected an inverse length, as \"1/um\"",
         ""});
  }
}

}  // namespace

topography::SpectrumRelief read_power_spectrum(const std::filesystem::path& path,
                                               const std::string& frequency_unit,
                                               const std::string& density_unit,
                                               const core::FileLocation& where) {
  const double per_um = frequency_factor(frequency_unit, where), um4 = density_factor(density_unit, where);
  const config::CsvTable table = config::read_csv(path);
  core::Problems problems;
  if (table.rows.front().values.size() < 2) {
    problems.add({table.file, table.rows.front().line},
                 "a single column; expected spatial frequency and power spectral density");
    problems.throw_if_any();
  }
  if (table.rows.size() < 2)
    problems.add({table.file, table.rows.front().line}, "a spectrum of one row; expected at least two");
  topography::SpectrumRelief spectrum;
  double before = 0.0;
  for (const config::CsvTable::Row& row : table.rows) {
    const double frequency = row.values[0], density = row.values[1];
    if (!(frequency > before) || !std::isfinite(frequency))
      problems.add({table.file, row.line},
                   fmt::format("spatial frequency {} after {}; expected positive, increasing frequencies",
                               frequency, before),
                   "sort the rows, and leave out the frequency 0");
    if (!(density >= 0.0) || !std::isfinite(density))
      problems.add({table.file, row.line},
                   fmt::format("power spectral density {}; expected 0 or more", density));
    before = frequency;
    spectrum.frequency_per_um.push_back(frequency * per_um);
    spectrum.density_um4.push_back(density * um4);
  }
  problems.throw_if_any();
  return spectrum;
}

}  // namespace scintray::materials
