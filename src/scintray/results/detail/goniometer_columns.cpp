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
}

void put_study(core::h5::Group group, const analysis::SurfaceStudy& study) {
  group.set_attribute("", "bench", study.bench);
  group.set_attribute("", "surface", study.place.surface);
  group.set_attribute("", "inside", study.place.inside);
  group.set_attribute("", "outside", study.place.outside);
  put(group, "wavelength_nm", study.place.wavelength_nm);
  put(group, "index_inside", study.index.inside);
  put(group, "index_outside", study.index.outside);
  put(group, "rays", study.rays);
  put(group, "incidence_deg", in_degrees(study.incidence_rad));
  put_estimates(group, "reflectance", "reflectance_error", study.reflectance, 1.0);
  if (!study.slope_rad.empty())
    put_estimates(group, "mean_slope_deg", "mean_slope_error_deg", study.slope_rad, core::kDegree);
  const analysis::GoniometerReading& reading = study.directions;
  put(group, "directions_at_deg", reading.settings.incidence_rad / core::kDegree);
  put(group, "rays_reflected", reading.reflected);
  put(group, "rays_transmitted", reading.transmitted);
  put(group, "rays_absorbed", reading.absorbed);
  put(group, "lobe_width", reading.reflected_lobe.width_in_plane);
  put(group, "reflected_cells", reading.reflected_directions.cells);
  put(group, "transmitted_cells", reading.transmitted_directions.cells);
  put(group, "reflected_profile", reading.reflected_directions.profile);
  put(group, "transmitted_profile", reading.transmitted_directions.profile);
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
  if (values.size() != size) throw std::invalid_argument("the columns of a bench differ in length");
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

analysis::SurfaceStudy get_study(const core::h5::Group& group) {
  analysis::SurfaceStudy study;
  study.bench = group.string_attribute("", "bench");
  study.place = {group.string_attribute("", "surface"), group.string_attribute("", "inside"),
                 group.string_attribute("", "outside"), get_number<double>(group, "wavelength_nm")};
  study.index = {get_number<double>(group, "index_inside"), get_number<double>(group, "index_outside")};
  study.rays = get_number<std::uint64_t>(group, "rays");
  study.incidence_rad = group.read<double>("incidence_deg");
  for (double& angle : study.incidence_rad) angle *= core::kDegree;
  const std::size_t size = study.incidence_rad.size();
  study.reflectance = get_estimates(group, "reflectance", "reflectance_error", size, 1.0);
  if (group.has("mean_slope_deg"))
    study.slope_rad = get_estimates(group, "mean_slope_deg", "mean_slope_error_deg", size, core::kDegree);

  analysis::GoniometerReading& reading = study.directions;
  reading.settings.incidence_rad = get_number<double>(group, "directions_at_deg") * core::kDegree;
  reading.settings.wavelength_nm = study.place.wavelength_nm;
  reading.settings.rays = study.rays;
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
  return study;
}

}  // namespace

void put_surface_studies(core::h5::Group& root, const std::vector<analysis::SurfaceStudy>& studies) {
  if (studies.empty()) return;
  core::h5::Group group = root.create_group(kGroup);
  group.set_attribute("", "description",
                      std::string("surfaces read on a bench, one group a surface and place"));
  put_cells(group);
  core::h5::Group list = group.create_group("surfaces");
  list.set_attribute("", "description", std::string("the surfaces, in the order of the scene"));
  for (std::size_t i = 0; i < studies.size(); ++i) put_study(list.create_group(numbered(i)), studies[i]);
}

std::vector<analysis::SurfaceStudy> get_surface_studies(const core::h5::Group& root) {
  std::vector<analysis::SurfaceStudy> studies;
  if (!root.has(kGroup)) return studies;
  const core::h5::Group list = root.open_group(kGroup).open_group("surfaces");
  for (const std::string& name : list.members()) studies.push_back(get_study(list.open_group(name)));
  return studies;
}

}  // namespace scintray::results::format
