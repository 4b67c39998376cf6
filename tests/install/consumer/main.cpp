// What a program that uses the installed library looks like: a photon meets a polished crystal face.

#include <cmath>
#include <iostream>

#include "scintray/core/data_folder.hpp"
#include "scintray/core/units.hpp"
#include "scintray/core/version.hpp"
#include "scintray/surface/fresnel.hpp"
#include "scintray/surface/surface.hpp"

int main() {
  const double steep = scintray::parse_quantity("60 deg", scintray::Dimension::angle);
  const scintray::IndexPair lso_to_air{1.82, 1.0};
  const scintray::Vec3 normal(0, 0, 1);
  scintray::Ray ray{scintray::Vec3(std::sin(steep), 0, std::cos(steep)), scintray::Vec3::Zero()};
  scintray::Rng rng(1, scintray::StreamKind::photon, 0);
  const scintray::Side side =
      scintray::SmoothSurface{}.scatter(ray, scintray::Side::inside, normal, lso_to_air, rng);

  std::cout << "version: " << scintray::version() << "\n"
            << "data: " << scintray::data_folder().string() << "\n";
  const bool reflected = side == scintray::Side::inside && ray.direction.z() < 0.0;
  if (!reflected) std::cerr << "light beyond the critical angle left the crystal\n";
  return reflected ? 0 : 1;
}
