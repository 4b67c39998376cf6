#pragma once
/// A fit of a scene to a measurement, with the content of its file and its page. Plain data.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/fit/curve_fit.hpp"
#include "scintray/analysis/fit/measured_curve.hpp"
#include "scintray/scene_file/fit.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::analysis {

struct FitRecord {
  std::string title, version, scene_file, scene_text;
  scene_file::FitSpec spec;  ///< its parameters are in step with the fit's
  MeasuredCurve measured;
  CurveFit fit;
  std::uint64_t seed = 0;
  std::uint64_t traced = 0;  ///< photons, events or rays at each point of each curve
  std::string thing;         ///< their kind: "photons", "events", "rays"
  double wall_seconds = 0.0;
  std::vector<std::string> notes;  ///< warnings of the scene
  /// PointResult::omitted at the start of the search; nothing for a reflectance.
  std::optional<std::vector<tally::OmittedEffect>> omitted = {};
};

/// Name of the measured quantity, for headings: "detected fraction", "light per keV", "reflectance".
inline const char* quantity_words(scene_file::FitQuantity quantity) {
  return quantity == scene_file::FitQuantity::detected_fraction ? "detected fraction"
         : quantity == scene_file::FitQuantity::light_per_keV   ? "light per keV"
                                                                : "reflectance";
}

}  // namespace scintray::analysis
