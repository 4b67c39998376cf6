#include "scintray/io/reweigh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "scintray/analysis/ratio.hpp"
#include "scintray/core/error.hpp"
#include "scintray/io/results.hpp"

namespace scintray {

namespace {

constexpr std::size_t kMostChoices = 10'000;
constexpr std::uint64_t kRowsAtOnce = 65'536;

InputError refused(const std::filesystem::path& path, const std::string& what, const std::string& hint) {
  return InputError({{path.string()}, what, hint});
}

/// The columns that a scan changes.
class Targets {
 public:
  Targets(const std::filesystem::path& path, const RunResult& run, const HistoryColumns& columns)
      : path_(path), run_(run), columns_(columns) {}

  std::vector<std::size_t> of(const PropertyScan& scan) const {
    return scan.property == OpticalProperty::absorption_length ? medium(scan.name) : reflectors(scan.name);
  }

 private:
  std::vector<std::size_t> medium(const std::string& name) const {
    if (const auto& gaps = columns_.gap_media; std::find(gaps.begin(), gaps.end(), name) != gaps.end())
      throw refused(path_,
                    "the medium \"" + name +
                        "\" also fills the gap of a surface, where paths of photons are not recorded",
                    "run the scene again with the other absorption length");
    const auto known = std::find(columns_.media.begin(), columns_.media.end(), name);
    if (known == columns_.media.end())
      throw unknown_name({path_.string()}, "medium that light was in", name, columns_.media);
    return {static_cast<std::size_t>(known - columns_.media.begin())};
  }

  std::vector<std::size_t> reflectors(const std::string& name) const {
    std::vector<std::size_t> found;
    std::set<std::string> names;
    for (std::size_t i = 0; i < columns_.reflectors.size(); ++i) {
      const ReflectorSite& site = columns_.reflectors[i];
      if (site.reflector == name || site.stack == name || site.surface == name) found.push_back(i);
      names.insert({site.reflector, site.stack, site.surface});
    }
    if (!found.empty()) return found;
    for (const std::string& surface : run_.header.surfaces)
      if (surface == name || surface.starts_with(name + " ("))
        throw refused(path_,
                      "the surface \"" + name +
                          "\" has no reflectance of its own: it has no reflector, or is a table that holds one",
                      names.empty() ? "no surface of this result has a reflector"
                                    : "reflectors of this result: " +
                                          fmt::format("{}", fmt::join(names, ", ")));
    throw unknown_name({path_.string()}, "reflector", name, {names.begin(), names.end()});
  }

  const std::filesystem::path& path_;
  const RunResult& run_;
  const HistoryColumns& columns_;
};

std::string site_text(const ReflectorSite& site) {
  return site.reflector == site.stack ? "\"" + site.stack + "\""
                                      : "\"" + site.reflector + "\" of \"" + site.stack + "\"";
}

void check_values(const std::filesystem::path& path, const PropertyScan& scan) {
  const auto refuse = [&](double value, const std::string& expected) {
    throw refused(path, describe(scan) + " cannot be " + describe_value(scan, value), expected);
  };
  if (scan.values.empty())
    throw refused(path, describe(scan) + " has no value", "give one value or several");
  for (const double value : scan.values) {
    if (scan.times) {
      if (!(value > 0.0 && std::isfinite(value))) refuse(value, "a factor is above 0");
    } else if (scan.property == OpticalProperty::absorption_length) {
      if (!(value > 0.0)) refuse(value, "an absorption length is above 0");
    } else if (!(value >= 0.0 && value <= 1.0)) {
      refuse(value, "a reflectance is from 0 to 1");
    }
  }
}

WantedProperty wanted(const PropertyScan& scan, double value) {
  const auto as = scan.times ? WantedProperty::As::times : WantedProperty::As::constant;
  return {as, scan.property == OpticalProperty::absorption_length ? 1.0 / value : value};
}

/// What is traced where a point has no such medium or reflector: none of its photons knows it.
std::vector<TracedRange> known_ranges(std::vector<TracedRange> ranges, double otherwise) {
  for (TracedRange& range : ranges)
    if (std::isnan(range.least) || std::isnan(range.most)) range = {otherwise, otherwise};
  return ranges;
}

/// All combinations of values, the last scan's fastest.
std::vector<std::vector<double>> combinations(const std::filesystem::path& path,
                                              const std::vector<PropertyScan>& scans) {
  std::vector<std::vector<double>> all{{}};
  for (const PropertyScan& scan : scans) {
    if (all.size() * scan.values.size() > kMostChoices)
      throw refused(path, fmt::format("more than {} combinations of values", kMostChoices),
                    "give fewer values at once");
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& values : all)
      for (const double value : scan.values) {
        longer.push_back(values);
        longer.back().push_back(value);
      }
    all = std::move(longer);
  }
  return all;
}

/// Photons that events emitted, of one point; empty for a source of photons.
std::map<std::uint64_t, double> emitted_by_event(const std::filesystem::path& path, std::size_t point,
                                                 std::uint64_t listed) {
  std::map<std::uint64_t, double> emitted;
  for (std::uint64_t row = 0; row < listed; row += kRowsAtOnce)
    for (const EventRecord& event : read_events(path, row, kRowsAtOnce, EventDetail::numbers))
      if (event.point == point) emitted[event.event] = static_cast<double>(event.emitted);
  return emitted;
}

/// The sum of weights of the event under way, and sums over the events before.
struct EventSums {
  double weight = 0.0;
  Moments light;           ///< of events with detected photons
  RatioOfSums of_emitted;  ///< light over emitted photons, all events that emitted any
  RatioOfSums of_traced;   ///< light over detected photons as traced
};

/// One point under all choices of values, photon by photon.
class PointReweighting {
 public:
  PointReweighting(const PointResult& point, std::vector<Reweighting> choices,
                   std::map<std::uint64_t, double> emitted)
      : point_(point), choices_(std::move(choices)), sums_(choices_.size()), emitted_(std::move(emitted)) {}

  void add(std::uint64_t event, const PhotonHistory& photon) {
    if (energy() && under_way_ && event != event_) end_event();
    event_ = event;
    under_way_ = true;
    ++detected_;
    for (std::size_t i = 0; i < choices_.size(); ++i) sums_[i].weight += choices_[i].add(photon);
  }

  std::vector<ReweighedPoint> finish(std::size_t number, const std::vector<std::vector<double>>& values) {
    if (energy()) end_events();
    std::vector<ReweighedPoint> results;
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      ReweighedPoint result;
      result.point = number;
      result.values = values[i];
      result.traced_fraction = point_.fraction(Fate::detected);
      result.light = choices_[i].finish(std::max<std::uint64_t>(1, point_.photons), point_.cut_bias_bound());
      if (energy()) add_events(sums_[i], result);
      results.push_back(std::move(result));
    }
    return results;
  }

 private:
  bool energy() const { return point_.energy.events_requested > 0; }

  void end_event() {
    const auto known = emitted_.find(event_);
    for (EventSums& sums : sums_) {
      sums.light.add(sums.weight);
      sums.of_emitted.add(known == emitted_.end() ? 0.0 : known->second, sums.weight);
      sums.of_traced.add(detected_, sums.weight);
      sums.weight = 0.0;
    }
    traced_.add(known == emitted_.end() ? 0.0 : known->second, detected_);
    if (known != emitted_.end()) emitted_.erase(known);
    detected_ = 0.0;
  }

  void end_events() {
    if (under_way_) end_event();
    for (const auto& [event, emitted] : emitted_) {  // that no sensor saw
      if (emitted == 0.0) continue;
      traced_.add(emitted, 0.0);
      for (EventSums& sums : sums_) sums.of_emitted.add(emitted, 0.0);
    }
  }

  void add_events(const EventSums& sums, ReweighedPoint& result) const {
    result.traced_fraction = traced_.ratio();
    result.light.detected_fraction = sums.of_emitted.ratio();
    result.light.relative = sums.of_traced.ratio();
    result.traced_per_event = point_.energy.detected.mean();
    Moments light = sums.light;
    light.count = std::max(light.count, point_.energy.detected.count);  // the others gave no light
    result.per_event = light.mean();
  }

  const PointResult& point_;
  std::vector<Reweighting> choices_;
  std::vector<EventSums> sums_;
  std::map<std::uint64_t, double> emitted_;
  RatioOfSums traced_;
  std::uint64_t event_ = 0;
  bool under_way_ = false;
  double detected_ = 0.0;
};

}  // namespace

std::string describe(const PropertyScan& scan) {
  return (scan.property == OpticalProperty::reflectance ? "reflectance of " : "absorption length of ") +
         scan.name;
}

std::string describe_value(const PropertyScan& scan, double value) {
  if (scan.times) return fmt::format("x {:.6g}", value);
  if (scan.property == OpticalProperty::reflectance) return fmt::format("{:.6g}", value);
  return std::isinf(value) ? "none" : fmt::format("{:.6g} mm", value);
}

namespace {

/// Everything about the scans that does not depend on the point.
struct Plan {
  Plan(const std::filesystem::path& path, const RunResult& run, const HistoryColumns& columns,
       const std::vector<PropertyScan>& scans)
      : path(path), scans(scans), columns(columns) {
    if (scans.empty())
      throw refused(path, "nothing is wanted otherwise than it was traced",
                    "give an absorption length or a reflectance");
    const Targets find(path, run, columns);
    std::map<std::pair<OpticalProperty, std::size_t>, std::string> taken;
    for (const PropertyScan& scan : scans) {
      check_values(path, scan);
      targets.push_back(find.of(scan));
      for (const std::size_t target : targets.back()) {
        const auto [other, is_new] = taken.try_emplace({scan.property, target}, scan.name);
        if (!is_new)
          throw refused(path,
                        fmt::format("\"{}\" and \"{}\" ask for the {} of the same thing", other->second,
                                    scan.name,
                                    scan.property == OpticalProperty::reflectance ? "reflectance"
                                                                                  : "absorption length"),
                        "give each once; several values as \"NAME=1,2,3 mm\"");
      }
    }
    values = combinations(path, scans);
    for (const ReflectorSite& site : columns.reflectors) reflector_names.push_back(site_text(site));
  }

  /// One choice of values at one point.
  OpticalChange change(const TracedOptics& traced, const std::vector<double>& chosen) const {
    OpticalChange change;
    change.traced_absorption_per_mm = known_ranges(traced.absorption_per_mm, 0.0);
    change.traced_reflectance = known_ranges(traced.reflectance, 1.0);
    change.absorption_per_mm.resize(change.traced_absorption_per_mm.size());
    change.reflectance.resize(change.traced_reflectance.size());
    change.reflector_names = reflector_names;
    for (std::size_t i = 0; i < scans.size(); ++i)
      for (const std::size_t target : targets[i]) {
        const WantedProperty property = wanted(scans[i], chosen[i]);
        if (scans[i].property == OpticalProperty::absorption_length) {
          change.absorption_per_mm[target] = property;
          continue;
        }
        const double most = traced.reflectance[target].most;  // not a number: not in this point
        if (scans[i].times && most * chosen[i] > 1.0)
          throw refused(path,
                        fmt::format("a reflectance of {:.6g} times {:.6g} is above 1, of {}", most, chosen[i],
                                    reflector_names[target]),
                        fmt::format("give factors up to {:.6g}", 1.0 / most));
        if (!std::isnan(most)) change.reflectance[target] = property;
      }
    return change;
  }

  const std::filesystem::path& path;
  const std::vector<PropertyScan>& scans;
  const HistoryColumns& columns;
  std::vector<std::vector<std::size_t>> targets;  ///< per scan
  std::vector<std::vector<double>> values;        ///< per choice
  std::vector<std::string> reflector_names;
};

/// Row `row` of a block.
PhotonHistory history_at(const PhotonHistories& rows, std::size_t row, const HistoryColumns& columns) {
  const auto part = [&](const auto& column, std::size_t width) {
    return std::span(column).subspan(row * width, width);
  };
  return {part(rows.path_mm, columns.media.size()), part(rows.absorption_depth, columns.media.size()),
          part(rows.reflections, columns.reflectors.size()),
          part(rows.reflection_depth, columns.reflectors.size())};
}

}  // namespace

std::vector<ReweighedPoint> reweigh_results(const std::filesystem::path& path, const RunResult& run,
                                            const std::vector<PropertyScan>& scans) {
  const HistoryReader histories(path);
  const Plan plan(path, run, histories.columns(), scans);
  const std::uint64_t listed_events = read_results_status(path).listed_events;
  std::vector<ReweighedPoint> results;
  PhotonHistories rows;
  std::uint64_t offset = 0;  // of `rows`
  std::size_t row = 0;       // in `rows`
  const auto more = [&] {
    if (row < rows.rows()) return true;
    offset += rows.rows();
    rows = histories.read(offset, kRowsAtOnce);
    row = 0;
    return rows.rows() > 0;
  };
  for (std::size_t number = 0; number < run.points.size(); ++number) {
    const auto traced = histories.traced(number);
    if (!traced) continue;
    const PointResult& point = run.points[number];
    const std::uint64_t detected = point.count(Fate::detected);
    std::vector<Reweighting> choices;
    for (const std::vector<double>& values : plan.values)
      choices.emplace_back(plan.change(*traced, values), detected);
    PointReweighting reweighting(point, std::move(choices), emitted_by_event(path, number, listed_events));
    std::uint64_t seen = 0;
    for (; more() && rows.point[row] == number; ++row, ++seen)
      reweighting.add(rows.event[row], history_at(rows, row, histories.columns()));
    if (seen != detected)
      throw results_format::damaged(path, fmt::format("{} histories for {} detected photons", seen, detected));
    for (ReweighedPoint& result : reweighting.finish(number, plan.values)) results.push_back(std::move(result));
  }
  return results;
}

}  // namespace scintray
