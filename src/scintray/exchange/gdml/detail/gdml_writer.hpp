#pragma once
/// Parts of a written GDML document: matrices, materials, optical surfaces.

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::exchange::gdml {

/// Wavelengths (nm) over which properties are tabulated.
struct WavelengthRange {
  double low_nm = 0.0, high_nm = 0.0;
};

/// A GDML document under construction. Properties are tabulated at photon energies spaced so closely that
/// Geant4's interpolation, linear in energy, agrees with curves that are linear in wavelength.
class GdmlWriter {
 public:
  /// @throws InternalError for a range whose ends are not above 0
  explicit GdmlWriter(WavelengthRange range);

  pugi::xml_node section(const char* name) { return root_.child(name); }
  std::string text() const;

  /// A <property> with a table of a curve against wavelength (nm), each value times `factor` in `unit`.
  void add_table(pugi::xml_node owner, const char* name, const core::Curve& curve,
                 const std::string& unit = {});
  /// The table of 1/length (1/mm) as lengths in mm; 0 becomes a length of 1e9 mm.
  void add_lengths(pugi::xml_node owner, const char* name, const core::Curve& per_mm);
  /// A spectrum per wavelength as one per energy, over its own wavelengths.
  void add_spectrum(pugi::xml_node owner, const char* name, const core::Curve& per_nm);
  void add_number(pugi::xml_node owner, const char* name, double value, const std::string& unit = {});

  /// Name of the <material> of a medium, written at its first use; one without RINDEX is opaque.
  std::string material(const optics::Medium& medium, bool opaque);
  /// Name of the <opticalsurface> of a surface for light from its inside or its outside, with the EFFICIENCY
  /// of a sensor that converts what it absorbs; empty where Geant4 needs none.
  std::string surface(const optics::Surface& surface, optics::Side from, const detector::Sensor* sensor);
  /// The <opticalsurface> of a body that absorbs all light, and detects the share of the sensor's efficiency.
  std::string absorbing_surface(const detector::Sensor& sensor);

  /// Adds a note on a property that cannot be written, with its effect; equal notes once.
  void note(const std::string& text);
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void add_matrix(pugi::xml_node owner, const char* name, int columns, const std::string& values);
  void add_bulk(pugi::xml_node material, const optics::Medium& medium);
  void add_scintillation(pugi::xml_node material, const optics::Medium& medium);
  /// At most two shifters, as Geant4's WLS and WLS2.
  void add_shifters(pugi::xml_node material, const optics::Medium& medium);
  void add_composition(pugi::xml_node material, const optics::Medium& medium);
  void note_face_response(const detector::Sensor& sensor);
  void add_finish(pugi::xml_node node, const optics::Surface& surface, optics::Side from);
  void add_rough(pugi::xml_node node, const optics::Surface& surface);
  std::string new_name(const std::string& wanted);

  WavelengthRange range_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::map<std::string, std::string> done_;  ///< names by what was written
  std::map<std::string, int> taken_;
  std::map<int, std::string> elements_;
  std::vector<std::string> notes_;
  int matrices_ = 0;
};

}  // namespace scintray::exchange::gdml
