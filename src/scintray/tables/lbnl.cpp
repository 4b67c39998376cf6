#include "scintray/tables/lbnl.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/core/version.hpp"

namespace scintray::tables {

namespace {

constexpr double kThetaStep = 4.0 * core::kDegree, kPhiStep = 5.0 * core::kDegree;
/// Number of directions that represent one incidence.
constexpr std::size_t kDirections = 20000;

/// One cell that Geant4's sampler can select.
struct Cell {
  optics::ExitAngles exit;
  double weight;
};

/// The cells of one incidence that leave the surface, and the weight of those that do not. The sampler
/// never selects the last theta and the last phi. At -90 deg of either the direction lies in the surface, and
/// the sampler tries again.
struct Cells {
  std::vector<Cell> leaving;
  double leaving_weight = 0.0, all_weight = 0.0;
};

Cells cells_of(const std::vector<float>& values, std::size_t incidence, const LbnlLayout& layout) {
  Cells cells;
  for (std::size_t i = 0; i + 1 < layout.thetas; ++i)
    for (std::size_t j = 0; j + 1 < layout.phis; ++j) {
      const double weight = values[layout.at(incidence, i, j)];
      cells.all_weight += weight;
      if (weight <= 0.0 || i == 0 || j == 0) continue;
      cells.leaving_weight += weight;
      const double theta = -0.5 * core::kPi + static_cast<double>(i) * kThetaStep;
      const double phi = -0.5 * core::kPi + static_cast<double>(j) * kPhiStep;
      // Positive theta is towards the incident light; phi is out of the plane of incidence.
      const double forward = -std::cos(phi) * std::sin(theta), sideways = std::sin(phi);
      const double cosine = std::cos(phi) * std::cos(theta);
      cells.leaving.push_back({{static_cast<float>(std::acos(std::min(1.0, cosine))),
                                static_cast<float>(std::abs(std::atan2(sideways, forward)))},
                               weight});
    }
  return cells;
}

/// Equally weighted directions in proportion to the cells' shares, by systematic sampling.
optics::DirectionQuantiles quantiles_of_cells(Cells& cells) {
  std::sort(cells.leaving.begin(), cells.leaving.end(), [](const Cell& a, const Cell& b) {
    return a.exit.polar != b.exit.polar ? a.exit.polar < b.exit.polar : a.exit.azimuth < b.exit.azimuth;
  });
  std::vector<optics::ExitAngles> sample;
  double passed = 0.0;
  for (const Cell& cell : cells.leaving) {
    passed += cell.weight / cells.leaving_weight;
    while (sample.size() < kDirections && static_cast<double>(sample.size()) + 0.5 <= passed * kDirections)
      sample.push_back(cell.exit);
  }
  return optics::quantiles_of(sample);
}

optics::TableNode node_of(const std::vector<float>& values, std::size_t incidence, const LbnlLayout& layout,
                          double reflectance) {
  Cells cells = cells_of(values, incidence, layout);
  const double leaving = cells.leaving_weight / cells.all_weight;
  optics::TableNode node;
  // Sum over trials: reflected and leaving, or reflected, not leaving, and repeated.
  node.reflectance = std::min(1.0, reflectance * leaving / (1.0 - reflectance * (1.0 - leaving)));
  node.absorptance = 1.0 - node.reflectance;
  node.reflected = quantiles_of_cells(cells);
  return node;
}

/// "polishedair", "etched_air" and the like: finishes that Geant4 lists and has no data for.
bool is_bare_finish(std::string name) {
  std::erase_if(name, [](char c) { return c == '_' || c == '-'; });
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* surface : {"polished", "etched", "ground"})
    if (name == surface || name == std::string(surface) + "air") return true;
  return false;
}

}  // namespace

std::vector<float> parse_lbnl(std::string_view content, const std::string& file, LbnlLayout layout) {
  std::vector<float> values = parse_numbers(content, file, {layout.numbers(), layout.numbers()});
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!(values[k] >= 0.0f && values[k] <= 1.0f))
      throw core::InputError({{file},
                              "value " + std::to_string(values[k]) + " as number " + std::to_string(k + 1) +
                                  ", at incidence " + std::to_string(k % layout.incidences) +
                                  " deg; expected 0 to 1, since Geant4 uses it as a probability",
                              "divide the table by its largest value, or check that it is a LUT of LBNL"});
  for (std::size_t incidence = 0; incidence < layout.incidences; ++incidence)
    if (cells_of(values, incidence, layout).leaving.empty())
      throw core::InputError({{file},
                              "no direction that leaves the surface at incidence " +
                                  std::to_string(incidence) + " deg; Geant4 would search for one without end",
                              "the file is damaged or of another kind"});
  return values;
}

optics::SurfaceTable lbnl_table(const std::vector<float>& values, const ImportSettings& settings,
                                const std::string& name) {
  check_indices(settings.index);
  if (!(settings.reflectance > 0.0 && settings.reflectance <= 1.0))
    throw core::InputError(
        {{},
         "a reflectance of " + std::to_string(settings.reflectance) + "; expected more than 0, at most 1",
         "the file holds none: give the REFLECTIVITY that the surface has in Geant4"});
  const LbnlLayout layout;
  std::vector<double> edges{0.0};
  std::vector<optics::TableNode> steps;
  for (std::size_t incidence = 0; incidence < layout.incidences; ++incidence) {
    steps.push_back(node_of(values, incidence, layout, settings.reflectance));
    edges.push_back(std::min((static_cast<double>(incidence) + 0.5) * core::kDegree, 0.5 * core::kPi));
  }
  optics::TableProvenance provenance;
  provenance.map = name + ", read as Geant4's LUT model reads it";
  provenance.preparation = "indices and reflectance " + std::to_string(settings.reflectance) +
                           " given on import; from outside, not in the file: " +
                           core::word_of(kFromOutsideWords, settings.from_outside) + "; errors unknown";
  provenance.version = core::version();
  return optics::SurfaceTable(settings.index, stepped_nodes(edges, steps),
                              outside_nodes(settings.index, settings.from_outside), std::move(provenance));
}

optics::SurfaceTable read_lbnl(const std::filesystem::path& path, const ImportSettings& settings) {
  const LbnlLayout layout;
  if (!std::filesystem::exists(path) && is_bare_finish(path.stem().string()))
    throw core::InputError(
        {{path.string()},
         "no such file: Geant4 lists the finishes polishedair, etchedair and groundair, but no "
         "data exist for them; its reader leaves such a table empty without a message",
         "take one of the 21 measured ones, for example GroundTeflon.z"});
  const std::string content = load_number_file(path, {layout.numbers(), layout.numbers()});
  return lbnl_table(parse_lbnl(content, path.string(), layout), settings, path.filename().string());
}

}  // namespace scintray::tables
