#pragma once
/// Thin films and metals: reflection and transmission with interference, and with complex indices.
///
/// Amplitudes: M. Born and E. Wolf, Principles of Optics, 7th ed., section 1.5.2 for one interface; G. B.
/// Airy's sum over the reflections within a film, section 7.6.1, from the last film to the first (L. G.
/// Parratt 1954, Phys. Rev. 95, 359). Absorbing media by a complex index n + i k, with fields that vary as
/// exp(-i omega t), section 14.2. (Cited from memory, not opened.)

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/optics/facets.hpp"

namespace scintray::optics {

/// A film: its complex refractive index and its thickness.
struct Film {
  std::complex<double> index;
  double thickness_nm = 0.0;
};

/// Response of a stack of films to light of the two polarisations, s (electric field across the plane of
/// incidence) and p (in it).
struct FilmResponse {
  std::complex<double> r_s, r_p;  ///< amplitudes reflected, in the sign convention of FresnelAmplitudes
  std::complex<double> t_s, t_p;  ///< amplitudes transmitted: of the electric field for s, magnetic for p
  double reflectance_s = 1.0, reflectance_p = 1.0;      ///< shares of the power
  double transmittance_s = 0.0, transmittance_p = 0.0;  ///< ...; what is left of 1 is absorbed in the films

  double reflectance() const { return 0.5 * (reflectance_s + reflectance_p); }
  double transmittance() const { return 0.5 * (transmittance_s + transmittance_p); }
};

/// Index times the cosine of the angle in a medium, of a wave that decays, or travels on, behind the face.
/// @param transverse_index  index times the sine of the angle, the same in all media
std::complex<double> normal_index(std::complex<double> index, double transverse_index);

/// Response of films between two media to light incident at an angle of cosine `cos_i` in [0, 1].
///
/// Light beyond the critical angle of a film crosses it as an evanescent wave, and is transmitted when the
/// medium behind admits it (frustrated total reflection). With an absorbing medium behind, the transmitted
/// power is absorbed there.
/// @param n1     index of the medium of incidence, real
/// @param films  in the order in which light crosses them; may be empty
/// @param n2     complex index of the medium behind
FilmResponse film_response(double cos_i, double n1, std::span<const Film> films, std::complex<double> n2,
                           double wavelength_nm);

enum class FilmOutcome { reflected, transmitted, absorbed };

/// Interaction of a ray with a face that has a response, at a facet of unit normal `m` against the ray, from
/// index n1 to n2; what is neither reflected nor transmitted is absorbed, and leaves the ray as it was.
FilmOutcome interact_at_films(Ray& ray, const core::Vec3& m, const FilmResponse& film, double n1, double n2,
                              core::Rng& rng);

/// A film of a surface: n and k against wavelength (nm).
struct CoatingLayer {
  core::Curve index, extinction = core::Curve::constant(0.0);
  double thickness_nm = 0.0;
};

/// A face with thin films, from the inside to the outside, which interfere; smooth, or of facets that the
/// films follow, as Geant4's type `coated` has it: what a facet sends into the surface interacts with another
/// facet. A polarised photon that
/// does not keep phases has one linear polarisation: of the phase between s and p only the linear part is
/// kept, drawn so that the mean over photons of the first three Stokes parameters is exact; what a retarding
/// film makes circular is not carried.
class ThinFilmSurface : public MicrosurfaceModel {
 public:
  /// Light that is not as electrodynamics has it, as options of Geant4's type `coated`.
  struct Options {
    bool frustrated =
        true;  ///< false: beyond the critical angle of a film without extinction all is reflected
    bool transmits = true;  ///< false: light that would be transmitted is absorbed
    bool operator==(const Options&) const = default;
  };
  explicit ThinFilmSurface(std::vector<CoatingLayer> layers) : layers_(std::move(layers)) {}
  ThinFilmSurface(std::vector<CoatingLayer> layers, const Options& options, FacetSurface facets = {})
      : layers_(std::move(layers)), options_(options), facets_(std::move(facets)) {}
  const Options& options() const { return options_; }
  bool opaque() const override { return !options_.transmits; }
  const std::vector<CoatingLayer>& layers() const { return layers_; }
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
  bool reciprocal() const override { return facets_.sigma_alpha_rad == 0.0 && facets_.smear == 0.0; }

 private:
  /// Interaction with the films on a facet of a normal against the ray.
  FilmOutcome interact(Ray& ray, Side side, const core::Vec3& facet, const IndexPair& index,
                       SurfaceInteraction& interaction) const;

  std::vector<CoatingLayer> layers_;  ///< from the inside to the outside
  Options options_;
  FacetSurface facets_;  ///< smooth unless they have a width
};

/// Complex index of a metal against wavelength (nm).
struct MetalIndex {
  core::Curve n, k;
};

/// A face of metal, which transmits nothing: the reflectance follows from the complex index of the metal and
/// the index of the medium of incidence, or is 1 without an index. `facets` holds its roughness, widths
/// and lobes; the lobe is chosen once, and light that a facet reflects into the surface
/// interacts with another facet (the loop of Geant4's boundary process).
class MetalSurface : public MicrosurfaceModel {
 public:
  std::optional<MetalIndex> metal;
  FacetSurface facets;

  bool opaque() const override { return true; }
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
};

}  // namespace scintray::optics
