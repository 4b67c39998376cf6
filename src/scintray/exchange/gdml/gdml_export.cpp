#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "scintray/exchange/gdml/detail/gdml_writer.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/scene/build_scene.hpp"

namespace scintray::exchange::gdml {

namespace {

/// Number of a part, or of the space around all parts.
using Body = std::optional<std::size_t>;

class SceneExporter {
 public:
  explicit SceneExporter(const scene::BuiltScene& built)
      : scene_(built.scene), placed_(built.placed), writer_({built.scene.low_nm, built.scene.high_nm}) {}

  GdmlExport run() {
    find_mothers();
    for (std::size_t i = 0; i < placed_.size(); ++i) add_part(i);
    add_surroundings();
    add_borders();
    return {writer_.text(), writer_.notes()};
  }

 private:
  const scene::PartInfo& part(std::size_t i) const { return scene_.parts[core::PartId(i)]; }

  Body body_of(core::RegionId region) const {
    const core::PartId part = scene_.regions[region].part;
    return part.has_value() ? Body(part.index()) : Body();
  }
  std::string name_of(Body body) const { return body ? names_.at(*body) : "surroundings"; }

  /// A part is in another where its faces border the other's inside, which has no face there.
  void find_mothers() {
    mothers_.assign(placed_.size(), std::nullopt);
    for (const scene::Interface& i : scene_.interfaces)
      for (const bool back : {true, false}) {
        const Body inner = body_of(back ? i.back : i.front), outer = body_of(back ? i.front : i.back);
        const bool own_face = (back ? i.back_face : i.front_face).has_value();
        const bool other_face = (back ? i.front_face : i.back_face).has_value();
        if (inner && outer && own_face && !other_face) mothers_[*inner] = outer;
      }
    std::map<std::string, int> taken;
    for (const contact::PlacedMesh& mesh : placed_) {
      const std::string name = part_name(mesh.name);
      const int count = ++taken[name];
      names_.push_back(count == 1 ? name : name + "_" + std::to_string(count));
    }
  }

  /// A tessellated solid in the coordinates of the scene.
  void add_solid(const std::string& name, const mesh::TriMesh& mesh) {
    pugi::xml_node define = writer_.section("define");
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      pugi::xml_node position = define.append_child("position");
      position.append_attribute("name") = fmt::format("{}_v{}", name, i).c_str();
      position.append_attribute("unit") = "mm";
      const core::Vec3& vertex = mesh.vertices[i];
      position.append_attribute("x") = fmt::format("{:.17g}", vertex.x()).c_str();
      position.append_attribute("y") = fmt::format("{:.17g}", vertex.y()).c_str();
      position.append_attribute("z") = fmt::format("{:.17g}", vertex.z()).c_str();
    }
    pugi::xml_node solid = writer_.section("solids").append_child("tessellated");
    solid.append_attribute("name") = name.c_str();
    for (const auto& triangle : mesh.triangles) {
      pugi::xml_node node = solid.append_child("triangular");
      for (std::size_t corner = 0; corner < 3; ++corner)
        node.append_attribute(fmt::format("vertex{}", corner + 1).c_str()) =
            fmt::format("{}_v{}", name, triangle[corner]).c_str();
      node.append_attribute("type") = "ABSOLUTE";
    }
  }

  pugi::xml_node new_volume(const std::string& name, const std::string& material, const std::string& solid) {
    pugi::xml_node volume = writer_.section("structure").append_child("volume");
    volume.append_attribute("name") = name.c_str();
    volume.append_child("materialref").append_attribute("ref") = material.c_str();
    volume.append_child("solidref").append_attribute("ref") = solid.c_str();
    return volume;
  }

  static void place(pugi::xml_node mother, const std::string& volume, const std::string& name) {
    pugi::xml_node physvol = mother.append_child("physvol");
    physvol.append_attribute("name") = name.c_str();
    physvol.append_child("volumeref").append_attribute("ref") = volume.c_str();
  }

  const detector::Sensor* sensor_of(std::size_t i) const {
    return part(i).sensor.has_value() ? &scene_.sensors[part(i).sensor] : nullptr;
  }

  /// True for a sensor behind a window whose faces reflect: a body of the window's index, and in it one that
  /// absorbs and detects.
  bool has_window(std::size_t i) const {
    const detector::Sensor* sensor = sensor_of(i);
    return sensor && sensor->converts_entering() && !sensor->window_matched && star_shaped(placed_[i].mesh);
  }

  static core::Vec3 middle(const mesh::TriMesh& mesh) {
    core::Vec3 sum = core::Vec3::Zero();
    for (const core::Vec3& vertex : mesh.vertices) sum += vertex;
    return sum / static_cast<double>(mesh.vertices.size());
  }

  /// True when the mean of the corners is on the inner side of every face's plane: a smaller copy about that
  /// point lies inside.
  static bool star_shaped(const mesh::TriMesh& mesh) {
    const core::Vec3 centre = middle(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (!(mesh.area_vector(t).dot(mesh.vertices[mesh.triangles[t][0]] - centre) > 0.0)) return false;
    return true;
  }

  void add_part(std::size_t i) {
    const std::string& name = names_[i];
    add_solid(name + "_solid", placed_[i].mesh);
    const scene::SceneMedium& medium = scene_.media[scene_.regions[part(i).region].medium];
    std::string material = writer_.material(medium.medium(), medium.is_opaque());
    const detector::Sensor* sensor = sensor_of(i);
    if (has_window(i)) {
      optics::Medium window;
      window.name = "window of " + sensor->name;
      window.index = core::Curve::constant(sensor->window_index);
      material = writer_.material(window, false);
    } else if (sensor && sensor->converts_entering() && !sensor->window_matched) {
      writer_.note("part " + name +
                   ": a sensor of this shape is written without its window: light that the "
                   "window's faces reflect enters it");
    }
    volumes_.push_back(new_volume(name + "_volume", material, name + "_solid"));
    if (sensor) {
      pugi::xml_node auxiliary = volumes_.back().append_child("auxiliary");
      auxiliary.append_attribute("auxtype") = "SensDet";
      auxiliary.append_attribute("auxvalue") = sensor->name.c_str();
    }
    if (has_window(i)) add_core(i);
    for (const scene::FaceInfo& face : scene_.faces)
      if (face.part == core::PartId(i) && face_has_sensor(face))
        writer_.note(
            "face " + face.name +
            ": a sensor of a face alone is left out: give it a part of its own, whose light it detects");
  }

  bool face_has_sensor(const scene::FaceInfo& face) const {
    const contact::PlacedMesh& mesh = placed_[face.part.index()];
    return std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const contact::PlacedFace& known) {
      return !known.sensor.empty() && face.name == mesh.name + ":" + known.name;
    });
  }

  /// The absorbing body within a sensor's window, a little smaller than it.
  void add_core(std::size_t i) {
    constexpr double kScale = 0.999;
    const std::string name = names_[i] + "_core";
    mesh::TriMesh mesh = placed_[i].mesh;
    const core::Vec3 centre = middle(mesh);
    for (core::Vec3& vertex : mesh.vertices) vertex = centre + kScale * (vertex - centre);
    add_solid(name + "_solid", mesh);
    optics::Medium inside;
    inside.name = "inside of sensors";
    inside.empty_space = true;
    pugi::xml_node volume = new_volume(name + "_volume", writer_.material(inside, true), name + "_solid");
    pugi::xml_node auxiliary = volume.append_child("auxiliary");
    auxiliary.append_attribute("auxtype") = "SensDet";
    auxiliary.append_attribute("auxvalue") = sensor_of(i)->name.c_str();
    place(volumes_[i], name + "_volume", name);
  }

  /// The space around the parts, as a volume of its own in a world: borders name physical volumes.
  void add_surroundings() {
    Eigen::AlignedBox3d box;
    for (const contact::PlacedMesh& mesh : placed_)
      for (const core::Vec3& vertex : mesh.mesh.vertices) box.extend(vertex);
    const core::Vec3 half = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()) +
                            core::Vec3::Constant(0.5 * box.diagonal().norm());
    pugi::xml_node solid = writer_.section("solids").append_child("box");
    solid.append_attribute("name") = "surroundings_solid";
    solid.append_attribute("lunit") = "mm";
    solid.append_attribute("x") = fmt::format("{:.9g}", 2.0 * half.x()).c_str();
    solid.append_attribute("y") = fmt::format("{:.9g}", 2.0 * half.y()).c_str();
    solid.append_attribute("z") = fmt::format("{:.9g}", 2.0 * half.z()).c_str();
    const scene::SceneMedium& ambient = scene_.media[scene_.regions[scene::kAmbientRegion].medium];
    const std::string material = writer_.material(ambient.medium(), ambient.is_opaque());
    pugi::xml_node surroundings = new_volume("surroundings_volume", material, "surroundings_solid");
    for (std::size_t i = 0; i < placed_.size(); ++i)
      place(mothers_[i] ? volumes_[*mothers_[i]] : surroundings, names_[i] + "_volume", names_[i]);
    place(new_volume("world", material, "surroundings_solid"), "surroundings_volume", "surroundings");
    writer_.section("setup").append_attribute("name") = "Default";
    writer_.section("setup").append_attribute("version") = "1.0";
    writer_.section("setup").append_child("world").append_attribute("ref") = "world";
  }

  /// A surface for light from one body to another: Geant4 has one for a pair.
  struct Border {
    std::string property;
    double area_mm2 = 0.0;
  };

  /// Sensor of the part on a side that converts what its surfaces absorb, or that admits light without
  /// reflection.
  const detector::Sensor* absorbing_sensor(Body one, Body other) const {
    for (const Body body : {one, other})
      if (const detector::Sensor* sensor = body ? sensor_of(*body) : nullptr;
          sensor && sensor->converts_absorbed())
        return sensor;
    return nullptr;
  }

  /// Name of the optical surface for light across an interface; empty: none is needed.
  std::string property(const scene::Interface& i, bool from_back) {
    const core::SurfaceId near = from_back ? i.back_surface : i.front_surface;
    const core::SurfaceId id = near.has_value() ? near : (from_back ? i.front_surface : i.back_surface);
    const Body from = body_of(from_back ? i.back : i.front), to = body_of(from_back ? i.front : i.back);
    if (i.gap_medium.has_value())
      writer_.note(
          "between " + name_of(body_of(i.back)) + " and " + name_of(body_of(i.front)) +
          ": the thin air gap of a dry contact: they are in optical contact in Geant4, and light of all "
          "angles passes. Give the gap a thickness in the scene to keep it");
    const detector::Sensor* behind = to ? sensor_of(*to) : nullptr;
    const bool enters_sensor = behind && behind->converts_entering() && !has_window(*to);
    const optics::Surface& surface = scene_.surfaces[id];
    if (enters_sensor && surface.plain()) return writer_.absorbing_surface(*behind);
    if (enters_sensor)
      writer_.note("surface " + surface.name + " at the sensor " + name_of(to) +
                   ": light that passes it enters a sensor without a window, and is not detected");
    const optics::Side side = near.has_value() ? optics::Side::inside : optics::Side::outside;
    return writer_.surface(surface, side, absorbing_sensor(from, to));
  }

  void add_borders() {
    std::map<std::pair<std::string, std::string>, std::vector<Border>> borders;
    for (const core::InterfaceId id : scene_.interfaces.ids())
      for (const bool from_back : {true, false}) {
        const scene::Interface& i = scene_.interfaces[id];
        const Body back = body_of(i.back), front = body_of(i.front);
        auto& known = borders[{name_of(from_back ? back : front), name_of(from_back ? front : back)}];
        const std::string wanted = property(i, from_back);
        auto border = std::find_if(known.begin(), known.end(),
                                   [&](const Border& one) { return one.property == wanted; });
        if (border == known.end()) border = known.insert(known.end(), {wanted, 0.0});
        border->area_mm2 += scene_.interface_area_mm2[id];
      }
    for (auto& [pair, kinds] : borders) {
      std::stable_sort(kinds.begin(), kinds.end(),
                       [](const Border& a, const Border& b) { return a.area_mm2 > b.area_mm2; });
      for (std::size_t k = 1; k < kinds.size(); ++k)
        writer_.note(
            fmt::format("from {} to {}: {:.4g} mm2 of surface {} have the surface {} of the larger area: "
                        "Geant4 has one for a pair of volumes",
                        pair.first, pair.second, kinds[k].area_mm2,
                        kinds[k].property.empty() ? "without a finish" : kinds[k].property,
                        kinds[0].property.empty() ? "without a finish" : kinds[0].property));
      add_border(pair.first, pair.second, kinds[0].property);
    }
    for (std::size_t i = 0; i < placed_.size(); ++i)
      if (has_window(i)) add_border(names_[i], names_[i] + "_core", writer_.absorbing_surface(*sensor_of(i)));
  }

  void add_border(const std::string& from, const std::string& to, const std::string& property) {
    if (property.empty()) return;
    pugi::xml_node node = writer_.section("structure").append_child("bordersurface");
    node.append_attribute("name") = (from + "_to_" + to).c_str();
    node.append_attribute("surfaceproperty") = property.c_str();
    node.append_child("physvolref").append_attribute("ref") = from.c_str();
    node.append_child("physvolref").append_attribute("ref") = to.c_str();
  }

  const scene::Scene& scene_;
  const std::vector<contact::PlacedMesh>& placed_;
  GdmlWriter writer_;
  std::vector<Body> mothers_;
  std::vector<std::string> names_;
  std::vector<pugi::xml_node> volumes_;
};

}  // namespace

GdmlExport export_gdml(const scene::BuiltScene& scene) { return SceneExporter(scene).run(); }

}  // namespace scintray::exchange::gdml
