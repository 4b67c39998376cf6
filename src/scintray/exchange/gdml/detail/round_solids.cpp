#include "scintray/exchange/gdml/detail/solid_reader.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/solids.hpp"

namespace scintray::exchange::gdml {

namespace {

using Outline = std::vector<Eigen::Vector2d>;

/// A solid of revolution, or one with curved walls.
class RoundSolid : public SolidReader {
 public:
  using SolidReader::SolidReader;

  /// Fewest segments of part of a torus or ball: two sections alone do not determine its surface, by which it
  /// is recognized.
  static constexpr int kFewestBent = 2;

  std::optional<mesh::TriMesh> make() const {
    struct Kind {
      std::string_view name;
      mesh::TriMesh (RoundSolid::*make)() const;
    };
    static constexpr Kind kKinds[] = {{"tube", &RoundSolid::tube},
                                      {"cutTube", &RoundSolid::cut_tube},
                                      {"cone", &RoundSolid::cone},
                                      {"polycone", &RoundSolid::polycone},
                                      {"genericPolycone", &RoundSolid::generic_polycone},
                                      {"polyhedra", &RoundSolid::polyhedra},
                                      {"genericPolyhedra", &RoundSolid::generic_polyhedra},
                                      {"sphere", &RoundSolid::sphere},
                                      {"orb", &RoundSolid::orb},
                                      {"torus", &RoundSolid::torus},
                                      {"ellipsoid", &RoundSolid::ellipsoid},
                                      {"eltube", &RoundSolid::elliptical_tube},
                                      {"elcone", &RoundSolid::elliptical_cone},
                                      {"paraboloid", &RoundSolid::paraboloid},
                                      {"hype", &RoundSolid::hyperboloid}};
    return make_one_of(*this, kKinds);
  }

 private:
  /// @param least_of_part  fewest segments of less than a full turn
  mesh::Turn turn(double radius_mm, int least_of_part = 1) const {
    constexpr double kRounding = 1e-9;
    mesh::Turn result;
    result.start_rad = angle("startphi");
    result.extent_rad = std::min(angle("deltaphi", core::kTwoPi), core::kTwoPi);
    if (result.extent_rad >= core::kTwoPi - kRounding) result.extent_rad = core::kTwoPi;
    const bool full = result.extent_rad == core::kTwoPi;
    result.segments = segments_about(radius_mm, result.extent_rad, full ? 3 : least_of_part);
    return result;
  }

  mesh::TriMesh revolve(const Outline& outline, int least_of_part = 1) const {
    double largest = 0.0;
    for (const Eigen::Vector2d& corner : outline) largest = std::max(largest, corner.x());
    return mesh::revolved(outline, turn(largest, least_of_part));
  }

  /// Corners on circles around the flats of a polyhedron's sides.
  mesh::TriMesh revolve_with_sides(Outline outline) const {
    const double sides = definitions_.number(solid_, "numsides");
    if (!(sides >= 1.0 && sides <= 1e5)) mesh::reject_shape("\"numsides\" is not between 1 and 100000");
    mesh::Turn result = turn(0.0);
    result.segments = static_cast<int>(sides);
    const double apothem = std::cos(0.5 * result.extent_rad / sides);
    if (!(apothem > 1e-3)) mesh::reject_shape("too few sides for the angle that they span");
    for (Eigen::Vector2d& corner : outline) corner.x() /= apothem;
    return mesh::revolved(outline, result);
  }

  mesh::TriMesh tube() const {
    const double inner = length("rmin"), outer = size("rmax"), half = 0.5 * size("z");
    if (!(inner >= 0.0 && inner < outer)) mesh::reject_shape("rmin is not between 0 and rmax");
    return revolve({{inner, -half}, {outer, -half}, {outer, half}, {inner, half}});
  }

  /// A tube whose ends are cut by planes through (0, 0, -half) and (0, 0, half) with the given outward
  /// normals.
  mesh::TriMesh cut_tube() const {
    const double half = 0.5 * size("z");
    const auto normal = [&](const char* x, const char* y, const char* z, double side) {
      const core::Vec3 n(definitions_.number(solid_, x, 0.0), definitions_.number(solid_, y, 0.0),
                         definitions_.number(solid_, z, 0.0));
      if (!(n.z() * side > 0.0)) mesh::reject_shape("the normal of an end does not point outwards");
      return n;
    };
    const core::Vec3 low = normal("lowX", "lowY", "lowZ", -1.0),
                     high = normal("highX", "highY", "highZ", 1.0);
    const auto height = [&](const core::Vec3& v, const core::Vec3& n, double z) {
      return z - (n.x() * v.x() + n.y() * v.y()) / n.z();
    };
    mesh::TriMesh mesh = tube();
    for (core::Vec3& v : mesh.vertices) {
      const double bottom = height(v, low, -half), top = height(v, high, half);
      if (!(bottom < top)) mesh::reject_shape("the planes of its ends meet within the tube");
      v.z() = v.z() < 0.0 ? bottom : top;
    }
    return mesh;
  }

  mesh::TriMesh cone() const {
    const double half = 0.5 * size("z");
    return revolve({{length("rmin1"), -half},
                    {length("rmax1"), -half},
                    {length("rmax2"), half},
                    {length("rmin2"), half}});
  }

  /// Outer radii upwards, then inner radii downwards.
  Outline z_planes() const {
    Outline outer, inner;
    definitions_.for_each_child(solid_, [&](Node plane) {
      const double z = unit() * definitions_.number(plane, "z");
      outer.emplace_back(unit() * definitions_.number(plane, "rmax"), z);
      inner.emplace_back(unit() * definitions_.number(plane, "rmin", 0.0), z);
    });
    outer.insert(outer.end(), inner.rbegin(), inner.rend());
    return outer;
  }

  Outline rz_points() const {
    Outline outline;
    definitions_.for_each_child(solid_, [&](Node point) {
      outline.emplace_back(unit() * definitions_.number(point, "r"),
                           unit() * definitions_.number(point, "z"));
    });
    return outline;
  }

  mesh::TriMesh polycone() const { return revolve(z_planes()); }
  mesh::TriMesh generic_polycone() const { return revolve(rz_points()); }
  mesh::TriMesh polyhedra() const { return revolve_with_sides(z_planes()); }
  mesh::TriMesh generic_polyhedra() const { return revolve_with_sides(rz_points()); }

  mesh::TriMesh shell(double inner, double outer, double theta_low, double theta_high) const {
    if (!(inner >= 0.0 && inner < outer))
      mesh::reject_shape("the inner radius is not between 0 and the outer");
    // theta counts from +z, the arc's angle from +r.
    Outline outline = mesh::arc({0.0, 0.0}, outer, outer, 0.5 * core::kPi - theta_high,
                                0.5 * core::kPi - theta_low, tessellation_);
    Outline back{{0.0, 0.0}};
    if (inner > 0.0)
      back = mesh::arc({0.0, 0.0}, inner, inner, 0.5 * core::kPi - theta_low, 0.5 * core::kPi - theta_high,
                       tessellation_);
    outline.insert(outline.end(), back.begin(), back.end());
    return revolve(outline, kFewestBent);
  }

  mesh::TriMesh sphere() const {
    const double low = angle("starttheta"), high = low + angle("deltatheta", core::kPi);
    if (!(low >= 0.0 && high > low)) mesh::reject_shape("starttheta or deltatheta is out of range");
    return shell(length("rmin"), size("rmax"), low, std::min(high, core::kPi));
  }

  mesh::TriMesh orb() const { return shell(0.0, size("r"), 0.0, core::kPi); }

  mesh::TriMesh torus() const {
    const double inner = length("rmin"), outer = size("rmax"), swept = size("rtor");
    if (!(swept > outer)) mesh::reject_shape("rtor is not above rmax: the torus would cross itself");
    Outline circle = mesh::arc({swept, 0.0}, outer, outer, 0.0, core::kTwoPi, tessellation_);
    circle.pop_back();
    if (inner > 0.0 && turn(swept, kFewestBent).extent_rad < core::kTwoPi)
      return hollow_bend(inner, outer, swept);
    mesh::TriMesh body = revolve(circle, kFewestBent);
    if (inner <= 0.0) return body;
    Outline hole = mesh::arc({swept, 0.0}, inner, inner, 0.0, core::kTwoPi, tessellation_);
    hole.pop_back();
    mesh::TriMesh hollow = mesh::revolved(hole, turn(swept + outer));
    mesh::reverse_orientation(hollow);
    return mesh::joined(body, hollow);
  }

  /// Part of a hollow torus.
  mesh::TriMesh hollow_bend(double inner, double outer, double swept) const {
    const mesh::Turn along = turn(swept + outer, kFewestBent);
    const int around = mesh::arc_segments(outer, core::kTwoPi, tessellation_, 3);
    return mesh::mapped_cube({along.segments, around, 1}, {false, true, false}, [&](const core::Vec3& at) {
      const double phi = along.start_rad + at.x() * along.extent_rad, angle = core::kTwoPi * at.y();
      const double r = inner + at.z() * (outer - inner), rho = swept + r * std::cos(angle);
      return core::Vec3(rho * std::cos(phi), rho * std::sin(phi), r * std::sin(angle));
    });
  }

  mesh::TriMesh ellipsoid() const {
    const double a = size("ax"), b = size("by"), c = size("cz");
    double low = length("zcut1"), high = length("zcut2");
    if (low == 0.0 && high == 0.0) low = -c, high = c;  // both left out: no cuts
    low = std::max(low, -c);
    high = high == 0.0 ? c : std::min(high, c);
    if (!(low < high)) mesh::reject_shape("zcut1 is not below zcut2");
    Outline outline =
        mesh::arc({0.0, 0.0}, std::max(a, b), c, std::asin(low / c), std::asin(high / c), tessellation_);
    outline.emplace_back(0.0, high);
    outline.emplace_back(0.0, low);
    mesh::TriMesh mesh = revolve(outline);
    for (core::Vec3& v : mesh.vertices) v = v.cwiseProduct(core::Vec3(a, b, std::max(a, b)) / std::max(a, b));
    return mesh;
  }

  std::vector<core::Vec3> ellipse(double a, double b, double z) const {
    std::vector<core::Vec3> corners;
    const int segments = std::max(3, mesh::arc_segments(std::max(a, b), core::kTwoPi, tessellation_));
    for (int i = 0; i < segments; ++i)
      corners.emplace_back(a * std::cos(core::kTwoPi * i / segments),
                           b * std::sin(core::kTwoPi * i / segments), z);
    return corners;
  }

  mesh::TriMesh elliptical_tube() const {
    const double a = size("dx"), b = size("dy"), half = size("dz");
    return mesh::lofted({ellipse(a, b, -half), ellipse(a, b, half)});
  }

  /// dx and dy are slopes: half axes a length of z below the apex at zmax.
  mesh::TriMesh elliptical_cone() const {
    const double a = definitions_.number(solid_, "dx"), b = definitions_.number(solid_, "dy"),
                 apex = size("zmax"), cut = size("zcut");
    const double top = std::min(cut, apex);
    std::vector<core::Vec3> low = ellipse(a * (apex + cut), b * (apex + cut), -cut), high;
    const double share = (apex - top) / (apex + cut);
    for (const core::Vec3& corner : low) high.emplace_back(share * corner.x(), share * corner.y(), top);
    if (share > 0.0) return mesh::lofted({low, high});
    std::vector<std::vector<core::Vec3>> facets{{low.rbegin(), low.rend()}};
    for (std::size_t i = 0; i < low.size(); ++i)
      facets.push_back({low[i], low[(i + 1) % low.size()], core::Vec3(0.0, 0.0, apex)});
    return from_facets(facets);
  }

  /// Corners along a meridian r(z) from -half to half.
  template <typename Radius>
  Outline meridian(double half, Radius radius) const {
    const int steps = std::max(8, mesh::arc_segments(std::max(radius(half), half), core::kPi, tessellation_));
    Outline outline;
    for (int i = 0; i <= steps; ++i) {
      const double z = half * (2.0 * i / steps - 1.0);
      outline.emplace_back(radius(z), z);
    }
    return outline;
  }

  mesh::TriMesh paraboloid() const {
    const double low = length("rlo"), high = size("rhi"), half = size("dz");
    if (!(low >= 0.0 && low < high)) mesh::reject_shape("rlo is not between 0 and rhi");
    Outline outline = meridian(half, [&](double z) {
      return std::sqrt(0.5 * (low * low * (1.0 - z / half) + high * high * (1.0 + z / half)));
    });
    outline.emplace_back(0.0, half);
    outline.emplace_back(0.0, -half);
    return revolve(outline);
  }

  mesh::TriMesh hyperboloid() const {
    const double half = 0.5 * size("z"), inner = length("rmin"), outer = size("rmax");
    const double inner_slope = std::tan(angle("inst")), outer_slope = std::tan(angle("outst"));
    const auto radius = [](double waist, double slope) {
      return [waist, slope](double z) { return std::hypot(waist, slope * z); };
    };
    Outline outline = meridian(half, radius(outer, outer_slope));
    const Outline hole = meridian(half, radius(inner, inner_slope));
    for (std::size_t i = 0; i < std::min(outline.size(), hole.size()); ++i)
      if (!(radius(inner, inner_slope)(outline[i].y()) < outline[i].x()))
        mesh::reject_shape("the inner wall touches the outer");
    outline.insert(outline.end(), hole.rbegin(), hole.rend());
    return revolve(outline);
  }
};

}  // namespace

std::optional<mesh::TriMesh> make_round_solid(Node solid, const Definitions& definitions,
                                              const mesh::Tessellation& tessellation) {
  return RoundSolid(solid, definitions, tessellation).make();
}

}  // namespace scintray::exchange::gdml
