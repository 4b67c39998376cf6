#pragma once
/// [fit]: the parameters of a scene to fit, and the measurement (docs/fit.md).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/scene_file/sweep.hpp"

namespace scintray::scene_file {

/// Simulated quantity that is compared with the measured values.
enum class FitQuantity {
  detected_fraction,  ///< of the photons of a source of photons
  light_per_keV,      ///< of an event source
  reflectance,        ///< of one surface on the goniometer, against the incidence angle
};

inline constexpr core::Word<FitQuantity> kFitQuantities[] = {
    {"detected_fraction", FitQuantity::detected_fraction},
    {"light_per_keV", FitQuantity::light_per_keV},
    {"reflectance", FitQuantity::reflectance}};

/// Variable of a parameter in which a fit searches, and in which an error is symmetrical: the one in which
/// curves are more nearly linear. Light decreases in proportion to an absorption coefficient, the inverse of
/// a length, as long as little is absorbed.
enum class FitVariable { value, inverse };

inline constexpr core::Word<FitVariable> kFitVariables[] = {{"value", FitVariable::value},
                                                            {"inverse", FitVariable::inverse}};

/// [[fit.parameter]]. Values are in their unit in the file.
struct FitParameterSpec {
  KeyPath path;
  std::string label;  ///< heading; the key by default
  double start = 0.0, low = 0.0, high = 0.0;
  std::string unit;                           ///< as written; empty for plain numbers
  FitVariable variable = FitVariable::value;  ///< inverse by default for lengths of absorption and scattering
  core::FileLocation where;                   ///< of the start; place of errors in values

  /// Setting of the key to a value.
  KeySetting setting(double value) const;
};

/// [fit.goniometer]: the surface whose reflectance was measured.
struct FitGoniometerSpec {
  config::NameRef surface, inside, outside;
  double wavelength_nm = 0.0;
  bool from_inside = true;  ///< side of incidence
  std::uint64_t rays = 0;   ///< at each angle
};

struct FitSpec {
  std::filesystem::path measurement;  ///< it exists
  core::FileLocation measurement_where;
  FitQuantity quantity = FitQuantity::detected_fraction;
  KeyPath at;        ///< key set to the measured positions; empty for a reflectance
  std::string unit;  ///< of the measured positions
  bool free_scale = false;
  bool errors_from_scatter = false;
  std::optional<FitGoniometerSpec> goniometer;
  std::vector<FitParameterSpec> parameters;
  core::FileLocation where;

  /// Setting of the key `at` to a position.
  KeySetting position(double value, const core::FileLocation& row) const;
};

/// Name of a quantity in scene files: "detected_fraction", ...
const char* quantity_name(FitQuantity quantity);

/// [fit] of a scene, or nothing. Errors are added to the collector of the table.
std::optional<FitSpec> read_fit(const config::TomlTable& scene);

}  // namespace scintray::scene_file
