#include "scintray/scene/wavelength_cover.hpp"

#include <fmt/format.h>

namespace scintray {

void check_cover(Problems& problems, const FileLocation& where, const Curve& curve, double low_nm,
                 double high_nm, const std::string& whose, const std::string& what, const std::string& hint) {
  if (curve.covers(low_nm, high_nm)) return;
  const std::string light =
      low_nm == high_nm ? fmt::format("{:g}", low_nm) : fmt::format("{:g} to {:g}", low_nm, high_nm);
  problems.add(where,
               fmt::format("{} has {} from {:g} to {:g} nm, but light of {} nm is in use", whose, what,
                           curve.x().front(), curve.x().back(), light),
               hint);
}

void check_cover(Problems& problems, const FileLocation& where, const Medium& medium, double low_nm,
                 double high_nm) {
  check_cover(problems, where, medium.index, low_nm, high_nm, "medium \"" + medium.name + "\"",
              "refractive indices", "extend its index table, or choose other wavelengths");
}

void check_cover(Problems& problems, const SurfaceSpec& surface, double low_nm, double high_nm) {
  const std::string hint = "extend the table in its definition, or choose other wavelengths";
  const std::string gap = "the gap of surface \"" + surface.name + "\"";
  check_cover(problems, surface.where, surface.gap_index, low_nm, high_nm, gap, "refractive indices", hint);
  check_cover(problems, surface.where, surface.gap_absorption_per_mm, low_nm, high_nm, gap, "an absorption",
              hint);
  if (surface.reflector)
    check_cover(problems, surface.where, surface.reflector->reflectance, low_nm, high_nm,
                "reflector \"" + surface.reflector->name + "\"", "reflectances", hint);
  for (const ShareSpec& part : surface.mixture) check_cover(problems, *part.surface, low_nm, high_nm);
}

}  // namespace scintray
