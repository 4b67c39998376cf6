#pragma once
/// [analysis]: how the events of a run are looked at, as a scene file states it (docs/analysis.md).

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::scene_file {

/// Where depths are measured from, and along which unit vector.
struct DepthSpec {
  core::Vec3 origin = core::Vec3::Zero();  ///< mm
  core::Vec3 along = core::Vec3::UnitZ();
};

struct AnalysisSpec {
  std::optional<DepthSpec> depth;                  ///< nothing: no depths
  std::optional<std::array<double, 2>> photopeak;  ///< light between which the peak is looked for
  bool log_ratio = false;                          ///< depth of interaction by ln(A / B), else A / (A + B)
  bool linear_calibration = false;                 ///< of the ratio, else monotone
  std::size_t slices = 10;                         ///< of depth
  double anger_power = 1.0, anger_threshold = 0.0;
  std::optional<std::size_t> peaks;                  ///< of the flood map; nothing: as many as parts were hit
  std::vector<std::vector<config::NameRef>> layers;  ///< parts of each layer, patterns; empty: no layers
  config::NameRef
      reference;  ///< curve of a sweep whose first point counts as 1 in plots of light; empty: none
  bool photopeak_only = true;  ///< flood map, depth of interaction and timing use the photopeak's events
  core::FileLocation where;
};

/// How a scene's events are to be looked at; as AnalysisSpec has it where [analysis] or a key is not given.
/// Adds what is wrong to the collector of the table. The caller looks at what is unknown.
AnalysisSpec read_analysis(const config::TomlTable& scene);

/// The same of a file's text, of which only [analysis] is read. @throws InputError with all that is wrong
AnalysisSpec analysis_of_text(const std::string& text, const std::string& file);

}  // namespace scintray::scene_file
