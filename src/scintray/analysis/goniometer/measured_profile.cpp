#include "scintray/analysis/goniometer/measured_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/config/csv.hpp"
#include "scintray/core/error.hpp"

namespace scintray::analysis {

namespace {

double area(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0.0;
  for (std::size_t k = 1; k < x.size(); ++k) sum += 0.5 * (y[k] + y[k - 1]) * (x[k] - x[k - 1]);
  return sum;
}

/// The reading's density at an angle, linear between the middles of bins, constant beyond.
double density_at(const DirectionCounts& reading, double angle_deg, double per_count) {
  const double at = std::clamp(angle_deg - profile_edge_deg(0) - 0.5, 0.0,
                               static_cast<double>(DirectionCounts::kProfileBins - 1));
  const auto below = std::min(static_cast<std::size_t>(at), reading.profile.size() - 2);
  return per_count * std::lerp(static_cast<double>(reading.profile[below]),
                               static_cast<double>(reading.profile[below + 1]),
                               at - static_cast<double>(below));
}

}  // namespace

MeasuredProfile read_measured_profile(const std::filesystem::path& path) {
  const config::CsvTable table = config::read_csv(path);
  const std::size_t width = table.rows.front().values.size();
  if (width != 2 && width != 3)
    throw core::InputError(
        {{table.file, table.rows.front().line, 1},
         fmt::format("rows of {} values; expected angle_deg,value or angle_deg,value,error", width),
         "remove the other columns"});
  core::Problems problems;
  MeasuredProfile profile;
  for (const config::CsvTable::Row& row : table.rows) {
    const double angle = row.values[0], value = row.values[1];
    const auto wrong = [&](const std::string& what, const std::string& hint) {
      problems.add({table.file, row.line, 0}, what, hint);
    };
    if (std::abs(angle) > 90.0)
      wrong(fmt::format("an angle of {:g} deg; expected -90 to 90", angle),
            "angles are from the normal, in degrees, positive on the forward (mirror) side");
    if (!profile.angle_deg.empty() && angle <= profile.angle_deg.back())
      wrong(fmt::format("an angle of {:g} deg after {:g}; expected them to increase", angle,
                        profile.angle_deg.back()),
            "sort the rows by angle, each angle once");
    if (value < 0.0) wrong(fmt::format("a value of {:g}; expected 0 or more", value), "");
    if (width == 3 && row.values[2] < 0.0)
      wrong(fmt::format("an error of {:g}; expected 0 or more", row.values[2]), "");
    profile.angle_deg.push_back(angle);
    profile.value.push_back(value);
    if (width == 3) profile.error.push_back(row.values[2]);
  }
  if (profile.value.size() < 2)
    problems.add({table.file, 0, 0}, "one row; expected two at least",
                 "a profile has an area between its angles");
  else if (*std::max_element(profile.value.begin(), profile.value.end()) <= 0.0)
    problems.add({table.file, 0, 0}, "no value above 0", "without light there is nothing to compare");
  problems.throw_if_any();
  return profile;
}

ScaledProfile scale_to(const MeasuredProfile& measured, const DirectionCounts& reading, std::uint64_t rays,
                       double half_width_rad) {
  const double per_count = 1.0 / (static_cast<double>(rays) * profile_bin_sr(half_width_rad));
  std::vector<double> own;
  for (const double angle : measured.angle_deg) own.push_back(density_at(reading, angle, per_count));
  const double own_area = area(measured.angle_deg, own);
  if (own_area <= 0.0)
    throw core::InputError(
        {{},
         fmt::format("no ray left between {:g} and {:g} deg in the plane of incidence, where the "
                     "measurement is",
                     measured.angle_deg.front(), measured.angle_deg.back()),
         "use more rays, a wider --half-width, or the measurement of this surface"});
  ScaledProfile scaled{measured, own_area / area(measured.angle_deg, measured.value), 0.0};
  double squares = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    scaled.profile.value[k] *= scaled.factor;
    if (!scaled.profile.error.empty()) scaled.profile.error[k] *= scaled.factor;
    squares += std::pow(scaled.profile.value[k] - own[k], 2.0);
  }
  const double largest =
      per_count * static_cast<double>(*std::max_element(reading.profile.begin(), reading.profile.end()));
  scaled.rms = std::sqrt(squares / static_cast<double>(own.size())) / largest;
  return scaled;
}

}  // namespace scintray::analysis
