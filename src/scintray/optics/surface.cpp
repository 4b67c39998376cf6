#include "scintray/optics/surface.hpp"

#include <algorithm>

#include "scintray/core/sampling.hpp"

namespace scintray::optics {

namespace {

/// The microsurface and the gap during one interaction.
class Interaction {
 public:
  Interaction(const Surface& surface, const Incidence& incidence, ShiftingLight* light, core::Rng& rng)
      : surface_(surface),
        at_{incidence.normal, surface.direction, incidence.wavelength_nm, rng},
        light_(light) {}

  double wavelength_nm() const { return at_.wavelength_nm; }

  /// Side on which a ray that is incident on the microsurface on `side` leaves.
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index) {
    return surface_.microsurface->scatter(ray, side, index, at_);
  }

  /// Traces the ray through the gap from one of its faces; true when it leaves at the far face, nothing when
  /// it is absorbed in the gap.
  std::optional<bool> cross_gap(Ray& ray, bool from_far) {
    if (!surface_.gap_thickness_um) {
      at_.place.reset();
      return !from_far;
    }
    if (surface_.gap_shifter) return cross_coating(ray, from_far);
    const double path_um = *surface_.gap_thickness_um / std::abs(ray.direction.dot(at_.normal));
    const double absorption_per_mm = surface_.gap_absorption_per_mm(at_.wavelength_nm);
    if (absorption_per_mm > 0.0 && core::sample_exponential(at_.rng) < absorption_per_mm * path_um * kMmPerUm)
      return std::nullopt;
    if (at_.place) at_.place->shift(ray.direction, path_um);
    return !from_far;
  }

 private:
  static constexpr double kMmPerUm = 1e-3;

  std::optional<bool> cross_coating(Ray& ray, bool from_far) {
    const double thickness_um = *surface_.gap_thickness_um;
    double depth_um = from_far ? thickness_um : 0.0;  // from the microsurface
    for (;;) {
      const double shifting_per_mm = surface_.gap_shifter->absorption_per_mm()(at_.wavelength_nm);
      const double total_per_mm = shifting_per_mm + surface_.gap_absorption_per_mm(at_.wavelength_nm);
      const double along = ray.direction.dot(at_.normal);
      const double to_face_um = (along > 0.0 ? thickness_um - depth_um : depth_um) / std::abs(along);
      const double depth = core::sample_exponential(at_.rng);
      const bool absorbed = depth < total_per_mm * to_face_um * kMmPerUm;
      const double path_um = absorbed ? depth / (total_per_mm * kMmPerUm) : to_face_um;
      if (at_.place) at_.place->shift(ray.direction, path_um);
      if (!absorbed) return along > 0.0;
      depth_um += path_um * along;
      if (at_.rng.uniform() * total_per_mm >= shifting_per_mm || !shift(ray)) return std::nullopt;
    }
  }

  /// Absorption of the photon by the gap's shifter; false when it is not re-emitted.
  bool shift(Ray& ray) {
    if (!light_) return false;
    const auto back = surface_.gap_shifter->absorb(at_.wavelength_nm, at_.rng, light_->count);
    if (!back) return false;
    at_.wavelength_nm = light_->wavelength_nm = back->wavelength_nm;
    light_->delay_ns += back->delay_ns;
    scatter_isotropic(ray, at_.rng);
    return true;
  }

  const Surface& surface_;
  SurfaceInteraction at_;
  ShiftingLight* light_;
};

/// What happens to light before it reaches a surface that does not admit all of it.
enum class Arrival { admitted, undeflected, absorbed };

Arrival arrive(const Admission& admission, double wavelength_nm, core::Rng& rng) {
  const double u = rng.uniform(), admitted = admission.admitted(wavelength_nm);
  if (u < admitted) return Arrival::admitted;
  return u < admitted + admission.undeflected(wavelength_nm) ? Arrival::undeflected : Arrival::absorbed;
}

const Surface& pick(const std::vector<SurfaceShare>& mixture, core::Rng& rng) {
  double u = rng.uniform();
  for (const SurfaceShare& part : mixture) {
    if (u < part.share) return *part.surface;
    u -= part.share;
  }
  return *mixture.back().surface;
}

/// Light that reaches the far face of a gap from within it, or from beyond it.
struct FarFace {
  const std::optional<Reflector>& reflector;
  const core::Vec3& normal;
  IndexPair index;  ///< of the gap, inside, and of what is beyond it
  double wavelength_nm;
  core::Rng& rng;
  ReflectionLog* log;

  enum class After { in_gap, beyond, absorbed };
  After from_gap(Ray& ray) const {
    if (reflector) {
      const SheetOutcome outcome = interact_at_reflector(
          *reflector, ray, {-normal, index.inside, index.outside}, wavelength_nm, rng, log);
      return after(outcome, After::in_gap, After::beyond);
    }
    return interact_at_facet(ray, -normal, index, Side::inside, rng) ? After::beyond : After::in_gap;
  }
  After from_beyond(Ray& ray) const {
    if (reflector) {  // the back of the sheet
      const SheetOutcome outcome = interact_at_reflector(
          *reflector, ray, {normal, index.outside, index.inside}, wavelength_nm, rng, log);
      return after(outcome, After::beyond, After::in_gap);
    }
    return interact_at_facet(ray, normal, index, Side::outside, rng) ? After::in_gap : After::beyond;
  }
  static After after(SheetOutcome outcome, After back, After through) {
    return outcome == SheetOutcome::back      ? back
           : outcome == SheetOutcome::through ? through
                                              : After::absorbed;
  }
};

}  // namespace

SurfaceOutcome Surface::interact(Ray& ray, const Incidence& incidence, ShiftingLight* light,
                                 core::Rng& rng) const {
  if (!mixture.empty()) return pick(mixture, rng).interact(ray, incidence, light, rng);
  if (admission) {
    const Arrival arrival = arrive(*admission, incidence.wavelength_nm, rng);
    if (arrival == Arrival::absorbed) return SurfaceOutcome::absorbed;
    if (arrival == Arrival::undeflected) return outcome_on(other(incidence.side));
  }
  Interaction interaction(*this, incidence, light, rng);
  if (!reflector && !gap_thickness_um) return interaction.scatter(ray, incidence.side, incidence.index);

  // Paint lies on the face itself: light incident on it is still in the inside medium.
  const bool painted = microsurface->kind() == MicrosurfaceKind::painted;
  IndexPair index = incidence.index;
  IndexPair under = index;
  under.outside = painted ? index.inside : gap_index(incidence.wavelength_nm);
  under.birefringent_outside = painted ? index.birefringent_inside : nullptr;
  const auto far = [&] {
    return FarFace{reflector,
                   incidence.normal,
                   {under.outside, index.outside, under.birefringent_outside, index.birefringent_outside},
                   interaction.wavelength_nm(),
                   rng,
                   incidence.log};
  };
  bool at_far_face = incidence.side == Side::outside;
  if (at_far_face) {
    switch (far().from_beyond(ray)) {
      case FarFace::After::beyond:
        return SurfaceOutcome::outside;
      case FarFace::After::absorbed:
        return SurfaceOutcome::absorbed;
      case FarFace::After::in_gap:
        break;
    }
  } else if (const SurfaceOutcome first = interaction.scatter(ray, incidence.side, under);
             first != SurfaceOutcome::outside) {
    return first;
  }
  for (;;) {
    const double before_nm = interaction.wavelength_nm();
    const std::optional<bool> crossed = interaction.cross_gap(ray, at_far_face);
    if (!crossed) return SurfaceOutcome::absorbed;
    at_far_face = *crossed;
    if (interaction.wavelength_nm() != before_nm) {
      index = light->index(interaction.wavelength_nm());
      under = {index.inside, gap_index(interaction.wavelength_nm()), index.birefringent_inside};
    }
    if (at_far_face) {
      const FarFace::After after = far().from_gap(ray);
      if (after == FarFace::After::absorbed) return SurfaceOutcome::absorbed;
      if (after == FarFace::After::beyond) return SurfaceOutcome::outside;
    } else {
      if (painted) return SurfaceOutcome::inside;
      const SurfaceOutcome after = interaction.scatter(ray, Side::outside, under);
      if (after != SurfaceOutcome::outside) return after;
    }
  }
}

bool Surface::mixture_shifts() const {
  return std::any_of(mixture.begin(), mixture.end(),
                     [](const SurfaceShare& part) { return part.surface->shifts(); });
}

std::string Surface::why_not_reciprocal() const {
  for (const SurfaceShare& part : mixture)
    if (std::string why = part.surface->why_not_reciprocal(); !why.empty()) return why;
  if (!mixture.empty()) return {};
  if (!microsurface->reciprocal()) return "its model is not reciprocal";
  if (gap_shifter) return "its coating shifts wavelengths";
  if (admission && admission->undeflected.max_y() > 0.0) return "it lets light through without refraction";
  if (reflector && reflector->polarisation != PaintPolarisation::random)
    return "its paint keeps the polarisation as Geant4 does";
  if (reflector && reflector->undeflected) return "its paint lets light through without refraction";
  return {};
}

bool Surface::birefringent() const {
  if (mixture.empty()) return microsurface->birefringent();
  return std::all_of(mixture.begin(), mixture.end(),
                     [](const SurfaceShare& part) { return part.surface->birefringent(); });
}

bool Surface::has_reflector() const {
  if (mixture.empty()) return reflector.has_value();
  return std::any_of(mixture.begin(), mixture.end(),
                     [](const SurfaceShare& part) { return part.surface->has_reflector(); });
}

bool Surface::opaque() const {
  if (!mixture.empty())
    return std::all_of(mixture.begin(), mixture.end(),
                       [](const SurfaceShare& part) { return part.surface->opaque(); });
  if (admission && admission->undeflected.max_y() > 0.0) return false;
  return (reflector && !reflector->transmittance) || microsurface->opaque() ||
         (admission && admission->admitted.max_y() <= 0.0);
}

}  // namespace scintray::optics
