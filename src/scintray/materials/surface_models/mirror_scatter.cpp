// Mirrors that scatter some of the light about the specular direction by a closed form.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "scintray/materials/detail/height_spectrum_form.hpp"
#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/optics/opaque_face.hpp"

namespace scintray::materials {

namespace {

constexpr double kFarthest = 2.0;  ///< distance of two directions in the plane of direction cosines

/// A BRDF that depends on the distance r = |beta - beta0| of two directions in the plane of direction cosines
/// alone, but for obliquity factors. Symmetric in the two directions: reciprocal.
class ScatterLaw {
 public:
  virtual ~ScatterLaw() = default;
  /// Integral of the BRDF over the plane of direction cosines within r of the specular direction, without
  /// obliquity; `waves` is the wavelength in the medium of incidence, nm.
  virtual double total(double waves_nm) const = 0;
  /// Distance at a share u of that integral.
  virtual double distance(double u, double waves_nm) const = 0;
  /// The factor cos(theta_in) cos(theta_out) of perturbation theory.
  virtual bool oblique() const { return false; }
};

/// A / (B + r^g): Photon Engineering, FRED's manual, "ABg"; lumos-sat's manual, lumos.brdf.library.ABG.
class AbgLaw : public ScatterLaw {
 public:
  AbgLaw(double a, double b, double g) : b_(b), g_(g) {
    constexpr double kRatio = 1.02;
    const double knee = std::min(kFarthest, g > 0.0 ? std::pow(b, 1.0 / g) : kFarthest);
    edges_ = {0.0, 1e-3 * knee};
    while (edges_.back() < kFarthest) edges_.push_back(std::min(kFarthest, edges_.back() * kRatio));
    sums_.push_back(0.0);
    for (std::size_t k = 0; k + 1 < edges_.size(); ++k)
      sums_.push_back(sums_.back() + core::kTwoPi * a * integral(edges_[k], edges_[k + 1]));
  }
  double total(double) const override { return sums_.back(); }
  /// A cell by its integral, and within it by rejection: exact.
  double distance(double u, double) const override {
    const auto above = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, u * sums_.back());
    const auto k = static_cast<std::size_t>(above - sums_.begin()) - 1;
    const double low = edges_[k], high = edges_[k + 1];
    // Equidistributed numbers made of the fraction of u within the cell, by the golden ratio.
    constexpr double kGolden = 0.61803398874989485, kPlastic = 0.75487766624669276;
    double v = (u * sums_.back() - sums_[k]) / (sums_[k + 1] - sums_[k]), w = v * 4096.0;
    const double most = high * profile(low);
    for (;;) {
      v -= std::floor(v);
      w -= std::floor(w);
      const double r = low + v * (high - low);
      if (w * most <= r * profile(r)) return r;
      v += kGolden;
      w += kPlastic;
    }
  }

 private:
  double profile(double r) const { return 1.0 / (b_ + std::pow(r, g_)); }
  /// Integral of r profile(r): Gauss and Legendre, five points.
  double integral(double low, double high) const {
    constexpr std::array<std::pair<double, double>, 5> kPoints{{{-0.9061798459386640, 0.2369268850561891},
                                                                {-0.5384693101056831, 0.4786286704993665},
                                                                {0.0, 0.5688888888888889},
                                                                {0.5384693101056831, 0.4786286704993665},
                                                                {0.9061798459386640, 0.2369268850561891}}};
    double sum = 0.0;
    for (const auto& [x, weight] : kPoints) {
      const double r = 0.5 * (low + high) + 0.5 * (high - low) * x;
      sum += weight * r * profile(r);
    }
    return 0.5 * (high - low) * sum;
  }

  double b_, g_;
  std::vector<double> edges_, sums_;
};

/// b0 (1 + (r / L)^2)^(s / 2): Photon Engineering, FRED's manual, "Harvey-Shack".
class HarveyShackLaw : public ScatterLaw {
 public:
  HarveyShackLaw(double b0, double knee, double slope) : b0_(b0), knee_(knee), slope_(slope) {}
  double total(double) const override { return core::kPi * b0_ * knee_ * knee_ * grown(kFarthest); }
  double distance(double u, double) const override {
    const double grown_to = u * grown(kFarthest), power = 0.5 * slope_ + 1.0;
    const double q = std::abs(power) < kLogarithm ? std::expm1(grown_to)
                                                  : std::expm1(std::log1p(power * grown_to) / power);
    return std::min(kFarthest, knee_ * std::sqrt(q));
  }

 private:
  static constexpr double kLogarithm = 1e-9;
  /// Integral of (1 + q)^(s / 2) dq, q = (r / L)^2.
  double grown(double r) const {
    const double q = std::pow(r / knee_, 2), power = 0.5 * slope_ + 1.0;
    return std::abs(power) < kLogarithm ? std::log1p(q) : std::expm1(power * std::log1p(q)) / power;
  }
  double b0_, knee_, slope_;
};

/// share exp(-(r / sigma)^2) / (pi sigma^2), normalised over r up to 2: Zemax, knowledge base, article 219
/// ("How to Create a User-Defined Scattering Function"), page 4, whose Gaussian_XY with equal widths this is.
class GaussianLaw : public ScatterLaw {
 public:
  GaussianLaw(double share, double sigma) : share_(share), sigma_(sigma) {}
  double total(double) const override { return share_; }
  double distance(double u, double) const override {
    const double all = -std::expm1(-std::pow(kFarthest / sigma_, 2));
    return std::min(kFarthest, sigma_ * std::sqrt(-std::log1p(-u * all)));
  }

 private:
  double share_, sigma_;
};

/// First-order perturbation of a mirror with the K-correlation spectrum of docs/surfaces.md: per unit of the
/// reflectance 16 pi^2 / w^4 cos cos S(r / w), w the wavelength in the medium, whose integral at normal
/// incidence is (4 pi Sq / w)^2, that of total integrated scatter. The form is that of J. C. Stover, Optical
/// Scattering, eq. (4.1), of which FRED's manual ("Tabulated PSD") names the factors; the constant follows
/// from the integral.
class KCorrelationLaw : public ScatterLaw {
 public:
  explicit KCorrelationLaw(std::shared_ptr<const optics::HeightSpectrum> spectrum)
      : spectrum_(std::move(spectrum)) {}
  double total(double waves_nm) const override {
    return std::pow(4.0 * core::kPi / waves_nm, 2) * spectrum_->variance_nm2(kFarthest / waves_nm);
  }
  double distance(double u, double waves_nm) const override {
    return waves_nm * spectrum_->frequency_per_nm(u, kFarthest / waves_nm);
  }
  bool oblique() const override { return true; }

 private:
  std::shared_ptr<const optics::HeightSpectrum> spectrum_;
};

/// A mirror of a reflectance of which some light is scattered by a law; the rest of the reflectance is
/// specular. With the law's total T at most the reflectance, a direction is drawn with T; one beyond the unit
/// circle, or refused by the obliquity factors, is specular after all. So the BRDF is the law's, exactly.
class MirrorScatterSurface : public optics::OpaqueFace {
 public:
  MirrorScatterSurface(core::Curve reflectance, std::shared_ptr<const ScatterLaw> law, double gap_index)
      : OpaqueFace(gap_index), reflectance_(std::move(reflectance)), law_(std::move(law)) {}

  /// Share of the light that the law scatters at most, light of all directions together.
  double scattered(double waves_nm, double wavelength_nm) const {
    return law_->total(waves_nm) * (law_->oblique() ? reflectance_(wavelength_nm) : 1.0);
  }
  double reflectance(double wavelength_nm) const { return reflectance_(wavelength_nm); }

 protected:
  bool reflect_light(optics::Ray& ray, const core::Vec3& normal, double index,
                     optics::SurfaceInteraction& at) const override {
    const double u = at.rng.uniform(), waves_nm = at.wavelength_nm / index;
    if (u >= reflectance_(at.wavelength_nm)) return false;
    const double cos_in = -ray.direction.dot(normal);
    optics::reflect(ray, normal);
    if (u >= scattered(waves_nm, at.wavelength_nm)) return true;
    const double r = law_->distance(at.rng.uniform(), waves_nm);
    const core::CirclePoint<double> on_circle = core::sample_circle(at.rng);
    const core::Frame frame = core::Frame::about(normal);
    const double x = ray.direction.dot(frame.x) + r * on_circle.x,
                 y = ray.direction.dot(frame.y) + r * on_circle.y;
    const double cos2 = 1.0 - x * x - y * y;
    if (cos2 <= optics::kLeastOpaqueCosine * optics::kLeastOpaqueCosine) return true;
    const double cosine = std::sqrt(cos2);
    if (law_->oblique() && at.rng.uniform() >= cos_in * cosine) return true;
    ray.direction = x * frame.x + y * frame.y + cosine * normal;
    if (!ray.polarisation.isZero(0.0)) optics::repolarise(ray, at.rng);
    return true;
  }

 private:
  core::Curve reflectance_;
  std::shared_ptr<const ScatterLaw> law_;
};

/// The definition: its total is known with the wavelengths and the index of the medium.
class MirrorScatterDefinition : public FixedMicrosurface {
 public:
  MirrorScatterDefinition(MirrorScatterSurface surface, std::vector<WavelengthTable> tables,
                          core::FileLocation where)
      : FixedMicrosurface(std::move(surface), std::nullopt, std::move(tables)), where_(std::move(where)) {}

  optics::Microsurface make(const SurfaceSetting& setting, ReliefStore& reliefs) const override {
    const optics::Microsurface made = FixedMicrosurface::make(setting, reliefs);
    const auto* mirror = made.get_if<MirrorScatterSurface>();
    for (const double nm : {setting.low_nm, setting.reference_nm, setting.high_nm}) {
      const optics::IndexPair index = setting.indices(nm);
      const double densest =
          std::max(mirror->gap_index() > 0.0 ? mirror->gap_index() : index.inside, index.outside);
      const double scattered = mirror->scattered(nm / densest, nm), reflectance = mirror->reflectance(nm);
      if (scattered > reflectance)
        throw core::InputError(
            {where_,
             fmt::format("surface \"{}\" would scatter {:.3g} of the light at {:g} nm, more than its "
                         "reflectance of {:g}",
                         setting.stack.name, scattered, nm, reflectance),
             "these laws hold for mirrors that scatter little: lower the roughness, a, b0 or l, or use "
             "a model of facets or a height map"});
    }
    return made;
  }

 private:
  core::FileLocation where_;
};

double read_scatter_number(const config::TomlTable& table, const char* key, bool positive) {
  const double value = table.number(key);
  table.expect(key, positive ? value > 0.0 : std::isfinite(value),
               fmt::format("\"{}\" is {:g}, but a number above 0 is expected", key, value));
  return value;
}

using LawReader = std::shared_ptr<const ScatterLaw> (*)(const config::TomlTable&);

std::shared_ptr<const ScatterLaw> read_abg(const config::TomlTable& table) {
  constexpr double kLeastKnee = 1e-6;
  const double a = read_scatter_number(table, "a", true), b = read_scatter_number(table, "b", true),
               g = read_scatter_number(table, "g", true);
  if (!table.good("a") || !table.good("b") || !table.good("g")) return nullptr;
  const double knee = std::pow(b, 1.0 / g);
  table.expect(
      "b", knee >= kLeastKnee,
      fmt::format("\"b\" and \"g\" put the knee of the law, b^(1/g), at {:g}; expected {:g} at least", knee,
                  kLeastKnee),
      "raise b: light within such a distance of the specular direction is specular");
  if (!table.good("b")) return nullptr;
  return std::make_shared<AbgLaw>(a, b, g);
}

std::shared_ptr<const ScatterLaw> read_harvey_shack(const config::TomlTable& table) {
  const double b0 = read_scatter_number(table, "b0", true), knee = read_scatter_number(table, "l", true),
               slope = table.number("s");
  table.expect("s", slope <= 0.0,
               fmt::format("\"s\" is {:g}, but the slope of a scatter law is not above 0", slope),
               "far from the specular direction the BRDF falls as the power s of the distance, as s = -1.5");
  if (!table.good("b0") || !table.good("l") || !table.good("s")) return nullptr;
  return std::make_shared<HarveyShackLaw>(b0, knee, slope);
}

std::shared_ptr<const ScatterLaw> read_gaussian(const config::TomlTable& table) {
  constexpr double kWidest = 5.0;  // OpticStudio's limit, at which the law is nearly Lambert's
  const double share = read_share(table, "share", std::nullopt),
               sigma = read_scatter_number(table, "sigma", true);
  table.expect("sigma", sigma <= kWidest, fmt::format("\"sigma\" is {:g}; expected 5 at most", sigma),
               "it is a distance of direction cosines: the sine of an angle from the specular direction");
  if (!table.good("share") || !table.good("sigma")) return nullptr;
  return std::make_shared<GaussianLaw>(share, sigma);
}

std::shared_ptr<const ScatterLaw> read_k_correlation(const config::TomlTable& table) {
  const std::optional<HeightSpectrumSpec> spectrum = read_k_correlation_spectrum(table);
  return spectrum ? std::make_shared<KCorrelationLaw>(spectrum->spectrum) : nullptr;
}

constexpr core::Word<LawReader> kScatterLaws[] = {{"abg", read_abg},
                                                  {"harvey_shack", read_harvey_shack},
                                                  {"gaussian", read_gaussian},
                                                  {"k_correlation", read_k_correlation}};

MicrosurfaceSpec read_mirror_scatter(const config::TomlTable& surface) {
  const config::TomlTable table = surface.table("mirror_scatter");
  core::Curve reflectance = core::Curve::constant(1.0);
  std::vector<WavelengthTable> covers;
  if (table.has("reflectance")) {
    reflectance = table.curve("reflectance", core::Dimension::dimensionless);
    const double most = reflectance.max_y();
    table.expect("reflectance", reflectance.min_y() >= 0.0 && most <= 1.0,
                 fmt::format("\"reflectance\" is up to {:g}, but a share between 0 and 1 is expected", most));
    covers.push_back({reflectance, "reflectances", table.where("reflectance")});
  }
  const double gap_index = read_gap_index(table);
  const core::Word<LawReader>* form = table.one_of(kScatterLaws, true);
  const std::shared_ptr<const ScatterLaw> law = form ? form->value(table.table(form->word)) : nullptr;
  if (!law) return FixedMicrosurface(optics::SmoothSurface());
  return MirrorScatterDefinition(MirrorScatterSurface(std::move(reflectance), law, gap_index),
                                 std::move(covers), table.where());
}

}  // namespace

SurfaceModel mirror_scatter_model() {
  return {.word = "mirror_scatter", .table = "mirror_scatter", .read = read_mirror_scatter};
}

}  // namespace scintray::materials
