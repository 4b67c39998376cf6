#pragma once
/// One side of a surface table as a continuous function of the incidence angle, for the writers.

#include <optional>
#include <vector>

#include "scintray/optics/table.hpp"

namespace scintray::tables {

/// The side on which light leaves a surface.
enum class Leaving { reflected, transmitted };

/// Index of the slice of a table at one of its wavelengths (nm); without a wavelength, the only one.
/// InputError when the table has no such wavelength, or has several and none is requested.
std::size_t slice_at(const optics::SurfaceTable& table, std::optional<double> wavelength_nm);

/// Light incident from one side. Agrees with SurfaceTable::scatter, which draws at random; here the caller
/// supplies the coordinates in the distribution, so that points can be distributed uniformly.
class TableSide {
 public:
  /// `table` must outlive this; `slice` as from slice_at. Throws InputError for a table of a surface with
  /// direction, which is not a function of the incidence angle alone, and for one made reciprocal.
  TableSide(const optics::SurfaceTable& table, optics::Side side, std::size_t slice = 0);

  /// Reflectance or transmittance at an incidence (rad).
  double share(Leaving way, double incidence_rad) const;
  /// Absorptance at an incidence (rad).
  double absorptance(double incidence_rad) const;
  /// True when the table has directions for light that leaves this way at this incidence.
  bool has_directions(Leaving way, double incidence_rad) const;
  /// The direction at `u` of the polar angle's cumulative distribution and, given that, at `v` of
  /// |azimuth|'s; u, v in [0, 1). Requires has_directions.
  optics::ExitAngles direction(Leaving way, double incidence_rad, double u, double v) const;

  const std::vector<optics::TableNode>& nodes() const { return *nodes_; }
  /// Index of the medium on the side of the light, and on the other.
  double index_before() const { return before_; }
  double index_behind() const { return behind_; }

 private:
  struct Place {
    const optics::TableNode *low, *high;
    double share;
  };
  Place place(double incidence_rad) const;

  const std::vector<optics::TableNode>* nodes_;
  double before_, behind_;
};

/// Point `k` of a quasi-random sequence in the unit cube, shifted by `shift` (each in [0, 1)) modulo 1.
/// Source: J. H. Halton 1960, Numer. Math. 2, 84-90, bases 2, 3, 5; the shift is that of R. Cranley and
/// T. Patterson 1976, SIAM J. Numer. Anal. 13, 904-914.
struct CubePoint {
  double u, v, w;
};
CubePoint cube_point(std::uint64_t k, const CubePoint& shift);

/// A random shift for `cube_point`, from a seed and two numbers that identify its use.
CubePoint random_shift(std::uint64_t seed, std::uint64_t a, std::uint64_t b);

}  // namespace scintray::tables
