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

/// What can be claimed of one surface.
struct Readable {
  std::string surface, outside;
  std::vector<double> incidence_rad;
  double directions_at_rad = 0.0;
  const analysis::SurfaceStudy* study = nullptr;  ///< nothing before the run

  bool has(const scene_file::ClaimSpec& claim) const {
    return claim.quantity == scene_file::ClaimQuantity::lobe_width
               ? same_angle(directions_at_rad, claim.incidence_rad)
               : std::any_of(incidence_rad.begin(), incidence_rad.end(),
                             [&](double angle) { return same_angle(angle, claim.incidence_rad); });
  }
};

std::vector<std::string> names(const std::vector<Readable>& readable, std::string Readable::*name) {
  std::vector<std::string> list;
  for (const Readable& one : readable)
    if (std::find(list.begin(), list.end(), one.*name) == list.end()) list.push_back(one.*name);
  return list;
}

const Readable& find(const std::vector<Readable>& readable, const scene_file::ClaimSpec& claim) {
  if (readable.empty())
    throw core::InputError({claim.where, "this claim is about a surface, but the scene has no [[bench]]",
                            "add one with the surface, the medium behind it and the wavelength"});
  const auto check_name = [&](const char* kind, const config::NameRef& name, std::string Readable::*member) {
    const std::vector<std::string> known = names(readable, member);
    if (std::find(known.begin(), known.end(), name.name) == known.end())
      throw core::unknown_name(name.where, kind, name.name, known);
  };
  check_name("surface of a bench", claim.surface, &Readable::surface);
  check_name("medium behind a surface of a bench", claim.outside, &Readable::outside);
  for (const Readable& one : readable)
    if (one.surface == claim.surface.name && one.outside == claim.outside.name && one.has(claim)) return one;
  throw core::InputError(
      {claim.where,
       fmt::format("no bench reads surface \"{}\" to \"{}\" at {:g} deg", claim.surface.name,
                   claim.outside.name, claim.incidence_rad / core::kDegree),
       claim.quantity == scene_file::ClaimQuantity::lobe_width ? "widths are read at directions_at"
                                                               : "add the angle to its incidence"});
}

std::size_t node_at(const analysis::SurfaceStudy& study, double incidence_rad) {
  std::size_t node = 0;
  while (!same_angle(study.incidence_rad[node], incidence_rad)) ++node;
  return node;
}

}  // namespace

core::Estimate surface_value(const scene_file::ClaimSpec& claim,
                             const std::vector<analysis::SurfaceStudy>& studies) {
  std::vector<Readable> readable;
  for (const analysis::SurfaceStudy& study : studies)
    readable.push_back({study.place.surface, study.place.outside, study.incidence_rad,
                        study.directions.settings.incidence_rad, &study});
  const analysis::SurfaceStudy& study = *find(readable, claim).study;
  if (claim.quantity == scene_file::ClaimQuantity::lobe_width)
    return {std::asin(std::min(1.0, study.directions.reflected_lobe.width_in_plane)), 0.0};
  const std::size_t node = node_at(study, claim.incidence_rad);
  if (claim.quantity == scene_file::ClaimQuantity::mean_slope) {
    if (study.slope_rad.empty())
      throw core::InputError({claim.surface.where,
                              "surface \"" + claim.surface.name + "\" has no facets of its own",
                              "slopes are those of height maps, recipes and their tables"});
    return study.slope_rad[node];
  }
  core::Estimate value = study.reflectance[node];
  if (claim.quantity == scene_file::ClaimQuantity::over_fresnel)
    value.value -=
        optics::fresnel(std::cos(claim.incidence_rad), study.index.inside, study.index.outside).unpolarised();
  return value;
}

void check_surface_claims(const std::vector<scene_file::BenchSpec>& benches,
                          const std::vector<scene_file::ClaimSpec>& claims) {
  std::vector<Readable> readable;
  for (const scene_file::BenchSpec& bench : benches)
    for (const config::NameRef& outside : bench.outside)
      for (const config::NameRef& surface : bench.surfaces)
        readable.push_back(
            {surface.name, outside.name, bench.incidence_rad, bench.directions_at_rad, nullptr});
  core::Problems problems;
  for (const scene_file::ClaimSpec& claim : claims) {
    if (!scene_file::is_of_surface(claim.quantity)) continue;
    try {
      find(readable, claim);
    } catch (const core::InputError& error) {
      problems.add(error);
    }
  }
  problems.throw_if_any();
}

}  // namespace scintray::report
