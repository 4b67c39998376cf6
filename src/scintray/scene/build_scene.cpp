#include "scintray/scene/build_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "scintray/contact/conform_parts.hpp"
#include "scintray/contact/cut_parts.hpp"
#include "scintray/core/curve.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/detector/channel.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/wavelength_cover.hpp"
#include "scintray/scene/detail/assemble.hpp"
#include "scintray/scene/detail/shifted_range.hpp"
#include "scintray/scene/place_parts.hpp"

namespace scintray::scene {

void add_definitions(materials::MaterialDatabase& database, const scene_file::SceneSpec& spec) {
  database.add(materials::DefinitionKind::medium, spec.media);
  database.add(materials::DefinitionKind::surface, spec.surfaces);
  database.add(materials::DefinitionKind::sensor, spec.sensors);
  database.add(materials::DefinitionKind::reflector, spec.reflectors);
}

materials::MaterialDatabase database_for(const scene_file::SceneSpec& spec) {
  materials::MaterialDatabase database = materials::MaterialDatabase::shipped();
  add_definitions(database, spec);
  return database;
}

namespace {

/// Wavelengths that photons of a scene can have, and the one tables are made for.
struct WavelengthRange {
  double low_nm = 0.0, high_nm = 0.0, reference_nm = 0.0;
};

/// Stands for the wavelengths of a scene with a mistake, until all mistakes are found.
constexpr WavelengthRange kNoLight{400.0, 400.0, 400.0};

/// The part of an emission spectrum that is not zero.
WavelengthRange range_of(const core::Curve& emission) {
  WavelengthRange range;
  const auto &x = emission.x(), &y = emission.y();
  std::size_t first = 0, last = x.size() - 1;
  while (first + 1 < x.size() && y[first + 1] == 0.0) ++first;
  while (last > 0 && y[last - 1] == 0.0) --last;
  range.low_nm = x[std::min(first, last)];
  range.high_nm = x[last];
  range.reference_nm = core::CurveSampler(emission).mean();
  return range;
}

/// Looks up every name of a scene and fills an Assembly.
class AssemblyMaker {
 public:
  AssemblyMaker(const scene_file::SceneSpec& spec, const materials::MaterialDatabase& database,
                materials::SurfaceFactory& surfaces, core::Problems& problems)
      : spec_(spec), database_(database), surface_factory_(surfaces), problems_(problems) {}

  Assembly make(const std::vector<contact::PlacedMesh>& placed, std::vector<std::string>& warnings) {
    wavelengths_ = find_wavelengths(placed);
    wavelengths_.high_nm = std::max(wavelengths_.high_nm, longest_shifted_nm(spec_, placed, database_));
    assembly_.low_nm = wavelengths_.low_nm;
    assembly_.high_nm = wavelengths_.high_nm;
    assembly_.ambient = medium_id(spec_.ambient);
    for (const contact::PlacedMesh& part : placed) add_part(part);
    assembly_.contacts_default = spec_.contacts_default;
    assembly_.contacts = spec_.contacts;
    assembly_.contact_tolerance_mm = spec_.run.contact_tolerance_mm;
    assembly_.accelerator = spec_.run.accelerator;
    check_contact_names();
    assembly_.make_surface = [this, &warnings](const std::string& name, core::MediumId inside,
                                               core::MediumId outside) {
      return make_surface(name, inside, outside, warnings);
    };
    return assembly_;
  }

 private:
  WavelengthRange find_wavelengths(const std::vector<contact::PlacedMesh>& placed) {
    if (spec_.energy_source) return emission_of(placed, {"*", {}});
    if (spec_.source.wavelength_nm) {
      const double nm = *spec_.source.wavelength_nm;
      return {nm, nm, nm};
    }
    if (const auto* region = std::get_if<scene_file::RegionSpec>(&spec_.source.origin))
      return emission_of(placed, region->part);
    problems_.add(
        spec_.source.wavelength_where,
        "wavelength = \"emission\" needs a source region with a part, since a point may lie anywhere",
        "give a wavelength, as wavelength = \"420 nm\"");
    return kNoLight;
  }

  /// Wavelengths that the parts of a name or pattern emit. Parts of an energy source that do not
  /// scintillate are left out, of a source of photons they are mistakes.
  WavelengthRange emission_of(const std::vector<contact::PlacedMesh>& placed, const config::NameRef& parts) {
    std::optional<WavelengthRange> found;
    for (const contact::PlacedMesh& part : placed) {
      if (!core::matches_pattern(parts.name, part.name) || part.medium.empty() ||
          part.medium.name == scene_file::kOpaqueMedium)
        continue;
      try {
        const optics::Medium& medium = database_.medium(part.medium.name, part.medium.where);
        const bool emits = medium.emission.max_y() > 0.0 && !medium.emission.is_constant();
        if (emits) {
          const WavelengthRange range = range_of(medium.emission);
          if (!found) found = range;
          found->low_nm = std::min(found->low_nm, range.low_nm);
          found->high_nm = std::max(found->high_nm, range.high_nm);
        } else if (!spec_.energy_source) {
          problems_.add(spec_.source.wavelength_where,
                        "medium \"" + medium.name + "\" has no emission spectrum to draw wavelengths from",
                        "give a wavelength, as wavelength = \"420 nm\", or an emission in the medium's file");
          return kNoLight;
        }
      } catch (const core::InputError&) {
        // reported where the part is added
      }
    }
    if (!found && spec_.energy_source && problems_.empty())
      problems_.add(spec_.energy_source->where, "no part scintillates, so energy makes no light",
                    "give a part's medium [yield], [emission] and [[decay]], or use one that has them, as "
                    "\"LSO\"");
    return found.value_or(kNoLight);
  }

  core::MediumId add_medium(optics::Medium medium, const core::FileLocation& where) {
    materials::check_cover(problems_, where, medium, wavelengths_.low_nm, wavelengths_.high_nm);
    return assembly_.media.emplace_back(std::move(medium));
  }

  core::MediumId medium_id(const config::NameRef& ref) {
    const auto [known, is_new] = media_.try_emplace(ref.name);
    if (!is_new) return known->second;
    if (ref.name == scene_file::kOpaqueMedium)
      return known->second = assembly_.media.push_back(SceneMedium::opaque());
    optics::Medium medium;
    medium.name = ref.name;
    medium.index = core::Curve::constant(1.0);
    try {
      medium = database_.medium(ref.name, ref.where);
    } catch (const core::InputError& error) {
      problems_.add(error);
    }
    return known->second = add_medium(std::move(medium), ref.where);
  }

  /// None for no name.
  core::SensorId sensor_id(const config::NameRef& ref) {
    if (ref.empty()) return core::SensorId::none();
    const auto [known, is_new] = sensors_.try_emplace(ref.name);
    if (!is_new) return known->second;
    detector::Sensor sensor;
    try {
      sensor = database_.sensor(ref.name, ref.where);
      materials::check_cover(problems_, ref.where, sensor.efficiency, wavelengths_.low_nm,
                             wavelengths_.high_nm, "sensor \"" + sensor.name + "\"", "an efficiency",
                             "extend its efficiency table, with zeros where it does not respond");
      check_pulse(sensor);
    } catch (const core::InputError& error) {
      problems_.add(error);
    }
    return known->second = assembly_.sensors.push_back(std::move(sensor));
  }

  /// Reports, at the readout, a sensor whose pulses would have no shape behind it.
  void check_pulse(const detector::Sensor& sensor) {
    if (!spec_.readout) return;
    try {
      detector::pulse_of(sensor, *spec_.readout);
    } catch (const core::InputError& error) {
      const core::Problem& problem = error.problems().front();
      problems_.add(spec_.readout->where, "sensor \"" + sensor.name + "\": " + problem.what, problem.hint);
    }
  }

  /// The medium of a sensor that names none: its window, which only its index describes.
  core::MediumId window_medium(const detector::Sensor& sensor) {
    const std::string name = "window of " + sensor.name;
    const auto [known, is_new] = media_.try_emplace(name);
    if (!is_new) return known->second;
    optics::Medium window;
    window.name = name;
    window.index = core::Curve::constant(sensor.window_index);
    return known->second = add_medium(std::move(window), {});
  }

  void add_part(const contact::PlacedMesh& placed) {
    AssemblyPart part;
    part.sensor = sensor_id(placed.sensor);
    part.medium = placed.medium.empty() && part.sensor.has_value()
                      ? window_medium(assembly_.sensors[part.sensor])
                      : medium_id(placed.medium);
    part.rotation = placed.rotation;
    part.surface = placed.surface.name;
    if (!placed.surface.empty()) find_surface(placed.surface);
    part.geometry = {placed.name, placed.mesh.vertices, placed.mesh.triangles, {}, placed.where};
    std::vector<core::FaceId> faces;  // as placed.faces
    for (const contact::PlacedFace& face : placed.faces) {
      if (!face.surface.empty()) find_surface(face.surface);
      faces.push_back(assembly_.faces.push_back({placed.name + ":" + face.name, assembly_.parts.next_id(),
                                                 face.surface.name, sensor_id(face.sensor)}));
    }
    for (const std::uint32_t face : placed.face_of) part.geometry.face.push_back(faces[face]);
    check_sheet(placed);
    assembly_.parts.push_back(std::move(part));
  }

  /// Reports, once for each surface, a sheet that lets light through into a medium that keeps it.
  void check_sheet(const contact::PlacedMesh& placed) {
    if (placed.medium.name != scene_file::kOpaqueMedium) return;
    for (const contact::PlacedFace& face : placed.faces) {
      if (face.surface.empty()) continue;
      const materials::SurfaceSpec& surface = surfaces_.at(face.surface.name);
      if (!surface.face_of_sheet || !surface.reflector || !surface.reflector->transmittance) continue;
      if (!leaking_.insert(face.surface.name).second) continue;
      problems_.add(placed.medium.where,
                    "light goes through the faces of the sheet \"" + placed.name + "\" (reflector \"" +
                        surface.reflector->name + "\"), but its medium, \"" + scene_file::kOpaqueMedium +
                        "\", keeps it",
                    "give the sheet the medium that fills the space between its faces, as medium = \"" +
                        spec_.ambient.name + "\"");
    }
  }

  /// Looks a surface up once; problems are reported where it was first named.
  void find_surface(const config::NameRef& ref) {
    if (surfaces_.contains(ref.name)) return;
    materials::SurfaceSpec& spec = surfaces_[ref.name];
    spec.microsurface = materials::SmoothSpec{};
    try {
      spec = database_.surface(ref.name, ref.where);
    } catch (const core::InputError& error) {
      problems_.add(error);
    }
  }

  void check_contact_names() {
    std::vector<std::string> names;
    for (const AssemblyPart& part : assembly_.parts) names.push_back(part.geometry.name);
    for (const scene_file::ContactSpec& contact : spec_.contacts) {
      if (!contact.surface.empty()) find_surface(contact.surface);
      if (contact.by_builder) continue;
      for (const config::NameRef& part : contact.between) {
        if (!core::matching(part.name, names).empty()) continue;
        const std::string near = core::nearest_word(part.name, names);
        problems_.add(part.where, "no part is called \"" + part.name + "\"",
                      near.empty() ? "name two [[part]]s of this scene" : "did you mean \"" + near + "\"?");
      }
    }
  }

  optics::Surface make_surface(const std::string& name, core::MediumId inside, core::MediumId outside,
                               std::vector<std::string>& warnings) {
    materials::SurfaceSpec smooth;
    smooth.microsurface = materials::SmoothSpec{};
    const materials::SurfaceSpec& spec = name.empty() ? smooth : surfaces_.at(name);
    // An opaque part has no index: where light enters it the indices match.
    const core::MediumId seen_inside = assembly_.media[inside].is_opaque() ? outside : inside;
    const core::MediumId seen_outside = assembly_.media[outside].is_opaque() ? inside : outside;
    const materials::MadeSurface made = surface_factory_.make(
        spec, assembly_.media[seen_inside].medium(), assembly_.media[seen_outside].medium(),
        wavelengths_.reference_nm, wavelengths_.low_nm, wavelengths_.high_nm);
    warnings.insert(warnings.end(), made.warnings.begin(), made.warnings.end());
    return made.surface;
  }

  const scene_file::SceneSpec& spec_;
  const materials::MaterialDatabase& database_;
  materials::SurfaceFactory& surface_factory_;
  core::Problems& problems_;
  WavelengthRange wavelengths_;
  Assembly assembly_;
  std::map<std::string, core::MediumId> media_;
  std::map<std::string, core::SensorId> sensors_;
  std::map<std::string, materials::SurfaceSpec> surfaces_;
  std::set<std::string> leaking_;  ///< surfaces of opaque sheets that were reported
};

/// Regions that light from `start` can reach through interfaces that are not opaque both ways.
core::IdVector<core::RegionId, bool> lit_regions(const Scene& scene,
                                                 const std::vector<core::RegionId>& start) {
  const auto passes = [&](const Interface& i, bool from_back) {
    const auto opaque = [&](core::SurfaceId id) { return id.has_value() && scene.surfaces[id].opaque(); };
    const core::RegionId next = from_back ? i.front : i.back;
    return !opaque(i.back_surface) && !opaque(i.front_surface) &&
           !scene.media[scene.regions[next].medium].is_opaque();
  };
  core::IdVector<core::RegionId, bool> lit(scene.regions.size(), false);
  for (const core::RegionId region : start) lit[region] = true;
  for (bool grew = true; grew;) {
    grew = false;
    for (const Interface& i : scene.interfaces) {
      if (lit[i.back] && !lit[i.front] && passes(i, true)) lit[i.front] = grew = true;
      if (lit[i.front] && !lit[i.back] && passes(i, false)) lit[i.back] = grew = true;
    }
  }
  return lit;
}

/// Regions in which light of the source may start.
std::vector<core::RegionId> starting_regions(const scene_file::SceneSpec& spec, const Scene& scene) {
  std::vector<core::RegionId> regions;
  if (spec.energy_source) {
    for (const core::RegionId region : scene.regions.ids())
      if (scene.media[scene.regions[region].medium].medium().yield_per_keV > 0.0) regions.push_back(region);
  } else if (const auto* region = std::get_if<scene_file::RegionSpec>(&spec.source.origin)) {
    for (const PartInfo& part : scene.parts)
      if (core::matches_pattern(region->part.name, part.name)) regions.push_back(part.region);
  } else {
    regions.push_back(scene.locate(std::get<core::Vec3>(spec.source.origin)));
  }
  return regions;
}

/// A sensor that cannot be reached is a mistake; a scene without any is a warning.
void check_sensors(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& placed,
                   const Scene& scene, core::Problems& problems, std::vector<std::string>& warnings) {
  const std::vector<core::RegionId> start = starting_regions(spec, scene);
  if (start.empty()) return;  // the source reports it
  const core::IdVector<core::RegionId, bool> lit = lit_regions(scene, start);
  bool any_sensor = false;
  for (const contact::PlacedMesh& part : placed)
    any_sensor |=
        !part.sensor.empty() || std::any_of(part.faces.begin(), part.faces.end(),
                                            [](const contact::PlacedFace& f) { return !f.sensor.empty(); });
  if (!any_sensor) warnings.push_back("the scene has no sensor: no photon can be detected");
  for (const core::PartId id : scene.parts.ids()) {
    const contact::PlacedMesh& part = placed[id.index()];
    if (!part.sensor.empty() && !lit[scene.parts[id].region])
      problems.add(
          part.where, "no light from the source can reach sensor \"" + part.name + "\"",
          "something opaque lies between: check the surfaces of the faces on the way, and that the parts "
          "touch (scintray check lists every interface)");
  }
}

/// The contacts with a tolerance of their own.
std::vector<contact::ConformingContact> conforming_contacts(const scene_file::SceneSpec& spec) {
  std::vector<contact::ConformingContact> result;
  for (const scene_file::ContactSpec& contact : spec.contacts)
    if (contact.tolerance_mm)
      result.push_back(
          {contact.between[0].name, contact.between[1].name, *contact.tolerance_mm, contact.where});
  return result;
}

bool same_place(const core::FileLocation& a, const core::FileLocation& b) {
  return a.line == b.line && a.column == b.column && a.file == b.file;
}

/// The same value at the same place of the same file, so that messages are the same too.
bool same_node(const config::TomlNode& a, const config::TomlNode& b) {
  return a.kind == b.kind && a.key == b.key && a.text == b.text && a.number == b.number &&
         a.integer == b.integer && a.boolean == b.boolean && same_place(a.where, b.where) &&
         same_place(a.key_where, b.key_where) &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), same_node);
}

bool same_definitions(const std::array<scene_file::InlineTables, 4>& a,
                      const std::array<scene_file::InlineTables, 4>& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const scene_file::InlineTables& one, const scene_file::InlineTables& other) {
                      return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                                        [](const auto& x, const auto& y) {
                                          return x.first == y.first &&
                                                 (x.second == y.second || same_node(*x.second, *y.second));
                                        });
                    });
}

}  // namespace

SceneBuilder::SceneBuilder(materials::SurfaceFactory::Hooks hooks) : surface_factory_(std::move(hooks)) {}

const materials::MaterialDatabase& SceneBuilder::database(const scene_file::SceneSpec& spec) {
  if (!shipped_) shipped_ = materials::MaterialDatabase::shipped();
  const OwnDefinitions own{spec.media, spec.surfaces, spec.sensors, spec.reflectors};
  if (database_ && same_definitions(own, own_)) return *database_;
  database_ = shipped_;
  add_definitions(*database_, spec);
  own_ = own;
  return *database_;
}

materials::MaterialDatabase::Readings SceneBuilder::readings() const {
  return shipped_ ? shipped_->readings() : materials::MaterialDatabase::Readings{};
}

BuiltScene SceneBuilder::build(const scene_file::SceneSpec& spec) {
  core::Problems problems;
  std::vector<contact::PlacedMesh> placed = place_parts(spec, problems);
  if (problems.empty()) contact::cut_overlaps(placed, spec.run.contact_tolerance_mm, problems);
  if (problems.empty())
    contact::conform_contacts(placed, conforming_contacts(spec), spec.run.contact_tolerance_mm, problems);
  const materials::MaterialDatabase& database = this->database(spec);
  BuiltScene built;
  AssemblyMaker factory(spec, database, surface_factory_, problems);
  const Assembly assembly = factory.make(placed, built.warnings);
  problems.throw_if_any();
  built.scene = assemble(assembly);
  check_sensors(spec, placed, built.scene, problems, built.warnings);
  problems.throw_if_any();
  for (const contact::PlacedMesh& part : placed)
    built.parts.push_back({part.name, part.diagnosis, part.notes});
  built.placed = std::move(placed);
  return built;
}

}  // namespace scintray::scene
