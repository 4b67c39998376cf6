#include "scintray/tables/bsdf_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/core/version.hpp"

namespace scintray::tables {

namespace {

/// Borders of the cells about `points`, rad: 0, halfway between neighbours, 180 deg.
std::vector<double> borders(const std::vector<double>& points) {
  std::vector<double> result{0.0};
  for (std::size_t k = 1; k < points.size(); ++k)
    result.push_back(0.5 * (points[k - 1] + points[k]) * core::kDegree);
  result.push_back(core::kPi);
  return result;
}

std::size_t cell_of(const std::vector<double>& borders, double angle) {
  const auto above = std::upper_bound(borders.begin() + 1, borders.end() - 1, angle);
  return static_cast<std::size_t>(above - borders.begin()) - 1;
}

/// Cells of light that leaves at `exit`, about the specular ray.
struct AboutSpecular {
  double radial, azimuth;
};

AboutSpecular about_specular(const optics::ExitAngles& exit, double specular) {
  const double sine = std::sin(exit.polar), x = sine * std::cos(exit.azimuth), z = std::cos(exit.polar);
  const double y = sine * std::sin(exit.azimuth);
  const double along = x * std::sin(specular) + z * std::cos(specular);
  const double to_normal = z * std::sin(specular) - x * std::cos(specular);
  return {std::atan2(std::hypot(to_normal, y), along), std::atan2(std::abs(y), to_normal)};
}

/// Values of one specular angle: shares of the cells over their projected solid angles.
void append_cells(Bsdf& bsdf, const TableSide& side, const BsdfSettings& settings, double incidence,
                  double specular) {
  const std::vector<double> azimuths = borders(bsdf.angles.azimuth), radials = borders(bsdf.angles.radial);
  const std::size_t columns = bsdf.angles.radial.size(), rows = bsdf.angles.azimuth.size();
  std::vector<double> shares(rows * columns, 0.0);
  const double total = side.share(settings.way, incidence);
  bsdf.total.push_back(total);
  if (total > 0.0 && side.has_directions(settings.way, incidence)) {
    const CubePoint shift = random_shift(settings.seed, bsdf.total.size(), 2);
    for (std::uint64_t k = 0; k < settings.rays; ++k) {
      const CubePoint at = cube_point(k, shift);
      const AboutSpecular place =
          about_specular(side.direction(settings.way, incidence, at.u, at.v), specular);
      shares[cell_of(azimuths, place.azimuth) * columns + cell_of(radials, place.radial)] +=
          total / static_cast<double>(settings.rays);
    }
  }
  std::vector<double> cells = projected_cells(bsdf.angles, specular);
  // At radial angle 0 all azimuths are one direction.
  double cap = 0.0, cap_share = 0.0;
  for (std::size_t row = 0; row < rows; ++row) {
    cap += cells[row * columns];
    cap_share += shares[row * columns];
  }
  for (std::size_t row = 0; row < rows; ++row) {
    cells[row * columns] = cap;
    shares[row * columns] = cap_share;
  }
  for (std::size_t k = 0; k < cells.size(); ++k)
    bsdf.values.push_back(cells[k] > 0.0 ? shares[k] / cells[k] : 0.0);
}

std::string row_text(const double* values, std::size_t count, const char* form) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k)
    text += fmt::format(fmt::runtime(form), values[k]) + (k + 1 < count ? "\t" : "\n");
  return text;
}

std::string angle_text(const char* name, const std::vector<double>& angles) {
  return fmt::format("{}\t{}\n", name, angles.size()) + row_text(angles.data(), angles.size(), "{:g}");
}

}  // namespace

BsdfAngles default_bsdf_angles() {
  BsdfAngles angles;
  for (int k = 0; k <= 17; ++k) angles.specular.push_back(5.0 * k);
  for (int k = 0; k <= 18; ++k) angles.azimuth.push_back(10.0 * k);
  angles.radial = {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.5};
  for (int k = 3; k <= 36; ++k) angles.radial.push_back(5.0 * k);
  return angles;
}

std::vector<double> projected_cells(const BsdfAngles& angles, double specular_rad, int parts) {
  const std::vector<double> azimuths = borders(angles.azimuth), radials = borders(angles.radial);
  std::vector<double> result;
  for (std::size_t row = 0; row + 1 < azimuths.size(); ++row)
    for (std::size_t column = 0; column + 1 < radials.size(); ++column) {
      const double wide = (azimuths[row + 1] - azimuths[row]) / parts;
      const double long_ = (radials[column + 1] - radials[column]) / parts;
      double sum = 0.0;
      for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j) {
          const double azimuth = azimuths[row] + (i + 0.5) * wide,
                       radial = radials[column] + (j + 0.5) * long_;
          const double cosine = std::cos(specular_rad) * std::cos(radial) +
                                std::sin(specular_rad) * std::sin(radial) * std::cos(azimuth);
          sum += std::max(0.0, cosine) * std::sin(radial);
        }
      result.push_back(2.0 * sum * wide * long_);
    }
  return result;
}

Bsdf bsdf_of(const optics::SurfaceTable& table, const BsdfSettings& settings) {
  const TableSide side(table, settings.side, settings.slice);
  Bsdf bsdf;
  bsdf.angles = settings.angles;
  bsdf.angles.specular.clear();
  const double ratio = settings.way == Leaving::reflected ? 1.0 : side.index_behind() / side.index_before();
  for (const double degrees : settings.angles.specular) {
    const double sine = ratio * std::sin(degrees * core::kDegree);
    if (sine > 1.0) continue;
    bsdf.angles.specular.push_back(degrees);
    append_cells(bsdf, side, settings, std::asin(sine), degrees * core::kDegree);
  }
  if (bsdf.angles.specular.empty())
    throw core::InputError({{}, "no specular angle at which light can leave", "give angles from 0 deg on"});
  return bsdf;
}

void write_bsdf(const std::filesystem::path& path, const Bsdf& bsdf, const optics::SurfaceTable& table,
                const BsdfSettings& settings) {
  const TableSide side(table, settings.side, settings.slice);
  const BsdfAngles& angles = bsdf.angles;
  core::OutputFile file(path, core::Container::plain);
  file.write(fmt::format("# ScintRay {}: light incident on index {:g} from index {:g}, calculated\n",
                         core::version(), side.index_behind(), side.index_before()));
  file.write("# values are means over cells with borders halfway between the angles\n");
  file.write("Source\tMeasured\nSymmetry\tPlaneSymmetrical\nSpectralContent\tMonochrome\n");
  file.write(settings.way == Leaving::reflected ? "ScatterType\tBRDF\n" : "ScatterType\tBTDF\n");
  file.write("SampleRotation\t1\n0\n");
  file.write(angle_text("AngleOfIncidence", angles.specular));
  file.write(angle_text("ScatterAzimuth", angles.azimuth));
  file.write(angle_text("ScatterRadial", angles.radial));
  file.write("\nMonochrome\nDataBegin\n");
  const std::size_t columns = angles.radial.size(), rows = angles.azimuth.size();
  for (std::size_t k = 0; k < angles.specular.size(); ++k) {
    file.write(fmt::format("TIS\t{:.6g}\n", bsdf.total[k]));
    for (std::size_t row = 0; row < rows; ++row)
      file.write(row_text(bsdf.values.data() + (k * rows + row) * columns, columns, "{:.6e}"));
  }
  file.write("DataEnd\n");
  file.commit();
}

}  // namespace scintray::tables
