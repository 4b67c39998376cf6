#pragma once
/// Waves scattered by a nearly smooth face between two media: vector perturbation theory, of first order in
/// the height for scattered light and of second order for the light that remains specular.
///
/// First order: the height h changes the permittivity in a thin layer; the polarisation of that layer in the
/// fields of the smooth face radiates, and by reciprocity its amplitude in a direction is its product with
/// the fields of a wave incident along the reversed direction. With indices n1 and n2, the wave number k in
/// vacuum, tangential fields E and normal displacements D of waves of unit amplitude, the amplitude is
/// proportional to k^2 (n2^2 - n1^2) (E . E' + D D' / (n1 n2)^2) for every pair of sides and polarisations.
/// For reflected light this is the theory of Rayleigh and Rice (T. A. Germer 1997, Appl. Opt. 36, 8798), for
/// transmitted light that of J. M. Elson 1995, J. Opt. Soc. Am. A 12, 729, both as in SCATMECH's urough.cpp,
/// which was read; the papers were not. tests/surface/wave_scatter_test.cpp compares both with those
/// formulas.
///
/// Second order: what scattered light is taken from. The law of energy leaves open how reflected and
/// transmitted light share it; see specular_shares.

#include <array>
#include <complex>
#include <memory>
#include <vector>

#include "scintray/core/elementary.hpp"
#include "scintray/optics/height_spectrum.hpp"
#include "scintray/optics/microsurface.hpp"

namespace scintray::optics {

/// Fields at a smooth face, of waves of unit amplitude from a medium of index n1 onto one of n2: across the
/// plane of incidence for s, along the face in that plane and normal to it (D / (n1 n2)) for p.
struct FaceFields {
  std::complex<double> s, along, normal;
};
/// @param transverse  index times the sine of the angle of incidence, below n1
FaceFields face_fields(double transverse, double n1, double n2);

/// Amplitudes of first order between the polarisations of incident and scattered light, named by the
/// scattered one first, relative to k^2 (n2^2 - n1^2) / (4 pi). Of p to p the parts by the tangential and by
/// the normal field.
struct ScatterAmplitudes {
  std::complex<double> s_s, s_p, p_s, p_p_along, p_p_normal;
  std::complex<double> p_p() const { return p_p_along + p_p_normal; }
};
/// @param out      fields of the reversed scattered wave, from its own medium
/// @param turn     azimuth of scattered light about the normal, from that of the incident light
/// @param crosses  the scattered light is in the other medium
ScatterAmplitudes scatter_amplitudes(const FaceFields& in, const FaceFields& out,
                                     const core::SineCosine& turn, bool crosses);

/// Shares of light of one wavelength and one polarisation that a face scatters, to either side, and how much
/// less it transmits than a smooth face.
struct SpecularShares {
  double scattered = 0.0;
  double lost_transmittance = 0.0;  ///< negative where small features act as a graded index
};
/// Shares for light from index n1 onto n2.
///
/// The scattering matrix of a lossless face is unitary, which determines the second order up to one number
/// for each polarisation. That follows from Green's function of the smooth face, whose dissipative part is
/// the sum over outgoing waves, and from the limit of a face that is displaced as a whole. With the
/// amplitude reflected r of the electric field and q the normal component of the index:
///   R' = R - r (d - d0) - 4 q1^2 k^2 Sq^2 R,  T' = 1 - R' - scattered,
/// where d sums the squared amplitudes by tangential fields less those by normal fields, and d0 is d for very
/// long waves of height. T' is then the same in both directions of the light (derived here; the test checks
/// it). Beyond the critical angle R' = 1 - scattered.
/// @return s and p polarisation
std::array<SpecularShares, 2> specular_shares(double transverse, double n1, double n2, double wavelength_nm,
                                              const HeightSpectrum& spectrum);

/// A nearly smooth face between two media. Polarised light is followed; reciprocal, and lossless.
class WaveScatterSurface : public MicrosurfaceModel {
 public:
  /// Indices on the two sides at a wavelength.
  struct Node {
    double wavelength_nm;
    double inside, outside;
  };
  /// Shares are computed at the nodes, whose wavelengths increase, and interpolated between them.
  WaveScatterSurface(std::shared_ptr<const HeightSpectrum> spectrum, const std::vector<Node>& nodes);

  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
  bool reciprocal() const override { return true; }
  /// Largest share that is scattered at any angle, wavelength, side and polarisation.
  double most_scattered() const { return most_scattered_; }

  /// Angles of the table: in [0, n_low] and, on the side of higher index, in [n_low, n_high].
  static constexpr std::size_t kAngles = 49;

 private:
  using Column = std::array<double, kAngles>;
  /// Shares at one wavelength, by polarisation.
  struct Table {
    double wavelength_nm;
    std::array<std::array<Column, 2>, 2> scattered;  ///< by side; transverse indices below both indices
    std::array<Column, 2> beyond;                    ///< scattered beyond the critical angle
    std::array<Column, 2> lost_transmittance;        ///< of light that may be transmitted
    double most_outgoing = 0.0;                      ///< bound for directions drawn by rejection
  };
  struct Shares {
    std::array<double, 2> scattered, transmitted;  ///< s, p
  };
  Table make_table(const Node& node);
  /// Tables around a wavelength, and the weight of the second.
  struct Neighbours {
    const Table &low, &high;
    double weight;
  };
  Neighbours around(double wavelength_nm) const;
  Shares shares(const IndexPair& index, Side side, double transverse, double wavelength_nm) const;
  bool scatter_light(Ray& ray, Side& side, const core::Vec3& against, const IndexPair& index,
                     SurfaceInteraction& interaction) const;

  std::shared_ptr<const HeightSpectrum> spectrum_;
  std::vector<Table> tables_;
  double most_scattered_ = 0.0;
};

}  // namespace scintray::optics
