#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/tables/davis.hpp"

namespace scintray::tables {

namespace {

/// Angles are written to 1e-5 rad; smaller ones would read as an empty pair.
constexpr float kLeastAngle = 1e-5f;

/// The incidences of one degree, weighted as diffuse light is incident on a surface: sin x cos, and by the
/// share of the light that leaves one way.
class Degree {
 public:
  Degree(const TableSide& side, Leaving way, int degree) : side_(side), way_(way) {
    double weight_sum = 0.0;
    for (int k = 0; k < kStrata; ++k) {
      const double angle = (degree + (k + 0.5) / kStrata) * core::kDegree;
      const double weight = std::sin(angle) * std::cos(angle);
      const bool known = side.has_directions(way, angle);
      weight_sum += weight;
      light_ += weight * side.share(way, angle);
      cumulative_[k + 1] = cumulative_[k] + (known ? weight * side.share(way, angle) : 0.0);
    }
    light_ /= weight_sum;
    begin_ = degree;
  }

  /// Mean share of the light that leaves this way.
  double light() const { return light_; }
  bool empty() const { return cumulative_.back() <= 0.0; }

  /// Polar angle and azimuth, negative on one side of the plane of incidence.
  optics::ExitAngles direction(const CubePoint& at) const {
    const double level = at.w * cumulative_.back();
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, level);
    const auto stratum = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
    const double width = cumulative_[stratum + 1] - cumulative_[stratum];
    const double part = width > 0.0 ? std::clamp((level - cumulative_[stratum]) / width, 0.0, 1.0) : 0.5;
    const double incidence = (begin_ + (static_cast<double>(stratum) + part) / kStrata) * core::kDegree;
    // The table holds |azimuth|: the halves of one coordinate are the two sides of the plane of incidence.
    const double side = 2.0 * at.v - 1.0;
    optics::ExitAngles exit = side_.direction(way_, incidence, at.u, std::abs(side));
    if (side < 0.0) exit.azimuth = -exit.azimuth;
    return exit;
  }

 private:
  static constexpr int kStrata = 64;
  const TableSide& side_;
  Leaving way_;
  double light_ = 0.0, begin_ = 0.0;
  std::array<double, kStrata + 1> cumulative_{};
};

/// The pairs of one block as text; "0 0" throughout when no light leaves this way.
void append_block(fmt::memory_buffer& text, const Degree& degree, Leaving way, const CubePoint& shift,
                  std::size_t samples) {
  for (std::size_t j = 0; j < samples; ++j) {
    if (degree.empty()) {
      fmt::format_to(std::back_inserter(text), "0 0\n");
      continue;
    }
    optics::ExitAngles exit = degree.direction(cube_point(j, shift));
    exit.polar = std::clamp(exit.polar, kLeastAngle, static_cast<float>(0.5 * core::kPi) - kLeastAngle);
    if (way == Leaving::transmitted) exit.polar = static_cast<float>(core::kPi) - exit.polar;
    fmt::format_to(std::back_inserter(text), "{:.5f} {:.5f}\n", exit.azimuth, exit.polar);
  }
}

void write_directions(core::OutputFile& file, const TableSide& side, const DavisSettings& settings) {
  fmt::memory_buffer text;
  for (const Leaving way : {Leaving::reflected, Leaving::transmitted}) {
    const bool reflected = way == Leaving::reflected;
    for (int block = 0; block < kDavisBlocks; ++block) {
      // No release reads the last blocks; filled, they keep readers with other rounding out of an
      // endless search.
      const int degree = std::min(reflected ? block + 1 : block, kDavisDegrees - 1);
      const CubePoint shift =
          random_shift(settings.seed, static_cast<std::uint64_t>(degree), reflected ? 0 : 1);
      text.clear();
      append_block(text, Degree(side, way, degree), way, shift, settings.layout.samples);
      file.write({text.data(), text.size()});
    }
  }
  file.write("0\n");
}

std::vector<std::string> losses(const TableSide& side, optics::Side from) {
  std::vector<std::string> result;
  result.push_back(
      fmt::format("valid only for light in a medium of index {:g} incident on one of index {:g}; the pair "
                  "does not state this",
                  side.index_before(), side.index_behind()));
  result.push_back(
      fmt::format("light from {} is not in the pair: use a border surface of one direction, since Geant4 "
                  "uses the pair of a skin surface for both",
                  from == optics::Side::inside ? "outside" : "inside"));
  result.push_back(
      "below 1 deg of incidence Geant4 reflects light back on its path and transmits the rest straight on");
  double absorbed = 0.0;
  for (const optics::TableNode& node : side.nodes())
    absorbed = std::max(absorbed, side.absorptance(node.incidence_rad));
  if (absorbed > 0.0)
    result.push_back(
        fmt::format("up to {:.4f} of the light is absorbed in the table; Geant4 transmits light that is not "
                    "reflected, or absorbs all of it when EFFICIENCY is above 0",
                    absorbed));
  return result;
}

}  // namespace

DavisFiles davis_files(const std::filesystem::path& directions) {
  constexpr std::string_view kEnd = "_LUT";
  const std::string stem = directions.stem().string(), extension = directions.extension().string();
  if (!stem.ends_with(kEnd) || stem.size() == kEnd.size() || (extension != ".z" && extension != ".dat"))
    throw core::InputError(
        {{directions.string()},
         "a name that Geant4 does not use; expected X_LUT.z (Geant4's data from 2.2 on) or X_LUT.dat",
         "Geant4 opens nine names only, for example Rough_LUT.z"});
  DavisFiles files{directions, directions, extension == ".z"};
  files.reflectances.replace_filename(stem + "R" + extension);
  return files;
}

std::vector<std::string> write_davis(const std::filesystem::path& directions,
                                     const optics::SurfaceTable& table, const DavisSettings& settings) {
  const DavisFiles files = davis_files(directions);
  const core::Container container = files.packed ? core::Container::zlib : core::Container::plain;
  const TableSide side(table, settings.side, settings.slice);
  core::OutputFile reflectances(files.reflectances, container);
  for (int degree = 0; degree < kDavisDegrees; ++degree)
    reflectances.write(fmt::format("{:.7g}\n", Degree(side, Leaving::reflected, degree).light()));
  core::OutputFile pairs(files.directions, container);
  write_directions(pairs, side, settings);
  reflectances.finish();
  pairs.commit();
  reflectances.commit();
  return losses(side, settings.side);
}

}  // namespace scintray::tables
