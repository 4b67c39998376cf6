#include "scintray/optics/coherent_layers.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/optics/elliptical.hpp"

namespace scintray::optics {

namespace {

using Complex = std::complex<double>;

/// Sine squared of the angle of incidence from which the plane of incidence is numerically defined.
constexpr double kObliqueFrom = 1e-20;
/// Least cosine of incidence, where the amplitudes reach their limit at grazing incidence.
constexpr double kGrazing = 1e-12;

/// Amplitudes reflected and transmitted by everything behind a face.
struct Amplitudes {
  Complex r, t;
};

/// @param admittance  of the media in order, the first and the last being those around the films
/// @param phase       of one crossing of each film
Amplitudes amplitudes(const std::vector<Complex>& admittance, const std::vector<Complex>& phase) {
  const auto face = [&](std::size_t j) {
    const Complex sum = admittance[j] + admittance[j + 1];
    return Amplitudes{(admittance[j] - admittance[j + 1]) / sum, 2.0 * admittance[j] / sum};
  };
  Amplitudes behind = face(phase.size());
  for (std::size_t j = phase.size(); j-- > 0;) {
    const Complex once = std::exp(Complex(0.0, 1.0) * phase[j]);
    const Amplitudes front = face(j);
    const Complex rounds = 1.0 + front.r * behind.r * once * once;
    behind = {(front.r + behind.r * once * once) / rounds, front.t * once * behind.t / rounds};
  }
  return behind;
}

bool polarised(const Ray& ray) { return !ray.polarisation.isZero(0.0); }

/// Share of the power in s, and the field's components along s and p; s across the plane of incidence.
struct Components {
  core::Vec3 s;
  FieldComponents field;

  Components(const Ray& ray, const core::Vec3& m) : s(ray.direction.cross(m).normalized()) {
    if (ray.keeps_phases)
      field = field_of(ray, s);
    else
      field = {ray.polarisation.dot(s), ray.polarisation.dot(s.cross(ray.direction.vec()))};
  }
  double share_of_s() const { return std::norm(field.s) / (std::norm(field.s) + std::norm(field.p)); }
};

/// Amplitudes and power shares of s and p that leave a face.
struct Leaving {
  Complex s, p;
  double power_s, power_p;
};

/// Sets the polarisation of a ray of its new direction. Where phases are not kept, the sign between s and p
/// is drawn so that its mean is the cosine of their phase.
void polarise(Ray& ray, const Components& before, const Leaving& out, core::Rng& rng) {
  if (ray.keeps_phases) {
    const auto with_phase_of = [](Complex amplitude, double power) {
      return std::polar(std::sqrt(std::max(0.0, power)), std::arg(amplitude));
    };
    set_field(ray, before.s,
              {with_phase_of(out.s, out.power_s) * before.field.s,
               with_phase_of(out.p, out.power_p) * before.field.p});
    return;
  }
  const double sign = draw_sign(out.s, out.p, rng);
  const double out_s = std::sqrt(std::max(0.0, out.power_s)) * before.field.s.real();
  const double out_p = sign * std::sqrt(std::max(0.0, out.power_p)) * before.field.p.real();
  ray.polarisation = (out_s * before.s + out_p * before.s.cross(ray.direction.vec())).normalized();
}

}  // namespace

std::complex<double> normal_index(std::complex<double> index, double transverse_index) {
  const Complex q = std::sqrt(index * index - transverse_index * transverse_index);
  return q.imag() < 0.0 || (q.imag() == 0.0 && q.real() < 0.0) ? -q : q;
}

FilmOutcome interact_at_films(Ray& ray, const core::Vec3& m, const FilmResponse& film, double n1, double n2,
                              core::Rng& rng) {
  const double cos_i = std::clamp(-ray.direction.dot(m), 0.0, 1.0);
  const Refraction refraction(cos_i, n1, n2);
  const bool oblique = refraction.sin2_i >= kObliqueFrom;
  std::optional<Components> parts;
  double share_s = 0.5;
  if (polarised(ray) && oblique) {
    parts.emplace(ray, m);
    share_s = parts->share_of_s();
  }
  const double reflectance = share_s * film.reflectance_s + (1.0 - share_s) * film.reflectance_p;
  const double transmittance = share_s * film.transmittance_s + (1.0 - share_s) * film.transmittance_p;
  const double u = rng.uniform();
  if (u < reflectance) {
    if (!parts) {
      reflect(ray, m);
    } else {
      ray.direction = core::mirror(ray.direction, m);
      polarise(ray, *parts, {film.r_s, film.r_p, film.reflectance_s, film.reflectance_p}, rng);
    }
    return FilmOutcome::reflected;
  }
  if (u >= reflectance + transmittance || refraction.total()) return FilmOutcome::absorbed;
  const double ratio = refraction.ratio;
  ray.direction = (ratio * ray.direction + (ratio * cos_i - refraction.cos_t()) * m).normalized();
  if (parts) polarise(ray, *parts, {film.t_s, film.t_p, film.transmittance_s, film.transmittance_p}, rng);
  return FilmOutcome::transmitted;
}

FilmResponse film_response(double cos_i, double n1, std::span<const Film> films, std::complex<double> n2,
                           double wavelength_nm) {
  const double cosine = std::max(cos_i, kGrazing);
  const double transverse = n1 * std::sqrt(1.0 - cosine * cosine);
  std::vector<Complex> s, p, phase;
  const auto add = [&](Complex index, Complex q) {
    s.push_back(q);
    p.push_back(q / (index * index));
  };
  add(n1, n1 * cosine);
  for (const Film& film : films) {
    const Complex q = normal_index(film.index, transverse);
    add(film.index, q);
    phase.push_back(core::kTwoPi * film.thickness_nm / wavelength_nm * q);
  }
  add(n2, normal_index(n2, transverse));
  const Amplitudes of_s = amplitudes(s, phase), of_p = amplitudes(p, phase);
  FilmResponse response;
  response.r_s = of_s.r;
  response.r_p = of_p.r;
  response.t_s = of_s.t;
  response.t_p = of_p.t;
  response.reflectance_s = std::min(1.0, std::norm(of_s.r));
  response.reflectance_p = std::min(1.0, std::norm(of_p.r));
  response.transmittance_s =
      std::clamp(s.back().real() / s.front().real() * std::norm(of_s.t), 0.0, 1.0 - response.reflectance_s);
  response.transmittance_p =
      std::clamp(p.back().real() / p.front().real() * std::norm(of_p.t), 0.0, 1.0 - response.reflectance_p);
  return response;
}

FilmOutcome ThinFilmSurface::interact(Ray& ray, Side side, const core::Vec3& facet, const IndexPair& index,
                                      SurfaceInteraction& interaction) const {
  const double nm = interaction.wavelength_nm;
  std::vector<Film> films;
  for (const CoatingLayer& layer : layers_)
    films.push_back({{layer.index(nm), layer.extinction(nm)}, layer.thickness_nm});
  if (side == Side::outside) std::reverse(films.begin(), films.end());
  const double n1 = index.on(side), n2 = index.on(other(side));
  const double cos_i = std::clamp(-ray.direction.dot(facet), 0.0, 1.0);
  const double tangential = n1 * std::sqrt(1.0 - cos_i * cos_i);
  if (!options_.frustrated && std::any_of(films.begin(), films.end(), [&](const Film& film) {
        return film.index.imag() == 0.0 && tangential >= film.index.real();
      })) {
    reflect(ray, facet);
    return FilmOutcome::reflected;
  }
  return interact_at_films(ray, facet, film_response(cos_i, n1, films, n2, nm), n1, n2, interaction.rng);
}

SurfaceOutcome ThinFilmSurface::scatter(Ray& ray, Side side, const IndexPair& index,
                                        SurfaceInteraction& interaction) const {
  core::Rng& rng = interaction.rng;
  for (;;) {
    const core::Vec3 against = side == Side::inside ? core::Vec3(-interaction.normal) : interaction.normal;
    const core::Vec3 facet = facets_.sample_facet(ray.direction, against, rng);
    const Ray before = ray;
    switch (interact(ray, side, facet, index, interaction)) {
      case FilmOutcome::reflected:
        FacetSurface::apply_lobe(facets_.sample_lobe(rng), ray, before, against, rng);
        break;
      case FilmOutcome::transmitted:
        if (!options_.transmits) return SurfaceOutcome::absorbed;
        side = other(side);
        break;
      case FilmOutcome::absorbed:
        return SurfaceOutcome::absorbed;
    }
    const double outward = ray.direction.dot(interaction.normal);
    if (side == Side::inside ? outward < 0.0 : outward > 0.0) return outcome_on(side);
  }
}

SurfaceOutcome MetalSurface::scatter(Ray& ray, Side side, const IndexPair& index,
                                     SurfaceInteraction& interaction) const {
  const core::Vec3 against = side == Side::inside ? core::Vec3(-interaction.normal) : interaction.normal;
  const double nm = interaction.wavelength_nm, n1 = index.on(side);
  core::Rng& rng = interaction.rng;
  const FacetSurface::Lobe lobe = facets.sample_lobe(rng);
  const bool at_facets = lobe == FacetSurface::Lobe::facet;
  for (;;) {
    const core::Vec3 facet = at_facets ? facets.sample_facet(ray.direction, against, rng) : against;
    const Ray before = ray;
    if (metal) {
      const FilmResponse response = film_response(std::clamp(-ray.direction.dot(facet), 0.0, 1.0), n1, {},
                                                  {metal->n(nm), metal->k(nm)}, nm);
      FilmResponse mirror = response;  // what enters the metal stays in it
      mirror.transmittance_s = mirror.transmittance_p = 0.0;
      if (interact_at_films(ray, facet, mirror, n1, n1, rng) != FilmOutcome::reflected)
        return SurfaceOutcome::absorbed;
    } else {
      reflect(ray, facet);
    }
    FacetSurface::apply_lobe(lobe, ray, before, against, rng);
    if (ray.direction.dot(against) > 0.0) return outcome_on(side);
  }
}

}  // namespace scintray::optics
