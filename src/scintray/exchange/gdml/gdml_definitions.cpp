#include "scintray/exchange/gdml/detail/optical.hpp"
#include "scintray/exchange/scene_draft.hpp"

namespace scintray::exchange::gdml {

SceneDraft definitions_of_gdml(const std::string& content, const std::string& file,
                               const GdmlImport& options) {
  const GdmlFile gdml(content, file, options.stated_origins ? Origins::stated : Origins::own);
  const Definitions definitions(gdml);
  const OpticalTables tables(gdml, definitions);
  SceneDraft draft;
  draft.notes = options.notes;
  const std::string name = std::filesystem::path(file).filename().string();
  std::string text;
  for (const ImportedMedium& medium : import_materials(tables)) {
    if (medium.problem) throw core::InputError(*medium.problem);
    for (const std::string& note : medium.notes)
      draft.notes.push_back("material " + medium.material + ": " + note);
    text += medium.opaque ? "\n# " + medium.material + " has no RINDEX: medium = \"opaque\"\n"
                          : "\n[media." + toml_string(medium.material) + "]\n" + medium.toml;
  }
  definitions.for_each_of("solids", [&](Node node) {
    if (std::string(node.name()) != "opticalsurface") return;
    const std::string surface_name = node.attribute("name").value();
    const ImportedSurface surface = import_surface(node, tables);
    for (const std::string& note : surface.notes)
      draft.notes.push_back("surface " + surface_name + ": " + note);
    if (surface.toml.empty()) {
      text += "\n# " + surface_name + " is not converted\n";
      return;
    }
    text += "\n[surfaces." + toml_string(surface_name) + "]\n" + surface.toml;
    if (!surface.efficiency.empty())
      text +=
          "\n[sensors." + toml_string(surface_name + " sensor") +
          "]  # its EFFICIENCY\nconverts = \"absorbed\"\nefficiency = { definition = \"internal\", value = " +
          surface.efficiency + " }\nwindow = { index = 1.0 }\n";
  });
  std::string notes;
  for (const std::string& note : draft.notes) notes += "#   " + note + "\n";
  draft.toml = "# Made by scintray import from " + name + ": definitions for a scene.\n" +
               (notes.empty() ? "" : "# Not carried over, or different from Geant4:\n" + notes) + text;
  draft.missing = {"[[part]]s and [source]: the file has definitions alone"};
  return draft;
}

}  // namespace scintray::exchange::gdml
