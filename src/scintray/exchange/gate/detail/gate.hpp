#pragma once
/// Files of GATE 9: macros, GateMaterials.db, Materials.xml and Surfaces.xml, as its source reads them
/// (OpenGATE/Gate, release 9.4: GateSurface.cc, GateXMLDocument.cc, GateMDBFile.cc, the placements and
/// repeaters).

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::exchange::gate {

/// A command of a macro: its path, and the words after it.
struct Command {
  std::string path;
  std::vector<std::string> words;
  core::FileLocation where;
};

/// The commands of a macro and of those that it executes, aliases replaced, comments left out.
/// @param folder working folder of GATE, where `/control/execute` looks for files, or the folder above it
/// Commands of /control that are not executed (loops, conditions) are in the list unchanged.
/// @throws InputError for a file that cannot be read, macros that execute each other endlessly, and an
/// alias that is not defined.
std::vector<Command> read_macro(const std::filesystem::path& macro);

/// File that a macro names: in the folder of the macro, or in the one above it, as macros often lie in a
/// folder of their own. @throws InputError at `where` when it is in neither.
std::filesystem::path find_file(const std::filesystem::path& macro_folder, const std::string& name,
                                const core::FileLocation& where);

/// Placement of a volume in its mother: the matrix that GATE passes to G4PVPlacement, which rotates the
/// mother's axes into the volume's, and the position in mm.
struct Placement {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  core::Vec3 position_mm = core::Vec3::Zero();
};

/// A repeater of a volume, or one of its settings with the words of its command.
struct Repeater {
  enum class Kind { cubic, linear, ring, generic };
  Kind kind = Kind::cubic;
  std::string name;
  std::map<std::string, Command> settings;
};

/// A surface for light that leaves the volume of the list for `other`.
struct BorderCommand {
  std::string name, other, property;
  core::FileLocation where;
};

struct Volume {
  std::string name, type, material, mother;
  core::FileLocation where;
  std::map<std::string, Command> dimensions;  ///< by the command's last word, such as setXLength
  Placement placement;
  core::Vec3 rotation_axis = core::Vec3::UnitZ();
  double rotation_rad = 0.0;
  std::vector<Repeater> repeaters;
  std::vector<BorderCommand> surfaces;
  bool sensitive = false;
};

/// The detector described by the commands of a macro.
struct Detector {
  std::vector<Volume> volumes;  ///< the world first, mothers before their daughters
  std::filesystem::path folder;
  std::optional<Command> material_database;
  std::vector<std::string> notes;  ///< commands that are not converted, with place and effect
  core::Problems problems;         ///< commands without their words, unknown volumes, types or units

  const Volume* find(const std::string& name) const;
};

/// Reads a macro; problems of its commands are in the result, so that all are reported at
/// once.
/// @throws InputError as read_macro
Detector read_detector(const std::filesystem::path& macro);

/// Number `index` of a command's words. @throws InputError at the command
double number(const Command& command, std::size_t index);
/// The same times the unit in the last word; mm, rad.
double quantity(const Command& command, std::size_t index, core::Dimension dimension);

/// The placements of all copies of a volume in its mother, by its repeaters in their order.
/// @throws InputError at the command that is wrong
std::vector<Placement> copies(const Volume& volume, const std::filesystem::path& folder);

/// A GDML document under construction. Elements have an attribute `origin`, the place that messages name.
class GdmlDocument {
 public:
  GdmlDocument();
  pugi::xml_node section(const char* name) { return root_.child(name); }
  /// Adds an element with its place.
  static pugi::xml_node add(pugi::xml_node parent, const char* tag, const core::FileLocation& where);
  /// Adds a matrix for a property. @return its unique name
  std::string add_matrix(int columns, const std::string& values, const core::FileLocation& where);
  std::string text() const;

 private:
  pugi::xml_document document_;
  pugi::xml_node root_;
  int matrices_ = 0;
};

/// Materials.xml or Surfaces.xml.
class PropertyFile {
 public:
  /// @throws InputError for XML that is not well-formed, or without the element `root`
  PropertyFile(const std::filesystem::path& path, const std::string& root);
  /// The <material> or <surface> of a name; the first of several, as in GATE. Empty when there is none.
  pugi::xml_node find(const std::string& name) const;
  std::vector<std::string> names() const;
  core::FileLocation where(pugi::xml_node node) const;
  /// The properties of an entry, as those of a GDML element. @throws InputError for entries without a name,
  /// without numbers, or with energies that are not above 0.
  void add_properties(pugi::xml_node entry, pugi::xml_node target, GdmlDocument& document,
                      std::vector<std::string>& notes) const;

 private:
  std::string path_, content_;
  pugi::xml_document document_;
};

/// Adds an <opticalsurface> for an entry of Surfaces.xml: sigma alpha in degrees, always of the unified model
/// unless DAVIS is stated.
void add_surface(const PropertyFile& file, pugi::xml_node entry, GdmlDocument& document,
                 std::vector<std::string>& notes);

/// GateMaterials.db.
class MaterialDatabase {
 public:
  explicit MaterialDatabase(const std::filesystem::path& path);
  /// Adds density and composition to a GDML <material>, with the elements that it needs; false when the file
  /// has no material of this name. @throws InputError with file and line for entries that cannot be read
  bool add_composition(const std::string& material, pugi::xml_node target, GdmlDocument& document);
  std::vector<std::string> names() const;

 private:
  struct Entry {
    std::map<std::string, std::string> fields;
    std::vector<std::map<std::string, std::string>> components;  ///< "kind" is el, mat or iso
    core::FileLocation where;
  };
  void add_parts(const Entry& entry, const std::string& name, pugi::xml_node target, GdmlDocument& document);

  std::map<std::string, Entry> elements_, materials_;
  std::map<std::string, bool> written_;
};

}  // namespace scintray::exchange::gate
