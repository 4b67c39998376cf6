#include "scintray/tables/import_settings.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::tables {

namespace {

constexpr double kOutsideStep = 0.5 * core::kDegree;
constexpr double kStepGap = 1e-6;

optics::TableNode outside_node(double incidence_rad, const optics::IndexPair& index, FromOutside choice) {
  optics::TableNode node;
  node.incidence_rad = node.traced_incidence_rad = incidence_rad;
  const double ratio = index.outside / index.inside;
  const optics::FresnelCoefficients flat =
      optics::fresnel(std::cos(incidence_rad), index.outside, index.inside);
  // The sine of 90 deg is exactly 1, its cosine is not 0.
  const bool grazing = incidence_rad >= 0.5 * core::kPi;
  if (choice == FromOutside::mirror || choice == FromOutside::absorb) {
    node.reflectance = choice == FromOutside::mirror ? 1.0 : 0.0;
    node.absorptance = 1.0 - node.reflectance;
  } else {
    node.reflectance = grazing ? 1.0 : flat.unpolarised();
  }
  node.reflected = single_direction(incidence_rad, 0.0);
  if (choice == FromOutside::smooth)
    node.transmitted = single_direction(std::asin(std::min(1.0, ratio * std::sin(incidence_rad))), 0.0);
  return node;
}

}  // namespace

void check_indices(const optics::IndexPair& index) {
  for (const optics::Side side : {optics::Side::inside, optics::Side::outside})
    if (!(index.on(side) >= 1.0 && index.on(side) < 10.0))
      throw core::InputError({{},
                              std::string("a refractive index ") +
                                  (side == optics::Side::inside ? "inside" : "outside") + " of " +
                                  std::to_string(index.on(side)) + "; expected 1 to 10",
                              "give the indices of the two media, for example 1.82 and 1"});
}

optics::DirectionQuantiles single_direction(double polar_rad, double azimuth_rad) {
  optics::DirectionQuantiles result;
  result.polar.assign(optics::kPolarBins + 1, static_cast<float>(polar_rad));
  result.azimuth.assign(optics::kPolarBins * (optics::kAzimuthBins + 1), static_cast<float>(azimuth_rad));
  return result;
}

std::vector<optics::TableNode> outside_nodes(const optics::IndexPair& index, FromOutside choice) {
  std::vector<double> angles;
  for (int k = 0; k * kOutsideStep < 0.5 * core::kPi - 0.5 * kOutsideStep; ++k)
    angles.push_back(k * kOutsideStep);
  angles.push_back(0.5 * core::kPi);
  if (choice == FromOutside::smooth && index.inside < index.outside) {
    const double critical = std::asin(index.inside / index.outside);
    const auto after = std::lower_bound(angles.begin(), angles.end(), critical);
    if (*after - critical > kStepGap && critical - *(after - 1) > kStepGap) angles.insert(after, critical);
  }
  std::vector<optics::TableNode> nodes;
  for (const double angle : angles) nodes.push_back(outside_node(angle, index, choice));
  return nodes;
}

std::vector<optics::TableNode> stepped_nodes(const std::vector<double>& edges_rad,
                                             const std::vector<optics::TableNode>& steps) {
  std::vector<optics::TableNode> nodes;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    nodes.push_back(steps[k]);
    nodes.back().incidence_rad = nodes.back().traced_incidence_rad = edges_rad[k];
    nodes.push_back(steps[k]);
    const double end = k + 1 < steps.size() ? edges_rad[k + 1] - kStepGap : edges_rad[k + 1];
    nodes.back().incidence_rad = nodes.back().traced_incidence_rad = end;
  }
  return nodes;
}

}  // namespace scintray::tables
