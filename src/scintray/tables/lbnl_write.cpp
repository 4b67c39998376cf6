#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/tables/lbnl.hpp"

namespace scintray::tables {

namespace {

constexpr double kThetaStep_rad = 4.0 * core::kDegree, kPhiStep_rad = 5.0 * core::kDegree;

/// Cells that Geant4's sampler selects and that leave the surface: neither at -90 deg, nor the last.
std::size_t cell(double angle_rad, double step_rad, std::size_t count) {
  const double place = std::round((angle_rad + 0.5 * core::kPi) / step_rad);
  return static_cast<std::size_t>(std::clamp(place, 1.0, static_cast<double>(count - 2)));
}

/// Relative probabilities of the directions at one incidence, up to 1.
void append_incidence(std::vector<float>& values, std::size_t degree, const TableSide& side,
                      const LbnlSettings& settings, const LbnlLayout& layout) {
  const double incidence = std::min(static_cast<double>(degree) * core::kDegree, 0.5 * core::kPi - 1e-6);
  if (!side.has_directions(Leaving::reflected, incidence)) {
    values[layout.at(degree, cell(-incidence, kThetaStep_rad, layout.thetas),
                     cell(0.0, kPhiStep_rad, layout.phis))] = 1.0F;
    return;
  }
  const CubePoint shift = random_shift(settings.seed, degree, 3);
  float most = 0.0F;
  for (std::uint64_t k = 0; k < settings.rays; ++k) {
    const CubePoint at = cube_point(k, shift);
    const double half = 2.0 * at.v - 1.0;
    const optics::ExitAngles exit = side.direction(Leaving::reflected, incidence, at.u, std::abs(half));
    const double sine = std::sin(exit.polar), forward = sine * std::cos(exit.azimuth);
    const double sideways = std::copysign(sine * std::sin(exit.azimuth), half);
    const std::size_t theta = cell(std::atan2(-forward, std::cos(exit.polar)), kThetaStep_rad, layout.thetas),
                      phi = cell(std::asin(std::clamp(sideways, -1.0, 1.0)), kPhiStep_rad, layout.phis);
    most = std::max(most, values[layout.at(degree, theta, phi)] += 1.0F);
  }
  for (std::size_t theta = 0; theta < layout.thetas; ++theta)
    for (std::size_t phi = 0; phi < layout.phis; ++phi) values[layout.at(degree, theta, phi)] /= most;
}

/// Reflectance for diffuse light, and the least and greatest over the incidences.
struct Reflectances {
  double diffuse = 0.0, least = 1.0, greatest = 0.0;
};

Reflectances reflectances_of(const TableSide& side) {
  Reflectances of;
  constexpr int kSteps = 900;
  double weights = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 0.5 * core::kPi * (k + 0.5) / kSteps, weight = std::sin(angle) * std::cos(angle);
    const double reflectance = side.share(Leaving::reflected, angle);
    of.diffuse += weight * reflectance;
    weights += weight;
    of.least = std::min(of.least, reflectance);
    of.greatest = std::max(of.greatest, reflectance);
  }
  of.diffuse /= weights;
  return of;
}

}  // namespace

std::vector<std::string> write_lbnl(const std::filesystem::path& path, const optics::SurfaceTable& table,
                                    const LbnlSettings& settings) {
  const std::string extension = path.extension().string();
  if (extension != ".z" && extension != ".dat")
    throw core::InputError({{path.string()},
                            "a name that Geant4 does not use; expected X.z (its data from 2.2 on) or X.dat",
                            "Geant4 opens 21 names only, for example GroundTeflon.z"});
  const TableSide side(table, settings.side, settings.slice);
  double transmitted = 0.0;
  for (const optics::TableNode& node : side.nodes())
    transmitted = std::max(transmitted, side.share(Leaving::transmitted, node.incidence_rad));
  constexpr double kMostTransmitted = 1e-3;
  if (transmitted > kMostTransmitted)
    throw core::InputError(
        {{path.string()},
         fmt::format("up to {:.3g} of the light is transmitted, which a table of LBNL does not hold",
                     transmitted),
         "give the surface a reflector (scintray table stack), or write a Davis pair: --format davis"});
  const LbnlLayout layout;
  std::vector<float> values(layout.numbers(), 0.0F);
  for (std::size_t degree = 0; degree < layout.incidences; ++degree)
    append_incidence(values, degree, side, settings, layout);
  core::OutputFile file(path, extension == ".z" ? core::Container::zlib : core::Container::plain);
  fmt::memory_buffer text;
  for (const float value : values) fmt::format_to(std::back_inserter(text), "{:.5g}\n", value);
  file.write({text.data(), text.size()});
  file.commit();
  const Reflectances reflectances = reflectances_of(side);
  return {fmt::format(
              "give the surface REFLECTIVITY {:.4f}, its reflectance for diffuse light; the file has none, "
              "and that of the table, {:.4f} to {:.4f} by incidence, becomes one number",
              reflectances.diffuse, reflectances.least, reflectances.greatest),
          "directions become those of a grid of 4 by 5 deg: a mirror is spread over a cell",
          fmt::format("valid only for light in a medium of index {:g}, and for both sides of a skin surface",
                      side.index_before())};
}

}  // namespace scintray::tables
