#include "scintray/report/text/until_text.hpp"

#include <cmath>

#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

std::string condition_text(const tally::UntilCondition& condition, core::Fate fate) {
  const bool counts = condition.quantity == "photons" || condition.quantity == "events";
  const auto number = [&](double value) {
    if (!std::isfinite(value)) return std::string("not known");
    return counts ? grouped(static_cast<std::uint64_t>(value)) : compact(value, 3);
  };
  if (counts)
    return number(condition.reached) + " " + condition.quantity + ", goal " + number(condition.goal);
  if (condition.quantity == "wall_time")
    return "wall time " + number(condition.reached) + " s, of " + number(condition.goal) + " s";
  const std::string kind = condition.quantity == "relative_error" ? "relative" : "absolute";
  return kind + " error of the share " + core::fate_name(fate) + " " + number(condition.reached) + ", goal " +
         number(condition.goal);
}

}  // namespace

std::string until_sentence(const tally::PointResult& point) {
  if (!point.until) return "";
  const bool ended = point.until->ended();
  std::string text;
  for (const tally::UntilCondition& condition : point.until->conditions)
    if (condition.met || !ended)
      text += (text.empty() ? "" : "; ") + condition_text(condition, point.until->fate);
  if (!ended)
    return (point.complete ? "All that the source has was traced before a condition of until held: "
                           : "Interrupted before a condition of until held: ") +
           text + ".";
  return "Ended by until: " + text + "." +
         (point.until->is_reproducible()
              ? ""
              : " The clock decided: another run ends after another number of photons.");
}

}  // namespace scintray::report
