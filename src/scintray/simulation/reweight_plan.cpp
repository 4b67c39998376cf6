#include "scintray/analysis/reweight.hpp"
#include "scintray/simulation/reweight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "scintray/core/error.hpp"

namespace scintray::simulation {

namespace {

constexpr std::size_t kMostChoices = 10'000;

core::InputError refused(const std::filesystem::path& path, const std::string& what,
                         const std::string& hint) {
  return core::InputError({{path.string()}, what, hint});
}

/// The columns that a scan changes.
class Targets {
 public:
  Targets(const std::filesystem::path& path, const tally::RunResult& run,
          const results::HistoryColumns& columns)
      : path_(path), run_(run), columns_(columns) {}

  std::vector<std::size_t> of(const PropertyScan& scan) const {
    return scan.property == OpticalProperty::absorption_length ? medium(scan.name) : reflectors(scan.name);
  }

 private:
  bool is_medium(const std::string& name) const {
    const std::vector<std::string>& media = run_.header.media.values();
    return std::find(media.begin(), media.end(), name) != media.end();
  }

  std::vector<std::size_t> medium(const std::string& name) const {
    if (const auto& gaps = columns_.gap_media; std::find(gaps.begin(), gaps.end(), name) != gaps.end())
      throw refused(path_,
                    "the medium \"" + name +
                        "\" also fills the gap of a surface, where paths of photons are not recorded",
                    "run the scene again with the other absorption length");
    const auto known = std::find(columns_.media.begin(), columns_.media.end(), name);
    if (known == columns_.media.end() && is_medium(name))
      throw refused(path_,
                    "the absorption along the paths of photons in the medium \"" + name +
                        "\" is not recorded: it is opaque, or birefringent",
                    "run the scene again with the other absorption length");
    if (known == columns_.media.end())
      throw core::unknown_name({path_.string()}, "medium that light was in", name, columns_.media);
    return {static_cast<std::size_t>(known - columns_.media.begin())};
  }

  std::vector<std::size_t> reflectors(const std::string& name) const {
    std::vector<std::size_t> found;
    std::set<std::string> names;
    for (std::size_t i = 0; i < columns_.reflectors.size(); ++i) {
      const tally::ReflectorSite& site = columns_.reflectors[i];
      if (site.reflector == name || site.stack == name || site.surface == name) found.push_back(i);
      names.insert({site.reflector, site.stack, site.surface});
    }
    const auto& transmitting = columns_.transmitting;
    if (std::find(transmitting.begin(), transmitting.end(), name) != transmitting.end())
      throw refused(path_, "\"" + name + "\" transmits light, so its reflectance does not change alone",
                    "run the scene again with the other reflectance");
    if (!found.empty()) return found;
    for (const std::string& surface : run_.header.surfaces)
      if (surface == name || surface.starts_with(name + " ("))
        throw refused(
            path_,
            "the surface \"" + name +
                "\" has no reflectance of its own: it has no reflector, or is a table that contains one",
            names.empty() ? "no surface of this result has a reflector"
                          : "reflectors of this result: " + fmt::format("{}", fmt::join(names, ", ")));
    throw core::unknown_name({path_.string()}, "reflector", name, {names.begin(), names.end()});
  }

  const std::filesystem::path& path_;
  const tally::RunResult& run_;
  const results::HistoryColumns& columns_;
};

std::string property_name(OpticalProperty property) {
  return property == OpticalProperty::reflectance ? "reflectance" : "absorption length";
}

std::string site_text(const tally::ReflectorSite& site) {
  return site.reflector == site.stack ? "\"" + site.stack + "\""
                                      : "\"" + site.reflector + "\" of \"" + site.stack + "\"";
}

void check_values(const std::filesystem::path& path, const PropertyScan& scan) {
  const auto refuse = [&](double value, const std::string& expected) {
    throw refused(path, describe(scan) + " cannot be " + describe_value(scan, value), expected);
  };
  if (scan.values.empty()) throw refused(path, describe(scan) + " has no value", "set one value or several");
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

analysis::WantedProperty wanted(const PropertyScan& scan, double value) {
  const auto as = scan.times ? analysis::WantedProperty::As::times : analysis::WantedProperty::As::constant;
  return {as, scan.property == OpticalProperty::absorption_length ? 1.0 / value : value};
}

/// Optics where a point has no such medium or reflector: none of its photons interacts with it.
std::vector<tally::TracedRange> known_ranges(std::vector<tally::TracedRange> ranges, double otherwise) {
  for (tally::TracedRange& range : ranges)
    if (std::isnan(range.least) || std::isnan(range.most)) range = {otherwise, otherwise};
  return ranges;
}

/// All combinations of values, the last scan's varying fastest.
std::vector<std::vector<double>> combinations(const std::filesystem::path& path,
                                              const std::vector<PropertyScan>& scans) {
  std::vector<std::vector<double>> all{{}};
  for (const PropertyScan& scan : scans) {
    if (all.size() * scan.values.size() > kMostChoices)
      throw refused(path, fmt::format("more than {} combinations of values", kMostChoices),
                    "use fewer values at once");
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

}  // namespace

std::string describe(const PropertyScan& scan) { return property_name(scan.property) + " of " + scan.name; }

std::string describe_value(const PropertyScan& scan, double value) {
  if (scan.times) return fmt::format("x {:.6g}", value);
  if (scan.property == OpticalProperty::reflectance) return fmt::format("{:.6g}", value);
  return std::isinf(value) ? "none" : fmt::format("{:.6g} mm", value);
}

ReweightPlan::ReweightPlan(const std::filesystem::path& path, const tally::RunResult& run,
                           const results::HistoryColumns& columns, const std::vector<PropertyScan>& scans)
    : path_(path), scans_(scans) {
  if (scans.empty())
    throw refused(path, "no absorption length or reflectance to change",
                  "set an absorption length or a reflectance");
  const Targets find(path, run, columns);
  std::map<std::pair<OpticalProperty, std::size_t>, std::string> taken;
  for (const PropertyScan& scan : scans) {
    check_values(path, scan);
    targets_.push_back(find.of(scan));
    for (const std::size_t target : targets_.back()) {
      const auto [other, is_new] = taken.try_emplace({scan.property, target}, scan.name);
      if (!is_new)
        throw refused(path,
                      fmt::format("\"{}\" and \"{}\" set the {} of the same item", other->second, scan.name,
                                  property_name(scan.property)),
                      "set each once; several values as \"NAME=1,2,3\"");
    }
  }
  choices_ = combinations(path, scans);
  for (const tally::ReflectorSite& site : columns.reflectors) reflector_names_.push_back(site_text(site));
}

analysis::OpticalChange ReweightPlan::change(const results::TracedOptics& traced,
                                             const std::vector<double>& chosen) const {
  analysis::OpticalChange change;
  change.traced_absorption_per_mm = known_ranges(traced.absorption_per_mm, 0.0);
  change.traced_reflectance = known_ranges(traced.reflectance, 1.0);
  change.absorption_per_mm.resize(change.traced_absorption_per_mm.size());
  change.reflectance.resize(change.traced_reflectance.size());
  change.reflector_names = reflector_names_;
  for (std::size_t i = 0; i < scans_.size(); ++i)
    for (const std::size_t target : targets_[i]) {
      const analysis::WantedProperty property = wanted(scans_[i], chosen[i]);
      if (scans_[i].property == OpticalProperty::absorption_length) {
        change.absorption_per_mm[target] = property;
        continue;
      }
      const double most = traced.reflectance[target].most;
      if (std::isnan(most)) continue;  // not in this point
      if (scans_[i].times && most * chosen[i] > 1.0)
        throw refused(path_,
                      fmt::format("a reflectance of {:.6g} times {:.6g} is above 1, of {}", most, chosen[i],
                                  reflector_names_[target]),
                      fmt::format("use factors up to {:.6g}", 1.0 / most));
      change.reflectance[target] = property;
    }
  return change;
}

}  // namespace scintray::simulation
