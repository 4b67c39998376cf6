#include "scintray/cli/scene_notes.hpp"

#include <fmt/format.h>

#include <ostream>

#include "scintray/cli/alike.hpp"
#include "scintray/contact/neighbours.hpp"

namespace scintray::cli {

namespace {

/// The text with every number replaced by a star, and quoted names by patterns.
std::string without_numbers(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool digit = std::string("0123456789.-+e").find(c) != std::string::npos;
    if (!digit) {
      result += c;
    } else if (result.empty() || result.back() != '*') {
      result += '*';
    }
  }
  return result;
}

}  // namespace

std::vector<core::Problem> gap_warnings(const simulation::SimulationPoint& point) {
  const double tolerance_mm = point.spec().run.contact_tolerance_mm;
  std::vector<core::Problem> warnings;
  for (const contact::SmallGap& gap : contact::find_small_gaps(point.built()->placed, tolerance_mm))
    warnings.push_back({{},
                        fmt::format("parts \"{}\" and \"{}\" are {:.3g} mm apart at ({:.5g}, {:.5g}, {:.5g}) "
                                    "mm: more than the contact tolerance of {:.3g} mm, less than 1/{:.0f} of "
                                    "the smaller one's diagonal",
                                    gap.a, gap.b, gap.gap_mm, gap.place.x(), gap.place.y(), gap.place.z(),
                                    tolerance_mm, 1.0 / contact::kSmallGapShare),
                        "if they are meant to touch, move one of them or raise run.contact_tolerance",
                        {{gap.place.x(), gap.place.y(), gap.place.z()}}});
  return warnings;
}

void print_notes(std::ostream& out, const scene_file::SceneFile& file,
                 const simulation::SimulationPoint& point) {
  for (const std::string& note : point.source_notes()) out << "note: " << note << "\n";
  for (const scene_file::DefinitionRef& unused : file.unused_definitions())
    out << fmt::format("note: [{}] (line {}) is used nowhere in the scene\n", definition_key(unused),
                       unused.name.where.line);
  for (const std::string& warning : point.warnings()) out << "warning: " << warning << "\n";
}

void print_warnings(std::ostream& out, const std::vector<core::Problem>& warnings, bool every_one) {
  Alike<core::Problem> lines;
  for (const core::Problem& warning : warnings)
    lines.add(every_one ? warning.what : without_numbers(warning.what), warning);
  for (const auto& line : lines.lines()) {
    out << "warning: " << line.first.what;
    if (line.count > 1)
      out << " (and " << line.count - 1 << " more like this; scintray check --all prints them)";
    out << "\n  hint: " << line.first.hint << "\n";
  }
}

}  // namespace scintray::cli
