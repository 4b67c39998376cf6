#pragma once
/// Round faces of which the triangles are traced, and what that may change.

#include <string>
#include <vector>

#include "scintray/mesh/support_surface.hpp"
#include "scintray/scene/build_scene.hpp"

namespace scintray::scene {

/// A round face that is traced as facets.
struct FacetFace {
  std::string name;           ///< "part:face"
  bool surface_known = true;  ///< false: the deviation is estimated from the angles between its facets
  mesh::FacetDeviation deviation;
  /// Upper estimate of the share of the light emitted in the part that total reflection at the true face
  /// would keep and that escapes through the facets (light_let_out); 0 where nothing is totally reflected.
  double let_out = 0.0;
};

/// Light in a body with a round wall, and what is behind the wall.
struct RoundWall {
  double index_inside = 1.0, index_outside = 1.0;
  double absorption_per_mm = 0.0;  ///< 0: trapped light is never absorbed
  double mean_chord_mm = 0.0;      ///< 4 V / S
  double facet_angle_rad = 0.0;    ///< largest angle between facets and the wall
};

/// Upper estimate of the share of isotropic light that escapes through the facets of a wall which would keep
/// it by total reflection.
///
/// A facet's normal deviates from the wall's by an angle uniform in [-d, d], so that a reflection
/// turns the ray by up to 2 d, 4 d^2 / 3 in the mean square. Taken as independent, the N reflections before
/// the light is absorbed, N = 1 / (absorption * mean chord), turn it by s = 2 d sqrt(N / 3) (root of the mean
/// square). Light that reaches the wall within s beyond the critical angle c may leave: of the isotropic
/// light that reaches a wall, sin^2(min(c + s, 90 deg)) - sin^2(c). An upper estimate, since most of it is
/// absorbed before, or deflected in the opposite sense.
double light_let_out(const RoundWall& wall);

/// Round faces of a scene that are traced as facets, in the order of its faces.
std::vector<FacetFace> facet_faces(const BuiltScene& built);

}  // namespace scintray::scene
