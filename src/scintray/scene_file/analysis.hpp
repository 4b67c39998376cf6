#pragma once
/// [analysis]: settings of the analysis of a run's events in a scene file (docs/analysis.md).

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::scene_file {

/// Origin and direction (unit vector) of depths.
struct DepthSpec {
  core::Vec3 origin = core::Vec3::Zero();  ///< mm
  core::Vec3 along = core::Vec3::UnitZ();
};

struct AnalysisSpec {
  std::optional<DepthSpec> depth;                  ///< nothing: no depths
  std::optional<std::array<double, 2>> photopeak;  ///< range of light in which the peak is searched
  bool log_ratio = false;                          ///< depth of interaction by ln(A / B), else A / (A + B)
  bool linear_calibration = false;                 ///< of the ratio, else monotone
  std::size_t slices = 10;                         ///< of depth
  double anger_power = 1.0, anger_threshold = 0.0;
  std::optional<std::size_t> peaks;  ///< of the flood map; nothing: the number of parts with deposits
  std::vector<std::vector<config::NameRef>> layers;  ///< patterns of each layer's parts; empty: no layers
  config::NameRef
      reference;  ///< curve of a sweep whose first point counts as 1 in plots of light; empty: none
  bool photopeak_only = true;  ///< flood map, depth of interaction and timing use the photopeak's events
  core::FileLocation where;
};

/// Analysis settings of a scene, with the defaults of AnalysisSpec where [analysis] or a key is absent. Adds
/// errors to the collector of the table. Unknown keys are reported by the caller.
AnalysisSpec read_analysis(const config::TomlTable& scene);

/// Analysis settings of a file's text, of which only [analysis] is read. @throws InputError with every error
AnalysisSpec analysis_of_text(const std::string& text, const std::string& file);

}  // namespace scintray::scene_file
