#pragma once
/// Reports of the benchmark as tables of text.

#include <string>

#include "figures.hpp"

namespace scintray::bench {

/// Ratio of medians, this over the baseline's; nothing where either is missing or 0.
std::optional<double> ratio_to_baseline(const std::optional<Spread>& now,
                                        const std::optional<Spread>& before);

/// Machine and settings in a few lines.
std::string text_of_machine(const Report& report);

/// The figures of all scenes as tables: speed, share of time by kind of work, building.
/// @param baseline  whose figures of the same scenes are compared: "(x 1.02)" behind a figure is that of this
///                  report over the baseline's; null: none
std::string text_of_figures(const Report& report, const Report* baseline);

/// What has to be known before figures of these reports are compared; empty without differences.
std::string text_of_differences(const Report& report, const Report& baseline);

}  // namespace scintray::bench
