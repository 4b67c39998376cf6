#include "scintray/mesh/import/mesh_format.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string_view>

#include "scintray/core/error.hpp"
#include "scintray/core/words.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

constexpr std::size_t kMostColladaTriangles = 20'000'000, kMostColladaNodes = 1'000'000;

/// Transform of a node: its elements, which apply in order, and the count of numbers of each.
struct Transform {
  enum class Kind { translate, rotate, scale, matrix, look_at, not_read };
  Kind kind;
  std::size_t numbers;
};
constexpr core::Word<Transform> kTransforms[] = {
    {"translate", {Transform::Kind::translate, 3}}, {"rotate", {Transform::Kind::rotate, 4}},
    {"scale", {Transform::Kind::scale, 3}},         {"matrix", {Transform::Kind::matrix, 16}},
    {"lookat", {Transform::Kind::look_at, 9}},      {"skew", {Transform::Kind::not_read, 7}}};

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

  ColladaReader(const std::filesystem::path& path, const std::string& content) : path_(path) {
    if (xml_depth(content) > kDeepestNesting) reject("XML elements are nested more than 500 deep");
    const pugi::xml_parse_result parsed = document_.load_buffer(content.data(), content.size());
    root_ = document_.child("COLLADA");
    if (!parsed) reject(std::string("the COLLADA file is not well-formed XML: ") + parsed.description());
    if (!root_) reject("the file has no <COLLADA>");
  }

  RawMesh read() {
    read_unit();
    remember_ids(root_);
    const Node instance = root_.child("scene").child("instance_visual_scene");
    const Node scene =
        instance ? referred(instance, "url") : root_.child("library_visual_scenes").child("visual_scene");
    if (!scene) reject("the COLLADA file has no visual scene, which places its geometries");
    for (const Node node : scene.children("node")) visit(node, Eigen::Affine3d::Identity(), 0);
    raw_.fill_body();
    if (skins_ > 0)
      raw_.notes.push_back(std::to_string(skins_) +
                           " skins and morphs left out: their meshes are imported unposed");
    return std::move(raw_);
  }

 private:
  [[noreturn]] void reject(const std::string& what) const {
    reject_file(path_, what, "the file is damaged or not plain COLLADA; export it again");
  }

  void read_unit() {
    constexpr double kMetre_mm = 1000.0;
    const Node unit = root_.child("asset").child("unit");
    const pugi::xml_attribute meter = unit.attribute("meter");
    raw_.unit = {"meter", kMetre_mm, false, kMetre_mm};
    if (!meter) return;
    const double mm = kMetre_mm * one_number(meter.value());
    if (!std::isfinite(mm) || mm <= 0.0)
      reject("the COLLADA file gives its unit as " + core::in_quotes(meter.value()) +
             " metres; expected a number above 0");
    raw_.unit = {unit.attribute("name").as_string("unit of its own"), mm, true, mm};
  }

  void remember_ids(Node start) {
    std::vector<Node> open{start};
    while (!open.empty()) {
      const Node node = open.back();
      open.pop_back();
      if (const pugi::xml_attribute id = node.attribute("id")) by_id_.emplace(id.value(), node);
      for (const Node child : node.children())
        if (child.type() == pugi::node_element) open.push_back(child);
    }
  }

  /// The element that "#id" in an attribute names.
  Node referred(Node node, const char* attribute) const {
    const std::string_view url = node.attribute(attribute).value();
    const auto found = url.starts_with("#") ? by_id_.find(std::string(url.substr(1))) : by_id_.end();
    if (found == by_id_.end())
      reject(std::string("<") + node.name() + "> refers to " + core::in_quotes(url) +
             ", which is not in the file");
    return found->second;
  }

  /// NaN when the text is not one number, between blanks and with either sign.
  static double one_number(std::string_view text) {
    constexpr std::string_view kSpace = " \t\r\n";
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    text = text.substr(0, text.find_last_not_of(kSpace) + 1);
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? value : std::nan("");
  }

  /// Calls `take` for each word of the text of an element.
  template <typename Take>
  void for_each_word(Node node, Take take) const {
    constexpr std::string_view kSpace = " \t\r\n";
    std::string_view text = node.text().get();
    for (;;) {
      const std::size_t start = text.find_first_not_of(kSpace);
      if (start == std::string_view::npos) return;
      const std::size_t end = std::min(text.find_first_of(kSpace, start), text.size());
      take(text.substr(start, end - start));
      text.remove_prefix(end);
    }
  }

  std::vector<double> numbers(Node node) const {
    std::vector<double> values;
    for_each_word(node, [&](std::string_view word) {
      values.push_back(one_number(word));
      // Coordinates that are not finite are reported with their place later.
      if (std::isnan(values.back()) && word != "nan" && word != "NaN")
        reject(std::string("<") + node.name() + "> holds " + core::in_quotes(word) +
               ", which is not a number");
    });
    return values;
  }

  std::vector<std::size_t> indices(Node node) const {
    std::vector<std::size_t> values;
    for_each_word(node, [&](std::string_view word) {
      if (word.starts_with('+')) word.remove_prefix(1);
      std::uint32_t value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size())
        reject(std::string("<") + node.name() + "> holds " + core::in_quotes(word) +
               ", which is not an index");
      values.push_back(value);
    });
    return values;
  }

  std::size_t count(Node node, const char* attribute, std::size_t fallback) const {
    if (!node.attribute(attribute)) return fallback;
    const double value = one_number(node.attribute(attribute).value());
    if (!(value >= 0.0 && value <= 1e9) || value != std::floor(value))
      reject(std::string("<") + node.name() + "> has " + attribute + "=" +
             core::in_quotes(node.attribute(attribute).value()) + ", which is not a count");
    return static_cast<std::size_t>(value);
  }

  Eigen::Affine3d transform_of(Node node) const {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    for (const Node step : node.children()) {
      const std::optional<Transform> known = core::find_word(kTransforms, step.name());
      if (!known) continue;
      const std::vector<double> v = numbers(step);
      if (v.size() != known->numbers)
        reject(std::string("<") + step.name() + "> has " + std::to_string(v.size()) + " numbers; expected " +
               std::to_string(known->numbers));
      switch (known->kind) {
        case Transform::Kind::translate:
          transform.translate(core::Vec3(v[0], v[1], v[2]));
          break;
        case Transform::Kind::rotate: {
          const core::Vec3 axis(v[0], v[1], v[2]);
          if (axis.norm() > 0.0) transform.rotate(Eigen::AngleAxisd(v[3] * core::kDegree, axis.normalized()));
          break;
        }
        case Transform::Kind::scale:
          transform.scale(core::Vec3(v[0], v[1], v[2]));
          break;
        case Transform::Kind::matrix: {
          Eigen::Affine3d step_matrix = Eigen::Affine3d::Identity();
          step_matrix.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(v.data());
          transform = transform * step_matrix;
          break;
        }
        case Transform::Kind::look_at: {  // from v[0..2] towards v[3..5], which is along -z, and v[6..8]
                                          // upwards
          const core::Vec3 eye(v[0], v[1], v[2]), interest(v[3], v[4], v[5]), up(v[6], v[7], v[8]);
          const core::Vec3 back = eye - interest, side = up.cross(back);
          if (!(back.norm() > 0.0) || !(side.norm() > 0.0))
            reject("a <lookat> looks at itself, or along its up axis");
          Eigen::Affine3d look = Eigen::Affine3d::Identity();
          look.linear().col(0) = side.normalized();
          look.linear().col(2) = back.normalized();
          look.linear().col(1) = look.linear().col(2).cross(look.linear().col(0));
          look.translation() = eye;
          transform = transform * look;
          break;
        }
        case Transform::Kind::not_read:
          reject(std::string("a node is placed by <") + step.name() + ">, which is not read");
      }
    }
    return transform;
  }

  void visit(Node node, const Eigen::Affine3d& parent, std::size_t depth) {
    if (depth > kDeepestNesting) reject("nodes are inside themselves, or nested more than 500 deep");
    if (++visited_ > kMostColladaNodes) reject("instances of nodes multiply to over a million");
    const Eigen::Affine3d transform = parent * transform_of(node);
    for (const Node child : node.children()) {
      const std::optional<Child> kind = core::find_word(kChildren, child.name());
      if (!kind) continue;
      switch (*kind) {
        case Child::node:
          visit(child, transform, depth + 1);
          break;
        case Child::instance_node:
          visit(referred(child, "url"), transform, depth + 1);
          break;
        case Child::instance_geometry:
          place(node, child, referred(child, "url"), transform);
          break;
        case Child::instance_controller:
          place(node, child, posed(referred(child, "url")), transform);
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
      controller = referred(skin, "source");
    }
    reject("a controller poses no geometry");
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
        raw_.points_and_lines += count(primitive, "count", 1);
        continue;
      }
      const std::uint32_t group =
          raw_.mesh.group_index(group_name(name_of(geometry), material_of(instance, primitive)));
      append(primitive, *kind, transform, {group, mirrored});
      if (std::max(raw_.mesh.triangles.size(), raw_.mesh.vertices.size()) > kMostColladaTriangles)
        reject("instances of geometries multiply to more than 20 million triangles");
    }
  }

  /// A primitive's material is a symbol, which the instance binds to one of the file's library_materials.
  std::string material_of(Node instance, Node primitive) const {
    const std::string symbol = primitive.attribute("material").value();
    if (symbol.empty()) return {};
    for (const Node bound : instance.child("bind_material").child("technique_common").children())
      if (symbol == bound.attribute("symbol").value() && bound.attribute("target")) {
        // Materials may stand in another file, which is not read: their name is all that counts here.
        const std::string target = bound.attribute("target").value();
        const std::string id = target.substr(target.find('#') + 1);
        const auto found = by_id_.find(id);
        if (target.starts_with("#") && found != by_id_.end()) return name_of(found->second);
        return id.empty() ? symbol : id;
      }
    return symbol;
  }

  /// Positions of the corners that a primitive's VERTEX input names, and the offset of their indices.
  std::vector<core::Vec3> positions(Node primitive, std::size_t& offset, std::size_t& stride) const {
    Node vertices;
    stride = 0;
    for (const Node input : primitive.children("input")) {
      const std::size_t own = count(input, "offset", 0);
      stride = std::max(stride, own + 1);
      if (std::string_view(input.attribute("semantic").value()) != "VERTEX") continue;
      vertices = referred(input, "source");
      offset = own;
    }
    if (!vertices) reject(std::string("<") + primitive.name() + "> has no input VERTEX");
    if (stride > 1000)
      reject(std::string("<") + primitive.name() + "> has an input with an offset of 1000 or more");
    for (const Node input : vertices.children("input"))
      if (std::string_view(input.attribute("semantic").value()) == "POSITION")
        return points_of(referred(input, "source"));
    reject("<vertices> has no input POSITION");
  }

  std::vector<core::Vec3> points_of(Node source) const {
    const Node accessor = source.child("technique_common").child("accessor");
    if (!accessor) reject("a <source> of positions has no <accessor>");
    const std::vector<double> values = numbers(referred(accessor, "source"));
    const std::size_t points = count(accessor, "count", 0), stride = count(accessor, "stride", 1),
                      offset = count(accessor, "offset", 0);
    if (stride < 3) reject("positions of fewer than three numbers");
    if (points > 0 && offset + points * stride > values.size())
      reject("an accessor needs " + std::to_string(offset + points * stride) + " numbers, but there are " +
             std::to_string(values.size()));
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
    if (primitive.child("ph")) reject("polygons with holes are not read");
    const Node sizes = primitive.child("vcount");
    for (const Node list : primitive.children("p")) {
      const std::vector<std::size_t> all = indices(list);
      std::vector<std::uint32_t> corners;
      for (std::size_t i = offset; i < all.size(); i += stride) {
        if (all[i] >= points.size())
          reject(std::string("<") + primitive.name() + "> refers to vertex " + std::to_string(all[i]) +
                 ", which does not exist");
        corners.push_back(first + static_cast<std::uint32_t>(all[i]));
      }
      append_polygons(kind, sizes ? indices(sizes) : std::vector<std::size_t>{}, corners, faces);
    }
  }

  void append_polygons(Primitive kind, const std::vector<std::size_t>& sizes,
                       const std::vector<std::uint32_t>& corners, const PrimitiveFaces& faces) {
    const auto add = [&](std::vector<std::uint32_t> polygon) {
      if (!raw_.add_polygon(polygon, faces.group, faces.mirrored))
        reject("a polygon has more corners than can be read");
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
          if (size > n - start) reject("the polygons of a <polylist> have more corners than it lists");
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

  const std::filesystem::path& path_;
  pugi::xml_document document_;
  Node root_;
  RawMesh raw_;
  std::map<std::string, Node> by_id_;
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
