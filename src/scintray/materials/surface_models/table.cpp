#include <fmt/format.h>

#include "scintray/core/named_file.hpp"
#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/materials/index_tolerance.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/materials/table_key.hpp"

namespace scintray::materials {

optics::Microsurface TableFileSpec::make(const SurfaceSetting& setting, ReliefStore&) const {
  const auto table = core::read_named_file(
      where, [&] { return std::make_shared<const optics::SurfaceTable>(optics::read_table(path)); });
  const std::string& name = setting.stack.name;
  if (table->absorbs() && (setting.stack.reflector || setting.stack.gap_thickness_um))
    throw core::InputError(
        {where,
         "the table of surface \"" + name + "\" holds a whole stack (" + table->provenance().stack +
             "), and another lies on it",
         "remove the surface's gap and reflector, or name a table of the bare microsurface"});
  if (index_mismatch(*table, setting, setting.reference_nm) > kIndexTolerance) {
    const optics::IndexPair own = table->index_pair(), here = setting.indices(setting.reference_nm);
    throw core::InputError(
        {where,
         fmt::format("the table of surface \"{}\" is for indices {:.4f} to {:.4f}, but here light goes from "
                     "{:.4f} to {:.4f}",
                     name, own.inside, own.outside, here.inside, here.outside),
         "build a table for these media with `scintray table build`, or name the height map itself"});
  }
  return table;
}

std::optional<std::string> TableFileSpec::key() const { return "table file " + file_key(path); }

SurfaceModel table_model() {
  const auto read = [](const config::TomlTable& surface) {
    const config::TomlTable file = surface.table("table");
    return TableFileSpec(file.existing_file("file"), file.where());
  };
  return {.word = "table", .table = "table", .read = read};
}

}  // namespace scintray::materials
