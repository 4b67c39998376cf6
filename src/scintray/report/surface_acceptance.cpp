#include "scintray/report/surface_acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/optics/fresnel.hpp"

namespace scintray::report {

namespace {

/// Angles written in deg and read back may differ in their last digits.
constexpr double kSameAngle_rad = 1e-9;

bool same_angle(double a_rad, double b_rad) { return std::abs(a_rad - b_rad) < kSameAngle_rad; }

/// A reading that a criterion can be about.
struct Readable {
  std::string surface, outside;
  std::vector<double> incidence_rad;
  double directions_at_rad = 0.0;
  const analysis::SurfaceAnalysis* analysis = nullptr;  ///< null before the run

  bool has(const scene_file::CriterionSpec& criterion) const {
    return criterion.quantity == scene_file::CriterionQuantity::lobe_width
               ? same_angle(directions_at_rad, criterion.incidence_rad)
               : std::any_of(incidence_rad.begin(), incidence_rad.end(),
                             [&](double angle) { return same_angle(angle, criterion.incidence_rad); });
  }
};

std::vector<std::string> names(const std::vector<Readable>& readable, std::string Readable::*name) {
  std::vector<std::string> list;
  for (const Readable& one : readable)
    if (std::find(list.begin(), list.end(), one.*name) == list.end()) list.push_back(one.*name);
  return list;
}

const Readable& find(const std::vector<Readable>& readable, const scene_file::CriterionSpec& criterion) {
  if (readable.empty())
    throw core::InputError({criterion.where,
                            "this criterion is about a surface, but the scene has no [[bench]]",
                            "add one with the surface, the medium behind it and the wavelength"});
  const auto check_name = [&](const char* kind, const config::NameRef& name, std::string Readable::*member) {
    const std::vector<std::string> known = names(readable, member);
    if (std::find(known.begin(), known.end(), name.name) == known.end())
      throw core::unknown_name(name.where, kind, name.name, known);
  };
  check_name("surface on a goniometer", criterion.surface, &Readable::surface);
  check_name("medium behind a surface on a goniometer", criterion.outside, &Readable::outside);
  for (const Readable& one : readable)
    if (one.surface == criterion.surface.name && one.outside == criterion.outside.name && one.has(criterion))
      return one;
  throw core::InputError(
      {criterion.where,
       fmt::format("no goniometer measures surface \"{}\" to \"{}\" at {:g} deg", criterion.surface.name,
                   criterion.outside.name, criterion.incidence_rad / core::kDegree),
       criterion.quantity == scene_file::CriterionQuantity::lobe_width
           ? "widths are available at directions_at only"
           : "add the angle to its incidence"});
}

std::size_t node_at(const analysis::SurfaceAnalysis& analysis, double incidence_rad) {
  std::size_t node = 0;
  while (!same_angle(analysis.incidence_rad[node], incidence_rad)) ++node;
  return node;
}

}  // namespace

core::Estimate surface_value(const scene_file::CriterionSpec& criterion,
                             const std::vector<analysis::SurfaceAnalysis>& analyses) {
  std::vector<Readable> readable;
  for (const analysis::SurfaceAnalysis& analysis : analyses)
    readable.push_back({analysis.place.surface, analysis.place.outside, analysis.incidence_rad,
                        analysis.directions.settings.incidence_rad, &analysis});
  const analysis::SurfaceAnalysis& analysis = *find(readable, criterion).analysis;
  if (criterion.quantity == scene_file::CriterionQuantity::lobe_width)
    return {std::asin(std::min(1.0, analysis.directions.reflected_lobe.width_in_plane)), 0.0};
  const std::size_t node = node_at(analysis, criterion.incidence_rad);
  if (criterion.quantity == scene_file::CriterionQuantity::mean_slope) {
    if (analysis.slope_rad.empty())
      throw core::InputError({criterion.surface.where,
                              "surface \"" + criterion.surface.name + "\" has no facets of its own",
                              "slopes are those of height maps, recipes and their tables"});
    return analysis.slope_rad[node];
  }
  core::Estimate value = analysis.reflectance[node];
  if (criterion.quantity == scene_file::CriterionQuantity::over_fresnel)
    value.value -=
        optics::fresnel(std::cos(criterion.incidence_rad), analysis.index.inside, analysis.index.outside)
            .unpolarised();
  return value;
}

void check_surface_criteria(const std::vector<scene_file::GoniometerSpec>& goniometers,
                            const std::vector<scene_file::CriterionSpec>& criteria) {
  std::vector<Readable> readable;
  for (const scene_file::GoniometerSpec& goniometer : goniometers)
    for (const config::NameRef& outside : goniometer.outside)
      for (const config::NameRef& surface : goniometer.surfaces)
        readable.push_back(
            {surface.name, outside.name, goniometer.incidence_rad, goniometer.directions_at_rad, nullptr});
  core::Problems problems;
  for (const scene_file::CriterionSpec& criterion : criteria) {
    if (!scene_file::is_of_surface(criterion.quantity)) continue;
    try {
      find(readable, criterion);
    } catch (const core::InputError& error) {
      problems.add(error);
    }
  }
  problems.throw_if_any();
}

}  // namespace scintray::report
