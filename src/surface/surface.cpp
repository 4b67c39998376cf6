#include "scintray/surface/surface.hpp"

#include <algorithm>

#include "scintray/core/sampling.hpp"

namespace scintray {

namespace {

/// The microsurface of one meeting: a height map keeps its place while light goes to and fro.
class Meeting {
 public:
  Meeting(const Surface& surface, const Vec3& normal, double wavelength_nm, Rng& rng)
      : surface_(surface), normal_(normal), wavelength_nm_(wavelength_nm), rng_(rng) {}

  /// The ray arrives at the microsurface on `side` and leaves on the returned one.
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index) {
    return std::visit(
        [&](const auto& model) -> SurfaceOutcome {
          using Model = std::decay_t<decltype(model)>;
          if constexpr (std::is_same_v<Model, PaintedSurface>) {
            return outcome_on(other(side));  // nothing between the light and the reflector
          } else if constexpr (std::is_same_v<Model, std::shared_ptr<const SurfaceTable>>) {
            return model->meet(ray, side, normal_, surface_.direction, wavelength_nm_, rng_);
          } else if constexpr (std::is_same_v<Model, std::shared_ptr<const HeightField>>) {
            if (!place_) place_ = model->random_place(normal_, surface_.direction, rng_);
            return outcome_on(model->scatter(ray, side, *place_, index, rng_));
          } else {
            return outcome_on(model.scatter(ray, side, normal_, index, rng_));
          }
        },
        surface_.microsurface);
  }

  /// Takes the ray from one side of the gap to the other; false: absorbed on the way.
  bool cross_gap(const Ray& ray) {
    if (!surface_.gap_thickness_um) {
      place_.reset();
      return true;
    }
    const double path_um = *surface_.gap_thickness_um / std::abs(ray.direction.dot(normal_));
    const double absorption_per_mm = surface_.gap_absorption_per_mm(wavelength_nm_);
    constexpr double kMmPerUm = 1e-3;
    if (absorption_per_mm > 0.0 && sample_exponential(rng_) < absorption_per_mm * path_um * kMmPerUm)
      return false;
    if (place_) place_->shift(ray.direction, path_um);
    return true;
  }

 private:
  const Surface& surface_;
  const Vec3& normal_;
  double wavelength_nm_;
  Rng& rng_;
  std::optional<MapPlace> place_;
};

void scatter_lambertian(Ray& ray, const Vec3& normal, Rng& rng) {
  const bool polarised = !ray.polarisation.isZero(0.0);
  ray.direction = sample_lambertian(normal, rng);
  if (polarised) ray.polarisation = sample_polarisation(ray.direction, rng);  // diffuse light: none left
}

/// Sends `ray`, in a medium of index `index`, back from a reflector whose normal towards the light is
/// `normal`; false: absorbed.
bool reflect_from(const Reflector& reflector, Ray& ray, const Vec3& normal, double index,
                  double wavelength_nm, Rng& rng) {
  const double reflectance = reflector.reflectance(wavelength_nm);
  if (reflector.volume_index > 0.0) {
    if (!meet_facet(ray, normal, index, reflector.volume_index, rng)) return true;
    for (;;) {
      if (rng.uniform() >= reflectance) return false;
      scatter_lambertian(ray, normal, rng);
      if (meet_facet(ray, -normal, reflector.volume_index, index, rng)) return true;
    }
  }
  if (rng.uniform() >= reflectance) return false;
  if (reflector.specular_share > 0.0 && rng.uniform() < reflector.specular_share)
    reflect(ray, normal);
  else
    scatter_lambertian(ray, normal, rng);
  return true;
}

const Surface& pick(const std::vector<SurfaceShare>& mixture, Rng& rng) {
  double u = rng.uniform();
  for (const SurfaceShare& part : mixture) {
    if (u < part.share) return *part.surface;
    u -= part.share;
  }
  return *mixture.back().surface;
}

/// Light that meets the far face of a gap from within it, or from beyond it.
struct FarFace {
  const std::optional<Reflector>& reflector;
  const Vec3& normal;
  double gap_index, beyond_index, wavelength_nm;
  Rng& rng;

  enum class After { in_gap, beyond, absorbed };
  After from_gap(Ray& ray) const {
    if (reflector)
      return reflect_from(*reflector, ray, -normal, gap_index, wavelength_nm, rng) ? After::in_gap
                                                                                   : After::absorbed;
    return meet_facet(ray, -normal, gap_index, beyond_index, rng) ? After::beyond : After::in_gap;
  }
  After from_beyond(Ray& ray) const {
    if (reflector)  // the back of the sheet
      return reflect_from(*reflector, ray, normal, beyond_index, wavelength_nm, rng) ? After::beyond
                                                                                     : After::absorbed;
    return meet_facet(ray, normal, beyond_index, gap_index, rng) ? After::in_gap : After::beyond;
  }
};

}  // namespace

SurfaceOutcome Surface::meet(Ray& ray, Side side, const Vec3& normal, const IndexPair& index,
                             double wavelength_nm, Rng& rng) const {
  if (!mixture.empty()) return pick(mixture, rng).meet(ray, side, normal, index, wavelength_nm, rng);
  Meeting meeting(*this, normal, wavelength_nm, rng);
  if (!reflector && !gap_thickness_um) return meeting.scatter(ray, side, index);

  // Paint lies on the face itself: its light is still in the inside medium.
  const bool painted = std::holds_alternative<PaintedSurface>(microsurface);
  const IndexPair under{index.inside, painted ? index.inside : gap_index(wavelength_nm)};
  const FarFace far{reflector, normal, under.outside, index.outside, wavelength_nm, rng};
  bool at_far_face = side == Side::outside;
  if (at_far_face) {
    switch (far.from_beyond(ray)) {
      case FarFace::After::beyond:
        return SurfaceOutcome::outside;
      case FarFace::After::absorbed:
        return SurfaceOutcome::absorbed;
      case FarFace::After::in_gap:
        break;
    }
  } else if (const SurfaceOutcome first = meeting.scatter(ray, side, under);
             first != SurfaceOutcome::outside) {
    return first;
  }
  for (;;) {
    if (!meeting.cross_gap(ray)) return SurfaceOutcome::absorbed;
    at_far_face = !at_far_face;
    if (at_far_face) {
      const FarFace::After after = far.from_gap(ray);
      if (after == FarFace::After::absorbed) return SurfaceOutcome::absorbed;
      if (after == FarFace::After::beyond) return SurfaceOutcome::outside;
    } else {
      if (painted) return SurfaceOutcome::inside;
      const SurfaceOutcome after = meeting.scatter(ray, Side::outside, under);
      if (after != SurfaceOutcome::outside) return after;
    }
  }
}

bool Surface::opaque() const {
  if (!mixture.empty())
    return std::all_of(mixture.begin(), mixture.end(),
                       [](const SurfaceShare& part) { return part.surface->opaque(); });
  const auto* table = std::get_if<std::shared_ptr<const SurfaceTable>>(&microsurface);
  return reflector.has_value() || (table && (*table)->opaque());
}

}  // namespace scintray
