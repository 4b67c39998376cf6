#include "scintray/contact/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scintray/contact/detail/boolean_difference.hpp"
#include "scintray/contact/detail/conformer.hpp"
#include "scintray/contact/detail/stitch.hpp"
#include "scintray/core/activity.hpp"

namespace scintray::contact {

namespace {

void conform(PlacedMesh& first, PlacedMesh& second, const ConformingContact& spec,
             const Eigen::Matrix3d& axes, double flat_mm, core::Problems& problems) {
  const double tolerance = spec.tolerance_mm;
  const auto refuse = [&](const std::string& why, const std::string& hint, const core::Vec3& at) {
    problems.add(
        spec.where,
        fmt::format("the contact of \"{}\" and \"{}\" cannot be closed within {:.4g} mm: {}{}{}", first.name,
                    second.name, tolerance, why, also_at(first.name, first.where, spec.where),
                    also_at(second.name, second.where, spec.where)),
        hint, {{at.x(), at.y(), at.z()}});
  };
  const core::Vec3 between = first.diagnosis.bounds.intersection(second.diagnosis.bounds).center();
  const ContactRule rule{{tolerance, flat_mm}, {}, {}};
  Conformer onto_first(first, second, rule), onto_second(second, first, rule);
  if (!onto_first.faces() && !onto_second.faces())
    return refuse("no faces of theirs face each other that closely",
                  "raise the tolerance, or remove it for flat faces", between);
  Conformer* chosen = onto_first.covered() ? &onto_first : &onto_second;
  if (!chosen->covered()) {
    const core::Vec3 at = onto_first.partly_at();
    const std::string why = stitch(first, second, rule, axes);
    if (!why.empty())
      refuse("on either part a triangle lies partly within the tolerance and partly beyond it, and " + why,
             "raise the tolerance; or, where each part's face ends within the other's, cut one of the faces "
             "with an edge where the other ends",
             at);
    return;
  }
  const std::string why = chosen->conform(axes);
  if (!why.empty())
    refuse(why, "make both parts with the same tessellation, or change the tolerance", between);
}

}  // namespace

void conform_contacts(std::vector<PlacedMesh>& parts, const std::vector<ConformingContact>& contacts,
                      double flat_mm, core::Problems& problems) {
  for (const ConformingContact& spec : contacts) {
    const auto named = [&](const std::string& name) {
      return std::find_if(parts.begin(), parts.end(),
                          [&](const PlacedMesh& part) { return part.name == name; });
    };
    const auto first = named(spec.first), second = named(spec.second);
    if (first == parts.end() || second == parts.end()) continue;  // reported where names are looked up
    core::report_activity("closing curved contacts: " + spec.first + ", " + spec.second);
    conform(*first, *second, spec, difference_axes({*first, *second}), flat_mm, problems);
  }
}

}  // namespace scintray::contact
