#include "scintray/scene_file/detail/round_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::scene_file {

namespace {

/// Largest number of flat sides around: with more, a side is narrower than the rounding of its corners in
/// single precision, which ray queries use.
constexpr int kMostSegments = 10'000;

int read_subdivisions(const config::TomlTable& table, int fallback, const std::string& what) {
  const std::int64_t subdivisions = table.integer("subdivisions", fallback);
  constexpr std::int64_t kMostSubdivisions = 250;
  table.expect("subdivisions", subdivisions >= 1 && subdivisions <= kMostSubdivisions,
               "a " + what + " of " + std::to_string(subdivisions) + " subdivisions",
               "give 1 (an icosahedron) to " + std::to_string(kMostSubdivisions) +
                   " (1,250,000 triangles); 16 is the default");
  return static_cast<int>(std::clamp<std::int64_t>(subdivisions, 1, kMostSubdivisions));
}

/// Keys for the thickness of a fibre.
enum class FibreSection { radius, side };
constexpr core::Word<FibreSection> kFibreSections[] = {{"radius", FibreSection::radius},
                                                       {"side", FibreSection::side}};

}  // namespace

double positive_length(const config::TomlTable& table, const std::string& key, const std::string& shape) {
  const double value = table.quantity(key, core::Dimension::length);
  table.expect(key, value > 0.0, "the " + key + " of a " + shape + " is not positive",
               "give a length above 0");
  return value;
}

int number_of_pieces(const config::TomlTable& table, const std::string& key, int fallback, int least,
                     const std::string& what) {
  const std::int64_t value = table.integer(key, fallback);
  table.expect(key, value >= least && value <= kMostSegments,
               "a " + what + " of " + std::to_string(value) + " " + key,
               "give " + std::to_string(least) + " or more (" + std::to_string(fallback) +
                   " is the default), up to " + std::to_string(kMostSegments));
  return static_cast<int>(std::clamp<std::int64_t>(value, least, kMostSegments));
}

SphereSpec read_sphere(const config::TomlTable& part) {
  const config::TomlTable table = part.table("sphere");
  SphereSpec sphere;
  sphere.where = table.where();
  sphere.radius_mm = positive_length(table, "radius", "sphere");
  sphere.subdivisions = read_subdivisions(table, sphere.subdivisions, "sphere");
  return sphere;
}

SpheroidSpec read_spheroid(const config::TomlTable& part) {
  const config::TomlTable table = part.table("spheroid");
  SpheroidSpec spheroid;
  spheroid.where = table.where();
  spheroid.radius_mm = positive_length(table, "radius", "spheroid");
  spheroid.half_height_mm = positive_length(table, "half_height", "spheroid");
  spheroid.subdivisions = read_subdivisions(table, spheroid.subdivisions, "spheroid");
  return spheroid;
}

TorusSpec read_torus(const config::TomlTable& part) {
  const config::TomlTable table = part.table("torus");
  TorusSpec torus;
  torus.where = table.where();
  torus.shape.radius = positive_length(table, "radius", "torus");
  torus.shape.tube_radius = positive_length(table, "tube_radius", "torus");
  table.expect("tube_radius", torus.shape.tube_radius < torus.shape.radius || !table.good("radius"),
               "a torus whose tube_radius is not below its radius",
               "give as radius that of the circle in the middle of the tube");
  torus.shape.segments = number_of_pieces(table, "segments", torus.shape.segments, 3, "torus");
  torus.shape.tube_segments = number_of_pieces(table, "tube_segments", torus.shape.tube_segments, 3, "torus");
  return torus;
}

TubeSpec read_tube(const config::TomlTable& part) {
  const config::TomlTable table = part.table("tube");
  TubeSpec tube;
  tube.where = table.where();
  tube.shape.outer_radius = positive_length(table, "outer_radius", "tube");
  tube.shape.inner_radius = positive_length(table, "inner_radius", "tube");
  table.expect("inner_radius",
               tube.shape.inner_radius < tube.shape.outer_radius || !table.good("outer_radius"),
               "a tube whose inner_radius is not below its outer_radius", "give the radius of the bore");
  tube.shape.height = positive_length(table, "height", "tube");
  tube.shape.segments = number_of_pieces(table, "segments", tube.shape.segments, 3, "tube");
  return tube;
}

LensSpec read_lens(const config::TomlTable& part) {
  const config::TomlTable table = part.table("lens");
  LensSpec lens;
  lens.where = table.where();
  lens.shape.diameter = positive_length(table, "diameter", "lens");
  lens.shape.thickness = positive_length(table, "thickness", "lens");
  const auto has_conic = [&](const std::string& key) {
    return table.has(key == "top_radius" ? "top_conic" : "bottom_conic");
  };
  for (const auto& [key, radius] : {std::pair{"bottom_radius", &mesh::LensShape::bottom_radius},
                                    {"top_radius", &mesh::LensShape::top_radius}}) {
    const std::optional<double> value = table.optional_quantity(key, core::Dimension::length);
    lens.shape.*radius = value.value_or(0.0);
    table.expect(
        key, !value || has_conic(key) || std::abs(*value) >= 0.5 * lens.shape.diameter,
        std::string(key) + ", a radius of curvature, is below half the diameter of the lens",
        "give half the diameter or more: above 0 convex, below 0 concave; leave it out for a flat face");
  }
  lens.shape.bottom_conic = table.number("bottom_conic", 0.0);
  lens.shape.top_conic = table.number("top_conic", 0.0);
  lens.shape.bottom_aspheric = table.numbers("bottom_aspheric", 0, false);
  lens.shape.top_aspheric = table.numbers("top_aspheric", 0, false);
  lens.shape.segments = number_of_pieces(table, "segments", lens.shape.segments, 3, "lens");
  return lens;
}

RevolvedSpec read_revolved(const config::TomlTable& part) {
  const config::TomlTable table = part.table("revolved");
  RevolvedSpec body;
  body.where = table.where();
  const std::vector<double> r = table.quantities("r", core::Dimension::length),
                            z = table.quantities("z", core::Dimension::length);
  if (table.good("r") && table.good("z")) {
    table.expect(
        "z", r.size() == z.size(),
        "a profile of " + std::to_string(r.size()) + " radii and " + std::to_string(z.size()) + " heights",
        "give one z for each r: the corners of the profile in order");
    table.expect("r", r.size() >= 3, "a profile of fewer than 3 corners",
                 "give the corners of half of the body's section, as r = [\"0 mm\", \"2 mm\", \"0 mm\"]");
    table.expect("r", std::all_of(r.begin(), r.end(), [](double value) { return value >= 0.0; }),
                 "a negative distance from the axis", "give radii of 0 and above");
    for (std::size_t i = 0; i < std::min(r.size(), z.size()); ++i) body.profile.push_back({r[i], z[i]});
  }
  const std::vector<double> smooth = table.numbers("smooth", 0, false);
  const double corners = static_cast<double>(body.profile.size());
  bool whole = smooth.size() % 2 == 0;
  for (const double number : smooth)
    whole = whole && number >= 0.0 && number < corners && number == std::floor(number);
  table.expect(
      "smooth", whole || !table.good("r") || !table.good("z"),
      "smooth ranges that are not pairs of corners of the profile",
      "give the numbers of the first and the last corner of each range, counted from 0, as smooth = [1, 9]");
  for (std::size_t i = 0; whole && i + 1 < smooth.size(); i += 2)
    body.smooth.push_back({static_cast<std::size_t>(smooth[i]), static_cast<std::size_t>(smooth[i + 1])});
  body.segments = number_of_pieces(table, "segments", body.segments, 3, "body of revolution");
  return body;
}

FibreSpec read_fibre(const config::TomlTable& part) {
  const config::TomlTable table = part.table("fibre");
  FibreSpec fibre;
  fibre.where = table.where();
  mesh::FibreShape& shape = fibre.shape;
  if (const core::Word<FibreSection>* section = table.one_of(kFibreSections, true))
    (section->value == FibreSection::radius ? shape.radius : shape.side) =
        positive_length(table, section->word, "fibre");
  std::size_t points = 0;
  std::array<std::vector<double>, 3> along;
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    along[axis] = table.quantities(kAxes[axis], core::Dimension::length, 0, false);
    points = std::max(points, along[axis].size());
  }
  table.expect(table.has("z") ? "z" : "x", points >= 2, "a fibre along fewer than 2 points",
               "give the points of its path, as x = [\"0 mm\", \"0 mm\"] and z = [\"0 mm\", \"100 mm\"]");
  for (std::size_t axis = 0; axis < 3; ++axis)
    table.expect(kAxes[axis], along[axis].empty() || along[axis].size() == points,
                 "a path of " + std::to_string(points) + " points with " +
                     std::to_string(along[axis].size()) + " values of " + kAxes[axis],
                 "give one for each point, or leave the key out where all are 0");
  for (std::size_t i = 0; i < points; ++i) {
    core::Vec3 point = core::Vec3::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (i < along[axis].size()) point[static_cast<int>(axis)] = along[axis][i];
    shape.path.push_back(point);
  }
  if (const auto bend = table.optional_quantity("bend_radius", core::Dimension::length)) {
    shape.bend_radius = *bend;
    table.expect("bend_radius", *bend > 0.0, "the bend_radius of a fibre is not positive",
                 "give a length above half of the fibre's thickness");
  }
  shape.segments = number_of_pieces(table, "segments", shape.segments, 3, "fibre");
  return fibre;
}

}  // namespace scintray::scene_file
