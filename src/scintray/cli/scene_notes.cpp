#include "scintray/cli/scene_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <set>

#include "scintray/contact/neighbours.hpp"
#include "scintray/core/pattern.hpp"

namespace scintray::cli {

namespace {

/// The patterns of the parts of each builder, by the place of its table.
std::map<std::pair<std::string, long>, std::set<std::string>> builder_patterns(
    const scene_file::SceneSpec& spec) {
  std::map<std::pair<std::string, long>, std::set<std::string>> patterns;
  for (const scene_file::ContactSpec& contact : spec.contacts) {
    if (!contact.by_builder) continue;
    for (const config::NameRef& side : contact.between)
      if (side.name != "*") patterns[{contact.where.file, contact.where.line}].insert(side.name);
  }
  return patterns;
}

/// Gaps of one size between parts of the same two patterns.
struct GapGroup {
  std::string a, b;  ///< patterns, or the names of the only pair
  std::vector<contact::SmallGap> gaps;
  double area_mm2 = 0.0, least_mm = HUGE_VAL, most_mm = 0.0;

  void add(const contact::SmallGap& gap) {
    gaps.push_back(gap);
    area_mm2 += gap.area_mm2;
    least_mm = std::min(least_mm, gap.gap_mm);
    most_mm = std::max(most_mm, gap.gap_mm);
  }
  std::string size() const {
    return most_mm - least_mm < 0.01 * most_mm ? fmt::format("{:.3g} mm", most_mm)
                                               : fmt::format("{:.3g} to {:.3g} mm", least_mm, most_mm);
  }
  /// Names or patterns that accept them.
  const std::string& accepted_a() const { return gaps.size() == 1 ? gaps.front().a : a; }
  const std::string& accepted_b() const { return gaps.size() == 1 ? gaps.front().b : b; }
  std::string parts() const {
    return gaps.size() == 1 ? fmt::format("\"{}\" and \"{}\"", gaps.front().a, gaps.front().b)
                            : fmt::format("\"{}\" and \"{}\"", a, b);
  }
};

/// A tolerance that closes a gap: above it, to two digits.
double closing_tolerance(double gap_mm) {
  const double digit = std::pow(10.0, std::floor(std::log10(gap_mm)) - 1.0);
  return digit * std::ceil(1.05 * gap_mm / digit - 1e-6);
}

core::Problem warning_of(const GapGroup& group, const std::vector<contact::PlacedMesh>& placed,
                         const std::string& ambient, double tolerance_mm) {
  const contact::SmallGap& first = group.gaps.front();
  core::Problem warning;
  for (const contact::PlacedMesh& part : placed)
    if (part.name == first.b) warning.where = part.where;
  const std::string place =
      fmt::format("({:.5g}, {:.5g}, {:.5g}) mm", first.place.x(), first.place.y(), first.place.z());
  warning.what = group.gaps.size() == 1
                     ? fmt::format("parts {} are {} apart at {}, over {:.3g} mm2", group.parts(),
                                   group.size(), place, group.area_mm2)
                     : fmt::format("{} gaps of {} between parts {}, over {:.3g} mm2 in all, one at {}",
                                   group.gaps.size(), group.size(), group.parts(), group.area_mm2, place);
  warning.what += fmt::format(
      ": more than the contact tolerance of {:.3g} mm, less than 1/{:.0f} of the smaller "
      "one's diagonal",
      tolerance_mm, 1.0 / contact::kSmallGapShare);
  warning.hint = fmt::format(
      "if they are meant to touch, move one of them or write contact_tolerance = \"{:.3g} mm\" in [run], "
      "which joins all parts that are nearer; if the gap is meant, accept it by [[gap]] with between = "
      "[\"{}\", "
      "\"{}\"]: light crosses it as {}",
      closing_tolerance(group.most_mm), group.accepted_a(), group.accepted_b(), ambient);
  for (const contact::SmallGap& gap : group.gaps)
    warning.places_mm.push_back({gap.place.x(), gap.place.y(), gap.place.z()});
  return warning;
}

std::string intended_text(const GapGroup& group, const std::string& ambient) {
  return fmt::format(
      "{} gap{} of {} between parts {}, left by their builder: filled with {}, as intended; a filler, or "
      "a sheet as thick as the gap, closes {}",
      group.gaps.size(), group.gaps.size() == 1 ? "" : "s", group.size(), group.parts(), ambient,
      group.gaps.size() == 1 ? "it" : "them");
}

std::string accepted_text(const GapGroup& group, const std::string& ambient) {
  return fmt::format("{} gap{} of {} between parts {}, accepted by [[gap]]: filled with {}",
                     group.gaps.size(), group.gaps.size() == 1 ? "" : "s", group.size(), group.parts(),
                     ambient);
}

/// Every [[gap]] that accepts a gap.
std::vector<const scene_file::GapSpec*> accepted_by(const scene_file::SceneSpec& spec,
                                                    const contact::SmallGap& gap) {
  std::vector<const scene_file::GapSpec*> found;
  for (const scene_file::GapSpec& accepted : spec.gaps) {
    const auto matches = [&](const std::string& a, const std::string& b) {
      return core::matches_pattern(accepted.between[0].name, a) &&
             core::matches_pattern(accepted.between[1].name, b);
    };
    if (matches(gap.a, gap.b) || matches(gap.b, gap.a)) found.push_back(&accepted);
  }
  return found;
}

}  // namespace

GapFindings find_gaps(const simulation::SimulationPoint& point, bool every_one) {
  const scene_file::SceneSpec& spec = point.spec();
  const auto builders = builder_patterns(spec);
  const auto one_builder = [&](const contact::SmallGap& gap) {
    const auto of = [](const std::set<std::string>& patterns, const std::string& name) {
      return std::any_of(patterns.begin(), patterns.end(),
                         [&](const std::string& pattern) { return core::matches_pattern(pattern, name); });
    };
    return std::any_of(builders.begin(), builders.end(), [&](const auto& builder) {
      return of(builder.second, gap.a) && of(builder.second, gap.b);
    });
  };
  const double tolerance_mm = spec.run.contact_tolerance_mm;
  std::vector<GapGroup> groups;
  std::map<std::string, std::size_t> known;
  std::set<const scene_file::GapSpec*> needed;
  for (const contact::SmallGap& gap : contact::find_small_gaps(point.built()->placed, tolerance_mm)) {
    std::string a = core::pattern_of(gap.a), b = core::pattern_of(gap.b);
    if (b < a) std::swap(a, b);
    const std::vector<const scene_file::GapSpec*> accepted = accepted_by(spec, gap);
    needed.insert(accepted.begin(), accepted.end());
    std::string key = (one_builder(gap) ? "1" : accepted.empty() ? "0" : "2") + a + '\n' + b;
    if (every_one) key += '\n' + gap.a + '\n' + gap.b;
    const auto [at, is_new] = known.try_emplace(key, groups.size());
    if (is_new) groups.push_back({a, b, {}});
    groups[at->second].add(gap);
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const GapGroup& x, const GapGroup& y) { return x.area_mm2 > y.area_mm2; });
  GapFindings findings;
  for (const GapGroup& group : groups)
    if (one_builder(group.gaps.front()))
      findings.intended.push_back(intended_text(group, spec.ambient.name));
    else if (!accepted_by(spec, group.gaps.front()).empty())
      findings.intended.push_back(accepted_text(group, spec.ambient.name));
    else
      findings.warnings.push_back(warning_of(group, point.built()->placed, spec.ambient.name, tolerance_mm));
  for (const scene_file::GapSpec& gap : spec.gaps)
    if (!needed.contains(&gap))
      findings.intended.push_back(
          fmt::format("[[gap]] at {}: there is no small gap between \"{}\" and \"{}\"", gap.where.text(),
                      gap.between[0].name, gap.between[1].name));
  return findings;
}

void print_notes(std::ostream& out, const scene_file::SceneFile& file,
                 const simulation::SimulationPoint& point) {
  for (const std::string& note : point.source_notes()) out << "note: " << note << "\n";
  for (const scene_file::DefinitionRef& unused : file.unused_definitions())
    out << fmt::format("note: [{}] (line {}) is used nowhere in the scene\n", definition_key(unused),
                       unused.name.where.line);
  for (const std::string& warning : point.warnings()) out << "warning: " << warning << "\n";
}

void print_gaps(std::ostream& out, const GapFindings& gaps) {
  for (const std::string& note : gaps.intended) out << "note: " << note << "\n";
  for (std::size_t i = 0; i < gaps.warnings.size(); ++i) {
    out << "warning" << (gaps.warnings.size() > 1 ? fmt::format(" {}", i + 1) : "") << ": "
        << gaps.warnings[i].what
        << (gaps.warnings[i].where.file.empty() ? "" : "; the latter is at " + gaps.warnings[i].where.text())
        << "\n  hint: " << gaps.warnings[i].hint << "\n";
  }
}

}  // namespace scintray::cli
