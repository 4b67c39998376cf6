#pragma once
/// Mueller matrices of measured BRDFs: how the reflectance depends on polarisation, and how polarisation is
/// reflected.
///
/// Stokes parameters are those of SCATMECH (T. A. Germer; its StokesVector was read): with the components of
/// the field along s = k x n and p = k x s, of light of direction k at a face of normal n, 1: |s|^2 - |p|^2;
/// 2: 2 Re(s* p); 3: 2 Im(s* p), for fields that vary as exp(-i omega t).

#include <Eigen/Core>

#include <array>
#include <vector>

#include "scintray/tables/brdf_table.hpp"

namespace scintray::tables {

/// Mueller matrices beside the table of a BRDF, at its nodes: f M is linear between them, f the BRDF. They
/// obey reciprocity, M(out, in) = d M(in, out)^T d with d = diag(1, 1, 1, -1), and the mirror symmetry of an
/// isotropic surface, by which the elements between (0, 1) and (2, 3) are odd in the azimuth.
class MuellerTable {
 public:
  /// The matrices nearest to those of the points, which all have one: least squares on nodes every 10 deg of
  /// polar angle and 20 deg of azimuth, with second differences as a penalty (weight 1, chosen).
  static MuellerTable fitted(const std::vector<BrdfPoint>& points, const BrdfTable& brdf);

  /// Matrix over its element (0, 0), for an azimuth of either sign.
  Eigen::Matrix4d matrix(double x_in, double x_out, double turn_rad) const;
  /// Reflectance of light with a first Stokes parameter s1, of unit intensity; in [0, 1].
  double reflectance(double x_in, double s1) const;
  /// Bound on how much more than unpolarised light any light is reflected into any direction.
  double most_excess() const { return most_excess_; }
  /// Root mean square of the deviations from the points, over all elements.
  double rms() const { return rms_; }

 private:
  explicit MuellerTable(const BrdfTable& brdf) : brdf_(brdf) {}
  void finish();
  double measured_rms(const std::vector<BrdfPoint>& points) const;

  BrdfTable brdf_;
  /// Elements of the upper triangle without (0, 0), row by row, at the nodes of the BRDF; those below follow
  /// by reciprocity.
  std::array<std::vector<double>, 9> elements_;
  std::array<double, kBrdfPolar> by_polarisation_{};  ///< reflectance per s1
  double most_excess_ = 0.0, rms_ = 0.0;
};

}  // namespace scintray::tables
