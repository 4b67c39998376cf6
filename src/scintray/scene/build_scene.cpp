#include "scintray/scene/build_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "scintray/contact/neighbours.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/detector/channel.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/wavelength_cover.hpp"
#include "scintray/scene/detail/assemble.hpp"
#include "scintray/scene/detail/build_steps.hpp"
#include "scintray/scene/place_parts.hpp"

namespace scintray::scene {

namespace {

/// The film of a sensor's photocathode as a surface, between the media on its two sides. The caller checks
/// that n and k cover the wavelengths in use.
materials::SurfaceSpec photocathode_surface(const detector::Sensor& sensor) {
  materials::SurfaceSpec spec;
  spec.name = "photocathode of " + sensor.name;
  spec.sources = sensor.sources;
  spec.microsurface = materials::FixedMicrosurface(optics::ThinFilmSurface({sensor.cathode->film}));
  return spec;
}

/// Maker of an Assembly: looks up every name of a scene.
class AssemblyMaker {
 public:
  AssemblyMaker(const scene_file::SceneSpec& spec, const materials::MaterialDatabase& database,
                materials::SurfaceFactory& surfaces, core::Problems& problems)
      : spec_(spec), database_(database), surface_factory_(surfaces), problems_(problems) {}

  Assembly make(const std::vector<contact::PlacedMesh>& placed, std::vector<std::string>& warnings) {
    wavelengths_ = find_wavelengths(spec_, placed, database_, problems_);
    assembly_.low_nm = wavelengths_.low_nm;
    assembly_.high_nm = wavelengths_.high_nm;
    assembly_.ambient = medium_id(spec_.ambient);
    if (assembly_.media[assembly_.ambient].medium().birefringence)
      problems_.add(spec_.ambient.where,
                    "the ambient medium, \"" + spec_.ambient.name + "\", is birefringent",
                    "place it as a part, whose principal axes have directions");
    for (const contact::PlacedMesh& part : placed) add_part(part, warnings);
    assembly_.contacts_default = spec_.contacts_default;
    assembly_.contacts = spec_.contacts;
    assembly_.contact_tolerance_mm = spec_.run.contact_tolerance_mm;
    assembly_.accelerator = spec_.run.accelerator;
    assembly_.curved = spec_.run.curved;
    assembly_.keeps_phases = spec_.run.polarisation == scene_file::PolarisationState::elliptical;
    check_contact_names();
    assembly_.make_surface = [this, &warnings](const std::string& name, core::MediumId inside,
                                               core::MediumId outside) {
      return make_surface(name, inside, outside, warnings);
    };
    return assembly_;
  }

 private:
  core::MediumId add_medium(optics::Medium medium, const core::FileLocation& where) {
    materials::check_cover(problems_, where, medium, wavelengths_.low_nm, wavelengths_.high_nm);
    return assembly_.media.emplace_back(std::move(medium));
  }

  /// The medium of a part: of a birefringent one there is one for every direction of its principal axes.
  core::MediumId medium_of(const contact::PlacedMesh& placed, std::vector<std::string>& warnings) {
    const core::MediumId id = medium_id(placed.medium);
    const std::shared_ptr<const optics::Birefringence> birefringence =
        assembly_.media[id].medium().birefringence;
    if (!birefringence) {
      if (placed.principal_axes && !unknown_media_.contains(placed.medium.name))
        problems_.add(placed.where,
                      "the part \"" + placed.name + "\" has principal axes, but its medium \"" +
                          placed.medium.name + "\" has " +
                          (assembly_.media[id].is_opaque() ? "none" : "one refractive index"),
                      "leave out principal_axes, or give the medium [index.y] and [index.z]");
      return id;
    }
    if (placed.principal_axes && !placed.principal_x_given &&
        !optics::alike(birefringence->axes[0], birefringence->axes[1]))
      problems_.add(placed.where,
                    "principal_axes of the part \"" + placed.name + "\" states z alone, but its medium \"" +
                        placed.medium.name + "\" differs along x and y",
                    "state x as well, as principal_axes = { z = [0, 0, 1], x = [1, 0, 0] }");
    if (!placed.principal_axes && along_part_.insert(placed.medium.name).second)
      warnings.push_back("the principal axes of the birefringent medium \"" + placed.medium.name +
                         "\" are taken along x, y and z of the part \"" + placed.name +
                         "\" and of others without principal_axes = { x = [1, 0, 0], z = [0, 0, 1] }");
    const Eigen::Matrix3d directions =
        placed.rotation * placed.principal_axes.value_or(Eigen::Matrix3d::Identity());
    if (directions.isIdentity(0.0)) return id;
    std::string name = placed.medium.name;
    for (const double number : directions.reshaped()) name += fmt::format(" {:.12g}", number + 0.0);
    const auto [known, is_new] = media_.try_emplace(name);
    if (!is_new) return known->second;
    optics::Medium turned = assembly_.media[id].medium();
    auto axes = std::make_shared<optics::Birefringence>(*birefringence);
    axes->directions = directions;
    turned.birefringence = std::move(axes);
    return known->second = assembly_.media.emplace_back(std::move(turned));
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
      unknown_media_.insert(ref.name);
      problems_.add(error);
    }
    return known->second = add_medium(std::move(medium), ref.where);
  }

  /// Id of a sensor; none for an empty name.
  core::SensorId sensor_id(const config::NameRef& ref) {
    if (ref.empty()) return core::SensorId::none();
    const auto [known, is_new] = sensors_.try_emplace(ref.name);
    if (!is_new) return known->second;
    detector::Sensor sensor;
    try {
      sensor = database_.sensor(ref.name, ref.where);
      materials::check_cover(problems_, ref.where,
                             {sensor.efficiency, "sensor \"" + sensor.name + "\"", "an efficiency",
                              "extend its efficiency table, with zeros where it does not respond"},
                             wavelengths_.low_nm, wavelengths_.high_nm);
      if (sensor.cathode)
        for (const core::Curve& curve : {sensor.cathode->film.index, sensor.cathode->film.extinction})
          materials::check_cover(problems_, ref.where,
                                 {curve, "the photocathode of sensor \"" + sensor.name + "\"", "n and k",
                                  "extend its tables of n and k, or narrow the wavelengths of the source"},
                                 wavelengths_.low_nm, wavelengths_.high_nm);
      check_pulse(sensor);
    } catch (const core::InputError& error) {
      problems_.add(error);
    }
    return known->second = assembly_.sensors.push_back(std::move(sensor));
  }

  /// Reports, at the readout, a sensor without a pulse shape.
  void check_pulse(const detector::Sensor& sensor) {
    if (!spec_.readout) return;
    try {
      detector::pulse_of(sensor, *spec_.readout);
    } catch (const core::InputError& error) {
      const core::Problem& problem = error.problems().front();
      problems_.add(spec_.readout->where, "sensor \"" + sensor.name + "\": " + problem.what, problem.hint);
    }
  }

  bool has_cathode(core::SensorId id) const {
    return id.has_value() && assembly_.sensors[id].cathode.has_value();
  }

  /// Name of the surface of a sensor's photocathode.
  std::string cathode_surface(core::SensorId id) {
    materials::SurfaceSpec spec = photocathode_surface(assembly_.sensors[id]);
    const std::string name = spec.name;
    surfaces_.try_emplace(name, std::move(spec));
    return name;
  }

  /// A face of a part, whose surface is the photocathode of its sensor, or of its part's, where that has one.
  AssemblyFace face_of(const contact::PlacedMesh& placed, const contact::PlacedFace& face,
                       core::SensorId part_sensor) {
    AssemblyFace made{placed.name + ":" + face.name, assembly_.parts.next_id(), face.surface.name,
                      sensor_id(face.sensor)};
    const bool of_part = has_cathode(part_sensor);
    if (!of_part && !has_cathode(made.sensor)) return made;
    if (!face.surface.empty() && (of_part || face.surface.name != placed.surface.name))
      problems_.add(face.surface.where,
                    "the face \"" + made.name + "\" has a surface, \"" + face.surface.name +
                        "\", and a sensor with a photocathode, which is the surface itself",
                    "leave out the surface");
    made.surface = cathode_surface(of_part ? part_sensor : made.sensor);
    made.is_cathode = true;
    return made;
  }

  /// The medium of a sensor part without one: its window, which has an index only. Light enters a matched
  /// window as it does an opaque part.
  core::MediumId window_medium(const detector::Sensor& sensor) {
    const std::string name = "window of " + sensor.name;
    const auto [known, is_new] = media_.try_emplace(name);
    if (!is_new) return known->second;
    if (sensor.window_matched) return known->second = assembly_.media.push_back(SceneMedium::opaque(name));
    optics::Medium window;
    window.name = name;
    window.index = core::Curve::constant(sensor.window_index);
    return known->second = add_medium(std::move(window), {});
  }

  void add_part(const contact::PlacedMesh& placed, std::vector<std::string>& warnings) {
    AssemblyPart part;
    part.sensor = sensor_id(placed.sensor);
    if (placed.medium.empty() && has_cathode(part.sensor))
      problems_.add(placed.where,
                    "the sensor \"" + placed.name + "\" has a photocathode, but no medium behind it",
                    "give it the vacuum of the tube, as medium = \"vacuum\", and place its window as a part "
                    "before it; or give the sensor to the back face of the window");
    if (placed.medium.empty() && placed.principal_axes)
      problems_.add(placed.where, "the sensor \"" + placed.name + "\" has principal axes, but no medium",
                    "leave out principal_axes, or give the birefringent medium of its window");
    part.medium = placed.medium.empty() && part.sensor.has_value()
                      ? window_medium(assembly_.sensors[part.sensor])
                      : medium_of(placed, warnings);
    part.rotation = placed.rotation;
    part.surface = placed.surface.name;
    if (!placed.surface.empty()) find_surface(placed.surface);
    part.geometry = {placed.name, placed.mesh.vertices, placed.mesh.triangles, {}, placed.where};
    if (placed.mesh.support.size() == placed.mesh.triangles.size()) {
      part.geometry.supports = placed.mesh.supports;
      part.geometry.support = placed.mesh.support;
    }
    std::vector<core::FaceId> faces;  // as placed.faces
    for (const contact::PlacedFace& face : placed.faces) {
      if (!face.surface.empty()) find_surface(face.surface);
      faces.push_back(assembly_.faces.push_back(face_of(placed, face, part.sensor)));
    }
    for (const std::uint32_t face : placed.face_of) part.geometry.face.push_back(faces[face]);
    check_sheet(placed);
    assembly_.parts.push_back(std::move(part));
  }

  /// Reports, once for each surface, a sheet that transmits light into an opaque medium.
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

  /// Looks up a surface once; problems are reported at its first use.
  void find_surface(const config::NameRef& ref) {
    if (surfaces_.contains(ref.name)) return;
    materials::SurfaceSpec& spec = surfaces_[ref.name];
    try {
      spec = database_.surface(ref.name, ref.where);
    } catch (const core::InputError& error) {
      problems_.add(error);
    }
  }

  void check_contact_names() {
    std::vector<std::string> names;
    for (const AssemblyPart& part : assembly_.parts) names.push_back(part.geometry.name);
    const std::set<std::string> known(names.begin(), names.end());
    for (const scene_file::ContactSpec& contact : spec_.contacts) {
      for (const config::NameRef& surface : {contact.surface, contact.leaving[0], contact.leaving[1]})
        if (!surface.empty()) find_surface(surface);
      if (contact.by_builder) continue;
      for (const config::NameRef& part : contact.between) {
        if (known.contains(part.name) ||
            (core::is_pattern(part.name) && !core::matching(part.name, names).empty()))
          continue;
        const std::string near = core::nearest_word(part.name, names);
        problems_.add(part.where, "no part is called \"" + part.name + "\"",
                      near.empty() ? "name two [[part]]s of this scene" : "did you mean \"" + near + "\"?");
      }
    }
  }

  optics::Surface make_surface(const std::string& name, core::MediumId inside, core::MediumId outside,
                               std::vector<std::string>& warnings) {
    const materials::SurfaceSpec smooth;
    const materials::SurfaceSpec& spec = name.empty() ? smooth : surfaces_.at(name);
    // An opaque part has no index: light enters it with matched indices.
    const core::MediumId seen_inside = assembly_.media[inside].is_opaque() ? outside : inside;
    const core::MediumId seen_outside = assembly_.media[outside].is_opaque() ? inside : outside;
    const materials::MadeSurface made = surface_factory_.make(
        spec, assembly_.media[seen_inside].medium(), assembly_.media[seen_outside].medium(),
        wavelengths_.reference_nm, wavelengths_.low_nm, wavelengths_.high_nm);
    warnings.insert(warnings.end(), made.warnings.begin(), made.warnings.end());
    for (const core::MediumId side : {inside, outside}) {
      const optics::Medium& medium = assembly_.media[side].medium();
      // A sheet in contact with the medium behind it mirrors rays, and refracts, by one index.
      const bool by_sheet = side == outside && made.surface.has_reflector();
      if (!medium.birefringence || (made.surface.birefringent() && !by_sheet)) continue;
      if (by_mean_index_.insert(name + '\n' + medium.name).second)
        warnings.push_back(
            fmt::format("surface \"{}\" has the mean refractive index, {:.4g}, of the birefringent medium "
                        "\"{}\": its model knows "
                        "one index; light that leaves it in the medium takes one of the two polarisations of "
                        "its direction",
                        name, medium.index(wavelengths_.reference_nm), medium.name));
    }
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
  std::set<std::string> unknown_media_;  ///< with problems of their own
  std::set<std::string> leaking_;        ///< surfaces of opaque sheets that were reported
  std::set<std::string> by_mean_index_;  ///< surface and birefringent medium of a warning
  std::set<std::string> along_part_;     ///< birefringent media whose axes' directions a warning states
};

/// The contacts with a tolerance of their own.
std::vector<contact::ConformingContact> conforming_contacts(const scene_file::SceneSpec& spec) {
  std::vector<contact::ConformingContact> result;
  for (const scene_file::ContactSpec& contact : spec.contacts)
    if (contact.tolerance_mm)
      result.push_back(
          {contact.between[0].name, contact.between[1].name, *contact.tolerance_mm, contact.where});
  return result;
}

}  // namespace

SceneBuilder::SceneBuilder(materials::SurfaceFactory::Hooks hooks, materials::DefinitionModels models,
                           const mesh::MeshFormats& formats)
    : surface_factory_(std::move(hooks)), models_(std::move(models)), formats_(&formats) {}

BuiltScene SceneBuilder::build(const scene_file::SceneSpec& spec) {
  core::Problems problems;
  std::vector<contact::PlacedMesh> placed = place_parts(spec, problems, *formats_);
  const std::vector<contact::ConformingContact> conforming = conforming_contacts(spec);
  if (problems.empty()) contact::conform_common_walls(placed, conforming, spec.run.contact_tolerance_mm);
  if (problems.empty()) contact::cut_overlaps(placed, spec.run.contact_tolerance_mm, problems);
  if (problems.empty())
    contact::conform_contacts(placed, conforming, spec.run.contact_tolerance_mm, problems);
  const materials::MaterialDatabase& database = this->database(spec);
  BuiltScene built;
  AssemblyMaker factory(spec, database, surface_factory_, problems);
  const Assembly assembly = factory.make(placed, built.warnings);
  check_definitions(spec, database, problems);
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
