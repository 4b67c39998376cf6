#include "scintray/mesh/import/mesh_format.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <pugixml.hpp>
#include <string_view>

#include "scintray/core/error.hpp"
#include "scintray/core/words.hpp"
#include "scintray/mesh/import/detail/collada_document.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

constexpr std::size_t kMostColladaTriangles = 20'000'000, kMostColladaNodes = 1'000'000;

/// Elements of a node that may hold meshes.
enum class Child { node, instance_node, instance_geometry, instance_controller };
constexpr core::Word<Child> kChildren[] = {{"node", Child::node},
                                           {"instance_node", Child::instance_node},
                                           {"instance_geometry", Child::instance_geometry},
                                           {"instance_controller", Child::instance_controller}};

/// Primitives of a mesh.
enum class Primitive { lines, triangles, polylist, polygons, strips, fans };
constexpr core::Word<Primitive> kPrimitives[] = {
    {"lines", Primitive::lines},       {"linestrips", Primitive::lines},  {"triangles", Primitive::triangles},
    {"polylist", Primitive::polylist}, {"polygons", Primitive::polygons}, {"tristrips", Primitive::strips},
    {"trifans", Primitive::fans}};

/// Group of a primitive's polygons, and whether their corners are reversed.
struct PrimitiveFaces {
  std::uint32_t group;
  bool mirrored;
};

class ColladaReader {
 public:
  using Node = pugi::xml_node;

  ColladaReader(const std::filesystem::path& path, const std::string& content) : file_(path, content) {}

  RawMesh read() {
    read_unit();
    const Node instance = file_.root().child("scene").child("instance_visual_scene");
    const Node scene = instance ? file_.referred(instance, "url")
                                : file_.root().child("library_visual_scenes").child("visual_scene");
    if (!scene) file_.reject("the COLLADA file has no visual scene, which places its geometries");
    for (const Node node : scene.children("node")) visit(node, Eigen::Affine3d::Identity(), 0);
    raw_.fill_body();
    if (skins_ > 0)
      raw_.notes.push_back(std::to_string(skins_) +
                           " skins and morphs left out: their meshes are imported unposed");
    return std::move(raw_);
  }

 private:
  void read_unit() {
    constexpr double kMetre_mm = 1000.0;
    const Node unit = file_.root().child("asset").child("unit");
    const pugi::xml_attribute meter = unit.attribute("meter");
    raw_.unit = {"meter", kMetre_mm, false, kMetre_mm};
    if (!meter) return;
    const double mm = kMetre_mm * ColladaDocument::one_number(meter.value());
    if (!std::isfinite(mm) || mm <= 0.0)
      file_.reject("the COLLADA file gives its unit as " + core::in_quotes(meter.value()) +
                   " metres; expected a number above 0");
    raw_.unit = {unit.attribute("name").as_string("unit of its own"), mm, true, mm};
  }

  void visit(Node node, const Eigen::Affine3d& parent, std::size_t depth) {
    if (depth > kDeepestNesting) file_.reject("nodes are inside themselves, or nested more than 500 deep");
    if (++visited_ > kMostColladaNodes) file_.reject("instances of nodes multiply to over a million");
    const Eigen::Affine3d transform = parent * file_.transform_of(node);
    for (const Node child : node.children()) {
      const std::optional<Child> kind = core::find_word(kChildren, child.name());
      if (!kind) continue;
      switch (*kind) {
        case Child::node:
          visit(child, transform, depth + 1);
          break;
        case Child::instance_node:
          visit(file_.referred(child, "url"), transform, depth + 1);
          break;
        case Child::instance_geometry:
          place(node, child, file_.referred(child, "url"), transform);
          break;
        case Child::instance_controller:
          place(node, child, posed(file_.referred(child, "url")), transform);
          break;
      }
    }
  }

  /// The geometry that a controller poses.
  Node posed(Node controller) {
    ++skins_;
    for (int depth = 0; depth < 8; ++depth) {
      if (std::string_view(controller.name()) == "geometry") return controller;
      const Node skin = controller.child("skin") ? controller.child("skin") : controller.child("morph");
      if (!skin) break;
      controller = file_.referred(skin, "source");
    }
    file_.reject("a controller poses no geometry");
  }

  static std::string name_of(Node node) {
    const std::string name = node.attribute("name").value();
    return name.empty() ? node.attribute("id").value() : name;
  }

  void place(Node node, Node instance, Node geometry, const Eigen::Affine3d& transform) {
    const Node mesh = geometry.child("mesh");
    if (!mesh) {
      raw_.notes.push_back("geometry \"" + name_of(geometry) + "\" left out: it is not a mesh");
      return;
    }
    raw_.begin_body(name_of(node).empty() ? name_of(geometry) : name_of(node));
    const bool mirrored = transform.linear().determinant() < 0.0;
    for (const Node primitive : mesh.children()) {
      const std::optional<Primitive> kind = core::find_word(kPrimitives, primitive.name());
      if (!kind) continue;
      if (*kind == Primitive::lines) {
        raw_.points_and_lines += file_.count(primitive, "count", 1);
        continue;
      }
      const std::uint32_t group =
          raw_.mesh.group_index(group_name(name_of(geometry), material_of(instance, primitive)));
      append(primitive, *kind, transform, {group, mirrored});
      if (std::max(raw_.mesh.triangles.size(), raw_.mesh.vertices.size()) > kMostColladaTriangles)
        file_.reject("instances of geometries multiply to more than 20 million triangles");
    }
  }

  /// A primitive's material is a symbol, which the instance binds to one of the file's library_materials.
  std::string material_of(Node instance, Node primitive) const {
    const std::string symbol = primitive.attribute("material").value();
    if (symbol.empty()) return {};
    for (const Node bound : instance.child("bind_material").child("technique_common").children())
      if (symbol == bound.attribute("symbol").value() && bound.attribute("target")) {
        // Materials may be in another file, which is not read: only their name is needed here.
        const std::string target = bound.attribute("target").value();
        const std::string id = target.substr(target.find('#') + 1);
        const Node found = file_.element(id);
        if (target.starts_with("#") && found) return name_of(found);
        return id.empty() ? symbol : id;
      }
    return symbol;
  }

  /// Positions of the corners that a primitive's VERTEX input names, and the offset of their indices.
  std::vector<core::Vec3> positions(Node primitive, std::size_t& offset, std::size_t& stride) const {
    Node vertices;
    stride = 0;
    for (const Node input : primitive.children("input")) {
      const std::size_t own = file_.count(input, "offset", 0);
      stride = std::max(stride, own + 1);
      if (std::string_view(input.attribute("semantic").value()) != "VERTEX") continue;
      vertices = file_.referred(input, "source");
      offset = own;
    }
    if (!vertices) file_.reject(std::string("<") + primitive.name() + "> has no input VERTEX");
    if (stride > 1000)
      file_.reject(std::string("<") + primitive.name() + "> has an input with an offset of 1000 or more");
    for (const Node input : vertices.children("input"))
      if (std::string_view(input.attribute("semantic").value()) == "POSITION")
        return points_of(file_.referred(input, "source"));
    file_.reject("<vertices> has no input POSITION");
  }

  std::vector<core::Vec3> points_of(Node source) const {
    const Node accessor = source.child("technique_common").child("accessor");
    if (!accessor) file_.reject("a <source> of positions has no <accessor>");
    const std::vector<double> values = file_.numbers(file_.referred(accessor, "source"));
    const std::size_t points = file_.count(accessor, "count", 0), stride = file_.count(accessor, "stride", 1),
                      offset = file_.count(accessor, "offset", 0);
    if (stride < 3) file_.reject("positions of fewer than three numbers");
    if (points > 0 && offset + points * stride > values.size())
      file_.reject("an accessor needs " + std::to_string(offset + points * stride) +
                   " numbers, but there are " + std::to_string(values.size()));
    std::vector<core::Vec3> result;
    for (std::size_t p = 0; p < points; ++p) {
      const double* v = values.data() + offset + p * stride;
      result.emplace_back(v[0], v[1], v[2]);
    }
    return result;
  }

  void append(Node primitive, Primitive kind, const Eigen::Affine3d& transform, const PrimitiveFaces& faces) {
    std::size_t offset = 0, stride = 1;
    const std::vector<core::Vec3> points = positions(primitive, offset, stride);
    const auto first = static_cast<std::uint32_t>(raw_.mesh.vertices.size());
    for (const core::Vec3& point : points) raw_.mesh.vertices.push_back(transform * point);
    if (primitive.child("ph")) file_.reject("polygons with holes are not read");
    const Node sizes = primitive.child("vcount");
    for (const Node list : primitive.children("p")) {
      const std::vector<std::size_t> all = file_.indices(list);
      std::vector<std::uint32_t> corners;
      for (std::size_t i = offset; i < all.size(); i += stride) {
        if (all[i] >= points.size())
          file_.reject(std::string("<") + primitive.name() + "> refers to vertex " + std::to_string(all[i]) +
                       ", which does not exist");
        corners.push_back(first + static_cast<std::uint32_t>(all[i]));
      }
      append_polygons(kind, sizes ? file_.indices(sizes) : std::vector<std::size_t>{}, corners, faces);
    }
  }

  void append_polygons(Primitive kind, const std::vector<std::size_t>& sizes,
                       const std::vector<std::uint32_t>& corners, const PrimitiveFaces& faces) {
    const auto add = [&](std::vector<std::uint32_t> polygon) {
      if (!raw_.add_polygon(polygon, faces.group, faces.mirrored))
        file_.reject("a polygon has more corners than can be read");
    };
    const std::size_t n = corners.size();
    switch (kind) {
      case Primitive::lines:
        break;
      case Primitive::triangles:
        for (std::size_t i = 0; i + 2 < n; i += 3) add({corners[i], corners[i + 1], corners[i + 2]});
        break;
      case Primitive::polylist: {
        std::size_t start = 0;
        for (const std::size_t size : sizes) {
          if (size > n - start) file_.reject("the polygons of a <polylist> have more corners than it lists");
          add({corners.begin() + static_cast<std::ptrdiff_t>(start),
               corners.begin() + static_cast<std::ptrdiff_t>(start + size)});
          start += size;
        }
        break;
      }
      case Primitive::polygons:
        add(corners);
        break;
      case Primitive::strips:
        for (std::size_t i = 0; i + 2 < n; ++i)
          add(i % 2 == 0 ? std::vector{corners[i], corners[i + 1], corners[i + 2]}
                         : std::vector{corners[i + 1], corners[i], corners[i + 2]});
        break;
      case Primitive::fans:
        for (std::size_t i = 1; i + 1 < n; ++i) add({corners[0], corners[i], corners[i + 1]});
        break;
    }
  }

  const ColladaDocument file_;
  RawMesh raw_;
  std::size_t visited_ = 0, skins_ = 0;
};

}  // namespace

/// Mesh of a COLLADA file (1.4.1, 1.5: Khronos Group, "COLLADA - Digital Asset Schema"): the meshes that the
/// visual scene places, with the transforms of its nodes, in the file's own axes and unit (<asset><unit
/// meter="..."/>; one metre when it is left out). Triangles, polylists, polygons, strips and fans; skins
/// unposed, with a note. Bodies are placed geometries, called after their node; groups are geometry and
/// material. Throws InputError also for references without a target, nodes inside themselves, holes in
/// polygons, and instances that multiply to more than 20 million triangles.
///
/// Assimp is not used: up to 5.3 it reads beyond its arrays when a file's counts do not fit each other.
RawMesh import_collada(const MeshFile& file) { return ColladaReader(file.path, file.content).read(); }

}  // namespace scintray::mesh
