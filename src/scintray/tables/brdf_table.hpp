#pragma once
/// Measured BRDFs of isotropic surfaces, as a table that is exactly reciprocal and whose reflectance is at
/// most 1.

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/rng.hpp"

namespace scintray::tables {

inline constexpr int kBrdfPolar = 19;  ///< nodes of the polar angle, every 5 deg
inline constexpr int kBrdfTurns = 19;  ///< nodes of the azimuth between two directions, every 10 deg

/// One measured value.
struct BrdfPoint {
  double wavelength_nm = 0.0;
  double incidence_rad = 0.0, polar_rad = 0.0;  ///< of incident and reflected light, 0 to pi/2
  double turn_rad = 0.0;                        ///< azimuth between the two, 0 (forward) to pi
  double value_per_sr = 0.0;
  /// Mueller matrix over its element (0, 0), as of MuellerTable, for an azimuth above 0.
  std::optional<Eigen::Matrix4d> mueller = std::nullopt;
};

/// Deviations of a table from the measured values at one wavelength, relative to the measured value.
struct BrdfResiduals {
  std::size_t points = 0;
  double mean = 0.0, rms = 0.0, largest = 0.0;
  double scaled = 0.0;  ///< largest relative reduction of a value for a reflectance of at most 1; 0: none
};

/// A BRDF at one wavelength, f(x_in, x_out, turn) with x the sine squared of the polar angle: linear in each
/// of the three between nodes. Values are symmetric in the two directions, so that f is the same for the
/// reversed path (reciprocity), and the reflectance exceeds 1 at no angle of incidence.
class BrdfTable {
 public:
  /// Sine squared of the polar angle of a node in [0, kBrdfPolar), and azimuth (rad) of one in [0,
  /// kBrdfTurns).
  static double polar_node(int node);
  static double turn_node(int node);

  /// The table nearest to the points, which are at one wavelength: least squares of the relative deviations,
  /// with second differences of the nodes as a penalty, which interpolates over directions without
  /// measurements (weight 0.05 relative to the mean value, chosen); values
  /// below 0 become 0, and rows with a reflectance above 1 are scaled with their columns. Throws InputError
  /// for fewer than 20 points or 2 angles of incidence.
  static BrdfTable fitted(const std::vector<BrdfPoint>& points);
  /// The table of a function f(x_in, x_out, turn), 1/sr, that is symmetric in its first two arguments: its
  /// values at the nodes, scaled as above.
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

  /// Number of a node of all.
  static std::size_t node(int a, int b, int k) {
    return static_cast<std::size_t>((a * kBrdfPolar + b) * kBrdfTurns + k);
  }
  /// Nodes around two directions, and their weights.
  struct Corner {
    int a, b, k;
    double weight;
  };
  static std::array<Corner, 8> corners(double x_in, double x_out, double turn_rad);
  /// Value at a node, and its share of the reflectance at an incidence: the integral over directions of the
  /// function that is linear, 1 at the node and 0 at all others.
  double node_value(int a, int b, int k) const { return at(a, b, k); }
  static double node_integral(int b, int k);
  double node_reflectance(int a) const { return reflectance_[static_cast<std::size_t>(a)]; }

  /// BRDF, 1/sr; x in [0, 1], turn in [0, pi].
  double value_per_sr(double x_in, double x_out, double turn_rad) const;
  /// Reflectance at an incidence, at most 1.
  double reflectance(double x_in) const;
  /// Reflectance for diffuse light (Lambert's law).
  double diffuse_reflectance() const;
  const BrdfResiduals& residuals() const { return residuals_; }

  struct Sample {
    double x, turn_rad;
  };
  /// A direction with the density of the table; nothing: absorbed. The cell is drawn from cumulative sums of
  /// the values, the position in it from the linear functions of its nodes, without approximation.
  std::optional<Sample> sample(double x_in, core::Rng& rng) const;

 private:
  double& at(int a, int b, int k) { return values_[node(a, b, k)]; }
  double at(int a, int b, int k) const { return values_[node(a, b, k)]; }
  /// Enforces the conservation of energy, and computes the sums for sampling.
  void finish();
  void sum_rows();

  std::vector<double> values_ = std::vector<double>(kBrdfPolar * kBrdfPolar * kBrdfTurns, 0.0);
  std::vector<double> sums_;  ///< cumulative, per node of incidence
  std::array<double, kBrdfPolar> reflectance_{};
  BrdfResiduals residuals_;
};

class MuellerTable;

/// BRDFs at one or several wavelengths, in rising order.
struct MeasuredBrdf {
  std::vector<double> wavelengths_nm;
  std::vector<BrdfTable> tables;
  std::vector<MuellerTable> mueller;  ///< of the tables, where all points have matrices; else empty
};

/// The tables of points, one per wavelength; InputError, at `file`, as BrdfTable::fitted and where a table
/// deviates from its points by more than 10 % (rms, chosen: the values are then not reciprocal, or have a
/// lobe narrower than the nodes).
MeasuredBrdf fit_brdf(const std::vector<BrdfPoint>& points, const std::string& file);

}  // namespace scintray::tables
