#pragma once
/// Text on the effects that the figures of a result do not include.

#include <optional>
#include <string>
#include <vector>

#include "scintray/tally/result.hpp"

namespace scintray::report {

/// Figures for which the effects that they do not include are listed.
enum class Figure { resolution, timing, fraction };

/// "energy resolution", "CTR", "detected fraction".
const char* figure_name(Figure figure);

/// Omitted effects of several points, each once; one that some points include is marked so. Nothing when a
/// point has no record of them.
std::optional<std::vector<tally::OmittedEffect>> omitted_anywhere(
    const std::vector<std::optional<std::vector<tally::OmittedEffect>>>& points);
std::optional<std::vector<tally::OmittedEffect>> omitted_anywhere(const tally::RunResult& run);

/// "The energy resolution does not include: intrinsic resolution (LSO), electronic noise." States where
/// every modelled effect is included, or where the result has no record.
std::string omission_sentence(const std::optional<std::vector<tally::OmittedEffect>>& effects, Figure figure);

/// The sentence as a paragraph of a page, with the keys of a scene that include the effects in a collapsed
/// list.
std::string omission_note(const std::optional<std::vector<tally::OmittedEffect>>& effects, Figure figure);

}  // namespace scintray::report
