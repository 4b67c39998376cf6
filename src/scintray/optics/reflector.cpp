#include "scintray/optics/reflector.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "scintray/core/sampling.hpp"

namespace scintray::optics {

namespace {

/// Whether transmitted light goes on as in a smooth face. A number is drawn only where both kinds occur.
bool is_specular(const Reflector& reflector, core::Rng& rng) {
  const double share = reflector.specular_share;
  return share >= 1.0 || (share > 0.0 && rng.uniform() < share);
}

/// Lambertian reflection of PaintPolarisation::geant4.
void scatter_as_geant4(Ray& ray, const core::Vec3& normal, core::Rng& rng) {
  ray.direction = core::sample_lambertian(normal, rng);
  const core::Vec3 across = ray.direction.cross(normal);
  if (ray.polarisation.isZero(0.0) || across.squaredNorm() == 0.0) return;
  const core::Vec3 s = across.normalized();
  const double e_s = std::clamp(ray.polarisation.dot(s), -1.0, 1.0);
  ray.polarisation = e_s * s + std::sqrt(1.0 - e_s * e_s) * s.cross(ray.direction.vec());
  ray.ellipticity_rad = 0.0;
}

/// Transmitted light: through, or back where it cannot enter the medium beyond.
SheetOutcome pass(const Reflector& reflector, Ray& ray, const SheetSide& side, core::Rng& rng) {
  if (reflector.undeflected) return SheetOutcome::through;
  if (is_specular(reflector, rng))
    return refract_only(ray, side.normal, side.index_here, side.index_beyond) ? SheetOutcome::through
                                                                              : SheetOutcome::back;
  const double ratio = side.index_beyond / side.index_here;
  const bool back = ratio < 1.0 && rng.uniform() >= ratio * ratio;
  scatter_lambertian(ray, back ? side.normal : core::Vec3(-side.normal), rng);
  return back ? SheetOutcome::back : SheetOutcome::through;
}

/// Reflectance and transmittance of a sheet at one wavelength.
struct SheetShares {
  double reflectance, transmittance;
};

/// Light refracted into a volume-like reflector, until it leaves it or is absorbed.
SheetOutcome scatter_in_volume(const Reflector& reflector, Ray& ray, const SheetSide& side,
                               const SheetShares& shares, core::Rng& rng, ReflectionLog* log) {
  for (bool from_here = true;;) {
    const double u = rng.uniform();
    if (u >= shares.reflectance + shares.transmittance) return SheetOutcome::absorbed;
    if (log && u < shares.reflectance) log->add(reflector, shares.reflectance);
    const bool to_here = (u < shares.reflectance) == from_here;
    const core::Vec3 out = to_here ? side.normal : core::Vec3(-side.normal);
    scatter_lambertian(ray, out, rng);
    if (interact_at_facet(ray, -out, reflector.volume_index, to_here ? side.index_here : side.index_beyond,
                          rng))
      return to_here ? SheetOutcome::back : SheetOutcome::through;
    from_here = to_here;
  }
}

/// Every wavelength (nm) at which a curve of the sheet has a point; one arbitrary wavelength when all are
/// constant.
std::set<double> wavelengths_of(const Reflector& reflector) {
  std::set<double> at;
  const auto add = [&](const core::Curve& curve) {
    if (!curve.is_constant()) at.insert(curve.x().begin(), curve.x().end());
  };
  add(reflector.reflectance);
  if (reflector.transmittance) add(*reflector.transmittance);
  if (at.empty()) at.insert(0.0);
  return at;
}

}  // namespace

SheetOutcome interact_at_reflector(const Reflector& reflector, Ray& ray, const SheetSide& side,
                                   double wavelength_nm, core::Rng& rng, ReflectionLog* log) {
  const SheetShares shares{reflector.reflectance(wavelength_nm),
                           reflector.transmittance ? (*reflector.transmittance)(wavelength_nm) : 0.0};
  if (reflector.volume_index > 0.0) {
    if (!interact_at_facet(ray, side.normal, side.index_here, reflector.volume_index, rng))
      return SheetOutcome::back;
    return scatter_in_volume(reflector, ray, side, shares, rng, log);
  }
  const double u = rng.uniform();
  if (u >= shares.reflectance)
    return u < shares.reflectance + shares.transmittance ? pass(reflector, ray, side, rng)
                                                         : SheetOutcome::absorbed;
  if (log) log->add(reflector, shares.reflectance);
  if (u < shares.reflectance * reflector.specular_share)
    reflect(ray, side.normal);
  else if (reflector.polarisation == PaintPolarisation::geant4)
    scatter_as_geant4(ray, side.normal, rng);
  else
    scatter_lambertian(ray, side.normal, rng);
  return SheetOutcome::back;
}

double most_kept(const Reflector& reflector) {
  double most = 0.0;
  for (const double nm : wavelengths_of(reflector))
    most = std::max(
        most, reflector.reflectance(nm) + (reflector.transmittance ? (*reflector.transmittance)(nm) : 0.0));
  return most;
}

Reflector face_of_sheet(const Reflector& sheet) {
  if (!sheet.transmittance) return sheet;
  constexpr double kStep_nm = 1.0;
  std::set<double> at = wavelengths_of(sheet);
  const double last = *at.rbegin();
  for (double nm = *at.begin() + kStep_nm; nm < last; nm += kStep_nm) at.insert(nm);
  std::vector<double> x, reflectance, transmittance;
  for (const double nm : at) {
    const double through = (*sheet.transmittance)(nm);
    const double r = sheet.reflectance(nm) / (1.0 + through);
    x.push_back(nm);
    reflectance.push_back(r);
    transmittance.push_back(std::sqrt(through * (1.0 - r * r)));
  }
  Reflector face = sheet;
  face.reflectance = core::Curve(x, std::move(reflectance));
  face.transmittance = core::Curve(std::move(x), std::move(transmittance));
  return face;
}

}  // namespace scintray::optics
