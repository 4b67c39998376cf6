#include "scintray/exchange/gdml/detail/solid_reader.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/solids.hpp"

namespace scintray::exchange::gdml {

namespace {

/// A solid of flat faces or ruled walls.
class FlatSolid : public SolidReader {
 public:
  using SolidReader::SolidReader;

  std::optional<mesh::TriMesh> make() const {
    struct Kind {
      std::string_view name;
      mesh::TriMesh (FlatSolid::*make)() const;
    };
    static constexpr Kind kKinds[] = {{"box", &FlatSolid::box},
                                      {"trd", &FlatSolid::trd},
                                      {"trap", &FlatSolid::trap},
                                      {"para", &FlatSolid::para},
                                      {"arb8", &FlatSolid::arb8},
                                      {"tet", &FlatSolid::tet},
                                      {"tessellated", &FlatSolid::tessellated},
                                      {"xtru", &FlatSolid::xtru}};
    return make_one_of(*this, kKinds);
  }

 private:
  mesh::TriMesh box() const {
    const core::Vec3 half = 0.5 * core::Vec3(size("x"), size("y"), size("z"));
    return mesh::make_box(-half, half);
  }

  static std::vector<core::Vec3> rectangle(double half_x, double half_y, double z) {
    return {{-half_x, -half_y, z}, {half_x, -half_y, z}, {half_x, half_y, z}, {-half_x, half_y, z}};
  }

  mesh::TriMesh trd() const {
    const double half = 0.5 * size("z");
    return mesh::lofted({rectangle(0.5 * length("x1"), 0.5 * length("y1"), -half),
                         rectangle(0.5 * length("x2"), 0.5 * length("y2"), half)});
  }

  struct Trapezoid {
    double half_y, half_x_low, half_x_high, tan_alpha;
  };

  /// Trapezoids at -half and +half whose centres lie along (theta, phi).
  mesh::TriMesh slanted(double half, double theta, double phi, const Trapezoid& bottom,
                        const Trapezoid& top) const {
    const core::Vec3 shift =
        half * core::Vec3(std::tan(theta) * std::cos(phi), std::tan(theta) * std::sin(phi), 1.0);
    const auto outline = [](const Trapezoid& t, const core::Vec3& centre) {
      const double slant = t.half_y * t.tan_alpha;
      return std::vector<core::Vec3>{centre + core::Vec3(-slant - t.half_x_low, -t.half_y, 0.0),
                                     centre + core::Vec3(-slant + t.half_x_low, -t.half_y, 0.0),
                                     centre + core::Vec3(slant + t.half_x_high, t.half_y, 0.0),
                                     centre + core::Vec3(slant - t.half_x_high, t.half_y, 0.0)};
    };
    return mesh::lofted({outline(bottom, -shift), outline(top, shift)});
  }

  mesh::TriMesh trap() const {
    return slanted(0.5 * size("z"), angle("theta"), angle("phi"),
                   {0.5 * size("y1"), 0.5 * length("x1"), 0.5 * length("x2"), std::tan(angle("alpha1"))},
                   {0.5 * size("y2"), 0.5 * length("x3"), 0.5 * length("x4"), std::tan(angle("alpha2"))});
  }

  mesh::TriMesh para() const {
    const Trapezoid side{0.5 * size("y"), 0.5 * size("x"), 0.5 * size("x"), std::tan(angle("alpha"))};
    return slanted(0.5 * size("z"), angle("theta"), angle("phi"), side, side);
  }

  /// Its walls may be twisted: ruled surfaces between corresponding points of both ends.
  mesh::TriMesh arb8() const {
    constexpr int kSlices = 16;
    const double half = size("dz");
    std::vector<core::Vec3> bottom, top;
    for (int corner = 1; corner <= 8; ++corner) {
      const std::string name = "v" + std::to_string(corner);
      (corner <= 4 ? bottom : top)
          .emplace_back(length((name + "x").c_str()), length((name + "y").c_str()),
                        corner <= 4 ? -half : half);
    }
    bool twisted = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const core::Vec3 along = bottom[(i + 1) % 4] - bottom[i], above = top[(i + 1) % 4] - top[i];
      twisted |= along.cross(above).norm() > 1e-9 * (along.squaredNorm() + above.squaredNorm());
    }
    const int slices = twisted ? kSlices : 1;
    std::vector<std::vector<core::Vec3>> outlines;
    for (int slice = 0; slice <= slices; ++slice) {
      const double share = static_cast<double>(slice) / slices;
      outlines.emplace_back();
      for (std::size_t i = 0; i < 4; ++i)
        outlines.back().push_back((1.0 - share) * bottom[i] + share * top[i]);
    }
    return mesh::lofted(outlines);
  }

  /// A <position> by its name, times the unit of the element, as Geant4 reads it.
  core::Vec3 vertex(Node node, const char* attribute) const {
    return definitions_.number(node, "lunit", 1.0) *
           definitions_.position_named(definitions_.name(node.attribute(attribute).value(), node), node);
  }

  mesh::TriMesh tet() const {
    const core::Vec3 a = vertex(solid_, "vertex1"), b = vertex(solid_, "vertex2"),
                     c = vertex(solid_, "vertex3"), d = vertex(solid_, "vertex4");
    return from_facets({{a, b, c}, {a, b, d}, {b, c, d}, {c, a, d}});
  }

  mesh::TriMesh tessellated() const {
    std::vector<std::vector<core::Vec3>> facets;
    definitions_.for_each_child(solid_, [&](Node facet) {
      // Corners of G4TriangularFacet and G4QuadrangularFacet of the type RELATIVE count from the first.
      const bool relative = std::string_view(facet.attribute("type").value()) == "RELATIVE";
      facets.emplace_back();
      for (const char* name : {"vertex1", "vertex2", "vertex3", "vertex4"}) {
        if (!facet.attribute(name)) continue;
        const core::Vec3 corner = vertex(facet, name);
        facets.back().push_back(relative && !facets.back().empty() ? facets.back().front() + corner : corner);
      }
      if (facets.back().size() < 3)
        mesh::reject_shape("a facet of fewer than 3 corners", "give vertex1, vertex2 and vertex3");
    });
    if (facets.empty())
      mesh::reject_shape("a tessellated solid without facets",
                         "add <triangular .../> or <quadrangular .../>");
    return from_facets(facets);
  }

  mesh::TriMesh xtru() const {
    std::vector<Eigen::Vector2d> corners;
    std::vector<std::pair<double, std::vector<core::Vec3>>> sections;
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
      std::vector<core::Vec3> outline;
      for (const Eigen::Vector2d& corner : corners)
        outline.emplace_back(scale * corner.x() + x, scale * corner.y() + y, z);
      sections.emplace_back(definitions_.number(child, "zOrder", static_cast<double>(sections.size())),
                            outline);
    });
    std::stable_sort(sections.begin(), sections.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::vector<core::Vec3>> outlines;
    for (auto& section : sections) outlines.push_back(std::move(section.second));
    return mesh::lofted(outlines);
  }
};

}  // namespace

std::optional<mesh::TriMesh> make_flat_solid(Node solid, const Definitions& definitions,
                                             const mesh::Tessellation& tessellation) {
  return FlatSolid(solid, definitions, tessellation).make();
}

}  // namespace scintray::exchange::gdml
