#include <fmt/format.h>

#include <cmath>

#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"

namespace scintray::materials {

namespace {

/// A face much smoother than the wavelength, as Geant4's SURFACEROUGHNESS has it: of the light that Fresnel's
/// equations, or total reflection, reflect on the side of the higher index, the share
/// 1 - exp(-(4 pi sigma n cos / lambda)^2) leaves by Lambert's law instead (total integrated scatter, H. E.
/// Bennett and J. O. Porteus 1961, J. Opt. Soc. Am. 51, 123, cited from memory; the rule is that of
/// G4OpBoundaryProcess 11.4, read). Transmitted light, and light from the other side, is not scattered.
class SlightlyRoughSurface : public optics::MicrosurfaceModel {
 public:
  explicit SlightlyRoughSurface(double rms_height_nm) : rms_height_nm_(rms_height_nm) {}

  optics::SurfaceOutcome scatter(optics::Ray& ray, optics::Side side, const optics::IndexPair& index,
                                 optics::SurfaceInteraction& interaction) const override {
    const core::Vec3 against =
        side == optics::Side::inside ? core::Vec3(-interaction.normal) : interaction.normal;
    const double n1 = index.on(side), n2 = index.on(other(side));
    const double cosine = std::abs(ray.direction.dot(against));
    if (optics::interact_at_facet(ray, against, index, side, interaction.rng))
      return optics::outcome_on(other(side));
    const double phase = 4.0 * core::kPi * rms_height_nm_ * n1 * cosine / interaction.wavelength_nm;
    if (n1 > n2 && interaction.rng.uniform() >= std::exp(-phase * phase))
      optics::scatter_lambertian(ray, against, interaction.rng);
    return optics::outcome_on(side);
  }

  bool birefringent() const override { return true; }

 private:
  double rms_height_nm_;
};

}  // namespace

SurfaceModel slightly_rough_model() {
  const auto read = [](const config::TomlTable& surface) {
    const config::TomlTable table = surface.table("slightly_rough");
    constexpr double kNmPerUm = 1e3;
    const double height_nm = kNmPerUm * read_um(table, "rms_height", 0.0, true);
    if (!table.has("rms_height")) table.quantity("rms_height", core::Dimension::length);
    return FixedMicrosurface(SlightlyRoughSurface(height_nm), fmt::format("slightly rough {} nm", height_nm));
  };
  return {.word = "slightly_rough", .table = "slightly_rough", .read = read};
}

}  // namespace scintray::materials
