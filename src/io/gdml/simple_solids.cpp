#include "scintray/io/gdml/simple_solids.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/polygon.hpp"
#include "scintray/mesh/primitives.hpp"
#include "scintray/mesh/shape_error.hpp"
#include "scintray/mesh/solids.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::gdml {

namespace {

using Outline = std::vector<Eigen::Vector2d>;

/// Reads one solid.
class SolidMaker {
 public:
  SolidMaker(Node solid, const Definitions& definitions, const Tessellation& tessellation)
      : solid_(solid), definitions_(definitions), tessellation_(tessellation) {}

  std::optional<TriMesh> make() const {
    struct Kind {
      std::string_view name;
      TriMesh (SolidMaker::*make)() const;
    };
    static constexpr Kind kKinds[] = {{"box", &SolidMaker::box},
                                      {"tube", &SolidMaker::tube},
                                      {"cone", &SolidMaker::cone},
                                      {"trd", &SolidMaker::trd},
                                      {"trap", &SolidMaker::trap},
                                      {"para", &SolidMaker::para},
                                      {"arb8", &SolidMaker::arb8},
                                      {"tet", &SolidMaker::tet},
                                      {"tessellated", &SolidMaker::tessellated},
                                      {"xtru", &SolidMaker::xtru},
                                      {"polycone", &SolidMaker::polycone},
                                      {"genericPolycone", &SolidMaker::generic_polycone},
                                      {"polyhedra", &SolidMaker::polyhedra},
                                      {"genericPolyhedra", &SolidMaker::generic_polyhedra},
                                      {"sphere", &SolidMaker::sphere},
                                      {"orb", &SolidMaker::orb},
                                      {"torus", &SolidMaker::torus},
                                      {"ellipsoid", &SolidMaker::ellipsoid},
                                      {"eltube", &SolidMaker::elliptical_tube},
                                      {"elcone", &SolidMaker::elliptical_cone},
                                      {"paraboloid", &SolidMaker::paraboloid},
                                      {"hype", &SolidMaker::hyperboloid}};
    for (const Kind& kind : kKinds)
      if (kind.name == solid_.name()) return (this->*kind.make)();
    return std::nullopt;
  }

 private:
  double length(const char* attribute, double fallback = 0.0) const {
    return definitions_.length(solid_, attribute, fallback);
  }
  /// A length that must be there and above 0.
  double size(const char* attribute) const {
    const double value = length(attribute);
    if (!(value > 0.0)) reject_shape(std::string("\"") + attribute + "\" is missing or not above 0");
    return value;
  }
  double angle(const char* attribute, double fallback = 0.0) const {
    return definitions_.angle(solid_, attribute, fallback);
  }
  double unit() const { return definitions_.number(solid_, "lunit", 1.0); }

  Turn turn(double radius_mm) const {
    constexpr double kRounding = 1e-9;
    Turn result;
    result.start_rad = angle("startphi");
    result.extent_rad = std::min(angle("deltaphi", kTwoPi), kTwoPi);
    if (result.extent_rad >= kTwoPi - kRounding) result.extent_rad = kTwoPi;
    const bool full = result.extent_rad == kTwoPi;
    const int needed = arc_segments(radius_mm, result.extent_rad, tessellation_, 1);
    result.segments = arc_segments(0.0, result.extent_rad, tessellation_, full ? 3 : 1);
    while (result.segments < needed) result.segments *= 2;
    return result;
  }

  TriMesh revolve(const Outline& outline) const {
    double largest = 0.0;
    for (const Eigen::Vector2d& corner : outline) largest = std::max(largest, corner.x());
    return revolved(outline, turn(largest));
  }

  /// Corners on circles around the flats of a polyhedron's sides.
  TriMesh revolve_with_sides(Outline outline) const {
    const double sides = definitions_.number(solid_, "numsides");
    if (!(sides >= 1.0 && sides <= 1e5)) reject_shape("\"numsides\" is not between 1 and 100000");
    Turn result = turn(0.0);
    result.segments = static_cast<int>(sides);
    const double apothem = std::cos(0.5 * result.extent_rad / sides);
    if (!(apothem > 1e-3)) reject_shape("too few sides for the angle that they span");
    for (Eigen::Vector2d& corner : outline) corner.x() /= apothem;
    return revolved(outline, result);
  }

  TriMesh box() const {
    const Vec3 half = 0.5 * Vec3(size("x"), size("y"), size("z"));
    return make_box(-half, half);
  }

  TriMesh tube() const {
    const double inner = length("rmin"), outer = size("rmax"), half = 0.5 * size("z");
    if (!(inner >= 0.0 && inner < outer)) reject_shape("rmin is not between 0 and rmax");
    return revolve({{inner, -half}, {outer, -half}, {outer, half}, {inner, half}});
  }

  TriMesh cone() const {
    const double half = 0.5 * size("z");
    return revolve({{length("rmin1"), -half},
                    {length("rmax1"), -half},
                    {length("rmax2"), half},
                    {length("rmin2"), half}});
  }

  static std::vector<Vec3> rectangle(double half_x, double half_y, double z) {
    return {{-half_x, -half_y, z}, {half_x, -half_y, z}, {half_x, half_y, z}, {-half_x, half_y, z}};
  }

  TriMesh trd() const {
    const double half = 0.5 * size("z");
    return lofted({rectangle(0.5 * length("x1"), 0.5 * length("y1"), -half),
                   rectangle(0.5 * length("x2"), 0.5 * length("y2"), half)});
  }

  struct Trapezoid {
    double half_y, half_x_low, half_x_high, tan_alpha;
  };

  /// Trapezoids at -half and +half whose centres lie along (theta, phi).
  TriMesh slanted(double half, double theta, double phi, const Trapezoid& bottom,
                  const Trapezoid& top) const {
    const Vec3 shift = half * Vec3(std::tan(theta) * std::cos(phi), std::tan(theta) * std::sin(phi), 1.0);
    const auto outline = [](const Trapezoid& t, const Vec3& centre) {
      const double slant = t.half_y * t.tan_alpha;
      return std::vector<Vec3>{centre + Vec3(-slant - t.half_x_low, -t.half_y, 0.0),
                               centre + Vec3(-slant + t.half_x_low, -t.half_y, 0.0),
                               centre + Vec3(slant + t.half_x_high, t.half_y, 0.0),
                               centre + Vec3(slant - t.half_x_high, t.half_y, 0.0)};
    };
    return lofted({outline(bottom, -shift), outline(top, shift)});
  }

  TriMesh trap() const {
    return slanted(0.5 * size("z"), angle("theta"), angle("phi"),
                   {0.5 * size("y1"), 0.5 * length("x1"), 0.5 * length("x2"), std::tan(angle("alpha1"))},
                   {0.5 * size("y2"), 0.5 * length("x3"), 0.5 * length("x4"), std::tan(angle("alpha2"))});
  }

  TriMesh para() const {
    const Trapezoid side{0.5 * size("y"), 0.5 * size("x"), 0.5 * size("x"), std::tan(angle("alpha"))};
    return slanted(0.5 * size("z"), angle("theta"), angle("phi"), side, side);
  }

  /// Its walls may be twisted: straight lines between corresponding points of both ends.
  TriMesh arb8() const {
    constexpr int kSlices = 16;
    const double half = size("dz");
    std::vector<Vec3> bottom, top;
    for (int corner = 1; corner <= 8; ++corner) {
      const std::string name = "v" + std::to_string(corner);
      (corner <= 4 ? bottom : top)
          .emplace_back(length((name + "x").c_str()), length((name + "y").c_str()),
                        corner <= 4 ? -half : half);
    }
    bool twisted = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 along = bottom[(i + 1) % 4] - bottom[i], above = top[(i + 1) % 4] - top[i];
      twisted |= along.cross(above).norm() > 1e-9 * (along.squaredNorm() + above.squaredNorm());
    }
    const int slices = twisted ? kSlices : 1;
    std::vector<std::vector<Vec3>> outlines;
    for (int slice = 0; slice <= slices; ++slice) {
      const double share = static_cast<double>(slice) / slices;
      outlines.emplace_back();
      for (std::size_t i = 0; i < 4; ++i)
        outlines.back().push_back((1.0 - share) * bottom[i] + share * top[i]);
    }
    return lofted(outlines);
  }

  Vec3 vertex(Node node, const char* attribute) const {
    return definitions_.position_named(definitions_.name(node.attribute(attribute).value(), node), node);
  }

  /// Facets with corners in any order of rotation, welded and turned outwards.
  static TriMesh from_facets(const std::vector<std::vector<Vec3>>& facets) {
    TriMesh mesh;
    mesh.groups = {"default"};
    for (const std::vector<Vec3>& facet : facets) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), facet.begin(), facet.end());
      bool simple = true;
      for (const auto& [a, b, c] : triangulate_polygon(facet, simple)) {
        mesh.triangles.push_back({first + a, first + b, first + c});
        mesh.group.push_back(0);
      }
    }
    const double length_mm = rounding_length(mesh);
    weld_vertices(mesh, length_mm);
    remove_degenerate(mesh, length_mm);
    orient_outwards(mesh);
    return mesh;
  }

  TriMesh tet() const {
    const Vec3 a = vertex(solid_, "vertex1"), b = vertex(solid_, "vertex2"), c = vertex(solid_, "vertex3"),
               d = vertex(solid_, "vertex4");
    return from_facets({{a, b, c}, {a, b, d}, {b, c, d}, {c, a, d}});
  }

  TriMesh tessellated() const {
    std::vector<std::vector<Vec3>> facets;
    definitions_.for_each_child(solid_, [&](Node facet) {
      if (std::string_view(facet.attribute("type").value()) == "RELATIVE")
        reject_shape("a facet with corners relative to its first is not read",
                     "write them with type=\"ABSOLUTE\"");
      facets.emplace_back();
      for (const char* name : {"vertex1", "vertex2", "vertex3", "vertex4"})
        if (facet.attribute(name)) facets.back().push_back(vertex(facet, name));
      if (facets.back().size() < 3) reject_shape("a facet of fewer than 3 corners");
    });
    if (facets.empty()) reject_shape("a tessellated solid without facets");
    return from_facets(facets);
  }

  TriMesh xtru() const {
    std::vector<Eigen::Vector2d> corners;
    std::vector<std::pair<double, std::vector<Vec3>>> sections;
    definitions_.for_each_child(solid_, [&](Node child) {
      if (std::string_view(child.name()) == "twoDimVertex")
        corners.emplace_back(unit() * definitions_.number(child, "x"),
                             unit() * definitions_.number(child, "y"));
    });
    definitions_.for_each_child(solid_, [&](Node child) {
      if (std::string_view(child.name()) != "section") return;
      const double scale = definitions_.number(child, "scalingFactor", 1.0);
      const double x = unit() * definitions_.number(child, "xOffset", 0.0),
                   y = unit() * definitions_.number(child, "yOffset", 0.0),
                   z = unit() * definitions_.number(child, "zPosition");
      std::vector<Vec3> outline;
      for (const Eigen::Vector2d& corner : corners)
        outline.emplace_back(scale * corner.x() + x, scale * corner.y() + y, z);
      sections.emplace_back(definitions_.number(child, "zOrder", static_cast<double>(sections.size())),
                            outline);
    });
    std::stable_sort(sections.begin(), sections.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::vector<Vec3>> outlines;
    for (auto& section : sections) outlines.push_back(std::move(section.second));
    return lofted(outlines);
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

  TriMesh polycone() const { return revolve(z_planes()); }
  TriMesh generic_polycone() const { return revolve(rz_points()); }
  TriMesh polyhedra() const { return revolve_with_sides(z_planes()); }
  TriMesh generic_polyhedra() const { return revolve_with_sides(rz_points()); }

  TriMesh shell(double inner, double outer, double theta_low, double theta_high) const {
    if (!(inner >= 0.0 && inner < outer)) reject_shape("the inner radius is not between 0 and the outer");
    // theta counts from +z, the arc's angle from +r.
    Outline outline =
        arc({0.0, 0.0}, outer, outer, 0.5 * kPi - theta_high, 0.5 * kPi - theta_low, tessellation_);
    Outline back{{0.0, 0.0}};
    if (inner > 0.0)
      back = arc({0.0, 0.0}, inner, inner, 0.5 * kPi - theta_low, 0.5 * kPi - theta_high, tessellation_);
    outline.insert(outline.end(), back.begin(), back.end());
    return revolve(outline);
  }

  TriMesh sphere() const {
    const double low = angle("starttheta"), high = low + angle("deltatheta", kPi);
    if (!(low >= 0.0 && high > low)) reject_shape("starttheta or deltatheta is out of range");
    return shell(length("rmin"), size("rmax"), low, std::min(high, kPi));
  }

  TriMesh orb() const { return shell(0.0, size("r"), 0.0, kPi); }

  TriMesh torus() const {
    const double inner = length("rmin"), outer = size("rmax"), swept = size("rtor");
    if (!(swept > outer)) reject_shape("rtor is not above rmax: the torus would cross itself");
    Outline circle = arc({swept, 0.0}, outer, outer, 0.0, kTwoPi, tessellation_);
    circle.pop_back();
    TriMesh body = revolve(circle);
    if (inner <= 0.0) return body;
    if (turn(swept).extent_rad < kTwoPi) reject_shape("a hollow torus that is not a full circle is not made");
    Outline hole = arc({swept, 0.0}, inner, inner, 0.0, kTwoPi, tessellation_);
    hole.pop_back();
    TriMesh hollow = revolved(hole, turn(swept + outer));
    reverse_orientation(hollow);
    return joined(body, hollow);
  }

  TriMesh ellipsoid() const {
    const double a = size("ax"), b = size("by"), c = size("cz");
    double low = length("zcut1"), high = length("zcut2");
    if (low == 0.0 && high == 0.0) low = -c, high = c;  // both left out: no cuts
    low = std::max(low, -c);
    high = high == 0.0 ? c : std::min(high, c);
    if (!(low < high)) reject_shape("zcut1 is not below zcut2");
    Outline outline =
        arc({0.0, 0.0}, std::max(a, b), c, std::asin(low / c), std::asin(high / c), tessellation_);
    outline.emplace_back(0.0, high);
    outline.emplace_back(0.0, low);
    TriMesh mesh = revolve(outline);
    for (Vec3& v : mesh.vertices) v = v.cwiseProduct(Vec3(a, b, std::max(a, b)) / std::max(a, b));
    return mesh;
  }

  std::vector<Vec3> ellipse(double a, double b, double z) const {
    std::vector<Vec3> corners;
    const int segments = std::max(3, arc_segments(std::max(a, b), kTwoPi, tessellation_));
    for (int i = 0; i < segments; ++i)
      corners.emplace_back(a * std::cos(kTwoPi * i / segments), b * std::sin(kTwoPi * i / segments), z);
    return corners;
  }

  TriMesh elliptical_tube() const {
    const double a = size("dx"), b = size("dy"), half = size("dz");
    return lofted({ellipse(a, b, -half), ellipse(a, b, half)});
  }

  /// dx and dy are slopes: half axes a length of z below the apex at zmax.
  TriMesh elliptical_cone() const {
    const double a = definitions_.number(solid_, "dx"), b = definitions_.number(solid_, "dy"),
                 apex = size("zmax"), cut = size("zcut");
    const double top = std::min(cut, apex);
    std::vector<Vec3> low = ellipse(a * (apex + cut), b * (apex + cut), -cut), high;
    const double share = (apex - top) / (apex + cut);
    for (const Vec3& corner : low) high.emplace_back(share * corner.x(), share * corner.y(), top);
    if (share > 0.0) return lofted({low, high});
    std::vector<std::vector<Vec3>> facets{{low.rbegin(), low.rend()}};
    for (std::size_t i = 0; i < low.size(); ++i)
      facets.push_back({low[i], low[(i + 1) % low.size()], Vec3(0.0, 0.0, apex)});
    return from_facets(facets);
  }

  /// Corners along a meridian r(z) from -half to half.
  template <typename Radius>
  Outline meridian(double half, Radius radius) const {
    const int steps = std::max(8, arc_segments(std::max(radius(half), half), kPi, tessellation_));
    Outline outline;
    for (int i = 0; i <= steps; ++i) {
      const double z = half * (2.0 * i / steps - 1.0);
      outline.emplace_back(radius(z), z);
    }
    return outline;
  }

  TriMesh paraboloid() const {
    const double low = length("rlo"), high = size("rhi"), half = size("dz");
    if (!(low >= 0.0 && low < high)) reject_shape("rlo is not between 0 and rhi");
    Outline outline = meridian(half, [&](double z) {
      return std::sqrt(0.5 * (low * low * (1.0 - z / half) + high * high * (1.0 + z / half)));
    });
    outline.emplace_back(0.0, half);
    outline.emplace_back(0.0, -half);
    return revolve(outline);
  }

  TriMesh hyperboloid() const {
    const double half = 0.5 * size("z"), inner = length("rmin"), outer = size("rmax");
    const double inner_slope = std::tan(angle("inst")), outer_slope = std::tan(angle("outst"));
    const auto radius = [](double waist, double slope) {
      return [waist, slope](double z) { return std::hypot(waist, slope * z); };
    };
    Outline outline = meridian(half, radius(outer, outer_slope));
    const Outline hole = meridian(half, radius(inner, inner_slope));
    for (std::size_t i = 0; i < std::min(outline.size(), hole.size()); ++i)
      if (!(radius(inner, inner_slope)(outline[i].y()) < outline[i].x()))
        reject_shape("the inner wall meets the outer");
    outline.insert(outline.end(), hole.rbegin(), hole.rend());
    return revolve(outline);
  }

  Node solid_;
  const Definitions& definitions_;
  const Tessellation& tessellation_;
};

}  // namespace

std::optional<TriMesh> make_simple_solid(Node solid, const Definitions& definitions,
                                         const Tessellation& tessellation) {
  return SolidMaker(solid, definitions, tessellation).make();
}

}  // namespace scintray::gdml
