#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "scintray/config/csv.hpp"
#include "scintray/core/text.hpp"
#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/measured_brdf.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/materials/table_key.hpp"
#include "scintray/optics/elliptical.hpp"
#include "scintray/tables/bsdf_text.hpp"
#include "scintray/tables/mueller_table.hpp"

namespace scintray::materials {

namespace {

/// Stokes parameters with the intensity, as of tables::MuellerTable.
using Stokes = Eigen::Vector4d;

/// Of a ray of unit intensity. optics::StokesParameters are about p = s x k, the opposite of k x s.
Stokes incident_stokes(const optics::Ray& ray, const core::Vec3& s) {
  const optics::StokesParameters stokes = optics::stokes_of(ray, s);
  return {1.0, stokes.s1, -stokes.s2, stokes.s3};
}

/// Reflected light: its direction, with an azimuth of either sign, and of polarised light its Stokes
/// parameters.
struct Reflected {
  tables::BrdfTable::Sample exit;
  Stokes stokes;
};

/// Polarised light that is reflected; nothing: absorbed.
std::optional<Reflected> sample_polarised(const tables::MuellerTable& mueller, const tables::BrdfTable& brdf,
                                          double x_in, const Stokes& stokes, core::Rng& rng) {
  if (rng.uniform() >= mueller.reflectance(x_in, stokes[1])) return std::nullopt;
  for (;;) {
    std::optional<tables::BrdfTable::Sample> exit = brdf.sample(x_in, rng);
    if (!exit) continue;
    if ((rng.bits() & 1) != 0) exit->turn_rad = -exit->turn_rad;
    const Stokes out = mueller.matrix(x_in, exit->x, exit->turn_rad) * stokes;
    if (rng.uniform() * (1.0 + mueller.most_excess()) < out[0]) return Reflected{*exit, out};
  }
}

/// Sets the polarisation of a ray of its new direction to a pure state, drawn so that the mean is that of the
/// Stokes parameters; where phases are not kept, of the first three.
void polarise(optics::Ray& ray, const core::Vec3& s, const Stokes& stokes, core::Rng& rng) {
  core::Vec3 state = stokes.tail<3>() / stokes[0];
  if (!ray.keeps_phases) state.z() = 0.0;
  const double degree = state.norm();
  if (degree < 1e-12) return optics::repolarise(ray, rng);
  state /= rng.uniform() < 0.5 * (1.0 + degree) ? degree : -degree;
  const double along_s = std::sqrt(std::max(0.0, 0.5 * (1.0 + state.x())));
  constexpr double kLeast = 1e-9;
  const optics::FieldComponents field =
      along_s > kLeast
          ? optics::FieldComponents{along_s, -std::complex<double>(state.y(), state.z()) / (2.0 * along_s)}
          : optics::FieldComponents{0.0, 1.0};
  optics::set_field(ray, s, field);
}

}  // namespace

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
  const double sine = lateral.norm(), x_in = std::min(1.0, sine * sine);
  constexpr double kNoPlane = 1e-9;
  const core::Vec3 forward =
      sine > kNoPlane ? core::Vec3(lateral / sine) : core::sample_polarisation(normal, at.rng);
  const bool polarised = !ray.polarisation.isZero(0.0);
  const tables::MuellerTable* mueller =
      polarised && !brdf_->mueller.empty() ? &brdf_->mueller[slice] : nullptr;
  std::optional<Reflected> light;
  if (mueller) {
    const Stokes stokes = incident_stokes(ray, forward.cross(normal));
    light = sample_polarised(*mueller, brdf_->tables[slice], x_in, stokes, at.rng);
  } else if (const auto exit = brdf_->tables[slice].sample(x_in, at.rng)) {
    light = Reflected{{exit->x, (at.rng.bits() & 1) != 0 ? exit->turn_rad : -exit->turn_rad}, Stokes::Zero()};
  }
  if (!light) return false;
  const double cosine = std::max(std::sqrt(std::max(0.0, 1.0 - light->exit.x)), optics::kLeastOpaqueCosine);
  const double out = std::sqrt(1.0 - cosine * cosine);
  const double turn = light->exit.turn_rad;
  const core::Vec3 radial = std::cos(turn) * forward + std::sin(turn) * normal.cross(forward);
  ray.direction = out * radial + cosine * normal;
  if (mueller)
    polarise(ray, radial.cross(normal), light->stokes, at.rng);
  else if (polarised)
    optics::repolarise(ray, at.rng);
  return true;
}

namespace {

/// Noise of measured elements stays below (chosen).
constexpr double kMostElement = 1.5;

/// Columns of a Mueller matrix, named "f_r12/f_r11" or "m12"; nothing unless all are there. The first is not
/// used.
std::optional<std::array<std::size_t, 16>> mueller_columns(const config::CsvTable& file) {
  std::array<std::size_t, 16> columns{};
  for (std::size_t element = 1; element < columns.size(); ++element) {
    const std::size_t row = element / 4 + 1, column = element % 4 + 1;
    const std::array<std::string, 2> names{fmt::format("f_r{}{}/f_r11", row, column),
                                           fmt::format("m{}{}", row, column)};
    const auto found =
        std::find_first_of(file.columns.begin(), file.columns.end(), names.begin(), names.end());
    if (found == file.columns.end()) return std::nullopt;
    columns[element] = static_cast<std::size_t>(found - file.columns.begin());
  }
  return columns;
}

Eigen::Matrix4d matrix_of(const config::CsvTable::Row& row, const std::array<std::size_t, 16>& columns) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (Eigen::Index element = 1; element < 16; ++element)
    matrix(element / 4, element % 4) = row.values[columns[static_cast<std::size_t>(element)]];
  return matrix;
}

/// Rotation of Stokes parameters by an azimuth.
Eigen::Matrix4d rotated_stokes(double azimuth_rad) {
  Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
  rotation(1, 1) = rotation(2, 2) = std::cos(2.0 * azimuth_rad);
  rotation(1, 2) = std::sin(2.0 * azimuth_rad);
  rotation(2, 1) = -rotation(1, 2);
  return rotation;
}

/// A matrix between s and p of both directions, of one whose polarisations are the axes of the face turned
/// into each direction, as in the data of sintered PTFE (docs/surfaces.md); of the azimuth's mirror image
/// where that is below 0.
Eigen::Matrix4d from_face_axes(const Eigen::Matrix4d& matrix, double phi_in, double phi_out, bool mirrored) {
  Eigen::Matrix4d turned = rotated_stokes(phi_out) * matrix * rotated_stokes(-phi_in);
  if (mirrored) {
    turned.topRightCorner<2, 2>() *= -1.0;
    turned.bottomLeftCorner<2, 2>() *= -1.0;
  }
  return turned;
}

/// Values of a file in the columns of T. A. Germer's data of sintered PTFE (2017): the unpolarised element of
/// the Mueller BRDF, and the others where the file has them all. An angle of incidence below 0 is that of
/// light from the azimuth phi + 180 deg.
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
  const std::optional<std::array<std::size_t, 16>> matrix = mueller_columns(file);
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
                      std::min(std::abs(std::remainder(turn_deg, 360.0)), 180.0) * core::kDegree, brdf,
                      std::nullopt});
    if (!matrix) continue;
    const Eigen::Matrix4d mueller = matrix_of(row, *matrix);
    if (!(mueller.cwiseAbs().maxCoeff() <= kMostElement))
      refuse("m12 to m44", mueller.cwiseAbs().maxCoeff(), "elements over f_r11 from -1.5 to 1.5");
    points.back().mueller =
        from_face_axes(mueller, row.values[phi_i] * core::kDegree, row.values[phi_r] * core::kDegree,
                       std::remainder(turn_deg, 360.0) < 0.0);
  }
  problems.throw_if_any();
  return points;
}

}  // namespace

std::vector<tables::BrdfPoint> read_brdf_points(const std::filesystem::path& path) {
  if (!core::same_but_case(path.extension().string(), ".bsdf")) return read_mueller_csv(path);
  return tables::brdf_points(tables::parse_bsdf(config::read_text_file(path), path.string()));
}

namespace {

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
