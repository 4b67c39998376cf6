#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/config/csv.hpp"
#include "scintray/core/text.hpp"
#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/measured_brdf.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/materials/table_key.hpp"
#include "scintray/tables/bsdf_text.hpp"

namespace scintray::materials {

bool MeasuredBrdfSurface::reflect_light(optics::Ray& ray, const core::Vec3& normal, double,
                                        optics::SurfaceInteraction& at) const {
  const std::vector<double>& nm = brdf_->wavelengths_nm;
  std::size_t slice = 0;
  if (nm.size() > 1) {
    const auto above = std::upper_bound(nm.begin() + 1, nm.end() - 1, at.wavelength_nm);
    slice = static_cast<std::size_t>(above - nm.begin()) - 1;
    if (at.rng.uniform() < (at.wavelength_nm - nm[slice]) / (nm[slice + 1] - nm[slice])) ++slice;
  }
  const core::Vec3 lateral = ray.direction - ray.direction.dot(normal) * normal;
  const double sine = lateral.norm();
  const auto exit = brdf_->tables[slice].sample(std::min(1.0, sine * sine), at.rng);
  if (!exit) return false;
  constexpr double kNoPlane = 1e-9;
  const core::Vec3 forward =
      sine > kNoPlane ? core::Vec3(lateral / sine) : core::sample_polarisation(normal, at.rng);
  const double cosine = std::max(std::sqrt(std::max(0.0, 1.0 - exit->x)), optics::kLeastOpaqueCosine);
  const double out = std::sqrt(1.0 - cosine * cosine);
  const double turn = (at.rng.bits() & 1) != 0 ? exit->turn_rad : -exit->turn_rad;
  ray.direction =
      out * std::cos(turn) * forward + out * std::sin(turn) * normal.cross(forward) + cosine * normal;
  if (!ray.polarisation.isZero(0.0)) optics::repolarise(ray, at.rng);
  return true;
}

namespace {

/// Values of a file in the columns of T. A. Germer's data of sintered PTFE (2017): the unpolarised element of
/// the Mueller BRDF. An angle of incidence below 0 is that of light from the azimuth phi + 180 deg.
std::vector<tables::BrdfPoint> read_mueller_csv(const std::filesystem::path& path) {
  const config::CsvTable file = config::read_csv(path);
  const auto column = [&](std::initializer_list<const char*> names) {
    for (const char* name : names)
      for (std::size_t k = 0; k < file.columns.size(); ++k)
        if (file.columns[k] == name) return k;
    throw core::InputError(
        {{file.file, 1},
         fmt::format("no column \"{}\" in the heading of a measured BRDF", *names.begin()),
         "name the columns lambda (um), thetai, phi, thetar, phir (deg) and f_r11 (1/sr)"});
  };
  const std::size_t lambda = column({"lambda"}), theta_i = column({"thetai"}),
                    phi_i = column({"phi", "phii"}), theta_r = column({"thetar"}), phi_r = column({"phir"}),
                    value = column({"f_r11", "fr11"});
  core::Problems problems;
  std::vector<tables::BrdfPoint> points;
  for (const config::CsvTable::Row& row : file.rows) {
    const auto refuse = [&](const char* name, double found, const char* expected) {
      problems.add({file.file, row.line}, fmt::format("\"{}\" is {:g}; expected {}", name, found, expected),
                   "wavelengths are in um, angles in degrees, and the BRDF in 1/sr");
    };
    const double um = row.values[lambda], in_deg = row.values[theta_i], out_deg = row.values[theta_r],
                 brdf = row.values[value];
    if (!(um >= 0.1 && um <= 20.0)) refuse("lambda", um, "0.1 to 20 um");
    if (!(std::abs(in_deg) < 90.0)) refuse("thetai", in_deg, "-90 to 90 deg");
    if (!(out_deg >= 0.0 && out_deg < 90.0)) refuse("thetar", out_deg, "0 to 90 deg");
    if (!(brdf >= 0.0 && std::isfinite(brdf))) refuse("f_r11", brdf, "0 or more");
    const double turn_deg = row.values[phi_r] - row.values[phi_i] - (in_deg < 0.0 ? 0.0 : 180.0);
    points.push_back({um * 1e3, std::abs(in_deg) * core::kDegree, out_deg * core::kDegree,
                      std::min(std::abs(std::remainder(turn_deg, 360.0)), 180.0) * core::kDegree, brdf});
  }
  problems.throw_if_any();
  return points;
}

/// Values of a file of either format, by the ending of its name.
std::vector<tables::BrdfPoint> read_brdf_points(const std::filesystem::path& path) {
  if (!core::same_but_case(path.extension().string(), ".bsdf")) return read_mueller_csv(path);
  return tables::brdf_points(tables::parse_bsdf(config::read_text_file(path), path.string()));
}

MicrosurfaceSpec read_measured_brdf(const config::TomlTable& surface) {
  const config::TomlTable table = surface.table("measured_brdf");
  const std::filesystem::path path = table.existing_file("file");
  const double gap_index = read_gap_index(table);
  if (path.empty() || (table.has("gap") && !table.good("gap")))
    return FixedMicrosurface(optics::SmoothSurface());
  try {
    tables::MeasuredBrdf brdf = tables::fit_brdf(read_brdf_points(path), path.string());
    std::vector<double> reflectances;
    for (const tables::BrdfTable& slice : brdf.tables) reflectances.push_back(slice.diffuse_reflectance());
    WavelengthTable cover{core::Curve(brdf.wavelengths_nm, std::move(reflectances)), "measured BRDFs",
                          table.where("file")};
    std::string key = fmt::format("measured BRDF {} {:a}", file_key(path), gap_index);
    return FixedMicrosurface(
        MeasuredBrdfSurface(std::make_shared<const tables::MeasuredBrdf>(std::move(brdf)), gap_index),
        std::move(key), {std::move(cover)});
  } catch (const core::InputError& error) {
    report_of_file(table, "file", error);
    return FixedMicrosurface(optics::SmoothSurface());
  }
}

}  // namespace

SurfaceModel measured_brdf_model() {
  return {.word = "measured_brdf", .table = "measured_brdf", .read = read_measured_brdf};
}

}  // namespace scintray::materials
