#include "scintray/results/detail/goniometer_columns.hpp"

#include <algorithm>
#include <stdexcept>

#include "scintray/core/vec.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results::format {

namespace {

constexpr const char* kGroup = "benches";

std::vector<double> in_degrees(std::vector<double> angles_rad) {
  for (double& angle : angles_rad) angle /= core::kDegree;
  return angles_rad;
}

void put_estimates(core::h5::Group& group, const char* name, const char* error_name,
                   const std::vector<core::Estimate>& estimates, double unit) {
  std::vector<double> values, errors;
  for (const core::Estimate& one : estimates) {
    values.push_back(one.value / unit);
    errors.push_back(one.error / unit);
  }
  put(group, name, values);
  put(group, error_name, errors);
}

void put_cells(core::h5::Group& group) {
  std::vector<double> polar_low, polar_high, azimuth_low, azimuth_high, solid_angle;
  for (std::size_t i = 0; i < analysis::hemisphere_grid().size(); ++i) {
    const analysis::HemisphereGrid::Cell cell = analysis::hemisphere_grid().cell(i);
    polar_low.push_back(cell.polar_low / core::kDegree);
    polar_high.push_back(cell.polar_high / core::kDegree);
    azimuth_low.push_back(cell.azimuth_low / core::kDegree);
    azimuth_high.push_back(cell.azimuth_high / core::kDegree);
    solid_angle.push_back(cell.solid_angle_sr);
  }
  put(group, "cell_polar_low_deg", polar_low);
  put(group, "cell_polar_high_deg", polar_high);
  put(group, "cell_azimuth_low_deg", azimuth_low);
  put(group, "cell_azimuth_high_deg", azimuth_high);
  put(group, "cell_solid_angle_sr", solid_angle);
  format::name_dimensions(group);
}

void put_analysis(core::h5::Group group, const analysis::SurfaceAnalysis& analysis) {
  group.set_attribute("", "bench", analysis.goniometer);
  group.set_attribute("", "surface", analysis.place.surface);
  group.set_attribute("", "inside", analysis.place.inside);
  group.set_attribute("", "outside", analysis.place.outside);
  put(group, "wavelength_nm", analysis.place.wavelength_nm);
  put(group, "index_inside", analysis.index.inside);
  put(group, "index_outside", analysis.index.outside);
  put(group, "rays", analysis.rays);
  put(group, "incidence_deg", in_degrees(analysis.incidence_rad));
  put_estimates(group, "reflectance", "reflectance_error", analysis.reflectance, 1.0);
  if (!analysis.slope_rad.empty())
    put_estimates(group, "mean_slope_deg", "mean_slope_error_deg", analysis.slope_rad, core::kDegree);
  const analysis::GoniometerReading& reading = analysis.directions;
  put(group, "directions_at_deg", reading.settings.incidence_rad / core::kDegree);
  put(group, "rays_reflected", reading.reflected);
  put(group, "rays_transmitted", reading.transmitted);
  put(group, "rays_absorbed", reading.absorbed);
  put(group, "lobe_width", reading.reflected_lobe.width_in_plane);
  put(group, "reflected_cells", reading.reflected_directions.cells);
  put(group, "transmitted_cells", reading.transmitted_directions.cells);
  put(group, "reflected_profile", reading.reflected_directions.profile);
  put(group, "transmitted_profile", reading.transmitted_directions.profile);
  format::name_dimensions(group, {{"incidence_deg", {"incidence_deg"}},
                                  {"reflectance", {"incidence_deg"}},
                                  {"reflectance_error", {"incidence_deg"}},
                                  {"mean_slope_deg", {"incidence_deg"}},
                                  {"mean_slope_error_deg", {"incidence_deg"}}});
}

template <typename T>
T get_number(const core::h5::Group& group, const char* name) {
  const std::vector<T> values = group.read<T>(name);
  if (values.size() != 1) throw std::invalid_argument(std::string(name) + " is not one value");
  return values.front();
}

template <typename T>
std::vector<T> get_column(const core::h5::Group& group, const char* name, std::size_t size) {
  std::vector<T> values = group.read<T>(name);
  if (values.size() != size) throw std::invalid_argument("the columns of a goniometer differ in length");
  return values;
}

std::vector<core::Estimate> get_estimates(const core::h5::Group& group, const char* name,
                                          const char* error_name, std::size_t size, double unit) {
  const std::vector<double> values = get_column<double>(group, name, size);
  const std::vector<double> errors = get_column<double>(group, error_name, size);
  std::vector<core::Estimate> estimates(size);
  for (std::size_t i = 0; i < size; ++i) estimates[i] = {values[i] * unit, errors[i] * unit};
  return estimates;
}

analysis::SurfaceAnalysis get_analysis(const core::h5::Group& group) {
  analysis::SurfaceAnalysis analysis;
  analysis.goniometer = group.string_attribute("", "bench");
  analysis.place = {group.string_attribute("", "surface"), group.string_attribute("", "inside"),
                    group.string_attribute("", "outside"), get_number<double>(group, "wavelength_nm")};
  analysis.index = {get_number<double>(group, "index_inside"), get_number<double>(group, "index_outside")};
  analysis.rays = get_number<std::uint64_t>(group, "rays");
  analysis.incidence_rad = group.read<double>("incidence_deg");
  for (double& angle : analysis.incidence_rad) angle *= core::kDegree;
  const std::size_t size = analysis.incidence_rad.size();
  analysis.reflectance = get_estimates(group, "reflectance", "reflectance_error", size, 1.0);
  if (group.has("mean_slope_deg"))
    analysis.slope_rad = get_estimates(group, "mean_slope_deg", "mean_slope_error_deg", size, core::kDegree);

  analysis::GoniometerReading& reading = analysis.directions;
  reading.settings.incidence_rad = get_number<double>(group, "directions_at_deg") * core::kDegree;
  reading.settings.wavelength_nm = analysis.place.wavelength_nm;
  reading.settings.rays = analysis.rays;
  reading.reflected = get_number<std::uint64_t>(group, "rays_reflected");
  reading.transmitted = get_number<std::uint64_t>(group, "rays_transmitted");
  reading.absorbed = get_number<std::uint64_t>(group, "rays_absorbed");
  reading.reflected_lobe.rays = reading.reflected;
  reading.reflected_lobe.width_in_plane = get_number<double>(group, "lobe_width");
  const auto counts = [&](const char* cells, const char* profile) {
    analysis::DirectionCounts directions;
    directions.cells = get_column<std::uint64_t>(group, cells, analysis::hemisphere_grid().size());
    directions.profile = get_column<std::uint64_t>(group, profile, analysis::DirectionCounts::kProfileBins);
    return directions;
  };
  reading.reflected_directions = counts("reflected_cells", "reflected_profile");
  reading.transmitted_directions = counts("transmitted_cells", "transmitted_profile");
  return analysis;
}

}  // namespace

void put_surface_analyses(core::h5::Group& root, const std::vector<analysis::SurfaceAnalysis>& analyses) {
  if (analyses.empty()) return;
  core::h5::Group group = root.create_group(kGroup);
  group.set_attribute(
      "", "description",
      std::string("goniometer readings, one group for each surface between two media at one wavelength"));
  put_cells(group);
  core::h5::Group list = group.create_group("surfaces");
  list.set_attribute("", "description", std::string("the readings, in the order of the scene"));
  for (std::size_t i = 0; i < analyses.size(); ++i) put_analysis(list.create_group(numbered(i)), analyses[i]);
}

std::vector<analysis::SurfaceAnalysis> get_surface_analyses(const core::h5::Group& root) {
  std::vector<analysis::SurfaceAnalysis> analyses;
  if (!root.has(kGroup)) return analyses;
  const core::h5::Group list = root.open_group(kGroup).open_group("surfaces");
  for (const std::string& name : list.members()) analyses.push_back(get_analysis(list.open_group(name)));
  return analyses;
}

}  // namespace scintray::results::format
