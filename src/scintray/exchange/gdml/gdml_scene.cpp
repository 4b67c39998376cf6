#include "scintray/exchange/scene_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "scintray/core/activity.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/core/units.hpp"
#include "scintray/exchange/gdml/detail/optical.hpp"
#include "scintray/exchange/gdml/detail/solids.hpp"
#include "scintray/exchange/gdml/detail/structure.hpp"
#include "scintray/mesh/shapes/primitives.hpp"

namespace scintray::exchange::gdml {

namespace {

std::string lengths(const core::Vec3& mm) {
  return fmt::format("[\"{:.17g} mm\", \"{:.17g} mm\", \"{:.17g} mm\"]", mm.x(), mm.y(), mm.z());
}

Origins origins_of(const GdmlImport& options) {
  return options.stated_origins ? Origins::stated : Origins::own;
}

bool is_identity(const Eigen::Matrix3d& rotation) { return rotation.isIdentity(1e-14); }

class SceneMaker {
 public:
  SceneMaker(const GdmlFile& file, const GdmlImport& options)
      : options_(options),
        file_(file),
        definitions_(file),
        tables_(file, definitions_),
        solids_(file, definitions_, options.tessellation),
        structure_(read_structure(file, definitions_, solids_)),
        neighbours_(structure_) {}

  SceneDraft make(const std::string& file_name) {
    read_media();
    name_parts();
    leave_out_filled();
    find_skins();
    find_sensors();
    std::string parts = world_part();
    for (std::size_t i = 0; i < structure_.placed.size(); ++i) {
      core::report_activity("making solids: " + structure_.placed[i].solid, i, structure_.placed.size());
      parts += part(i);
    }
    const std::string contacts = border_contacts();
    SceneDraft& draft = draft_;
    for (const std::string& differs : definitions_.notes()) note(differs);
    for (const std::string& found : solids_.notes()) note(found);
    for (const std::string& found : structure_.notes) note(found);
    for (const std::string& before : options_.notes) note(before);
    if (structure_.placed.empty()) draft.missing.push_back(empty_world());
    const std::string source_table = source();
    std::string notes;
    for (const std::string& note : draft.notes) notes += "#   " + note + "\n";
    draft.toml = "# Made by scintray import from " + file_name + ".\n";
    if (!notes.empty()) draft.toml += "# Not carried over, or different from Geant4:\n" + notes;
    draft.toml += "title = " + toml_string(file_name) + "\nambient = " + toml_string(ambient_) +
                  "  # the material of the world\ncontacts_default = \"each_side\"  # Geant4's rule for skin "
                  "surfaces\n" +
                  parts + contacts + source_table + media_tables() + surface_tables_ + sensor_tables_;
    return std::move(draft);
  }

 private:
  void note(const std::string& text) {
    if (noted_.insert(text).second) draft_.notes.push_back(text);
  }

  /// Why the scene has no parts.
  std::string empty_world() const {
    constexpr std::size_t kNamed = 5;
    std::string unplaced;
    std::size_t named = 0;
    for (const std::string& volume : structure_.volumes) {
      if (volume == structure_.world_volume) continue;
      if (named < kNamed) unplaced += (named > 0 ? ", \"" : "\"") + volume + "\"";
      ++named;
    }
    return "the scene has no parts: the world of the file, \"" + structure_.world_volume +
           "\", contains no volume" +
           (named == 0 ? "; place one in it with <physvol>"
                       : ", and these are placed nowhere: " + unplaced +
                             (named > kNamed ? " and " + std::to_string(named - kNamed) + " more" : "") +
                             "; name the volume that holds the others in <setup>, in a <world> around them");
  }

  void read_media() {
    for (ImportedMedium& medium : import_materials(tables_)) {
      const std::string name = medium.material;
      media_.emplace(name, std::move(medium));
    }
    for (const auto& [material, definition] : options_.media)
      if (!media_.contains(material))
        throw core::InputError(
            core::Problem{{},
                          "--medium names a material \"" + material + "\" that the file does not have",
                          "its materials are " + material_list()});
    check_material(structure_.world_material, structure_.world);
    for (const PlacedVolume& placed : structure_.placed) check_material(placed.material, placed.element);
  }

  /// As in Geant4, which refuses names that neither the file nor its own database has (G4_...).
  void check_material(const std::string& material, Node volume) {
    if (const ImportedMedium* medium = find_medium(material)) {
      if (medium->problem && !options_.media.contains(material)) throw core::InputError(*medium->problem);
      return;
    }
    if (!material.starts_with("G4_"))
      file_.reject(volume, "no material is called \"" + material + "\"",
                   "define it in <materials>; the file has " +
                       (media_.empty() ? std::string("none") : material_list()));
    note("material " + material + " is one of Geant4's own database, without optical properties: opaque");
  }

  /// Leaves out mothers that one daughter fills: light that enters such a mother is in the daughter.
  void leave_out_filled() {
    left_ = shares_left(structure_, solids_);
    std::vector<std::size_t> daughters(left_.size(), 0);
    for (const PlacedVolume& placed : structure_.placed)
      if (placed.mother) ++daughters[*placed.mother];
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (left_[i] > kNothingLeft || daughters[i] != 1) continue;
      left_out_[i] = true;
      note("volume " + structure_.placed[i].volume +
           " is filled by its daughter and left out; its surfaces, at which Geant4 has a step of no length, "
           "do "
           "not act");
    }
  }

  /// The box of the world, where a share of the light is absorbed or scattered in it: beyond it, where
  /// Geant4's light ends, the same index goes on, in which nothing happens to light. Sets the ambient medium.
  std::string world_part() {
    const std::string& material = structure_.world_material;
    ambient_ = medium_name(material);
    const ImportedMedium* medium = find_medium(material);
    if (structure_.placed.empty() || !medium || medium->opaque || options_.media.contains(material))
      return "";
    constexpr double kClear = 1000.0;  // in sizes of the world: a share of the light below 0.001
    Eigen::AlignedBox3d box;
    for (const core::Vec3& corner : solids_.mesh(structure_.world_solid, structure_.world).vertices)
      box.extend(corner);
    if (medium->shortest_mm > kClear * box.diagonal().norm()) return "";
    ambient_ = "beyond the world";
    surface_tables_ += "\n[media." + toml_string(ambient_) + "]\n" + medium->index +
                       "absorption = { none = true }\nscattering = { none = true }\n";
    PlacedVolume world;
    world.volume = structure_.world_volume;
    world.solid = structure_.world_solid;
    world.element = structure_.world;
    std::string name = part_name(world.volume);
    while (std::find(names_.begin(), names_.end(), name) != names_.end()) name += "_box";
    return "\n[[part]]\nname = " + toml_string(name) + "\n" + shape(world, false) +
           "medium = " + toml_string(material) + "\n";
  }

  std::string material_list() const {
    std::string list;
    for (const auto& [name, medium] : media_) list += (list.empty() ? "\"" : ", \"") + name + "\"";
    return list;
  }

  const ImportedMedium* find_medium(const std::string& material) const {
    const auto found = media_.find(material);
    return found == media_.end() ? nullptr : &found->second;
  }

  bool is_opaque(const std::string& material) const {
    if (options_.media.contains(material)) return false;
    const ImportedMedium* medium = find_medium(material);
    return !medium || medium->opaque;
  }

  std::string medium_name(const std::string& material) const {
    if (const auto given = options_.media.find(material); given != options_.media.end()) return given->second;
    return is_opaque(material) ? "opaque" : material;
  }

  void name_parts() {
    std::set<std::string> taken;
    std::map<std::string, int> next_number;
    for (const PlacedVolume& placed : structure_.placed) {
      const std::string base = part_name(placed.physvol);
      std::string name = base;
      int& number = next_number.try_emplace(base, 2).first->second;
      while (!taken.insert(name).second) name = base + "_" + std::to_string(number++);
      names_.push_back(name);
    }
    left_out_.assign(names_.size(), false);
  }

  void find_skins() {
    for (const SurfacePlacement& surface : structure_.surfaces)
      if (!surface.volume.empty()) skins_.try_emplace(surface.volume, &surface);
  }

  /// Keys of the shape: a box and what has a shape of its own as they are, everything else as a mesh beside
  /// the scene.
  std::string shape(const PlacedVolume& placed, bool mirrored) {
    const mesh::TriMesh& mesh = solids_.mesh(placed.solid, placed.element);
    if (const std::optional<core::Vec3> sides = solids_.box_sides(placed.solid, placed.element);
        sides && !mirrored) {
      const core::Vec3 half = 0.5 * *sides;
      return "box = { low = " + lengths(-half) + ", high = " + lengths(half) + " }\n";
    }
    if (!mirrored)
      if (std::optional<std::string> exact = solids_.exact_shape(placed.solid, placed.element)) return *exact;
    mesh::TriMesh own = mesh;
    std::string name = part_name(placed.solid);
    if (mirrored) {
      Eigen::Affine3d scale = Eigen::Affine3d::Identity();
      scale.linear() = placed.to_world.linear();
      own = mesh::transformed(mesh, scale);
      name += "_" + std::to_string(mirrored_count_++);
    }
    const std::filesystem::path path = options_.mesh_folder / (name + ".ply");
    draft_.meshes.emplace(path, std::move(own));
    return "mesh = " + toml_string(path.generic_string()) + "\nunit = \"mm\"\n" +
           (solids_.is_round(placed.solid, placed.element) ? "curved = \"recognize\"\n" : "");
  }

  std::string part(std::size_t i) {
    const PlacedVolume& placed = structure_.placed[i];
    if (left_out_[i]) return "";
    const Eigen::Matrix3d linear = placed.to_world.linear();
    // Scaled placements: rotation and scale are applied to the mesh.
    const bool scaled = !(linear.transpose() * linear).isIdentity(1e-9) || linear.determinant() < 0.0;
    std::string keys;
    try {
      keys = shape(placed, scaled);
    } catch (const core::InputError& error) {
      if (!options_.skip_unsupported) throw;
      left_out_[i] = true;
      note("volume " + placed.volume + ": " + error.problems().front().what);
      return "";
    }
    std::string text = "\n[[part]]\nname = " + toml_string(names_[i]) + "\n";
    if (!sensors_[i].empty())
      text += "sensor = " + toml_string(sensors_[i]) + "\n";
    else if (!placed.sensitive.empty())
      text += "# Geant4 has the sensitive detector " + toml_string(placed.sensitive) +
              " here: give it sensor = \"...\" to detect light\n";
    text += keys;
    if (!scaled && !is_identity(linear)) {
      const Eigen::AngleAxisd turn(linear);
      text += fmt::format("rotate = {{ axis = [{:.17g}, {:.17g}, {:.17g}], angle = \"{:.17g} rad\" }}\n",
                          turn.axis().x(), turn.axis().y(), turn.axis().z(), turn.angle());
    }
    if (!placed.to_world.translation().isZero())
      text += "translate = " + lengths(placed.to_world.translation()) + "\n";
    text += "medium = " + toml_string(medium_name(placed.material)) +
            (is_opaque(placed.material) ? "  # material " + placed.material + " has no RINDEX" : "") + "\n";
    used_media_.insert(placed.material);
    const SurfacePlacement* skin = skin_of(placed.volume);
    if (!skin && !placed.mother) skin = skin_of(structure_.world_volume);
    return skin ? text + "surface = " + toml_string(use_surface(*skin)) + "\n" : text;
  }

  /// The skin surface of a volume, or null; of several the first, as G4LogicalSkinSurface keeps it.
  const SurfacePlacement* skin_of(const std::string& volume) const {
    const auto found = skins_.find(volume);
    return found == skins_.end() ? nullptr : found->second;
  }

  /// [[contact]]s of all borders, with the surfaces of both directions.
  std::string border_contacts() {
    constexpr std::size_t kMostPairs = 1'000'000;
    std::map<std::pair<std::size_t, std::size_t>, std::array<const SurfacePlacement*, 2>> pairs;
    std::size_t visited = 0;
    for (const SurfacePlacement& surface : structure_.surfaces) {
      if (!surface.volume.empty()) continue;
      bool used = false;
      neighbours_.visit(
          neighbours_.copies_of(surface.from), neighbours_.copies_of(surface.to),
          [&](std::size_t a, std::size_t b) {
            if (left_out_[a] || left_out_[b]) return;
            if (++visited > kMostPairs)
              file_.reject(
                  surface.element,
                  "more than " + std::to_string(kMostPairs) + " pairs of volumes have a border surface",
                  "a border surface between copies in one mother is for each pair of them; use a skin "
                  "surface, or place the copies in mothers of their own");
            used = true;
            auto& both = pairs.try_emplace(std::minmax(a, b)).first->second;
            const SurfacePlacement*& own = both[a < b ? 0 : 1];
            if (!own) own = &surface;
          });
      if (!used)
        note("border surface " + surface.property +
             ": it is not between two volumes of which one is in the "
             "other, or both in a third");
    }
    std::string text;
    for (const auto& [pair, surfaces] : pairs) {
      text += "\n[[contact]]\nbetween = [" + toml_string(names_[pair.first]) + ", " +
              toml_string(names_[pair.second]) + "]\nkind = \"each_side\"\n";
      for (const std::size_t side : {0, 1})
        if (surfaces[side])
          text += std::string(side == 0 ? "leaving_first" : "leaving_second") + " = " +
                  toml_string(use_surface(*surfaces[side])) + "\n";
    }
    return text;
  }

  /// Efficiency of the surface as TOML; empty without one, or where the user replaces the surface.
  std::string efficiency_of(const SurfacePlacement& placement) {
    if (options_.surfaces.contains(placement.property)) return "";
    const Node element = solids_.optical_surface(placement.property);
    return element ? import_surface(element, tables_).efficiency : "";
  }

  /// The sensor of each part: Geant4's boundary process detects the share EFFICIENCY of the light that a
  /// surface absorbs. A skin's hits are those of its volume, a border's those of the volume behind it.
  void find_sensors() {
    sensors_.assign(names_.size(), "");
    const auto give = [&](std::size_t i, const SurfacePlacement& surface, const std::string& efficiency) {
      const std::string name = sensor(surface, efficiency, !structure_.placed[i].sensitive.empty());
      if (sensors_[i].empty()) sensors_[i] = name;
      if (sensors_[i] != name)
        note("volume " + structure_.placed[i].volume + ": a second EFFICIENCY, of surface " +
             surface.property + "; its sensor has that of " + sensors_[i]);
    };
    for (const SurfacePlacement& surface : structure_.surfaces) {
      const std::string efficiency = efficiency_of(surface);
      if (efficiency.empty()) continue;
      if (surface.volume.empty()) {
        const Neighbours::Copies& behind = neighbours_.copies_of(surface.to);
        for (const std::size_t i : behind.all.empty() ? neighbours_.copies_of(surface.from).all : behind.all)
          give(i, surface, efficiency);
        continue;
      }
      for (std::size_t i = 0; i < names_.size(); ++i)
        if (structure_.placed[i].volume == surface.volume) give(i, surface, efficiency);
    }
  }

  /// Name of the sensor of a surface's EFFICIENCY; writes its definition on first use. In a sensitive volume
  /// light that enters is a hit, too.
  std::string sensor(const SurfacePlacement& surface, const std::string& efficiency, bool sensitive) {
    const std::string name = surface.property + (sensitive ? " of a sensitive volume" : " sensor");
    if (sensitive)
      note("surface " + surface.property +
           ": light that it absorbs is detected by its EFFICIENCY, and so is light that enters the sensitive "
           "volume; in Geant4 the first are hits only after /process/optical/boundary/setInvokeSD true: "
           "without it, write converts = \"entering\" in [sensors." +
           toml_string(name) + "]");
    if (defined_sensors_.insert(name).second)
      sensor_tables_ += "\n[sensors." + toml_string(name) + "]  # EFFICIENCY of " + surface.property +
                        "\nconverts = \"" + (sensitive ? "both" : "absorbed") +
                        "\"\nefficiency = { definition = \"internal\", value = " + efficiency +
                        " }\nwindow = { index = 1.0 }\n";
    return name;
  }

  /// Name of the surface in the scene; writes its definition on first use.
  std::string use_surface(const SurfacePlacement& placement) {
    const std::string& property = placement.property;
    if (const auto given = options_.surfaces.find(property); given != options_.surfaces.end())
      return given->second;
    if (!defined_surfaces_.insert(property).second) return property;
    const Node element = solids_.optical_surface(property);
    if (!element)
      file_.reject(placement.element, "no <opticalsurface> is called \"" + property + "\"",
                   "define it in <solids>");
    const ImportedSurface surface = import_surface(element, tables_);
    for (const std::string& left_out : surface.notes) note("surface " + property + ": " + left_out);
    if (surface.toml.empty())
      draft_.missing.push_back("surface " + toml_string(property) + ": [surfaces." + toml_string(property) +
                               "], or --surface " + property + "=DATABASE_SURFACE");
    else
      surface_tables_ += "\n[surfaces." + toml_string(property) + "]\n" + surface.toml;
    if (!surface.gap_index.empty())
      surface_tables_ += "\n[media." + toml_string(gap_name(element.attribute("name").value())) +
                         "]  # RINDEX of the surface\nindex = { n = " + surface.gap_index +
                         " }\nabsorption = { none = true }\nscattering = { none = true }\n";
    return property;
  }

  std::string media_tables() {
    used_media_.insert(structure_.world_material);
    std::string text;
    for (const std::string& material : used_media_) {
      const ImportedMedium* medium = find_medium(material);
      if (!medium || is_opaque(material) || options_.media.contains(material)) continue;
      text += "\n[media." + toml_string(material) + "]\n" + medium->toml;
    }
    return text;
  }

  /// A pattern that the names of all parts of the volume of a part match, and no others; else its name.
  std::string pattern_of_copies(std::size_t part) const {
    std::string common = names_[part];
    const auto is_copy = [&](std::size_t i) {
      return structure_.placed[i].volume == structure_.placed[part].volume && !left_out_[i];
    };
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (is_copy(i))
        common.resize(static_cast<std::size_t>(
            std::mismatch(common.begin(), common.end(), names_[i].begin(), names_[i].end()).first -
            common.begin()));
    common += "*";
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (core::matches_pattern(common, names_[i]) != is_copy(i)) return names_[part];
    return common;
  }

  std::string source() {
    const auto note_material = [this](const std::string& material) {
      if (const ImportedMedium* medium = find_medium(material); medium && !options_.media.contains(material))
        for (const std::string& left_out : medium->notes) note("material " + material + ": " + left_out);
    };
    note_material(structure_.world_material);
    for (const PlacedVolume& placed : structure_.placed) note_material(placed.material);
    for (const auto& [scintillating, apart] :
         {std::pair{true, true}, std::pair{true, false}, std::pair{false, true}, std::pair{false, false}})
      for (std::size_t i = 0; i < names_.size(); ++i) {
        if (apart && !sensors_[i].empty()) continue;
        const PlacedVolume& placed = structure_.placed[i];
        const ImportedMedium* medium = find_medium(placed.material);
        const bool own = medium && !options_.media.contains(placed.material);
        if (left_out_[i] || left_[i] <= kNothingLeft || is_opaque(placed.material) ||
            (scintillating && !(own && medium->scintillates)))
          continue;
        const std::string wavelength = scintillating ? "emission" : "420 nm";
        return "\n[source]  # an example: a GDML file has none\ntype = \"photons\"\nregion = { part = " +
               toml_string(options_.light_in_all_copies ? pattern_of_copies(i) : names_[i]) +
               " }\nwavelength = \"" + wavelength + "\"\n" + (scintillating ? "time = \"decay\"\n" : "") +
               "photons = 10_000\n";
      }
    draft_.missing.push_back(
        "[source]: no volume has a material with RINDEX for light to start in; give its materials media with "
        "--medium MATERIAL=DATABASE_MEDIUM");
    return "";
  }

  const GdmlImport& options_;
  const GdmlFile& file_;
  Definitions definitions_;
  OpticalTables tables_;
  Solids solids_;
  Structure structure_;
  Neighbours neighbours_;
  SceneDraft draft_;
  std::map<std::string, ImportedMedium> media_;
  std::vector<std::string> names_;
  std::map<std::string, const SurfacePlacement*> skins_;  ///< by the name of the volume
  std::set<std::string> noted_;
  std::vector<bool> left_out_;
  std::vector<double> left_;  ///< shares of the volumes beside their daughters
  std::string ambient_;
  std::vector<std::string> sensors_;  ///< of the parts; empty: none
  std::set<std::string> used_media_, defined_surfaces_, defined_sensors_;
  std::string surface_tables_, sensor_tables_;
  int mirrored_count_ = 1;
};

}  // namespace

SceneDraft draft_of_gdml(const std::string& content, const std::string& file, const GdmlImport& options) {
  const GdmlFile gdml(content, file, origins_of(options));
  return SceneMaker(gdml, options).make(std::filesystem::path(file).filename().string());
}

}  // namespace scintray::exchange::gdml
