#pragma once
/// Measured BRDFs of surfaces without direction, as a table that is exactly reciprocal and reflects at most
/// all light.

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/philox.hpp"

namespace scintray::tables {

inline constexpr int kBrdfPolar = 19;  ///< nodes of the polar angle, every 5 deg
inline constexpr int kBrdfTurns = 19;  ///< nodes of the azimuth between two directions, every 10 deg

/// One measured value.
struct BrdfPoint {
  double wavelength_nm = 0.0;
  double incidence_rad = 0.0, polar_rad = 0.0;  ///< of incident and reflected light, 0 to pi/2
  double turn_rad = 0.0;                        ///< azimuth from the plane of incidence, 0 forward, to pi
  double value_per_sr = 0.0;
};

/// How a table follows what was measured at one wavelength: deviations relative to the measured value.
struct BrdfResiduals {
  std::size_t points = 0;
  double mean = 0.0, rms = 0.0, largest = 0.0;
  double scaled = 0.0;  ///< largest reduction of a value by which the reflectance became at most 1; 0: none
};

/// A BRDF at one wavelength, f(x_in, x_out, turn) with x the sine squared of the polar angle: linear in each
/// of the three between nodes. Values are symmetric in the two directions, so that f is the same for light
/// that is sent back (reciprocity), and the reflectance of no direction exceeds 1.
class BrdfTable {
 public:
  /// Sine squared of the polar angle of a node, and azimuth (rad) of a node.
  static double polar_node(int node);
  static double turn_node(int node);

  /// The table next to the points, which are at one wavelength: least squares of the relative deviations,
  /// with second differences of the nodes (weight 0.05, relative to the mean value) that fill what was not
  /// measured; values below 0 become 0, and rows that reflect more than all light are scaled with their
  /// columns. Throws InputError for fewer than 20 points or 2 angles of incidence.
  static BrdfTable fitted(const std::vector<BrdfPoint>& points);
  /// The table of a function that is symmetric in its first two arguments, at the nodes, scaled as above.
  template <typename Function>
  static BrdfTable of(const Function& value_per_sr) {
    BrdfTable table;
    for (int a = 0; a < kBrdfPolar; ++a)
      for (int b = 0; b < kBrdfPolar; ++b)
        for (int k = 0; k < kBrdfTurns; ++k)
          table.at(a, b, k) = value_per_sr(polar_node(a), polar_node(b), turn_node(k));
    table.finish();
    return table;
  }

  /// BRDF, 1/sr; x in [0, 1], turn in [0, pi].
  double value_per_sr(double x_in, double x_out, double turn_rad) const;
  /// Share of the light of an incidence that is reflected.
  double reflectance(double x_in) const;
  /// Share of diffuse light that is reflected.
  double diffuse_reflectance() const;
  const BrdfResiduals& residuals() const { return residuals_; }

  struct Sample {
    double x, turn_rad;
  };
  /// A direction with the density of the table; nothing: absorbed. The cell is drawn from sums of the values,
  /// the place in it from the linear functions of its nodes: there is no approximation.
  std::optional<Sample> sample(double x_in, core::Rng& rng) const;

 private:
  double& at(int a, int b, int k) {
    return values_[static_cast<std::size_t>((a * kBrdfPolar + b) * kBrdfTurns + k)];
  }
  double at(int a, int b, int k) const {
    return values_[static_cast<std::size_t>((a * kBrdfPolar + b) * kBrdfTurns + k)];
  }
  /// Conservation of energy, and the sums that are sampled.
  void finish();
  void sum_rows();

  std::vector<double> values_ = std::vector<double>(kBrdfPolar * kBrdfPolar * kBrdfTurns, 0.0);
  std::vector<double> sums_;  ///< of shares, per node of incidence
  std::array<double, kBrdfPolar> reflectance_{};
  BrdfResiduals residuals_;
};

/// BRDFs at one or several wavelengths, rising.
struct MeasuredBrdf {
  std::vector<double> wavelengths_nm;
  std::vector<BrdfTable> tables;
};

/// The tables of points, one per wavelength; InputError, at `file`, as of BrdfTable::fitted and where a table
/// follows its points to more than 10 % (rms).
MeasuredBrdf fit_brdf(const std::vector<BrdfPoint>& points, const std::string& file);

}  // namespace scintray::tables
