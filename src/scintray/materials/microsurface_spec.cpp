#include "scintray/materials/microsurface_spec.hpp"

#include "scintray/materials/built_in_microsurfaces.hpp"

namespace scintray::materials {

optics::IndexPair SurfaceSetting::indices(double wavelength_nm) const {
  const bool layer = stack.reflector || stack.gap_thickness_um;
  return {inside.index(wavelength_nm), layer ? stack.gap_index(wavelength_nm) : outside.index(wavelength_nm)};
}

optics::Microsurface ReliefSpec::make(const SurfaceSetting& setting, ReliefStore& reliefs) const {
  const Relief made = relief(reliefs);
  if (!table) return made.field;
  std::vector<topography::SpectralPoint> spectrum;
  for (const double nm : table->wavelengths_nm) spectrum.push_back({nm, setting.indices(nm)});
  if (spectrum.empty()) spectrum.push_back({setting.reference_nm, setting.indices(setting.reference_nm)});
  return reliefs.table(setting.stack.name, made, table->settings, spectrum);
}

}  // namespace scintray::materials
