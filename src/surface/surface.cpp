#include "scintray/surface/surface.hpp"

#include "scintray/core/sampling.hpp"

namespace scintray {

namespace {

Side scatter(const Microsurface& microsurface, Ray& ray, Side side, const Vec3& normal,
             const IndexPair& index, Rng& rng) {
  return std::visit(
      [&](const auto& model) -> Side {
        using Model = std::decay_t<decltype(model)>;
        if constexpr (std::is_same_v<Model, PaintedSurface>)
          return other(side);  // nothing between the light and the reflector
        else if constexpr (requires { model->scatter(ray, side, normal, index, rng); })
          return model->scatter(ray, side, normal, index, rng);
        else
          return model.scatter(ray, side, normal, index, rng);
      },
      microsurface);
}

/// Sends `ray` back from a reflector whose normal towards the light is `normal`; false: absorbed.
bool reflect_from(const Reflector& reflector, Ray& ray, const Vec3& normal, double wavelength_nm, Rng& rng) {
  if (rng.uniform() >= reflector.reflectance(wavelength_nm)) return false;
  if (reflector.specular_share > 0.0 && rng.uniform() < reflector.specular_share) {
    reflect(ray, normal);
    return true;
  }
  const bool polarised = !ray.polarisation.isZero(0.0);
  ray.direction = sample_lambertian(normal, rng);
  if (polarised) ray.polarisation = sample_polarisation(ray.direction, rng);  // diffuse light: none left
  return true;
}

}  // namespace

SurfaceOutcome Surface::meet(Ray& ray, Side side, const Vec3& normal, const IndexPair& index,
                             double wavelength_nm, Rng& rng) const {
  if (!reflector) {
    const Side after = scatter(microsurface, ray, side, normal, index, rng);
    return after == Side::inside ? SurfaceOutcome::inside : SurfaceOutcome::outside;
  }
  if (side == Side::outside) {  // the back of the sheet
    return reflect_from(*reflector, ray, normal, wavelength_nm, rng) ? SurfaceOutcome::outside
                                                                     : SurfaceOutcome::absorbed;
  }
  const IndexPair under{index.inside, gap_index(wavelength_nm)};
  while (scatter(microsurface, ray, side, normal, under, rng) == Side::outside) {
    if (!reflect_from(*reflector, ray, -normal, wavelength_nm, rng)) return SurfaceOutcome::absorbed;
    if (std::holds_alternative<PaintedSurface>(microsurface)) break;
    side = Side::outside;
  }
  return SurfaceOutcome::inside;
}

}  // namespace scintray
