#pragma once
/// [fit]: which parameters of a scene are to be found from which measurement (docs/fit.md).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/scene_file/sweep.hpp"

namespace scintray::scene_file {

/// What of the simulation stands beside the measured values.
enum class FitQuantity {
  detected_fraction,  ///< of the photons of a source of photons
  light_per_keV,      ///< of a source of energy
  reflectance,        ///< of one surface on the goniometer, against the incidence angle
};

inline constexpr core::Word<FitQuantity> kFitQuantities[] = {
    {"detected_fraction", FitQuantity::detected_fraction},
    {"light_per_keV", FitQuantity::light_per_keV},
    {"reflectance", FitQuantity::reflectance}};

/// [[fit.parameter]]. Values are in the unit that the file gives them in.
struct FitParameterSpec {
  KeyPath path;
  std::string label;  ///< heading; the key when not given
  double start = 0.0, low = 0.0, high = 0.0;
  std::string unit;          ///< as written; empty for plain numbers
  core::FileLocation where;  ///< of the start, to which errors in values point

  /// The key with a value.
  KeySetting setting(double value) const;
};

/// [fit.goniometer]: the surface whose reflectance was measured.
struct FitGoniometerSpec {
  config::NameRef surface, inside, outside;
  double wavelength_nm = 0.0;
  bool from_inside = true;  ///< where the light comes from
  std::uint64_t rays = 0;   ///< at each angle
};

struct FitSpec {
  std::filesystem::path measurement;  ///< it exists
  core::FileLocation measurement_where;
  FitQuantity quantity = FitQuantity::detected_fraction;
  KeyPath at;        ///< the key that takes the measured positions; empty for a reflectance
  std::string unit;  ///< of the measured positions
  bool free_scale = false;
  bool errors_from_scatter = false;
  std::optional<FitGoniometerSpec> goniometer;
  std::vector<FitParameterSpec> parameters;
  core::FileLocation where;

  /// The key `at` with a position.
  KeySetting position(double value, const core::FileLocation& row) const;
};

/// "detected_fraction", ... as a scene file has it.
const char* quantity_name(FitQuantity quantity);

/// [fit] of a scene, or nothing. What is wrong is added to the collector of the table.
std::optional<FitSpec> read_fit(const config::TomlTable& scene);

}  // namespace scintray::scene_file
