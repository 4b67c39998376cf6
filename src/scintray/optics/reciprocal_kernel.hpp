#pragma once
/// An exactly reciprocal kernel of scattering, made from a lossless table.

#include <cstdint>
#include <vector>

#include "scintray/optics/microsurface.hpp"

namespace scintray::optics {

/// Kernel of scattering between bins of direction that hold equal shares of diffuse light, symmetric under
/// reversal.
///
/// A direction is binned by side, by sin^2 of its polar angle (kPolar equal steps: each holds the same share
/// of Lambertian light) and, between two directions, by |difference of azimuth| (kTurns equal steps). The
/// flux from bin a to bin b under isotropic light, n_a^2 times the share of a's light that leaves into b, is
/// the same as that from b to a (reciprocity), and all flux into a bin is what leaves it (equilibrium).
///
/// Traced shares satisfy both within their statistics. They are averaged with their transpose and then
/// scaled, f_ab -> d_a f_ab d_b, until every row sums to its bin's flux: symmetric scaling keeps symmetry (R.
/// Sinkhorn and P. Knopp 1967, Pacific J. Math. 21, 343). Directions are continuous, uniform within bins.
class ReciprocalKernel {
 public:
  static constexpr int kPolar = 90;
  static constexpr int kTurns = 36;
  static constexpr int kStates = 2 * kPolar;  ///< inside, then outside

  /// Indices of the state and of the target of a direction; `sine2` in [0, 1], `turn` in [0, pi] (rad).
  static int state(Side side, double sine2);
  static int target(int to_state, double turn);

  /// Deviation of the traced table from reciprocity.
  struct Report {
    double chi2 = 0.0;        ///< of all pairs of directions with counts, against their reverse
    std::uint64_t pairs = 0;  ///< degrees of freedom of chi2
    double diffuse_inside = 0.0, diffuse_inside_error = 0.0;    ///< n1^2 (1 - R12), diffuse light
    double diffuse_outside = 0.0, diffuse_outside_error = 0.0;  ///< n2^2 (1 - R21)
    double largest_scaling = 0.0;                               ///< largest |d_a - 1| required by equilibrium
  };

  /// The kernel of rays counted by state and target, counts[state * (kStates * kTurns) + target]; every state
  /// was illuminated with `rays` rays, uniform in sin^2 within its bin. Throws InputError when a state has
  /// another number.
  static ReciprocalKernel from_counts(const IndexPair& index, const std::vector<std::uint32_t>& counts,
                                      std::uint64_t rays, Report& report);
  /// The kernel of the shares in a file, as returned by shares(). Throws InputError when they are not those
  /// of a kernel.
  explicit ReciprocalKernel(std::vector<float> shares);

  /// Share of light from each state into each target; the sum of each row is 1.
  const std::vector<float>& shares() const { return shares_; }
  /// Reflectance of a state: the share of its light that leaves on the same side.
  double reflectance(Side side, double sine2) const;

  struct Sample {
    Side side;
    double sine2, turn;
  };
  Sample sample(Side side, double sine2, core::Rng& rng) const;

 private:
  std::vector<float> shares_;
  std::vector<double> cumulative_;
};

}  // namespace scintray::optics
