#include "scintray/scene_file/goniometer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scintray::scene_file {

namespace {

constexpr double kStep_deg = 2.5;
/// Close to grazing, where the slopes that light hits are steepest.
constexpr double kLast_deg = 88.5;
constexpr double kDirectionsAt_deg = 45.0;

std::vector<double> usual_incidence() {
  std::vector<double> angles;
  for (double angle = 0.0; angle < kLast_deg; angle += kStep_deg) angles.push_back(angle * core::kDegree);
  angles.push_back(kLast_deg * core::kDegree);
  return angles;
}

bool is_incidence(double angle_rad) { return angle_rad >= 0.0 && angle_rad < 0.5 * std::numbers::pi; }

std::vector<config::NameRef> names_of_list(const config::TomlTable& table, const std::string& key) {
  std::vector<config::NameRef> names;
  for (const std::string& name : table.strings(key)) names.push_back({name, table.where(key)});
  return names;
}

GoniometerSpec read_goniometer_table(const config::TomlTable& table) {
  GoniometerSpec goniometer;
  goniometer.where = table.where();
  goniometer.title = table.string("title", "Surfaces");
  goniometer.surfaces = names_of_list(table, "surfaces");
  goniometer.inside = {table.string("inside"), table.where("inside")};
  goniometer.outside = names_of_list(table, "outside");
  goniometer.wavelength_nm = table.quantity("wavelength", core::Dimension::wavelength);
  table.expect("wavelength", goniometer.wavelength_nm > 0.0, "a wavelength must be positive");

  goniometer.incidence_rad =
      table.has("incidence") ? table.quantities("incidence", core::Dimension::angle) : usual_incidence();
  const bool rising = std::adjacent_find(goniometer.incidence_rad.begin(), goniometer.incidence_rad.end(),
                                         std::greater_equal<>()) == goniometer.incidence_rad.end();
  table.expect(
      "incidence",
      rising && std::all_of(goniometer.incidence_rad.begin(), goniometer.incidence_rad.end(), is_incidence),
      "angles of incidence rise, from 0 deg to below 90 deg", "as [\"0 deg\", \"45 deg\", \"80 deg\"]");
  goniometer.directions_at_rad =
      table.quantity("directions_at", core::Dimension::angle, kDirectionsAt_deg * core::kDegree);
  table.expect("directions_at", is_incidence(goniometer.directions_at_rad),
               "an angle of incidence lies from 0 deg to below 90 deg");

  const std::int64_t rays = table.integer("rays", static_cast<std::int64_t>(goniometer.rays));
  const bool good = rays >= static_cast<std::int64_t>(GoniometerSpec::kFewestRays) &&
                    rays <= static_cast<std::int64_t>(GoniometerSpec::kMostRays);
  table.expect("rays", good, "the number of rays is not in 1,000 to 100,000,000",
               "they are shot at each angle of incidence");
  if (good) goniometer.rays = static_cast<std::uint64_t>(rays);
  return goniometer;
}

}  // namespace

std::vector<GoniometerSpec> read_goniometers(const config::TomlTable& scene) {
  std::vector<GoniometerSpec> goniometers;
  for (const config::TomlTable& table : scene.tables("bench"))
    goniometers.push_back(read_goniometer_table(table));
  return goniometers;
}

}  // namespace scintray::scene_file
