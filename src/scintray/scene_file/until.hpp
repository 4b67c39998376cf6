#pragma once
/// [run] until: conditions that end a run before all photons or events of its source are traced.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/core/words.hpp"

namespace scintray::scene_file {

/// The result whose error ends a point.
enum class UntilGoal {
  fate,               ///< share of the emitted photons with a fate
  tally,              ///< a bin of a tally, per emitted photon
  photopeak,          ///< position of the photopeak
  energy_resolution,  ///< its FWHM over its position
  light_per_energy,   ///< light of the events over the energy deposited in scintillators
  ctr,                ///< coincidence time resolution, FWHM
};

inline constexpr core::Word<UntilGoal> kUntilGoals[] = {{"fate", UntilGoal::fate},
                                                        {"tally", UntilGoal::tally},
                                                        {"photopeak", UntilGoal::photopeak},
                                                        {"energy_resolution", UntilGoal::energy_resolution},
                                                        {"light_per_energy", UntilGoal::light_per_energy},
                                                        {"ctr", UntilGoal::ctr}};

/// True for a result of the analysis of events.
inline bool is_of_events(UntilGoal goal) { return goal != UntilGoal::fate && goal != UntilGoal::tally; }

/// Conditions, of which the first that holds ends a point. One at least is stated.
struct UntilSpec {
  UntilGoal of = UntilGoal::fate;          ///< the result whose error is required
  core::Fate fate = core::Fate::detected;  ///< of UntilGoal::fate
  config::NameRef tally;                   ///< of UntilGoal::tally: its name
  std::vector<std::string> bin;  ///< an entry per axis of the tally: a name, or a value within the bin
  std::optional<double> relative_error;  ///< standard error of the result over the result
  std::optional<double> absolute_error;  ///< standard error of the result, in its internal unit
  std::optional<double> wall_time_s;     ///< of the whole run
  std::optional<std::uint64_t> photons;  ///< emitted, of a point
  std::optional<std::uint64_t> events;   ///< of a point of an event source
  core::FileLocation where;
};

/// The conditions in [run]; nothing without `until`. Adds errors to the collector of the table.
std::optional<UntilSpec> read_until(const config::TomlTable& run);

}  // namespace scintray::scene_file
