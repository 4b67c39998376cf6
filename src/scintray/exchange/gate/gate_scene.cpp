#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "scintray/core/text.hpp"
#include "scintray/exchange/gate/detail/gate.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gate {

namespace {

constexpr std::size_t kMostBorders = 100'000;
constexpr const char* kAround = "around the world";

/// A dimension of a solid: GATE's command, the attribute in GDML, and its value when it is not set. Lengths
/// without a value are required; angles are full circles.
struct SolidDimension {
  const char* command;
  const char* attribute;
  core::Dimension dimension = core::Dimension::length;
  double fallback = -1.0;
  bool required() const { return fallback < 0.0; }
};
struct SolidKind {
  const char* type;
  const char* tag;
  std::vector<SolidDimension> dimensions;
};

const std::vector<SolidKind>& solid_kinds() {
  using enum core::Dimension;
  constexpr double kFull = 2.0 * core::kPi;
  static const std::vector<SolidKind> kinds{
      {"box", "box", {{"setXLength", "x"}, {"setYLength", "y"}, {"setZLength", "z"}}},
      {"cylinder",
       "tube",
       {{"setRmin", "rmin", length, 0.0},
        {"setRmax", "rmax"},
        {"setHeight", "z"},
        {"setPhiStart", "startphi", angle, 0.0},
        {"setDeltaPhi", "deltaphi", angle, kFull}}},
      {"sphere",
       "sphere",
       {{"setRmin", "rmin", length, 0.0},
        {"setRmax", "rmax"},
        {"setPhiStart", "startphi", angle, 0.0},
        {"setDeltaPhi", "deltaphi", angle, kFull},
        {"setThetaStart", "starttheta", angle, 0.0},
        {"setDeltaTheta", "deltatheta", angle, 0.5 * kFull}}},
      {"cone",
       "cone",
       {{"setRmin1", "rmin1", length, 0.0},
        {"setRmax1", "rmax1"},
        {"setRmin2", "rmin2", length, 0.0},
        {"setRmax2", "rmax2"},
        {"setHeight", "z"},
        {"setPhiStart", "startphi", angle, 0.0},
        {"setDeltaPhi", "deltaphi", angle, kFull}}}};
  return kinds;
}

/// The detector of a macro as a GDML document, whose volumes, materials and borders Geant4 would have.
class Converter {
 public:
  Converter(Detector detector, const gdml::GdmlImport& options)
      : detector_(std::move(detector)), options_(options), problems_(detector_.problems) {}

  std::string convert() {
    for (const Volume& volume : detector_.volumes)
      attempt([&] { copies_[volume.name] = copies(volume, detector_.folder); });
    attempt([this] { add_materials(); });
    for (const Volume& volume : detector_.volumes) attempt([&] { add_solid(volume); });
    problems_.throw_if_any();
    add_volumes();
    attempt([this] { add_borders(); });
    problems_.throw_if_any();
    return document_.text();
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> all = notes_;
    all.insert(all.end(), detector_.notes.begin(), detector_.notes.end());
    return all;
  }

 private:
  template <typename Step>
  void attempt(const Step& step) {
    try {
      step();
    } catch (const core::InputError& error) {
      problems_.add(error);
    }
  }

  std::optional<std::filesystem::path> beside(const char* name) const {
    std::error_code error;
    for (const auto& folder : {detector_.folder, detector_.folder / ".."})
      if (std::filesystem::is_regular_file(folder / name, error)) return folder / name;
    return std::nullopt;
  }

  void add_materials() {
    std::optional<MaterialDatabase> database;
    if (const auto& command = detector_.material_database)
      database.emplace(
          find_file(detector_.folder, command->words.empty() ? "" : command->words[0], command->where));
    std::optional<PropertyFile> properties;
    if (const auto path = beside("Materials.xml"))
      properties.emplace(*path, "materials");
    else
      notes_.push_back(
          "no Materials.xml lies beside the macro: no material has optical properties, and all are opaque");
    std::set<std::string> done;
    for (const Volume& volume : detector_.volumes) {
      if (volume.material.empty())
        problems_.add(volume.where, "volume \"" + volume.name + "\" has no material",
                      "add /gate/" + volume.name + "/setMaterial MATERIAL");
      if (volume.material.empty() || !done.insert(volume.material).second) continue;
      const pugi::xml_node entry = properties ? properties->find(volume.material) : pugi::xml_node();
      pugi::xml_node node = GdmlDocument::add(document_.section("materials"), "material",
                                              entry ? properties->where(entry) : volume.where);
      node.append_attribute("name") = volume.material.c_str();
      if (entry) properties->add_properties(entry, node, document_, notes_);
      // The material of the world unless a macro sets one, and those of Geant4 itself (G4_AIR).
      const bool built_in = volume.material == "worldDefaultAir" || volume.material.starts_with("G4_");
      if (database && database->add_composition(volume.material, node, document_)) continue;
      if (built_in || options_.media.contains(volume.material))
        notes_.push_back("material " + volume.material +
                         " is one of Geant4's own: its density and composition are not stated");
      else if (database)
        problems_.add(core::unknown_name(volume.where, "material", volume.material, database->names()));
      else
        notes_.push_back("no /gate/geometry/setMaterialDatabase: material " + volume.material +
                         " has no density and composition, which gammas need");
    }
  }

  void add_solid(const Volume& volume) {
    const auto& kinds = solid_kinds();
    const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                   [&](const SolidKind& known) { return volume.type == known.type; });
    if (kind == kinds.end())
      throw core::InputError(
          core::Problem{volume.where, "volumes of type " + core::in_quotes(volume.type) + " are not read",
                        "expected box, cylinder, sphere or cone; export the geometry from Geant4 as GDML"});
    pugi::xml_node solid = GdmlDocument::add(document_.section("solids"), kind->tag, volume.where);
    solid.append_attribute("name") = volume.name.c_str();
    core::Vec3& half = half_mm_[volume.name] = core::Vec3::Zero();
    for (const SolidDimension& dimension : kind->dimensions) {
      const auto set = volume.dimensions.find(dimension.command);
      if (set == volume.dimensions.end() && dimension.required() && volume.name != "world") {
        problems_.add(volume.where, "volume \"" + volume.name + "\" has no " + dimension.command,
                      "add /gate/" + volume.name + "/geometry/" + dimension.command + " LENGTH mm");
        continue;
      }
      constexpr double kWorld_mm = 500.0;
      double value = dimension.required() ? kWorld_mm : dimension.fallback;
      if (set != volume.dimensions.end())
        attempt([&] { value = quantity(set->second, 0, dimension.dimension); });
      solid.append_attribute(dimension.attribute) = fmt::format("{:.17g}", value).c_str();
      // The box around it: lengths of a box and heights are whole, radii halves.
      const std::string_view name = dimension.attribute;
      if (name == "x") half.x() = 0.5 * value;
      if (name == "y") half.y() = 0.5 * value;
      if (name == "z") half.z() = 0.5 * value;
      if (name.starts_with("rmax")) half = half.cwiseMax(core::Vec3(value, value, 0.0));
    }
    if (volume.type == std::string("sphere")) half.z() = half.x();
    for (const auto& [command, given] : volume.dimensions)
      if (std::none_of(kind->dimensions.begin(), kind->dimensions.end(),
                       [&, &name = command](const SolidDimension& known) { return name == known.command; }))
        problems_.add(given.where, given.path + " is no dimension of a " + volume.type,
                      "expected " + core::list_of(kind->dimensions, ", ", [](const SolidDimension& d) {
                        return std::string(d.command);
                      }));
  }

  std::string placed_name(const Volume& volume, std::size_t copy) const {
    return copies_.at(volume.name).size() == 1 ? volume.name : volume.name + "_" + std::to_string(copy);
  }

  /// True when a surface has the world on one side: it then is a part of its own, in a world around it.
  bool world_has_surfaces() const {
    return std::any_of(detector_.volumes.begin(), detector_.volumes.end(), [](const Volume& volume) {
      return std::any_of(volume.surfaces.begin(), volume.surfaces.end(), [&](const BorderCommand& surface) {
        return volume.name == "world" || surface.other == "world";
      });
    });
  }

  void add_volumes() {
    for (const Volume& volume : detector_.volumes) {
      pugi::xml_node node = GdmlDocument::add(document_.section("structure"), "volume", volume.where);
      node.append_attribute("name") = volume.name.c_str();
      node.append_child("materialref").append_attribute("ref") = volume.material.c_str();
      node.append_child("solidref").append_attribute("ref") = volume.name.c_str();
      if (volume.sensitive) {
        pugi::xml_node auxiliary = node.append_child("auxiliary");
        auxiliary.append_attribute("auxtype") = "SensDet";
        auxiliary.append_attribute("auxvalue") = "crystalSD";
      }
      for (const Volume& daughter : detector_.volumes)
        if (daughter.mother == volume.name) add_copies(daughter, node);
    }
    const char* world = "world";
    if (world_has_surfaces()) {
      const Volume& inner = detector_.volumes.front();
      pugi::xml_node node = GdmlDocument::add(document_.section("structure"), "volume", inner.where);
      node.append_attribute("name") = kAround;
      node.append_child("materialref").append_attribute("ref") = inner.material.c_str();
      node.append_child("solidref").append_attribute("ref") = "world";
      add_copies(inner, node);
      world = kAround;
    }
    document_.section("setup").append_child("world").append_attribute("ref") = world;
  }

  void add_copies(const Volume& volume, pugi::xml_node mother) {
    const std::vector<Placement>& placements = copies_.at(volume.name);
    for (std::size_t copy = 0; copy < placements.size(); ++copy) {
      pugi::xml_node node = GdmlDocument::add(mother, "physvol", volume.where);
      node.append_attribute("name") = placed_name(volume, copy).c_str();
      node.append_child("volumeref").append_attribute("ref") = volume.name.c_str();
      const auto vector = [&](const char* tag, const core::Vec3& value, const char* unit) {
        pugi::xml_node child = node.append_child(tag);
        child.append_attribute("unit") = unit;
        child.append_attribute("x") = fmt::format("{:.17g}", value.x()).c_str();
        child.append_attribute("y") = fmt::format("{:.17g}", value.y()).c_str();
        child.append_attribute("z") = fmt::format("{:.17g}", value.z()).c_str();
      };
      vector("position", placements[copy].position_mm, "mm");
      if (!placements[copy].axes.isIdentity(1e-14)) vector("rotation", angles(placements[copy].axes), "rad");
    }
  }

  /// The angles of a GDML rotation: the matrix is Rz(z) Ry(y) Rx(x).
  static core::Vec3 angles(const Eigen::Matrix3d& axes) {
    const double y = -std::asin(std::clamp(axes(2, 0), -1.0, 1.0));
    if (std::abs(axes(2, 0)) > 1.0 - 1e-12) return {std::atan2(-axes(1, 2), axes(1, 1)), y, 0.0};
    return {std::atan2(axes(2, 1), axes(2, 2)), y, std::atan2(axes(1, 0), axes(0, 0))};
  }

  /// Half the box around a copy, along its mother's axes.
  core::Vec3 extent(const Volume& volume, const Placement& copy) const {
    return copy.axes.transpose().cwiseAbs() * half_mm_.at(volume.name);
  }

  bool near(const Volume& one, const Placement& first, const Volume& other, const Placement& second) const {
    const core::Vec3 apart = (first.position_mm - second.position_mm).cwiseAbs();
    constexpr double kMargin_mm = 1e-3;
    return ((extent(one, first) + extent(other, second) - apart).array() > -kMargin_mm).all();
  }

  void add_borders() {
    std::optional<PropertyFile> file;
    if (const auto path = beside("Surfaces.xml")) file.emplace(*path, "surfaces");
    std::set<std::string> properties;
    std::size_t borders = 0;
    for (const Volume& volume : detector_.volumes)
      for (const BorderCommand& surface : volume.surfaces) {
        if (surface.property.empty()) {
          notes_.push_back(surface.where.text() + ": surface " + surface.name +
                           " has no setSurface: it has no effect, as in GATE");
          continue;
        }
        if (properties.insert(surface.property).second) attempt([&] { add_property(file, surface); });
        borders += add_borders_of(volume, surface);
        if (borders > kMostBorders)
          throw core::InputError(core::Problem{surface.where, "more than 100000 borders between volumes",
                                               "write repeated volumes as daughters of a repeated mother"});
      }
    if (borders > 0)
      notes_.push_back(
          "a surface of /gate/A/surfaces with insert B is for light from A to B, as GATE's source has it "
          "(GateSurface.cc); its manual states the opposite");
  }

  void add_property(const std::optional<PropertyFile>& file, const BorderCommand& surface) {
    if (options_.surfaces.contains(surface.property)) return;
    if (!file)
      throw core::InputError(core::Problem{surface.where, "no Surfaces.xml lies beside the macro",
                                           "GATE reads it from its working folder: put it beside the macro"});
    const pugi::xml_node entry = file->find(surface.property);
    if (!entry)
      throw core::unknown_name(surface.where, "surface of Surfaces.xml", surface.property, file->names());
    add_surface(*file, entry, document_, notes_);
  }

  /// Border surfaces between all copies of two volumes that may touch: one in the other, or both in a third.
  std::size_t add_borders_of(const Volume& volume, const BorderCommand& surface) {
    const Volume& other = *detector_.find(surface.other);
    const bool nested = volume.mother == other.name || other.mother == volume.name;
    const bool siblings = volume.mother == other.mother;
    if (!nested && !siblings) {
      notes_.push_back(surface.where.text() + ": surface " + surface.name + ": " + volume.name + " and " +
                       other.name + " are not in each other, nor in the same volume: it has no effect");
      return 0;
    }
    const auto &first = copies_.at(volume.name), &second = copies_.at(other.name);
    std::size_t count = 0;
    for (std::size_t i = 0; i < first.size(); ++i)
      for (std::size_t j = 0; j < second.size(); ++j) {
        if (siblings && (&volume == &other && i == j)) continue;
        if (siblings && !near(volume, first[i], other, second[j])) continue;
        pugi::xml_node node =
            GdmlDocument::add(document_.section("structure"), "bordersurface", surface.where);
        node.append_attribute("name") = surface.name.c_str();
        node.append_attribute("surfaceproperty") = surface.property.c_str();
        node.append_child("physvolref").append_attribute("ref") = placed_name(volume, i).c_str();
        node.append_child("physvolref").append_attribute("ref") = placed_name(other, j).c_str();
        if (++count > kMostBorders) return count;
      }
    return count;
  }

  Detector detector_;
  const gdml::GdmlImport& options_;
  GdmlDocument document_;
  std::map<std::string, std::vector<Placement>> copies_;
  std::map<std::string, core::Vec3> half_mm_;
  std::vector<std::string> notes_;
  core::Problems problems_;
};

/// Definitions alone: every entry of a property file, in a document without volumes.
std::string definitions_only(const std::filesystem::path& path, bool surfaces, gdml::GdmlImport& options) {
  const PropertyFile file(path, surfaces ? "surfaces" : "materials");
  if (file.names().empty())
    throw core::InputError(core::Problem{{path.string()},
                                         "the file has no entries",
                                         surfaces ? "expected <surface name=\"...\">s in <surfaces>"
                                                  : "expected <material name=\"...\">s in <materials>"});
  GdmlDocument document;
  for (const std::string& name : file.names()) {
    const pugi::xml_node entry = file.find(name);
    if (surfaces) {
      add_surface(file, entry, document, options.notes);
      continue;
    }
    pugi::xml_node node = GdmlDocument::add(document.section("materials"), "material", file.where(entry));
    node.append_attribute("name") = name.c_str();
    file.add_properties(entry, node, document, options.notes);
  }
  return document.text();
}

}  // namespace

SceneDraft draft_of_gate(const std::filesystem::path& macro, gdml::GdmlImport options) {
  Converter converter(read_detector(macro), options);
  const std::string document = converter.convert();
  for (const std::string& note : converter.notes()) options.notes.push_back(note);
  options.stated_origins = options.light_in_all_copies = true;
  return gdml::draft_of_gdml(document, macro.string(), options);
}

SceneDraft definitions_of_gate(const std::filesystem::path& file, gdml::GdmlImport options) {
  const std::string content = mesh::read_mesh_file(file);
  const bool surfaces = content.find("<surfaces") != std::string::npos;
  const std::string document = definitions_only(file, surfaces, options);
  options.stated_origins = true;
  return gdml::definitions_of_gdml(document, file.string(), options);
}

}  // namespace scintray::exchange::gate
