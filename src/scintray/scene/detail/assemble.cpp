#include "scintray/scene/detail/assemble.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "scintray/core/activity.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/scene/detail/round_parts.hpp"

namespace scintray::scene {

namespace {

using InterfaceKey = std::tuple<core::PartId, core::PartId, core::FaceId, core::FaceId>;

/// Maker of interfaces from groups of interface triangles.
class InterfaceMaker {
 public:
  InterfaceMaker(const Assembly& assembly, Scene& scene, core::Problems& problems)
      : assembly_(assembly),
        scene_(scene),
        problems_(problems),
        contact_used_(assembly.contacts.size(), false) {
    index_contacts();
  }

  core::InterfaceId interface_of(const contact::InterfaceTriangle& t) {
    const InterfaceKey key{t.back, t.front, t.back_face, t.front_face};
    const auto [known, is_new] = known_.try_emplace(key, scene_.interfaces.next_id());
    if (is_new) {
      scene_.interfaces.push_back(make(t));
      scene_.interface_area_mm2.push_back(0.0);
    }
    return known->second;
  }

  void report_unused_contacts() {
    for (std::size_t i = 0; i < assembly_.contacts.size(); ++i) {
      if (contact_used_[i] || assembly_.contacts[i].by_builder) continue;
      if (assembly_.contacts[i].kind == scene_file::ContactKind::each_side) continue;  // as Geant4's borders
      const scene_file::ContactSpec& contact = assembly_.contacts[i];
      problems_.add(
          contact.where,
          "\"" + side_name(contact, 0) + "\" and \"" + side_name(contact, 1) +
              "\" of this contact do not touch",
          "check their positions (scintray check lists every interface), or raise run.contact_tolerance");
    }
  }

 private:
  static std::string side_name(const scene_file::ContactSpec& contact, std::size_t side) {
    const std::string& face = contact.faces[side];
    return contact.between[side].name + (face.empty() ? "" : ":" + face);
  }

  Interface make(const contact::InterfaceTriangle& t) {
    Interface result;
    result.back = region_of(t.back);
    result.front = region_of(t.front);
    result.back_face = t.back_face;
    result.front_face = t.front_face;
    bind_sensors(t, result);
    if (is_cathode(t.back_face) || is_cathode(t.front_face))
      make_cathode(t, result);
    else if (t.back_face.has_value() && t.front_face.has_value())
      make_contact(t, result);
    else if (t.back_face.has_value() && t.front != contact::kAmbient)
      make_nested(t, result);
    else if (t.back_face.has_value())
      result.back_surface = surface(face(t.back_face).surface, medium(t.back), medium(t.front));
    else
      result.front_surface = surface(face(t.front_face).surface, medium(t.front), medium(t.back));
    const bool has_back = result.back_surface.has_value();
    if (has_back != result.front_surface.has_value() && !result.gap_medium.has_value())
      result.plain = scene_.surfaces[has_back ? result.back_surface : result.front_surface].plain() &&
                     !birefringent(t.back) && !birefringent(t.front);
    return result;
  }

  /// A sensor part detects light that enters it, or that its surfaces absorb, also from its own side; a
  /// sensor face light that leaves its part there, or with a photocathode light from either side.
  void bind_sensors(const contact::InterfaceTriangle& t, Interface& result) const {
    const auto bind = [&](core::PartId entered, core::PartId left, core::FaceId left_face,
                          core::FaceId entered_face, core::SensorId& sensor, core::PartId& part) {
      if (entered != contact::kAmbient && assembly_.parts[entered].sensor.has_value()) {
        sensor = assembly_.parts[entered].sensor;
        part = entered;
      } else if (left_face.has_value() && assembly_.faces[left_face].sensor.has_value()) {
        sensor = assembly_.faces[left_face].sensor;
        part = left;
      } else if (is_cathode(entered_face)) {
        sensor = assembly_.faces[entered_face].sensor;
        part = entered;
      } else if (left != contact::kAmbient && assembly_.parts[left].sensor.has_value() &&
                 assembly_.sensors[assembly_.parts[left].sensor].converts_absorbed()) {
        sensor = assembly_.parts[left].sensor;
        part = left;
      }
    };
    bind(t.front, t.back, t.back_face, t.front_face, result.front_sensor, result.front_sensor_part);
    bind(t.back, t.front, t.front_face, t.back_face, result.back_sensor, result.back_sensor_part);
  }

  bool is_cathode(core::FaceId id) const { return id.has_value() && face(id).is_cathode; }

  /// An interface with a photocathode is bonded, and has no other surface.
  void make_cathode(const contact::InterfaceTriangle& t, Interface& result) {
    const bool of_back = is_cathode(t.back_face);
    const AssemblyFace& own = face(of_back ? t.back_face : t.front_face);
    if (of_back && is_cathode(t.front_face) && face(t.front_face).surface != own.surface)
      problems_.add(part(t.back).geometry.where,
                    "faces \"" + own.name + "\" and \"" + face(t.front_face).name +
                        "\" touch, and each has a photocathode of its own",
                    "give the sensor to one of them");
    const bool between_parts = t.back != contact::kAmbient && t.front != contact::kAmbient;
    const scene_file::ContactSpec* contact = between_parts ? find_contact(t).first : nullptr;
    if (contact && !contact->by_builder &&
        (contact->kind == scene_file::ContactKind::dry || !contact->surface.empty()))
      problems_.add(contact->where,
                    "this contact is at the photocathode of \"" + own.name +
                        "\", which is bonded and the only surface there",
                    "leave the contact out, or name other faces in it");
    set_surface(t, result, of_back, own.surface);
  }

  void make_dry(const contact::InterfaceTriangle& t, const std::string& back, const std::string& front,
                Interface& result) {
    result.gap_medium = assembly_.ambient;
    result.back_surface = surface(back, medium(t.back), assembly_.ambient);
    result.front_surface = surface(front, medium(t.front), assembly_.ambient);
  }

  /// Where a part is nested in another, its own surface applies unless a contact specifies another.
  void make_nested(const contact::InterfaceTriangle& t, Interface& result) {
    const scene_file::ContactSpec* contact = find_contact(t).first;
    const std::string& own = face(t.back_face).surface;
    const scene_file::ContactKind kind = contact ? contact->kind : assembly_.contacts_default;
    if (contact && kind == scene_file::ContactKind::dry)
      make_dry(t, own, part(t.front).surface, result);
    else if (kind == scene_file::ContactKind::each_side)
      make_each_side(t, own, part(t.front).surface, result);
    else
      set_surface(t, result, true, contact && !contact->surface.empty() ? contact->surface.name : own);
  }

  /// Surfaces for light of either direction. A smooth one that holds for both is made once, so that the
  /// interface is plain.
  void make_each_side(const contact::InterfaceTriangle& t, const std::string& back, const std::string& front,
                      Interface& result) {
    const auto [contact, back_is_first] = find_contact(t);
    const auto leaving = [&, first = back_is_first, given = contact](bool from_back) {
      if (given) {
        const config::NameRef& own = given->leaving[from_back == first ? 0 : 1];
        if (!own.empty()) return own.name;
      }
      const std::string& here = from_back ? back : front;
      return here.empty() ? (from_back ? front : back) : here;
    };
    const std::string from_back = leaving(true), from_front = leaving(false);
    result.back_surface = surface(from_back, medium(t.back), medium(t.front));
    if (from_back == from_front && scene_.surfaces[result.back_surface].plain()) return;
    result.front_surface = surface(from_front, medium(t.front), medium(t.back));
  }

  void make_contact(const contact::InterfaceTriangle& t, Interface& result) {
    const AssemblyFace &back = face(t.back_face), &front = face(t.front_face);
    const auto [contact, back_is_first] = find_contact(t);
    const scene_file::ContactKind kind = contact ? contact->kind : assembly_.contacts_default;
    if (kind == scene_file::ContactKind::dry) {
      make_dry(t, back.surface, front.surface, result);
      return;
    }
    if (kind == scene_file::ContactKind::each_side) {
      make_each_side(t, back.surface, front.surface, result);
    } else if (contact && contact->joint) {
      set_surface(t, result, true, std::string());
    } else if (contact && !contact->surface.empty()) {
      set_surface(t, result, back_is_first, contact->surface.name);
    } else if (front.surface.empty() || back.surface == front.surface) {
      set_surface(t, result, true, back.surface);
    } else if (back.surface.empty()) {
      set_surface(t, result, false, front.surface);
    } else {
      const contact::PlacedPart &at_back = part(t.back).geometry, &at_front = part(t.front).geometry;
      const core::FileLocation& where = contact ? contact->where : at_back.where;
      problems_.add(where,
                    "faces \"" + back.name + "\" (surface \"" + name_or_smooth(back.surface) + "\") and \"" +
                        front.name + "\" (surface \"" + name_or_smooth(front.surface) +
                        "\") are bonded, but an interface has one surface" +
                        contact::also_at(at_front.name, at_front.where, where),
                    "add [[contact]] between = [\"" + at_back.name + "\", \"" + at_front.name +
                        "\"] with the surface of the joint, or kind = \"dry\"");
      set_surface(t, result, true, std::string());
    }
  }

  void set_surface(const contact::InterfaceTriangle& t, Interface& result, bool of_back,
                   const std::string& name) {
    if (of_back)
      result.back_surface = surface(name, medium(t.back), medium(t.front));
    else
      result.front_surface = surface(name, medium(t.front), medium(t.back));
  }

  /// True when the contact's side names this face of this part. Inside another part there is no face.
  bool names(const scene_file::ContactSpec& contact, std::size_t side, core::PartId of_part,
             core::FaceId of_face) const {
    const std::string& part_name = part(of_part).geometry.name;
    if (!core::matches_pattern(contact.between[side].name, part_name)) return false;
    return contact.faces[side].empty() ||
           (of_face.has_value() && part_name + ":" + contact.faces[side] == face(of_face).name);
  }

  /// Specificity of a contact for a pair of faces; of several that match, the most specific applies. Contacts
  /// of the file precede those of builders, then more faces precede fewer, then more letters of both names.
  static std::tuple<bool, int, std::size_t> weight(const scene_file::ContactSpec& contact) {
    return {!contact.by_builder, !contact.faces[0].empty() + !contact.faces[1].empty(),
            core::literal_length(contact.between[0].name) + core::literal_length(contact.between[1].name)};
  }

  static std::pair<std::string, std::string> ordered(const std::string& a, const std::string& b) {
    return std::minmax(a, b);
  }

  /// Finds contacts by the names of two parts, those with patterns apart.
  void index_contacts() {
    for (std::size_t i = 0; i < assembly_.contacts.size(); ++i) {
      const auto& between = assembly_.contacts[i].between;
      if (core::is_pattern(between[0].name) || core::is_pattern(between[1].name))
        contacts_with_patterns_.push_back(i);
      else
        contacts_of_[ordered(between[0].name, between[1].name)].push_back(i);
    }
  }

  /// Those that may be meant for two parts, in the order of the file.
  std::vector<std::size_t> contacts_between(core::PartId one, core::PartId other) const {
    std::vector<std::size_t> found = contacts_with_patterns_;
    const auto own = contacts_of_.find(ordered(part(one).geometry.name, part(other).geometry.name));
    if (own == contacts_of_.end()) return found;
    found.insert(found.end(), own->second.begin(), own->second.end());
    std::sort(found.begin(), found.end());
    return found;
  }

  /// The contact that applies to these two faces, and whether its first name is that of the back.
  std::pair<const scene_file::ContactSpec*, bool> find_contact(const contact::InterfaceTriangle& t) {
    std::optional<std::size_t> best;
    bool back_is_first = true;
    for (const std::size_t i : contacts_between(t.back, t.front)) {
      const scene_file::ContactSpec& contact = assembly_.contacts[i];
      const bool straight =
          names(contact, 0, t.back, t.back_face) && names(contact, 1, t.front, t.front_face);
      if (!straight && !(names(contact, 0, t.front, t.front_face) && names(contact, 1, t.back, t.back_face)))
        continue;
      contact_used_[i] = true;
      if (best && weight(contact) < weight(assembly_.contacts[*best])) continue;
      if (best && weight(contact) == weight(assembly_.contacts[*best]))
        report_tie(assembly_.contacts[*best], contact, t);
      best = i;
      back_is_first = straight;
    }
    if (!best) return {nullptr, true};
    return {&assembly_.contacts[*best], back_is_first};
  }

  void report_tie(const scene_file::ContactSpec& one, const scene_file::ContactSpec& other,
                  const contact::InterfaceTriangle& t) {
    if (one.kind == other.kind && one.surface.name == other.surface.name) return;
    const auto pattern = [](const scene_file::ContactSpec& c) {
      return "\"" + side_name(c, 0) + "\" - \"" + side_name(c, 1) + "\"";
    };
    if (!ties_.insert(pattern(one) + pattern(other)).second) return;
    problems_.add(other.where,
                  "the contacts " + pattern(one) + " and " + pattern(other) + " are equally close to \"" +
                      face(t.back_face).name + "\" - \"" +
                      (t.front_face.has_value() ? face(t.front_face).name : part(t.front).geometry.name) +
                      "\", and differ",
                  "name this pair in a [[contact]] of its own, or spell out more of one of them");
  }

  /// The surface between two media, made once per name and pair of media.
  core::SurfaceId surface(const std::string& name, core::MediumId inside, core::MediumId outside) {
    const auto [known, is_new] = surfaces_.try_emplace({name, inside, outside}, scene_.surfaces.next_id());
    if (is_new) {
      optics::Surface made;
      try {
        made = assembly_.make_surface(name, inside, outside);
      } catch (const core::InputError& error) {
        problems_.add(error);
      }
      made.name = name_or_smooth(name) + " (" + assembly_.media[inside].medium().name + " to " +
                  assembly_.media[outside].medium().name + ")";
      scene_.surfaces.push_back(std::move(made));
    }
    return known->second;
  }

  const AssemblyFace& face(core::FaceId id) const { return assembly_.faces[id]; }
  const AssemblyPart& part(core::PartId id) const { return assembly_.parts[id]; }
  bool birefringent(core::PartId id) const {
    return assembly_.media[medium(id)].medium().birefringence != nullptr;
  }
  core::MediumId medium(core::PartId id) const {
    return id == contact::kAmbient ? assembly_.ambient : part(id).medium;
  }

  const Assembly& assembly_;
  Scene& scene_;
  core::Problems& problems_;
  std::vector<bool> contact_used_;
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> contacts_of_;
  std::vector<std::size_t> contacts_with_patterns_;
  std::set<std::string> ties_;  ///< pairs of contacts already reported
  std::map<InterfaceKey, core::InterfaceId> known_;
  std::map<std::tuple<std::string, core::MediumId, core::MediumId>, core::SurfaceId> surfaces_;
};

}  // namespace

Scene assemble(const Assembly& assembly) {
  Scene scene;
  scene.media = assembly.media;
  for (const SceneMedium& medium : scene.media) scene.optics.add(medium, assembly.low_nm, assembly.high_nm);
  scene.sensors = assembly.sensors;
  scene.keeps_phases = assembly.keeps_phases;
  scene.low_nm = assembly.low_nm;
  scene.high_nm = assembly.high_nm;
  describe_parts(assembly, scene);
  core::Problems problems;
  place_sensor_faces(assembly, scene, problems);

  std::vector<contact::PlacedPart> placed;
  for (const AssemblyPart& part : assembly.parts) placed.push_back(part.geometry);
  std::vector<contact::OverlappingPair> by_facets;
  const std::vector<contact::InterfaceTriangle> triangles =
      contact::resolve_contacts(placed, assembly.contact_tolerance_mm, &by_facets);

  InterfaceMaker maker(assembly, scene, problems);
  std::vector<core::InterfaceId> interface_of;
  for (const contact::InterfaceTriangle& triangle : triangles) {
    interface_of.push_back(maker.interface_of(triangle));
    const double area = area_of(triangle.vertex);
    scene.interface_area_mm2[interface_of.back()] += area;
    if (!triangle.back_face.has_value() || !triangle.front_face.has_value()) continue;
    scene.faces[triangle.back_face].contact_area_mm2 += area;
    scene.faces[triangle.front_face].contact_area_mm2 += area;
  }
  maker.report_unused_contacts();
  problems.throw_if_any();
  const PartBodies bodies = find_part_bodies(assembly, triangles);
  std::erase_if(by_facets, [&](const contact::OverlappingPair& pair) {
    return fit_exactly(assembly, bodies, core::PartId(pair.a), core::PartId(pair.b));
  });
  contact::refuse_overlaps(placed, by_facets, assembly.contact_tolerance_mm);
  if (!bodies.empty()) describe_curves(assembly, bodies, triangles, interface_of, scene);
  core::report_activity("preparing the ray search");
  build_regions(assembly, triangles, interface_of, bodies, scene);
  return scene;
}

}  // namespace scintray::scene
