#include "scintray/materials/wavelength_cover.hpp"

#include <fmt/format.h>

namespace scintray::materials {

void check_cover(core::Problems& problems, const core::FileLocation& where, const TabulatedCurve& tabulated,
                 double low_nm, double high_nm) {
  const auto& [curve, whose, what, hint] = tabulated;
  if (curve.covers(low_nm, high_nm)) return;
  const std::string light =
      low_nm == high_nm ? fmt::format("{:g}", low_nm) : fmt::format("{:g} to {:g}", low_nm, high_nm);
  problems.add(where,
               fmt::format("{} has {} from {:g} to {:g} nm, but light of {} nm is in use", whose, what,
                           curve.x().front(), curve.x().back(), light),
               hint);
}

namespace {

void check_cover_of_shifter(core::Problems& problems, const core::FileLocation& where,
                            const optics::WavelengthShifter* shifter, double low_nm, double high_nm,
                            const std::string& whose) {
  if (!shifter) return;
  const std::string hint = "extend the table, with zeros where nothing is absorbed or re-emitted";
  for (const optics::Fluorophore& fluorophore : shifter->fluorophores()) {
    check_cover(problems, where, {fluorophore.absorption_per_mm, whose, "a shifter's absorption", hint},
                low_nm, high_nm);
    check_cover(problems, where, {fluorophore.quantum_yield, whose, "quantum yields", hint}, low_nm, high_nm);
  }
}

}  // namespace

void check_cover(core::Problems& problems, const core::FileLocation& where, const optics::Medium& medium,
                 double low_nm, double high_nm) {
  const std::string whose = "medium \"" + medium.name + "\"";
  check_cover(
      problems, where,
      {medium.index, whose, "refractive indices", "extend its index table, or choose other wavelengths"},
      low_nm, high_nm);
  if (medium.group_index)
    check_cover(
        problems, where,
        {*medium.group_index, whose, "group indices", "extend its table, or choose other wavelengths"},
        low_nm, high_nm);
  if (medium.birefringence)
    for (const optics::PrincipalAxis& axis : medium.birefringence->axes)
      if (axis.group_index)
        check_cover(
            problems, where,
            {*axis.group_index, whose, "group indices", "extend its table, or choose other wavelengths"},
            low_nm, high_nm);
  check_cover_of_shifter(problems, where, medium.shifter.get(), low_nm, high_nm, whose);
}

void check_cover(core::Problems& problems, const SurfaceSpec& surface, double low_nm, double high_nm) {
  const std::string hint = "extend the table in its definition, or choose other wavelengths";
  const std::string gap = "the gap of surface \"" + surface.name + "\"";
  const auto check = [&](const core::Curve& curve, const std::string& whose, const std::string& what) {
    check_cover(problems, surface.where, {curve, whose, what, hint}, low_nm, high_nm);
  };
  check(surface.gap_index, gap, "refractive indices");
  check(surface.gap_absorption_per_mm, gap, "an absorption");
  check_cover_of_shifter(problems, surface.where, surface.gap_shifter.get(), low_nm, high_nm, gap);
  if (surface.admission) {
    const std::string whose = "surface \"" + surface.name + "\"";
    check(surface.admission->admitted, whose, "admitted shares");
    check(surface.admission->undeflected, whose, "undeflected shares");
  }
  if (surface.reflector) {
    const std::string reflector = "reflector \"" + surface.reflector->name + "\"";
    check(surface.reflector->reflectance, reflector, "reflectances");
    if (surface.reflector->transmittance)
      check(*surface.reflector->transmittance, reflector, "transmittances");
  }
  for (const ShareSpec& part : surface.mixture) check_cover(problems, *part.surface, low_nm, high_nm);
}

}  // namespace scintray::materials
