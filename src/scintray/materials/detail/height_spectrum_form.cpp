#include "scintray/materials/detail/height_spectrum_form.hpp"

#include <fmt/format.h>

#include <vector>

#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/power_spectrum.hpp"
#include "scintray/materials/table_key.hpp"

namespace scintray::materials {

namespace {

constexpr double kNmPerMicrometre = 1e3;

/// A length that has no default, nm; 0 when it was reported.
double read_needed_nm(const config::TomlTable& table, const char* key) {
  if (!table.has(key)) {
    table.report(key, fmt::format("the spectrum has no \"{}\"", key), "write a length, as \"1 nm\"");
    return 0.0;
  }
  return kNmPerMicrometre * read_um(table, key, 0.0, false);
}

std::optional<HeightSpectrumSpec> read_gaussian_spectrum(const config::TomlTable& table) {
  const double rms_nm = read_needed_nm(table, "rms_height"),
               correlation_nm = read_needed_nm(table, "correlation_length");
  if (!table.good("rms_height") || !table.good("correlation_length")) return std::nullopt;
  return HeightSpectrumSpec{std::make_shared<optics::GaussianSpectrum>(rms_nm, correlation_nm),
                            fmt::format("gaussian {:a} {:a}", rms_nm, correlation_nm)};
}

std::optional<HeightSpectrumSpec> read_tabulated_spectrum(const config::TomlTable& table) {
  const std::filesystem::path file = table.existing_file("file");
  const std::string frequency = table.string("frequency_unit"), density = table.string("density_unit");
  if (file.empty() || frequency.empty() || density.empty()) return std::nullopt;
  try {
    topography::SpectrumRelief read = read_power_spectrum(file, frequency, density, table.where("file"));
    for (double& per_um : read.frequency_per_um) per_um /= kNmPerMicrometre;
    for (double& um4 : read.density_um4)
      um4 *= kNmPerMicrometre * kNmPerMicrometre * kNmPerMicrometre * kNmPerMicrometre;
    return HeightSpectrumSpec{std::make_shared<optics::TabulatedSpectrum>(std::move(read.frequency_per_um),
                                                                          std::move(read.density_um4)),
                              fmt::format("spectrum {} {} {}", file_key(file), frequency, density)};
  } catch (const core::InputError& error) {
    report_of_file(table, "file", error);
    return std::nullopt;
  }
}

using SpectrumReader = std::optional<HeightSpectrumSpec> (*)(const config::TomlTable&);

constexpr core::Word<SpectrumReader> kHeightSpectra[] = {{"gaussian", read_gaussian_spectrum},
                                                         {"k_correlation", read_k_correlation_spectrum},
                                                         {"spectrum", read_tabulated_spectrum}};

}  // namespace

std::optional<HeightSpectrumSpec> read_k_correlation_spectrum(const config::TomlTable& table) {
  const double rms_nm = read_needed_nm(table, "rms_height"), knee_nm = read_needed_nm(table, "knee_length");
  const double exponent = table.number("exponent");
  table.expect("exponent", exponent > 1.0, fmt::format("\"exponent\" is {:g}; expected above 1", exponent));
  if (!table.good("rms_height") || !table.good("knee_length") || !table.good("exponent")) return std::nullopt;
  return HeightSpectrumSpec{std::make_shared<optics::KCorrelationSpectrum>(rms_nm, knee_nm, exponent),
                            fmt::format("k_correlation {:a} {:a} {:a}", rms_nm, knee_nm, exponent)};
}

std::optional<HeightSpectrumSpec> read_height_spectrum(const config::TomlTable& table) {
  const core::Word<SpectrumReader>* form = table.one_of(kHeightSpectra, true);
  return form ? form->value(table.table(form->word)) : std::nullopt;
}

}  // namespace scintray::materials
