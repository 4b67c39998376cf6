#include <fmt/format.h>

#include <cmath>

#include "scintray/materials/detail/height_spectrum_form.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/optics/wave_scatter.hpp"

namespace scintray::materials {

namespace {

/// Largest share of the light that perturbation theory may scatter (chosen: what it leaves out is of the
/// order of the square of this share).
constexpr double kMostScattered = 0.2;
/// Largest ratio of two wavelengths between which shares are interpolated (chosen).
constexpr double kWavelengthRatio = 1.08;

/// The definition: shares are computed for the wavelengths in use and the indices of the media.
class WaveScatterDefinition : public MicrosurfaceDefinition {
 public:
  WaveScatterDefinition(HeightSpectrumSpec spectrum, core::FileLocation where)
      : spectrum_(std::move(spectrum)), where_(std::move(where)) {}

  optics::Microsurface make(const SurfaceSetting& setting, ReliefStore&) const override {
    const double low = setting.low_nm, high = setting.high_nm;
    const int steps = static_cast<int>(std::ceil(std::log(high / low) / std::log(kWavelengthRatio) - 1e-9));
    std::vector<optics::WaveScatterSurface::Node> nodes;
    for (int k = 0; k <= steps; ++k) {
      const double nm = k == steps ? high : low * std::pow(high / low, static_cast<double>(k) / steps);
      const optics::IndexPair index = setting.indices(nm);
      nodes.push_back({nm, index.inside, index.outside});
    }
    optics::WaveScatterSurface surface(spectrum_.spectrum, nodes);
    if (surface.most_scattered() > kMostScattered)
      throw core::InputError(
          {where_,
           fmt::format("surface \"{}\" would scatter {:.3g} of the light; perturbation theory holds for "
                       "faces that scatter {:g} at most",
                       setting.stack.name, surface.most_scattered(), kMostScattered),
           "give a smaller rms_height, or model the face by its height map, a recipe or facets"});
    return surface;
  }
  std::optional<std::string> key() const override { return "wave scatter " + spectrum_.key; }

 private:
  HeightSpectrumSpec spectrum_;
  core::FileLocation where_;
};

MicrosurfaceSpec read_wave_scatter(const config::TomlTable& surface) {
  const config::TomlTable table = surface.table("wave_scatter");
  std::optional<HeightSpectrumSpec> spectrum = read_height_spectrum(table);
  if (!spectrum) return FixedMicrosurface(optics::SmoothSurface());
  return WaveScatterDefinition(std::move(*spectrum), table.where());
}

}  // namespace

SurfaceModel wave_scatter_model() {
  return {.word = "wave_scatter", .table = "wave_scatter", .read = read_wave_scatter};
}

}  // namespace scintray::materials
