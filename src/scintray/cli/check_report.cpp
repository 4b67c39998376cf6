#include "scintray/cli/check.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scintray/cli/alike.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/scene/facet_faces.hpp"

namespace scintray::cli {
namespace {

std::string yes_no(bool value) { return value ? "yes" : "NO"; }

/// Prints one scene; similar items on one line, or each on its own.
class Printer {
 public:
  Printer(const scene::BuiltScene& built, bool every_one)
      : built_(built), scene_(built.scene), every_one_(every_one) {}

  void print() const {
    print_parts();
    print_faces();
    print_round_faces();
    print_regions();
    print_interfaces();
    print_contacts();
  }

 private:
  /// Text before the name's column, the name, and text after it.
  struct Row {
    std::string name, rest;
  };

  std::string shown(const std::string& name) const { return every_one_ ? name : core::pattern_of(name); }

  static std::string with_count(const std::string& name, const std::string& pattern, std::size_t count) {
    return count == 1 ? name : fmt::format("{} x {}", pattern, count);
  }

  void print_rows(const Alike<Row>& rows, int width) const {
    for (const auto& line : rows.lines())
      std::cout << fmt::format("  {:<{}} {}\n",
                               with_count(line.first.name, shown(line.first.name), line.count), width,
                               line.first.rest);
  }
  void add(Alike<Row>& rows, const std::string& name, const std::string& rest) const {
    rows.add(shown(name) + '\n' + rest + (every_one_ ? name : ""), {name, rest});
  }

  static std::string size(const Eigen::AlignedBox3d& box) {
    const core::Vec3 edges = box.sizes();
    return fmt::format("{:.4g} x {:.4g} x {:.4g}", edges.x(), edges.y(), edges.z());
  }
  static std::string extent(const Eigen::AlignedBox3d& box) {
    return vector_text(box.min()) + " to " + vector_text(box.max());
  }
  static std::string vector_text(const core::Vec3& v) {
    const auto rounded = [](double x) { return std::abs(x) < 5e-7 ? 0.0 : x; };  // no "-0", no noise
    return fmt::format("({:.5g}, {:.5g}, {:.5g})", rounded(v.x()), rounded(v.y()), rounded(v.z()));
  }

  /// The outward normal of a flat face.
  static std::string normal_of(const scene::FaceInfo& face) {
    constexpr double kFlat = 1.0 - 1e-6;
    const double length = face.area_vector_mm2.norm();
    if (face.area_mm2 <= 0.0) return "-";
    return length >= kFlat * face.area_mm2 ? vector_text(face.area_vector_mm2 / length) : "not flat";
  }

  /// The middle of a face's bounding box, where every face has a line of its own.
  std::string centre_of(const scene::FaceInfo& face) const {
    if (!every_one_ || face.corners.empty()) return "";
    Eigen::AlignedBox3d box;
    for (const core::Vec3& corner : face.corners) box.extend(corner);
    return ", " + vector_text(box.center());
  }

  /// Of the exact body, where the part has one.
  const Eigen::AlignedBox3d& bounds_of(core::PartId part, const mesh::MeshDiagnosis& d) const {
    return scene_.parts[part].curved ? scene_.parts[part].bounds : d.bounds;
  }
  double area_of(core::PartId part, const mesh::MeshDiagnosis& d) const {
    if (!scene_.parts[part].curved) return d.area_mm2;
    double area = 0.0;
    for (const scene::FaceInfo& face : scene_.faces)
      if (face.part == part) area += face.area_mm2;
    return area;
  }

  void print_parts() const {
    std::cout << fmt::format("\nparts ({})\n", built_.parts.size());
    std::cout << fmt::format("  {:<20} {:<22} {:>12} {:>11} {:>9} {:>7} {:>8} {:>10}  {}\n", "name", "medium",
                             "volume mm3", "area mm2", "triangles", "closed", "outwards", "degenerate",
                             every_one_ ? "from, to mm" : "size mm");
    Alike<Row> rows;
    Eigen::AlignedBox3d all;
    for (const core::PartId id : scene_.parts.ids()) {
      const scene::PartReport& part = built_.parts[id.index()];
      const mesh::MeshDiagnosis& d = part.diagnosis;
      const scene::Region& region = scene_.regions[scene_.parts[id].region];
      std::string rest =
          fmt::format("{:<22} {:>12.6g} {:>11.6g} {:>9} {:>7} {:>8} {:>10}  {}",
                      scene_.media[region.medium].medium().name,
                      scene_.parts[id].curved ? scene_.parts[id].volume_mm3 : d.volume_mm3, area_of(id, d),
                      d.triangles, yes_no(d.closed()), yes_no(d.outward()), d.degenerate_triangles.count,
                      every_one_ ? extent(bounds_of(id, d)) : size(bounds_of(id, d)));
      all.extend(bounds_of(id, d));
      for (const std::string& note : part.notes) rest += "\n    note: " + note;
      add(rows, part.name, rest);
    }
    print_rows(rows, 20);
    if (!all.isEmpty())
      std::cout << "  bounding box of all parts: " << extent(all) << " mm, size " << size(all) << " mm\n";
  }

  void print_faces() const {
    std::cout << "\nfaces\n";
    std::cout << fmt::format("  {:<28} {:<28} {:>11} {:>14} {:>9}  {}\n", "part:face", "surface", "area mm2",
                             "in contact mm2", "triangles", every_one_ ? "normal, centre mm" : "normal");
    Alike<Row> rows;
    for (const scene::FaceInfo& face : scene_.faces)
      add(rows, face.name,
          fmt::format("{:<28} {:>11.6g} {:>14.6g} {:>9}  {}", face.surface, face.area_mm2,
                      face.contact_area_mm2, face.triangles, normal_of(face) + centre_of(face)));
    print_rows(rows, 28);
  }

  static std::string facets_text(const scene::FacetFace& face, const scene::PartInfo& part) {
    const double degrees = face.deviation.angle_rad / core::kDegree;
    std::string text =
        face.surface_known
            ? fmt::format("facets up to {:.3g} mm and {:.3g} deg from it: {}", face.deviation.distance_mm,
                          degrees, part.facets_because)
            : fmt::format("facets, estimated up to {:.3g} mm and {:.3g} deg from a smooth surface",
                          face.deviation.distance_mm, degrees);
    if (face.let_out > 0.0)
      text +=
          fmt::format("; of the light in the part up to {:.2g} % may leave that total reflection would keep",
                      100.0 * face.let_out);
    return text;
  }

  /// Faces that approximate a known surface: by that surface, or by how far their facets are from it.
  void print_round_faces() const {
    std::map<std::string, scene::FacetFace> of_facets;
    for (scene::FacetFace& face : scene::facet_faces(built_)) of_facets[face.name] = face;
    Alike<Row> rows;
    for (const scene::FaceInfo& face : scene_.faces) {
      const auto facets = of_facets.find(face.name);
      if (face.curve.empty() && facets == of_facets.end()) continue;
      std::string how = "exact";
      if (facets != of_facets.end()) how = facets_text(facets->second, scene_.parts[face.part]);
      add(rows, face.name, fmt::format("{:<28} {}", face.curve.empty() ? "not known" : face.curve, how));
    }
    if (rows.lines().empty()) return;
    std::cout << "\nround faces\n";
    print_rows(rows, 28);
  }

  static std::string query_method(const scene::Accelerator& accelerator) {
    const scene::ExactBodies& exact = accelerator.boundary().exact;
    if (accelerator.uses_planes()) return fmt::format("{} planes", accelerator.plane_count());
    if (accelerator.size() == 0) return "no boundary";
    if (exact.empty()) return "Embree";
    return fmt::format("{} planes, {} round face{}{}", exact.planes.size(), exact.quadrics.size(),
                       exact.quadrics.size() == 1 ? "" : "s", exact.meshed > 0 ? ", and Embree" : "");
  }

  void print_regions() const {
    std::cout << fmt::format("\nregions ({}, sharing {} accelerators)\n", scene_.regions.size(),
                             scene_.accelerators.size());
    std::cout << fmt::format("  {:<20} {:<22} {:>9} {:>10} {}\n", "name", "medium", "triangles", "index",
                             "ray queries by");
    Alike<Row> rows;
    const double middle_nm = 0.5 * (scene_.low_nm + scene_.high_nm);
    for (const core::RegionId id : scene_.regions.ids()) {
      const scene::Region& region = scene_.regions[id];
      const scene::SceneMedium& medium = scene_.media[region.medium];
      const scene::Accelerator& accelerator = scene_.accelerator(region);
      const std::string index =
          medium.is_opaque() ? "-" : fmt::format("{:.4f}", scene_.optics.index(region.medium, middle_nm));
      const std::string how = query_method(accelerator);
      add(rows, scene_.region_names[id],
          fmt::format("{:<22} {:>9} {:>10} {}", medium.medium().name, accelerator.size(), index, how));
    }
    print_rows(rows, 20);
  }

  std::string optics_of(const scene::Interface& interface) const {
    std::string text;
    if (interface.back_surface.has_value()) text = scene_.surfaces[interface.back_surface].name;
    if (interface.gap_medium.has_value())
      text += " | dry gap of " + scene_.media[interface.gap_medium].medium().name + " | ";
    else if (interface.back_surface.has_value() && interface.front_surface.has_value())
      text += " | back: ";
    if (interface.front_surface.has_value()) text += scene_.surfaces[interface.front_surface].name;
    const auto sensor = [&](core::SensorId id, core::PartId part) {
      if (!id.has_value()) return;
      text += ", detected by " + scene_.sensors[id].name;
      if (scene_.sensors[id].over_face)
        text += fmt::format(" (efficiency times {:.3g} in the mean over the face)",
                            scene_.sensor_frame(interface, part).mean_factor);
    };
    sensor(interface.front_sensor, interface.front_sensor_part);
    sensor(interface.back_sensor, interface.back_sensor_part);
    return text;
  }

  struct Between {
    std::string back, front, optics;
    double area = 0.0;
  };

  void print_interfaces() const {
    std::cout << fmt::format("\ninterfaces ({})\n", scene_.interfaces.size());
    Alike<Between> lines;
    for (const core::InterfaceId id : scene_.interfaces.ids()) {
      const scene::Interface& interface = scene_.interfaces[id];
      const Between one{scene_.region_names[interface.back], scene_.region_names[interface.front],
                        optics_of(interface), 0.0};
      const std::string key = every_one_ ? std::to_string(id.index())
                                         : shown(one.back) + '\n' + shown(one.front) + '\n' + one.optics;
      lines.add(key, one).first.area += scene_.interface_area_mm2[id];
    }
    for (const auto& line : lines.lines()) {
      const bool one = line.count == 1;
      std::cout << fmt::format("  {:<20} | {:<20} {:>11.6g} mm2  {}{}\n",
                               one ? line.first.back : shown(line.first.back),
                               one ? line.first.front : shown(line.first.front), line.first.area,
                               one ? "" : fmt::format("{} x ", line.count), line.first.optics);
    }
  }

  struct Pair {
    std::string a, b;
    std::size_t bonded = 0, dry = 0;
    double area = 0.0;
  };

  /// Pairs of parts in contact, nested ones included.
  void print_contacts() const {
    Alike<Pair> pairs;
    for (const core::InterfaceId id : scene_.interfaces.ids()) {
      const scene::Interface& interface = scene_.interfaces[id];
      if (interface.back == scene::kAmbientRegion || interface.front == scene::kAmbientRegion) continue;
      Pair one{scene_.region_names[interface.back], scene_.region_names[interface.front], 0, 0, 0.0};
      if (shown(one.b) < shown(one.a)) std::swap(one.a, one.b);
      Pair& pair = pairs.add(shown(one.a) + '\n' + shown(one.b), one).first;
      ++(interface.gap_medium.has_value() ? pair.dry : pair.bonded);
      pair.area += scene_.interface_area_mm2[id];
    }
    std::cout << "\ncontacts between parts" << (pairs.lines().empty() ? ": none\n" : "\n");
    for (const auto& line : pairs.lines()) {
      const Pair& pair = line.first;
      const bool one = line.count == 1;
      std::string kinds;
      if (pair.bonded > 0) kinds += fmt::format("{} bonded", pair.bonded);
      if (pair.dry > 0) kinds += fmt::format("{}{} dry", kinds.empty() ? "" : ", ", pair.dry);
      std::cout << fmt::format("  {} | {}: {} interface{} ({}), {:.6g} mm2\n", one ? pair.a : shown(pair.a),
                               one ? pair.b : shown(pair.b), line.count, one ? "" : "s", kinds, pair.area);
    }
  }

  const scene::BuiltScene& built_;
  const scene::Scene& scene_;
  bool every_one_;
};

}  // namespace

void print_scene(const scene::BuiltScene& built, bool every_one) { Printer(built, every_one).print(); }

}  // namespace scintray::cli
