#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/core/version.hpp"
#include "scintray/tables/davis.hpp"

namespace scintray::tables {

namespace {

/// Rounding of angles written with few digits: 3.14 is pi and 1.57 is a right angle.
constexpr double kRounding = 2e-3;

std::string degrees(double angle_rad) { return std::to_string(angle_rad / core::kDegree) + " deg"; }

class PairCheck {
 public:
  PairCheck(const DavisPair& pair, const DavisFiles& files, Unreflected unreflected)
      : pair_(pair), files_(files), unreflected_(unreflected) {}

  void run() const {
    for (int degree = 0; degree < kDavisDegrees; ++degree) {
      const float r = pair_.reflectances[degree];
      if (!(r >= 0.0f && r <= 1.0f))
        refuse(files_.reflectances,
               "reflectance " + std::to_string(r) + " at " + std::to_string(degree) + " deg; expected 0 to 1",
               "the file is damaged or of another kind");
      // Degree 0 has no directions that Geant4 reads.
      if (degree == 0) continue;
      block(Leaving::reflected, degree, r > 0.0f);
      if (unreflected_ == Unreflected::transmitted) block(Leaving::transmitted, degree, r < 1.0f);
    }
  }

 private:
  void block(Leaving way, int degree, bool needed) const {
    const bool reflected = way == Leaving::reflected;
    const std::size_t begin = reflected ? pair_.layout.reflected(degree) : pair_.layout.transmitted(degree);
    bool found = false;
    for (std::size_t at = begin; at < begin + pair_.layout.block(); at += 2) {
      const double azimuth = pair_.directions[at], elevation = pair_.directions[at + 1];
      if (azimuth == 0.0 && elevation == 0.0) continue;
      found = true;
      const auto here = [&] {
        return std::string(reflected ? "reflected" : "transmitted") + " direction " +
               std::to_string((at - begin) / 2 + 1) + " of " + std::to_string(degree) + " deg";
      };
      if (!(std::abs(azimuth) <= core::kTwoPi + kRounding && elevation >= 0.0 &&
            elevation <= core::kPi + kRounding))
        refuse(files_.directions,
               here() + " has azimuth " + std::to_string(azimuth) + " and elevation " +
                   std::to_string(elevation) + " rad; expected -2 pi to 2 pi and 0 to pi",
               "angles are in radians, the azimuth first");
      const double beyond = reflected ? elevation - 0.5 * core::kPi : 0.5 * core::kPi - elevation;
      if (beyond > kRounding)
        refuse(files_.directions,
               here() + " has elevation " + degrees(elevation) +
                   ", on the other side of the surface; expected " +
                   (reflected ? "0 to 90 deg" : "90 to 180 deg"),
               reflected ? "Geant4 would send this reflected light through the surface"
                         : "Geant4 would send this transmitted light back; elevations are measured from the "
                           "normal on the side where the light comes from");
    }
    if (needed && !found)
      refuse(files_.directions,
             std::string("no ") + (reflected ? "reflected" : "transmitted") + " direction at " +
                 std::to_string(degree) + " deg, where the reflectance is " +
                 std::to_string(pair_.reflectances[degree]) + "; Geant4 would search for one without end",
             reflected ? "the two files are not of one pair, or damaged"
                       : "of a surface whose light is detected, import with `--unreflected absorbed`");
  }

  [[noreturn]] static void refuse(const std::filesystem::path& file, std::string what, std::string hint) {
    throw core::InputError({{file.string()}, std::move(what), std::move(hint)});
  }

  const DavisPair& pair_;
  const DavisFiles& files_;
  Unreflected unreflected_;
};

/// The pairs of one block as angles from the normal of the side where the light goes.
std::vector<optics::ExitAngles> exits(const DavisPair& pair, Leaving way, int degree) {
  const bool reflected = way == Leaving::reflected;
  const std::size_t begin = reflected ? pair.layout.reflected(degree) : pair.layout.transmitted(degree);
  std::vector<optics::ExitAngles> result;
  for (std::size_t at = begin; at < begin + pair.layout.block(); at += 2) {
    const double azimuth = pair.directions[at], elevation = pair.directions[at + 1];
    if (azimuth == 0.0 && elevation == 0.0) continue;
    const double polar = std::clamp(reflected ? elevation : core::kPi - elevation, 0.0, 0.5 * core::kPi);
    const double folded = std::min(std::abs(std::remainder(azimuth, core::kTwoPi)), core::kPi);
    result.push_back({static_cast<float>(polar), static_cast<float>(folded)});
  }
  return result;
}

/// Below 1 deg Geant4 reads no directions: light returns on its path, or continues straight.
std::vector<optics::TableNode> below_one_degree(optics::TableNode node, bool transmits) {
  std::vector<optics::TableNode> ends(2, node);
  for (int k = 0; k < 2; ++k) {
    ends[k].reflected = single_direction(k * core::kDegree, core::kPi);
    if (transmits) ends[k].transmitted = single_direction(k * core::kDegree, 0.0);
  }
  return ends;
}

std::vector<optics::TableNode> inside_nodes(const DavisPair& pair, Unreflected unreflected) {
  const bool transmits = unreflected == Unreflected::transmitted;
  std::vector<double> edges;
  std::vector<optics::TableNode> steps;
  for (int degree = 0; degree < kDavisDegrees; ++degree) {
    edges.push_back(degree * core::kDegree);
    optics::TableNode node;
    node.reflectance = pair.reflectances[degree];
    if (!transmits) node.absorptance = 1.0 - node.reflectance;
    if (degree > 0) {
      std::vector<optics::ExitAngles> back = exits(pair, Leaving::reflected, degree);
      node.rays = back.size();
      node.reflected = optics::quantiles_of(back);
      if (transmits) {
        std::vector<optics::ExitAngles> on = exits(pair, Leaving::transmitted, degree);
        node.transmitted = optics::quantiles_of(on);
      }
    }
    steps.push_back(std::move(node));
  }
  edges.push_back(0.5 * core::kPi);
  std::vector<optics::TableNode> nodes = stepped_nodes(edges, steps);
  const std::vector<optics::TableNode> first = below_one_degree(steps.front(), transmits);
  for (int k = 0; k < 2; ++k) {
    nodes[k].reflected = first[k].reflected;
    nodes[k].transmitted = first[k].transmitted;
  }
  return nodes;
}

}  // namespace

DavisPair parse_davis(std::string_view directions, std::string_view reflectances, const DavisFiles& files,
                      Unreflected unreflected, DavisLayout layout) {
  DavisPair pair;
  pair.layout = layout;
  pair.reflectances =
      parse_numbers(reflectances, files.reflectances.string(), {kDavisDegrees, kDavisDegrees});
  pair.directions =
      parse_numbers(directions, files.directions.string(), {layout.numbers() - 1, layout.numbers()});
  PairCheck(pair, files, unreflected).run();
  return pair;
}

optics::SurfaceTable davis_table(const DavisPair& pair, const ImportSettings& settings,
                                 const std::string& name) {
  check_indices(settings.index);
  optics::TableProvenance provenance;
  provenance.map = name + ", read as Geant4's LUTDAVIS model reads it";
  provenance.preparation =
      std::string("indices given on import; not reflected: ") +
      (settings.unreflected == Unreflected::transmitted ? "transmitted" : "absorbed") +
      "; from outside, not in the file: " + core::word_of(kFromOutsideWords, settings.from_outside) +
      "; errors unknown";
  provenance.version = core::version();
  return optics::SurfaceTable(settings.index, inside_nodes(pair, settings.unreflected),
                              outside_nodes(settings.index, settings.from_outside), std::move(provenance));
}

optics::SurfaceTable read_davis(const std::filesystem::path& directions, const ImportSettings& settings) {
  check_indices(settings.index);
  const DavisFiles files = davis_files(directions);
  const DavisLayout layout;
  const std::string reflectances = load_number_file(files.reflectances, {kDavisDegrees, kDavisDegrees});
  const std::string pairs = load_number_file(files.directions, {layout.numbers() - 1, layout.numbers()});
  const DavisPair pair = parse_davis(pairs, reflectances, files, settings.unreflected, layout);
  return davis_table(pair, settings, files.directions.filename().string());
}

}  // namespace scintray::tables
