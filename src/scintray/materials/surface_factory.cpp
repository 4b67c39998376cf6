#include "scintray/materials/surface_factory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scintray/materials/index_tolerance.hpp"

namespace scintray::materials {

namespace {

void warn_of_dispersion(const optics::SurfaceTable& table, const SurfaceSetting& setting,
                        std::vector<std::string>& warnings) {
  double worst = 0.0;
  for (const double nm : {setting.low_nm, setting.reference_nm, setting.high_nm})
    worst = std::max(worst, index_mismatch(table, setting, nm));
  if (worst > kIndexTolerance)
    warnings.push_back(fmt::format(
        "surface \"{}\" ({} to {}): over the wavelengths in use, {:.0f} to {:.0f} nm, the ratio of indices "
        "differs from its table's by up to {:.1f} %; a table for more wavelengths would follow it "
        "(tracing.wavelengths)",
        setting.stack.name, setting.inside.name, setting.outside.name, setting.low_nm, setting.high_nm,
        100.0 * worst));
}

}  // namespace

MadeSurface SurfaceFactory::make(const SurfaceSpec& spec, const optics::Medium& inside,
                                 const optics::Medium& outside, double reference_nm, double low_nm,
                                 double high_nm) {
  MadeSurface made;
  optics::Surface& surface = made.surface;
  static_cast<optics::SurfaceStack&>(surface) = spec;
  surface.definition = spec.name;
  if (spec.between_media_only && inside.name == outside.name) {
    static_cast<optics::SurfaceStack&>(surface) = {};
    surface.name = spec.name;
    return made;
  }
  for (const ShareSpec& part : spec.mixture) {
    MadeSurface share = make(*part.surface, inside, outside, reference_nm, low_nm, high_nm);
    surface.mixture.push_back(
        {part.share, std::make_shared<const optics::Surface>(std::move(share.surface))});
    made.warnings.insert(made.warnings.end(), share.warnings.begin(), share.warnings.end());
  }
  if (!spec.mixture.empty()) return made;

  const SurfaceSetting setting{spec, inside, outside, reference_nm, low_nm, high_nm};
  surface.microsurface = spec.microsurface->make(setting, reliefs_);
  if (const auto* table = surface.microsurface.get_if<optics::SurfaceTable>())
    warn_of_dispersion(*table, setting, made.warnings);
  return made;
}

}  // namespace scintray::materials
