#include "scintray/tables/brdf_table.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/vec.hpp"

namespace scintray::tables {

namespace {

constexpr double kPolarStep_rad = 0.5 * core::kPi / (kBrdfPolar - 1);
constexpr double kTurnStep_rad = core::kPi / (kBrdfTurns - 1);

/// Integral of the linear function that is 1 at a node and 0 at its neighbours.
template <double (*Node)(int)>
double hat_integral(int node, int nodes) {
  return 0.5 * (Node(std::min(node + 1, nodes - 1)) - Node(std::max(node - 1, 0)));
}

/// A place with the density of that function.
template <double (*Node)(int)>
double hat_sample(int node, int nodes, core::Rng& rng) {
  const double here = Node(node), left = here - Node(std::max(node - 1, 0)),
               right = Node(std::min(node + 1, nodes - 1)) - here;
  const double u = rng.uniform() * (left + right);
  return u < left ? here - left * (1.0 - std::sqrt(1.0 - u / left))
                  : here + right * (1.0 - std::sqrt(std::max(0.0, 1.0 - (u - left) / right)));
}

/// Node below a place, and the share of the node above it.
struct BrdfCell {
  int low;
  double share;
};

BrdfCell polar_cell(double x) {
  const double polar = std::asin(std::sqrt(std::clamp(x, 0.0, 1.0)));
  int low = std::clamp(static_cast<int>(polar / kPolarStep_rad), 0, kBrdfPolar - 2);
  if (low > 0 && x < BrdfTable::polar_node(low)) --low;
  const double start = BrdfTable::polar_node(low), end = BrdfTable::polar_node(low + 1);
  return {low, std::clamp((x - start) / (end - start), 0.0, 1.0)};
}

BrdfCell turn_cell(double turn_rad) {
  const double at = std::clamp(turn_rad / kTurnStep_rad, 0.0, static_cast<double>(kBrdfTurns - 1));
  const int low = std::min(static_cast<int>(at), kBrdfTurns - 2);
  return {low, at - low};
}

}  // namespace

double BrdfTable::polar_node(int node) {
  static const std::array<double, kBrdfPolar> nodes = [] {
    std::array<double, kBrdfPolar> all{};
    for (int k = 0; k < kBrdfPolar; ++k)
      all[static_cast<std::size_t>(k)] = std::pow(std::sin(k * kPolarStep_rad), 2);
    all.back() = 1.0;
    return all;
  }();
  return nodes[static_cast<std::size_t>(node)];
}

double BrdfTable::turn_node(int node) { return node * kTurnStep_rad; }

std::array<BrdfTable::Corner, 8> BrdfTable::corners(double x_in, double x_out, double turn_rad) {
  const BrdfCell in = polar_cell(x_in), out = polar_cell(x_out), turn = turn_cell(turn_rad);
  std::array<Corner, 8> corners;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    corners[static_cast<std::size_t>(corner)] = {in.low + i, out.low + j, turn.low + k,
                                                 (i ? in.share : 1.0 - in.share) *
                                                     (j ? out.share : 1.0 - out.share) *
                                                     (k ? turn.share : 1.0 - turn.share)};
  }
  return corners;
}

double BrdfTable::node_integral(int b, int k) {
  return hat_integral<polar_node>(b, kBrdfPolar) * hat_integral<turn_node>(k, kBrdfTurns);
}

double BrdfTable::value_per_sr(double x_in, double x_out, double turn_rad) const {
  double sum = 0.0;
  for (const Corner& corner : corners(x_in, x_out, turn_rad))
    sum += corner.weight * at(corner.a, corner.b, corner.k);
  return sum;
}

double BrdfTable::reflectance(double x_in) const {
  const BrdfCell in = polar_cell(x_in);
  const auto low = static_cast<std::size_t>(in.low);
  return std::lerp(reflectance_[low], reflectance_[low + 1], in.share);
}

double BrdfTable::diffuse_reflectance() const {
  double sum = 0.0;
  for (int a = 0; a < kBrdfPolar; ++a)
    sum += hat_integral<polar_node>(a, kBrdfPolar) * reflectance_[static_cast<std::size_t>(a)];
  return sum;
}

void BrdfTable::sum_rows() {
  sums_.clear();
  for (int a = 0; a < kBrdfPolar; ++a) {
    double sum = 0.0;
    for (int b = 0; b < kBrdfPolar; ++b)
      for (int k = 0; k < kBrdfTurns; ++k) {
        sum += at(a, b, k) * node_integral(b, k);
        sums_.push_back(sum);
      }
    reflectance_[static_cast<std::size_t>(a)] = sum;
  }
}

void BrdfTable::finish() {
  constexpr int kMostRounds = 1000;
  std::array<double, kBrdfPolar> scale;
  scale.fill(1.0);
  sum_rows();
  for (int round = 0; round < kMostRounds; ++round) {
    bool exceeds = false;
    std::array<double, kBrdfPolar> step;
    for (std::size_t a = 0; a < kBrdfPolar; ++a) {
      // Half of the excess by the row, half by the columns that are scaled with it.
      step[a] = reflectance_[a] > 1.0 ? 1.0 / std::sqrt(reflectance_[a] * (1.0 + 1e-12)) : 1.0;
      exceeds = exceeds || reflectance_[a] > 1.0 + 1e-12;
      scale[a] *= step[a];
    }
    if (!exceeds) break;
    for (int a = 0; a < kBrdfPolar; ++a)
      for (int b = 0; b < kBrdfPolar; ++b)
        for (int k = 0; k < kBrdfTurns; ++k)
          at(a, b, k) *= step[static_cast<std::size_t>(a)] * step[static_cast<std::size_t>(b)];
    sum_rows();
  }
  const double least = *std::min_element(scale.begin(), scale.end());
  residuals_.scaled = 1.0 - least * least;
}

std::optional<BrdfTable::Sample> BrdfTable::sample(double x_in, core::Rng& rng) const {
  const BrdfCell in = polar_cell(x_in);
  const int row = in.low + (rng.uniform() < in.share ? 1 : 0);
  constexpr int kCells = kBrdfPolar * kBrdfTurns;
  const auto begin = sums_.begin() + row * kCells, end = begin + kCells;
  const auto found = std::upper_bound(begin, end, rng.uniform());
  if (found == end) return std::nullopt;
  const int cell = static_cast<int>(found - begin);
  const double x = hat_sample<polar_node>(cell / kBrdfTurns, kBrdfPolar, rng);
  return Sample{x, hat_sample<turn_node>(cell % kBrdfTurns, kBrdfTurns, rng)};
}

}  // namespace scintray::tables
