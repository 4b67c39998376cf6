#pragma once
/// Acceptance criteria of a scene, defined in its file and evaluated on its page (docs/analysis.md).

#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"

namespace scintray::scene_file {

/// Quantity derived from one or two curves of a sweep, or from a surface on the goniometer.
enum class CriterionQuantity {
  range,            ///< (largest - smallest) / mean of the light of a curve
  fall,             ///< 1 - last / first light of a curve
  fall_difference,  ///< fall of a curve minus that of another
  light,            ///< light per event at the first point of a curve
  maximum_ratio,    ///< largest light of a curve over that of another
  resolution,       ///< of the photopeak at the first point of a curve, full width at half maximum
  time_ratio,       ///< time per photon of a curve over that of another
  mean_slope,       ///< mean visible slope: mean angle of the facets that light hits first, rad
  reflectance,
  over_fresnel,  ///< reflectance minus Fresnel's of a flat face
  lobe_width,    ///< rms width of the reflected light, in the plane of incidence, as the angle of that sine,
                 ///< rad
};
inline constexpr core::Word<CriterionQuantity> kCriterionQuantities[] = {
    {"range", CriterionQuantity::range},
    {"fall", CriterionQuantity::fall},
    {"fall_difference", CriterionQuantity::fall_difference},
    {"light", CriterionQuantity::light},
    {"maximum_ratio", CriterionQuantity::maximum_ratio},
    {"resolution", CriterionQuantity::resolution},
    {"time_ratio", CriterionQuantity::time_ratio},
    {"mean_slope", CriterionQuantity::mean_slope},
    {"reflectance", CriterionQuantity::reflectance},
    {"over_fresnel", CriterionQuantity::over_fresnel},
    {"lobe_width", CriterionQuantity::lobe_width}};
/// True for a quantity of a surface of a [[bench]], not of curves.
bool is_of_surface(CriterionQuantity quantity);
/// True for a quantity that is an angle.
bool is_angle(CriterionQuantity quantity);

struct CriterionSpec {
  std::string text;       ///< the criterion as text
  std::string published;  ///< the published value, as text
  std::string note;       ///< reason for a deviation of the simulation
  CriterionQuantity quantity = CriterionQuantity::light;
  config::NameRef curve,
      over;  ///< labels of curves: values of all keys but the last swept number, "2 mm, polished"
  config::NameRef surface, outside;         ///< of a [[bench]]
  double incidence_rad = 0.0;               ///< one of the goniometer's angles
  std::optional<double> at_least, at_most;  ///< limits of acceptance, both inclusive; rad for an angle
  core::FileLocation where;
};

/// Acceptance criteria: [[claim]] of a scene. Adds errors to the collector of the table.
std::vector<CriterionSpec> read_criteria(const config::TomlTable& scene);

/// Acceptance criteria of a file's text, of which nothing else is read. @throws InputError with every error
std::vector<CriterionSpec> criteria_of_text(const std::string& text, const std::string& file);

}  // namespace scintray::scene_file
