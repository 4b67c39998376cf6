#pragma once
/// A periodic height field on which rays are traced one by one: the reference for surface tables.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scintray/optics/microsurface.hpp"

namespace scintray::optics {

/// Outcome of one ray on the height field.
struct HeightFieldExit {
  Side side = Side::inside;    ///< medium in which the ray left
  int facet_interactions = 0;  ///< number of facet interactions, at least 1
  double first_slope_rad = 0;  ///< angle between the first facet's normal and the mean normal
  double x_um = 0, y_um = 0;   ///< lateral position where it crossed the plane of extreme heights
  bool cut = false;            ///< released at the step limit, in its direction there
};

/// Height field on a periodic rectangular lattice; each cell is split along the diagonal from (i, j+1) to
/// (i+1, j) into two triangles. Units are um, but only ratios matter.
///
/// The height of a ray above the surface is a continuous, piecewise linear function of the path, and its sign
/// determines the medium of the ray; a crossing is a change of sign. Direction and medium are therefore
/// always consistent, and no ray is unclassified. Empty space is skipped through a pyramid of the extreme
/// heights of blocks of 4, 16, 64, ... cells.
class HeightField : public MicrosurfaceModel {
 public:
  HeightField() = default;
  /// @param heights  row-major, heights[j * columns + i] at (i * pitch_x, j * pitch_y), one period (the row
  ///        after the last is the first again); at least 2 x 2, all finite; pitches positive. Throws
  ///        InputError otherwise.
  HeightField(std::vector<float> heights, std::uint32_t columns, std::uint32_t rows, double pitch_x_um,
              double pitch_y_um);

  /// Traces a ray from outside the roughness, at the lateral position (x, y) um where it crosses the plane of
  /// extreme heights, until it leaves on either side. Directions are in the frame of the height map: x, y
  /// lateral, z the mean normal. Uniform (x, y) gives the projected-area weighting of a parallel beam. A ray
  /// whose sine to the horizontal plane is below 1e-6 is tilted to that sine on entry; after kStepLimit steps
  /// it is released at its position (`cut`).
  HeightFieldExit follow(Ray& ray, Side side, double x_um, double y_um, const IndexPair& index,
                         core::Rng& rng) const;

  /// The side on which the ray leaves, for a random position on the height map and a random azimuth of it
  /// about `normal`.
  Side scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index, core::Rng& rng) const;
  /// The side on which the ray leaves from a place on the height map; the place is moved to the point of
  /// exit.
  Side scatter(Ray& ray, Side side, MapPlace& place, const IndexPair& index, core::Rng& rng) const;
  /// The same at the place of the interaction, which is drawn when it has none yet.
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
  bool reciprocal() const override { return true; }
  bool birefringent() const override { return true; }
  /// A place drawn uniformly on the height map, with its x along `along` (see map_frame).
  MapPlace random_place(const core::Vec3& normal, const core::Vec3& along, core::Rng& rng) const;

  double period_x_um() const { return pitch_x_ * columns_; }
  double period_y_um() const { return pitch_y_ * rows_; }
  double low_um() const { return low_; }    ///< lowest vertex
  double high_um() const { return high_; }  ///< highest vertex
  std::uint32_t columns() const { return columns_; }
  std::uint32_t rows() const { return rows_; }

  /// Number of steps (triangles entered and blocks skipped) after which a ray is cut.
  static constexpr std::uint64_t kStepLimit = 20'000'000;

 private:
  struct Extremes {
    float low, high;
  };
  /// Extreme heights of the blocks of 4^level x 4^level cells; level 0 is single cells.
  struct Level {
    std::uint32_t columns = 0;
    std::vector<Extremes> blocks;
  };
  class Walk;

  void build_pyramid();
  float vertex(std::uint32_t i, std::uint32_t j) const { return heights_[j * stride_ + i]; }

  std::vector<float> heights_;  ///< (rows + 1) x (columns + 1): the first row and column repeated
  std::size_t stride_ = 0;
  std::uint32_t columns_ = 0, rows_ = 0;
  double pitch_x_ = 0, pitch_y_ = 0;
  double low_ = 0, high_ = 0;
  std::vector<Level> pyramid_;
};

}  // namespace scintray::optics
