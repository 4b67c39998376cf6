#include "scintray/materials/microsurface_spec.hpp"

#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/materials/table_key.hpp"
#include "scintray/materials/wavelength_cover.hpp"

namespace scintray::materials {

optics::IndexPair SurfaceSetting::indices(double wavelength_nm) const {
  const bool layer = stack.reflector || stack.gap_thickness_um;
  return {inside.index(wavelength_nm), layer ? stack.gap_index(wavelength_nm) : outside.index(wavelength_nm)};
}

optics::Microsurface FixedMicrosurface::make(const SurfaceSetting& setting, ReliefStore&) const {
  core::Problems problems;
  for (const WavelengthTable& table : tables_)
    check_cover(problems, table.where,
                {table.curve, "surface \"" + setting.stack.name + "\"", table.what,
                 "extend the table in its definition, or choose other wavelengths"},
                setting.low_nm, setting.high_nm);
  problems.throw_if_any();
  return microsurface_;
}

optics::Microsurface ReliefSpec::make(const SurfaceSetting& setting, ReliefStore& reliefs) const {
  const std::string key = relief_key();
  const auto relief = [&]() -> const Relief& {
    return reliefs.relief(key, [this] { return make_relief(); });
  };
  if (!table) return relief().field;
  TableRequest request{
      setting.stack.name, setting.inside.name + " to " + setting.outside.name, key, table->settings, {}};
  for (const double nm : table->wavelengths_nm) request.spectrum.push_back({nm, setting.indices(nm)});
  if (request.spectrum.empty())
    request.spectrum.push_back({setting.reference_nm, setting.indices(setting.reference_nm)});
  return reliefs.table(request, relief);
}

std::optional<std::string> ReliefSpec::key() const {
  return relief_key() + (table ? "; " + tracing_key(*table) : "");
}

}  // namespace scintray::materials
