// A program that uses the installed library: a photon interacts with a polished crystal face.

#include <cmath>
#include <iostream>

#include "scintray/core/data_folder.hpp"
#include "scintray/core/units.hpp"
#include "scintray/core/version.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/optics/surface.hpp"

int main() {
  const double steep = scintray::core::parse_quantity("60 deg", scintray::core::Dimension::angle);
  const scintray::optics::IndexPair lso_to_air{1.82, 1.0};
  const scintray::core::Vec3 normal(0, 0, 1);
  scintray::optics::Ray ray{scintray::core::Vec3(std::sin(steep), 0, std::cos(steep)),
                            scintray::core::Vec3::Zero()};
  scintray::core::Rng rng(1, scintray::core::StreamKind::photon, 0);
  const scintray::optics::Side side =
      scintray::optics::SmoothSurface{}.scatter(ray, scintray::optics::Side::inside, normal, lso_to_air, rng);

  std::cout << "version: " << scintray::core::version() << "\n"
            << "data: " << scintray::core::data_folder().string() << "\n";
  const bool reflected = side == scintray::optics::Side::inside && ray.direction.z() < 0.0;
  if (!reflected) std::cerr << "light beyond the critical angle left the crystal\n";
  return reflected ? 0 : 1;
}
