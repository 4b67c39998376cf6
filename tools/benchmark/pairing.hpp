#pragma once
/// Two benchmark programs that trace the same photons in turns.

#include <functional>
#include <string>
#include <vector>

#include "measure.hpp"

namespace scintray::bench {

/// Comparison of two programs on one scene with one number of threads and one lane width.
struct PairedFigures {
  std::string scene;
  Turn turn;
  /// Speed of this program over that of the other for the same photons: processor time for one thread,
  /// elapsed time for more.
  Spread ratio;
  double segments_per_s = 0.0;  ///< of this program, median
  bool same_photons = true;     ///< both traced the same number of segments
  std::string trouble;          ///< why there are no figures; empty: there are
};

/// Compares this program with another one. Both are started anew for every scene, this one too, so that
/// neither has an advantage; each round measures both with each number of threads and each lane width, first
/// one, then the other, in an order that alternates.
/// @param self   path of this program
/// @param other  path of the other
/// @param done   receives the figures of each scene
/// @throws SystemError when a program cannot be started, or ends early
std::vector<PairedFigures> pair_programs(const std::string& self, const std::string& other,
                                         const std::vector<BenchScene>& scenes,
                                         const MeasureSettings& settings,
                                         const std::function<void(const PairedFigures&)>& done);

/// The figures of a pair from its traces, in the order of the rounds.
PairedFigures paired_figures(const std::string& scene, const Turn& turn, const std::vector<Trace>& mine,
                             const std::vector<Trace>& others);

/// A line of the table of pairs, and its headings.
std::string pair_headings();
std::string text_of_pair(const PairedFigures& pair);

/// Pairs in JSON.
std::string json_of_pairs(const std::string& other, const std::vector<PairedFigures>& pairs);

}  // namespace scintray::bench
