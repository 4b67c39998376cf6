#include "scintray/exchange/gdml/detail/solid_reader.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/mesh/shapes/solids.hpp"

namespace scintray::exchange::gdml {

namespace {

/// A solid whose cross-section turns along z. Shapes as the sources of Geant4 11.4 compute them
/// (G4VTwistedFaceted, G4TwistTrapParallelSide, G4TwistedTubs).
class TwistedSolid : public SolidReader {
 public:
  using SolidReader::SolidReader;

  std::optional<mesh::TriMesh> make() const {
    struct Kind {
      std::string_view name;
      mesh::TriMesh (TwistedSolid::*make)() const;
    };
    static constexpr Kind kKinds[] = {{"twistedbox", &TwistedSolid::box},
                                      {"twistedtrd", &TwistedSolid::trd},
                                      {"twistedtrap", &TwistedSolid::trap},
                                      {"twistedtubs", &TwistedSolid::tubs}};
    return make_one_of(*this, kKinds);
  }

 private:
  /// Half lengths of an end.
  struct End {
    double x_low, x_high, y;
  };

  /// Steps along z, and across a wall.
  struct Steps {
    int along = 1, across = 1;
  };

  /// Two triangles for a piece of a wall through the axis deviate from it by a quarter of the sine of its
  /// twist times its width: at most the tessellation's deviation.
  Steps steps(double half_width_mm, double twist_rad) const {
    const double pieces = half_width_mm * std::abs(twist_rad) / (2.0 * tessellation_.deviation_at(half_width_mm));
    const int arc = mesh::arc_segments(half_width_mm, std::abs(twist_rad), tessellation_, 1);
    const int along = std::max(arc, static_cast<int>(std::ceil(std::sqrt(std::min(pieces, 1e8)))));
    return {along, std::max(1, static_cast<int>(std::ceil(std::min(pieces, 1e8) / along)))};
  }

  double twist() const {
    const double angle_rad = angle("PhiTwist");
    if (!(angle_rad != 0.0 && std::abs(angle_rad) < 0.5 * core::kPi))
      mesh::reject_shape("PhiTwist is 0, or not between -90 and 90 degrees");
    return angle_rad;
  }

  /// Trapezoids, and between them straight lines in the turned frame; the centre moves by `shift` over all
  /// of the length.
  mesh::TriMesh faceted(const End& low, const End& high, double tan_alpha, const core::Vec3& shift) const {
    const double twist_rad = twist(), length_mm = size("z");
    const double widest = std::max({low.x_low, low.x_high, high.x_low, high.x_high, low.y, high.y});
    const Steps cut = steps(widest, twist_rad);
    return mesh::mapped_cube({cut.across, cut.across, cut.along}, {}, [&](const core::Vec3& at) {
      const auto between = [](double a, double b, double share) { return a + share * (b - a); };
      const double y = (2.0 * at.y() - 1.0) * between(low.y, high.y, at.z());
      const double half_x =
          between(between(low.x_low, high.x_low, at.z()), between(low.x_high, high.x_high, at.z()), at.y());
      const double x = (2.0 * at.x() - 1.0) * half_x + y * tan_alpha;
      const double phi = twist_rad * (at.z() - 0.5);
      return core::Vec3(core::Vec3(x * std::cos(phi) - y * std::sin(phi),
                                   x * std::sin(phi) + y * std::cos(phi), length_mm * (at.z() - 0.5)) +
                        (at.z() - 0.5) * shift);
    });
  }

  mesh::TriMesh box() const {
    const End end{0.5 * size("x"), 0.5 * size("x"), 0.5 * size("y")};
    return faceted(end, end, 0.0, core::Vec3::Zero());
  }

  mesh::TriMesh trd() const {
    return faceted({0.5 * size("x1"), 0.5 * size("x1"), 0.5 * size("y1")},
                   {0.5 * size("x2"), 0.5 * size("x2"), 0.5 * size("y2")}, 0.0, core::Vec3::Zero());
  }

  mesh::TriMesh trap() const {
    const double slant = size("z") * std::tan(angle("Theta"));
    return faceted({0.5 * size("x1"), 0.5 * size("x2"), 0.5 * size("y1")},
                   {0.5 * size("x3"), 0.5 * size("x4"), 0.5 * size("y2")}, std::tan(angle("Alph")),
                   slant * core::Vec3(std::cos(angle("Phi")), std::sin(angle("Phi")), 0.0));
  }

  /// The part of a ring between two hyperboloids, about the x axis in its middle, whose sides are straight
  /// lines through the axis that turn by an angle whose tangent is proportional to z.
  mesh::TriMesh tubs() const {
    const double twist_rad = angle("twistedangle"), length_mm = length("zlen");
    double low = length("negativeEndz"), high = length("positiveEndz");
    double inner = length("midinnerrad"), outer = length("midouterrad");
    if (length_mm != 0.0) {  // radii are those of the ends
      inner = length("endinnerrad") * std::cos(0.5 * twist_rad);
      outer = length("endouterrad") * std::cos(0.5 * twist_rad);
      low = -0.5 * length_mm;
      high = 0.5 * length_mm;
    }
    const double parts = definitions_.number(solid_, "nseg", 0.0);
    const double extent = parts != 0.0 ? angle("totphi") / parts : angle("phi");
    if (!(inner > 0.0 && inner < outer))
      mesh::reject_shape("the inner radius is not between 0 and the outer");
    if (!(low < high)) mesh::reject_shape("its lower end is not below the upper one");
    if (!(extent > 0.0 && extent < core::kTwoPi)) mesh::reject_shape("it spans no angle between 0 and 2 pi");
    if (!(std::abs(twist_rad) < core::kPi))
      mesh::reject_shape("twistedangle is not between -180 and 180 degrees");
    const double kappa = std::tan(0.5 * twist_rad) / std::max(std::abs(low), std::abs(high));
    const double widest = outer * std::hypot(1.0, kappa * std::max(std::abs(low), std::abs(high)));
    const double turned = std::atan(kappa * high) - std::atan(kappa * low);
    const Steps cut = steps(widest, turned);
    const int around = mesh::arc_segments(widest, extent, tessellation_, 1);
    return mesh::mapped_cube(
        {std::max(around, cut.across), cut.across, cut.along}, {}, [&](const core::Vec3& at) {
          const double z = low + at.z() * (high - low);
          const double r = (inner + at.y() * (outer - inner)) * std::hypot(1.0, kappa * z);
          const double phi = std::atan(kappa * z) + (at.x() - 0.5) * extent;
          return core::Vec3(r * std::cos(phi), r * std::sin(phi), z);
        });
  }
};

}  // namespace

std::optional<mesh::TriMesh> make_twisted_solid(Node solid, const Definitions& definitions,
                                                const mesh::Tessellation& tessellation) {
  return TwistedSolid(solid, definitions, tessellation).make();
}

}  // namespace scintray::exchange::gdml
