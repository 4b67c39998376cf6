#include "scintray/optics/height_field.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/optics/birefringence.hpp"

namespace scintray::optics {

namespace {

constexpr int kLevelShift = 2;  // blocks grow by 4 x 4 from level to level

/// Smallest sine to the horizontal plane of a ray that is traced.
constexpr double kSmallestRise = 1e-6;

std::uint32_t block_count(std::uint32_t cells, int level) {
  const std::uint32_t size = 1u << (kLevelShift * level);
  return (cells + size - 1) / size;
}

void check_map(const std::vector<float>& heights, std::uint32_t columns, std::uint32_t rows, double pitch_x,
               double pitch_y) {
  core::Problems problems;
  if (columns < 2 || rows < 2)
    problems.add({}, "height field of " + std::to_string(columns) + " x " + std::to_string(rows) +
                         " points; expected at least 2 x 2");
  if (heights.size() != std::size_t{columns} * rows)
    problems.add({}, "height field with " + std::to_string(heights.size()) + " heights; expected " +
                         std::to_string(std::size_t{columns} * rows));
  if (!(pitch_x > 0.0 && pitch_y > 0.0 && std::isfinite(pitch_x) && std::isfinite(pitch_y)))
    problems.add({}, "height field pitch " + std::to_string(pitch_x) + " x " + std::to_string(pitch_y) +
                         " um; expected positive lengths");
  const auto bad = std::find_if(heights.begin(), heights.end(), [](float h) { return !std::isfinite(h); });
  if (bad != heights.end())
    problems.add({}, "height number " + std::to_string(bad - heights.begin()) + " is not finite",
                 "fill or crop missing pixels before tracing");
  problems.throw_if_any();
}

}  // namespace

HeightField::HeightField(std::vector<float> heights, std::uint32_t columns, std::uint32_t rows,
                         double pitch_x_um, double pitch_y_um)
    : stride_(std::size_t{columns} + 1),
      columns_(columns),
      rows_(rows),
      pitch_x_(pitch_x_um),
      pitch_y_(pitch_y_um) {
  check_map(heights, columns, rows, pitch_x_um, pitch_y_um);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  low_ = *low;
  high_ = *high;
  heights_.resize(stride_ * (rows + 1));
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i)
      heights_[j * stride_ + i] = heights[std::size_t{j % rows} * columns + i % columns];
  build_pyramid();
}

void HeightField::build_pyramid() {
  Level cells{columns_, {}};
  cells.blocks.reserve(std::size_t{columns_} * rows_);
  for (std::uint32_t j = 0; j < rows_; ++j)
    for (std::uint32_t i = 0; i < columns_; ++i) {
      const auto [low, high] =
          std::minmax({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
      cells.blocks.push_back({low, high});
    }
  pyramid_.push_back(std::move(cells));
  while (pyramid_.back().blocks.size() > 1) {
    const int level = static_cast<int>(pyramid_.size());
    const Level& finer = pyramid_.back();
    const std::uint32_t finer_rows = static_cast<std::uint32_t>(finer.blocks.size() / finer.columns);
    constexpr Extremes kNothing{std::numeric_limits<float>::infinity(),
                                -std::numeric_limits<float>::infinity()};
    Level coarser{block_count(columns_, level), {}};
    coarser.blocks.assign(std::size_t{coarser.columns} * block_count(rows_, level), kNothing);
    for (std::uint32_t j = 0; j < finer_rows; ++j)
      for (std::uint32_t i = 0; i < finer.columns; ++i) {
        const Extremes& from = finer.blocks[std::size_t{j} * finer.columns + i];
        Extremes& to = coarser.blocks[std::size_t{j >> kLevelShift} * coarser.columns + (i >> kLevelShift)];
        to = {std::min(to.low, from.low), std::max(to.high, from.high)};
      }
    pyramid_.push_back(std::move(coarser));
  }
}

/// State of one ray. Lateral coordinates are in cells; the cell and the triangle are kept as integers beside
/// them, so that the position does not depend on the rounding of a coordinate.
class HeightField::Walk {
 public:
  Walk(const HeightField& field, Ray& ray, Side side, double x_um, double y_um)
      : field_(field), ray_(ray), side_(side) {
    const double rise = side == Side::inside ? kSmallestRise : -kSmallestRise;
    if (ray.direction.z() * rise < kSmallestRise * kSmallestRise) {
      ray.direction.z() = rise;
      ray.direction.normalize();
    }
    place(x_um / field.pitch_x_, field.columns_, x_, i_);
    place(y_um / field.pitch_y_, field.rows_, y_, j_);
    z_ = side == Side::inside ? field.low_ : field.high_;
    level_ = static_cast<int>(field.pyramid_.size()) - 1;
    take_direction();
  }

  HeightFieldExit run(const IndexPair& index, core::Rng& rng) {
    for (std::uint64_t step = 0; step < kStepLimit; ++step) {
      if (has_left()) return finish();
      if (const Extremes& block = this->block(); clears(block)) {
        cross_block();
      } else if (level_ > 0) {
        --level_;
      } else {
        cross_cell(index, rng);
      }
    }
    exit_.cut = true;
    const double out = side_ == Side::outside ? 1.0 : -1.0;
    ray_.direction.z() = out * std::max(kSmallestRise, std::abs(ray_.direction.z()));
    ray_.direction.normalize();
    return finish();
  }

 private:
  static void place(double position, std::uint32_t cells, double& coordinate, std::uint32_t& cell) {
    coordinate = position - std::floor(position / cells) * cells;
    cell = std::min(static_cast<std::uint32_t>(std::max(0.0, coordinate)), cells - 1);
  }

  HeightFieldExit finish() {
    exit_.side = side_;
    // Back along the ray to the plane of extreme heights, which an empty block may reach beyond.
    const double plane = side_ == Side::outside ? field_.high_ : field_.low_;
    const double beyond = exit_.cut ? 0.0 : (z_ - plane) / dz_;
    exit_.x_um = (x_ - du_ * beyond) * field_.pitch_x_;
    exit_.y_um = (y_ - dv_ * beyond) * field_.pitch_y_;
    return exit_;
  }

  void take_direction() {
    du_ = ray_.direction.x() / field_.pitch_x_;
    dv_ = ray_.direction.y() / field_.pitch_y_;
    dz_ = ray_.direction.z();
    inverse_u_ = du_ == 0.0 ? 0.0 : 1.0 / du_;
    inverse_v_ = dv_ == 0.0 ? 0.0 : 1.0 / dv_;
  }

  bool has_left() const {
    return side_ == Side::outside ? z_ >= field_.high_ && dz_ > 0.0 : z_ <= field_.low_ && dz_ < 0.0;
  }

  const Extremes& block() const {
    const Level& level = field_.pyramid_[level_];
    const int shift = kLevelShift * level_;
    return level.blocks[std::size_t{j_ >> shift} * level.columns + (i_ >> shift)];
  }

  /// Path to the nearest vertical wall of the present block, and which wall it is.
  double path_to_wall(bool& through_x) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const int shift = kLevelShift * level_;
    const std::uint32_t i0 = (i_ >> shift) << shift, j0 = (j_ >> shift) << shift;
    const double wall_x = du_ > 0.0 ? std::min(i0 + (1u << shift), field_.columns_) : i0;
    const double wall_y = dv_ > 0.0 ? std::min(j0 + (1u << shift), field_.rows_) : j0;
    const double to_x = du_ == 0.0 ? kNever : std::max(0.0, (wall_x - x_) * inverse_u_);
    const double to_y = dv_ == 0.0 ? kNever : std::max(0.0, (wall_y - y_) * inverse_v_);
    through_x = to_x <= to_y;
    return through_x ? to_x : to_y;
  }

  /// True when the ray cannot cross the surface in a block before it leaves the block or the relief.
  bool clears(const Extremes& block) {
    path_ = path_to_wall(through_x_);
    const double end = z_ + dz_ * path_;
    return side_ == Side::outside ? std::min(z_, end) > block.high : std::max(z_, end) < block.low;
  }

  /// Moves the ray to the wall found by `clears` and into the next block.
  void cross_block() {
    if (!std::isfinite(path_)) {  // straight up or down
      z_ = side_ == Side::outside ? field_.high_ : field_.low_;
      return;
    }
    z_ += dz_ * path_;
    x_ += du_ * path_;
    y_ += dv_ * path_;
    pass_wall();
  }

  /// Crosses the wall at `path_`; moves up in the pyramid when the ray leaves the parent block.
  void pass_wall() {
    const std::uint32_t old_i = i_, old_j = j_;
    const int shift = kLevelShift * level_;
    if (through_x_) {
      step(du_ > 0.0, shift, field_.columns_, x_, i_);
      if (level_ > 0) clamp_to_block(y_, field_.rows_, shift, j_);
    } else {
      step(dv_ > 0.0, shift, field_.rows_, y_, j_);
      if (level_ > 0) clamp_to_block(x_, field_.columns_, shift, i_);
    }
    const int top = static_cast<int>(field_.pyramid_.size()) - 1;
    const int parent = kLevelShift * (level_ + 1);
    if (level_ < top && (((old_i ^ i_) | (old_j ^ j_)) >> parent) != 0) ++level_;
  }

  static void step(bool forward, int shift, std::uint32_t cells, double& coordinate, std::uint32_t& cell) {
    const std::uint32_t block_start = (cell >> shift) << shift;
    if (forward) {
      cell = block_start + (1u << shift);
      if (cell >= cells) cell = 0;
      coordinate = cell;
    } else {
      const std::uint32_t wall = block_start == 0 ? cells : block_start;
      cell = wall - 1;
      coordinate = wall;
    }
  }

  /// Finds the cell along the other axis after a block was skipped, without leaving the block.
  static void clamp_to_block(double coordinate, std::uint32_t cells, int shift, std::uint32_t& cell) {
    const std::uint32_t start = (cell >> shift) << shift;
    const std::uint32_t last = std::min(start + (1u << shift), cells) - 1;
    cell = coordinate <= start ? start : std::min(static_cast<std::uint32_t>(coordinate), last);
  }

  /// Plane of one of the two triangles of the present cell: height and slopes per cell.
  struct Plane {
    double height, slope_u, slope_v;
  };

  /// Plane of the present triangle, with its height at the position of the ray.
  Plane plane(bool upper) const {
    const double z10 = field_.vertex(i_ + 1, j_), z01 = field_.vertex(i_, j_ + 1);
    const double u = x_ - i_, v = y_ - j_;
    if (upper) {
      const double z11 = field_.vertex(i_ + 1, j_ + 1);
      const double slope_u = z11 - z01, slope_v = z11 - z10;
      return {z11 + slope_u * (u - 1.0) + slope_v * (v - 1.0), slope_u, slope_v};
    }
    const double z00 = field_.vertex(i_, j_);
    const double slope_u = z10 - z00, slope_v = z01 - z00;
    return {z00 + slope_u * u + slope_v * v, slope_u, slope_v};
  }

  /// Traces the ray through its cell, from facet to facet, until it crosses a wall or leaves.
  void cross_cell(const IndexPair& index, core::Rng& rng) {
    double past_diagonal = (x_ - i_) + (y_ - j_) - 1.0;
    bool upper = past_diagonal > 0.0 || (past_diagonal == 0.0 && du_ + dv_ > 0.0);
    bool on_surface = false;
    for (int pass = 0; pass < kPassesPerStep; ++pass) {
      path_ = path_to_wall(through_x_);
      past_diagonal = (x_ - i_) + (y_ - j_) - 1.0;
      const double towards = du_ + dv_;
      bool through_diagonal = false;
      if (upper ? towards < 0.0 : towards > 0.0) {
        const double path = std::max(0.0, -past_diagonal / towards);
        through_diagonal = path < path_;
        if (through_diagonal) path_ = path;
      }
      const Plane facet = plane(upper);
      const double rate = dz_ - facet.slope_u * du_ - facet.slope_v * dv_;
      const double above = on_surface ? 0.0 : z_ - facet.height;
      if (crosses_within(above, rate)) {
        advance(std::clamp(-above / rate, 0.0, path_));
        interact(facet, index, rng);
        if (has_left()) return;
        on_surface = true;
        continue;
      }
      if (!std::isfinite(path_)) {  // straight up or down, away from the surface
        z_ = side_ == Side::outside ? field_.high_ : field_.low_;
        return;
      }
      advance(path_);
      on_surface = false;
      if (!through_diagonal) {
        pass_wall();
        return;
      }
      upper = !upper;
    }
  }

  /// True when the height above the facet changes sign against the medium within `path_`.
  bool crosses_within(double above, double rate) const {
    if (side_ == Side::outside) return rate < 0.0 && above + rate * path_ < 0.0;
    return rate > 0.0 && above + rate * path_ > 0.0;
  }

  void advance(double path) {
    x_ += du_ * path;
    y_ += dv_ * path;
    z_ += dz_ * path;
  }

  void interact(const Plane& facet, const IndexPair& index, core::Rng& rng) {
    const core::Vec3 up =
        core::Vec3(-facet.slope_u / field_.pitch_x_, -facet.slope_v / field_.pitch_y_, 1.0).normalized();
    if (exit_.facet_interactions++ == 0)
      exit_.first_slope_rad = std::atan2(std::hypot(up.x(), up.y()), up.z());
    const core::Vec3 against = side_ == Side::outside ? up : core::Vec3(-up);
    if (interact_at_facet(ray_, against, index, side_, rng)) side_ = other(side_);
    take_direction();
  }

  /// Facets and diagonals passed in one cell before the step counter is read again.
  static constexpr int kPassesPerStep = 64;

  const HeightField& field_;
  Ray& ray_;
  Side side_;
  double x_ = 0, y_ = 0, z_ = 0;     // cells, cells, um
  double du_ = 0, dv_ = 0, dz_ = 0;  // per um of path
  double inverse_u_ = 0, inverse_v_ = 0;
  std::uint32_t i_ = 0, j_ = 0;
  int level_ = 0;
  double path_ = 0;
  bool through_x_ = false;
  HeightFieldExit exit_;
};

HeightFieldExit HeightField::follow(Ray& ray, Side side, double x_um, double y_um, const IndexPair& index,
                                    core::Rng& rng) const {
  return Walk(*this, ray, side, x_um, y_um).run(index, rng);
}

MapPlace HeightField::random_place(const core::Vec3& normal, const core::Vec3& along, core::Rng& rng) const {
  MapPlace place{map_frame(normal, along, rng), 0.0, 0.0};
  place.x_um = period_x_um() * rng.uniform();
  place.y_um = period_y_um() * rng.uniform();
  return place;
}

Side HeightField::scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index,
                          core::Rng& rng) const {
  MapPlace place = random_place(normal, core::Vec3::Zero(), rng);
  return scatter(ray, side, place, index, rng);
}

SurfaceOutcome HeightField::scatter(Ray& ray, Side side, const IndexPair& index,
                                    SurfaceInteraction& interaction) const {
  std::optional<MapPlace>& place = interaction.place;
  if (!place) place = random_place(interaction.normal, interaction.direction, interaction.rng);
  return outcome_on(scatter(ray, side, *place, index, interaction.rng));
}

Side HeightField::scatter(Ray& ray, Side side, MapPlace& place, const IndexPair& index,
                          core::Rng& rng) const {
  const core::Frame& map = place.map;
  Ray local{map.to_local(ray.direction), map.to_local(ray.polarisation), ray.ellipticity_rad,
            ray.keeps_phases};
  IndexPair local_index{index.inside, index.outside};
  std::optional<BirefringentOptics> inside, outside;  // in the frame of the map
  if (index.birefringent_inside)
    local_index.birefringent_inside = &inside.emplace(index.birefringent_inside->in_frame(map));
  if (index.birefringent_outside)
    local_index.birefringent_outside = &outside.emplace(index.birefringent_outside->in_frame(map));
  const HeightFieldExit exit = follow(local, side, place.x_um, place.y_um, local_index, rng);
  place.x_um = exit.x_um;
  place.y_um = exit.y_um;
  ray.direction = map.to_world(local.direction).normalized();
  ray.polarisation = map.to_world(local.polarisation);
  ray.ellipticity_rad = local.ellipticity_rad;
  // The rotation into the world frame may, by rounding, carry a grazing direction through the mean plane.
  const double out = exit.side == Side::outside ? 1.0 : -1.0;
  const double rise = out * ray.direction.dot(map.z);
  if (rise <= 0.0) ray.direction = (ray.direction + out * (kSmallestRise - rise) * map.z).normalized();
  return exit.side;
}

}  // namespace scintray::optics
