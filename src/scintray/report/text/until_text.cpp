#include "scintray/report/text/until_text.hpp"

#include <cmath>

#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

std::string condition_text(const tally::UntilCondition& condition, const tally::UntilResult& until) {
  const bool counts = condition.quantity == "photons" || condition.quantity == "events";
  const auto number = [&](double value) {
    if (!std::isfinite(value)) return std::string("not known");
    return counts ? grouped(static_cast<std::uint64_t>(value)) : compact(value, 3);
  };
  if (counts)
    return number(condition.reached) + " " + condition.quantity + ", goal " + number(condition.goal);
  if (condition.quantity == "wall_time")
    return "wall time " + number(condition.reached) + " s, of " + number(condition.goal) + " s";
  const bool relative = condition.quantity == "relative_error";
  const std::string of = until.of.empty() ? std::string("share ") + core::fate_name(until.fate) : until.of;
  const std::string unit = relative || until.unit == "1" ? "" : " " + until.unit;
  return std::string(relative ? "relative" : "absolute") + " error of the " + of + " " +
         number(condition.reached) + unit + ", goal " + number(condition.goal) + unit;
}

}  // namespace

std::string until_sentence(const tally::PointResult& point) {
  if (!point.until) return "";
  const bool ended = point.until->ended();
  std::string text;
  for (const tally::UntilCondition& condition : point.until->conditions)
    if (condition.met || !ended) text += (text.empty() ? "" : "; ") + condition_text(condition, *point.until);
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
