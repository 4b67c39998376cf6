#pragma once
/// Power spectra of heights in definitions of surfaces.

#include <memory>
#include <optional>
#include <string>

#include "scintray/config/toml_reader.hpp"
#include "scintray/optics/height_spectrum.hpp"

namespace scintray::materials {

/// A spectrum, and the text of everything that it depends on.
struct HeightSpectrumSpec {
  std::shared_ptr<const optics::HeightSpectrum> spectrum;
  std::string key;
};

/// The keys `rms_height`, `knee_length` and `exponent` of a table; nothing when they were reported.
std::optional<HeightSpectrumSpec> read_k_correlation_spectrum(const config::TomlTable& table);

/// One of the tables `gaussian`, `k_correlation` and `spectrum`.
std::optional<HeightSpectrumSpec> read_height_spectrum(const config::TomlTable& table);

}  // namespace scintray::materials
