#pragma once
/// [[tally.axes]] and [[tally.where]]: the bins of a tally, and its conditions on numbers.

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/scene_file/tally_variable.hpp"

namespace scintray::scene_file {

struct TallyAxisSpec {
  TallyVariablePtr variable;              ///< never null
  core::Vec3 along = core::Vec3::Zero();  ///< unit; of a variable that is measured along a direction
  std::optional<double> low, high;        ///< in the variable's unit; nothing: the face's extent
  std::int64_t bins = 1;                  ///< of a number
  std::vector<config::NameRef> names;     ///< of a name, may have wildcards; nothing: all possible names
  bool across_face = false;               ///< `along` is the face's first or second direction
  int across = 0;                         ///< which of the two
  std::optional<double> pixel_mm;         ///< in place of bins
  core::FileLocation where;
};

/// A bound on a number: low <= x < high.
struct TallyRangeSpec {
  TallyVariablePtr variable;  ///< a number; never null
  core::Vec3 along = core::Vec3::Zero();
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  core::FileLocation where;
};

/// [[tally.axes]].
/// @param has_faces  true when the tally is bound to faces
TallyAxisSpec read_tally_axis(const config::TomlTable& table, const TallyVariables& variables,
                              bool has_faces);
/// [[tally.where]].
TallyRangeSpec read_tally_range(const config::TomlTable& table, const TallyVariables& variables);

/// Axis of equal bins of a number between its natural bounds.
TallyAxisSpec binned_axis(TallyVariablePtr variable, std::int64_t bins);
/// Axis of a name, with the given names; without any, with the default ones of its kind.
TallyAxisSpec named_axis(TallyVariablePtr variable, std::vector<config::NameRef> names = {});
/// The two axes of a grid over a face: `pixels = [n, m]` or `pixel = "0.5 mm"`.
/// @param fallback  pixels in each direction where the table has neither; nothing: one is required
std::vector<TallyAxisSpec> read_pixels(const config::TomlTable& table, const TallyVariables& variables,
                                       std::optional<std::int64_t> fallback);

}  // namespace scintray::scene_file
