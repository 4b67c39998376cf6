#include "scintray/mesh/import/mesh_format.hpp"

#include <Eigen/Geometry>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <string_view>

#include "scintray/core/error.hpp"
#include "scintray/core/zip_archive.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

using Node = pugi::xml_node;

constexpr std::size_t kMost3mfTriangles = 20'000'000;

/// 3MF Core Specification 1.3, section 3.4.
constexpr std::array<std::pair<const char*, double>, 6> k3mfUnits{{{"micron", 1e-3},
                                                                   {"millimeter", 1.0},
                                                                   {"centimeter", 10.0},
                                                                   {"inch", 25.4},
                                                                   {"foot", 304.8},
                                                                   {"meter", 1000.0}}};

struct ThreeMfTriangle {
  std::array<std::uint32_t, 3> corners{};
  std::string material;
};

/// A mesh, or the element with the components of an object.
struct ThreeMfObject {
  std::string name;
  std::vector<core::Vec3> vertices;
  std::vector<ThreeMfTriangle> triangles;
  Node components;
};

class ThreeMfReader {
 public:
  ThreeMfReader(const std::filesystem::path& path, const std::string& content)
      : path_(path), archive_(content, path.string()) {}

  RawMesh read() {
    const std::string model = archive_.read(model_entry());
    if (xml_depth(model) > kDeepestNesting) reject_file(path_, "XML elements are nested more than 500 deep");
    const pugi::xml_parse_result parsed = document_.load_buffer(model.data(), model.size());
    const Node root = document_.child("model");
    if (!parsed || !root)
      reject_file(
          path_,
          parsed ? std::string("the 3MF file has no <model>")
                 : std::string("the model of the 3MF file is not well-formed XML: ") + parsed.description(),
          kExportAgain);
    check_extensions(root);
    read_unit(root);
    read_resources(root.child("resources"));
    for (const Node item : root.child("build").children("item")) {
      require_here(item);
      const std::string id = item.attribute("objectid").value();
      raw_.begin_body(find_object(id).name);
      place(id, transform_of(item), 0);
    }
    raw_.fill_body();
    if (lattices_ > 0)
      raw_.notes.push_back(std::to_string(lattices_) +
                           " beam lattices left out: their beams are no triangles");
    return std::move(raw_);
  }

 private:
  static constexpr const char* kExportAgain = "the file is damaged; export it again";

  /// Name of the model's entry: "3D/3dmodel.model" unless the relationships name another.
  std::string model_entry() const {
    pugi::xml_document relationships;
    const std::string text = archive_.read("_rels/.rels");
    relationships.load_buffer(text.data(), text.size());
    for (const Node relation : relationships.child("Relationships").children())
      if (std::string_view(relation.attribute("Type").value()).ends_with("/3dmodel")) {
        const std::string target = relation.attribute("Target").value();
        return target.starts_with("/") ? target.substr(1) : target;
      }
    return "3D/3dmodel.model";
  }

  /// Section 2.3.2 of the specification: a file that requires an extension must not be read without it.
  void check_extensions(Node model) const {
    std::string_view prefixes = model.attribute("requiredextensions").value();
    constexpr std::string_view kSpace = " \t\r\n";
    while (!prefixes.empty()) {
      prefixes.remove_prefix(std::min(prefixes.find_first_not_of(kSpace), prefixes.size()));
      const std::string prefix(prefixes.substr(0, prefixes.find_first_of(kSpace)));
      prefixes.remove_prefix(prefix.size());
      if (prefix.empty()) continue;
      const std::string name = model.attribute(("xmlns:" + prefix).c_str()).value();
      // These add colours, names of sets of triangles, and identifiers; references to other models of the
      // production extension are refused where they are used.
      const bool harmless = name.find("/material/") != name.npos ||
                            name.find("/trianglesets/") != name.npos ||
                            name.find("/production/") != name.npos;
      if (!harmless)
        reject_file(path_,
                    "the 3MF file requires the extension " + core::in_quotes(name.empty() ? prefix : name) +
                        ", which is not read, so that a part of its geometry would be missing",
                    "export the model as plain triangles, without lattices, slices or encryption");
    }
  }

  /// Throws for an object in another model of the archive (3MF Production Extension 1.1, section 2).
  void require_here(Node reference) const {
    for (const pugi::xml_attribute attribute : reference.attributes())
      if (std::string_view(attribute.name()).ends_with(":path"))
        reject_file(path_,
                    "the 3MF file places an object of its other model " + core::in_quotes(attribute.value()) +
                        ", and only one model is read",
                    "export the model in one piece, without the production extension");
  }

  void read_unit(Node model) {
    const pugi::xml_attribute attribute = model.attribute("unit");
    const std::string name = attribute ? attribute.value() : "millimeter";
    for (const auto& [known, mm] : k3mfUnits)
      if (name == known) raw_.unit = {name, mm, !attribute.empty(), mm};
    if (raw_.unit.mm == 0.0)
      reject_file(path_,
                  "the 3MF file is in " + core::in_quotes(name) +
                      "; expected micron, millimeter, centimeter, inch, foot or meter",
                  kExportAgain);
  }

  void read_resources(Node resources) {
    for (const Node group : resources.children("basematerials"))
      for (const Node base : group.children("base"))
        materials_[group.attribute("id").value()].push_back(base.attribute("name").value());
    for (const Node node : resources.children("object")) {
      ThreeMfObject object;
      object.name = node.attribute("name").value();
      object.components = node.child("components");
      if (const Node mesh = node.child("mesh")) read_mesh(node, mesh, object);
      objects_[node.attribute("id").value()] = std::move(object);
    }
  }

  double number(Node node, const char* attribute) const {
    const std::string_view text = node.attribute(attribute).value();
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      reject_file(path_,
                  std::string("<") + node.name() + "> has " + attribute + "=" + core::in_quotes(text) +
                      ", which is not a number",
                  kExportAgain);
    return value;
  }

  std::size_t index(Node node, const char* attribute, std::size_t below, const char* of) const {
    const double value = number(node, attribute);
    if (!(value >= 0.0 && value < static_cast<double>(below)) || value != std::floor(value))
      reject_file(path_,
                  std::string("<") + node.name() + "> refers to " + of + " " +
                      core::in_quotes(node.attribute(attribute).value()) + ", which does not exist",
                  kExportAgain);
    return static_cast<std::size_t>(value);
  }

  void read_mesh(Node owner, Node mesh, ThreeMfObject& object) {
    for (const Node vertex : mesh.child("vertices").children("vertex"))
      object.vertices.emplace_back(number(vertex, "x"), number(vertex, "y"), number(vertex, "z"));
    for (const Node child : mesh.children())
      if (std::string_view(child.name()).ends_with(":beamlattice")) ++lattices_;
    for (const Node node : mesh.child("triangles").children("triangle")) {
      ThreeMfTriangle triangle;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        constexpr std::array kNames{"v1", "v2", "v3"};
        triangle.corners[corner] =
            static_cast<std::uint32_t>(index(node, kNames[corner], object.vertices.size(), "vertex"));
      }
      triangle.material = material(node, node.attribute("pid") ? node : owner, owner);
      object.triangles.push_back(std::move(triangle));
    }
  }

  /// Name of the base material: that of the triangle, else of its object; empty for colours and none.
  std::string material(Node triangle, Node with_group, Node owner) const {
    const auto group = materials_.find(with_group.attribute("pid").value());
    if (group == materials_.end()) return {};
    const bool own = triangle.attribute("p1");
    const Node with_index = own ? triangle : owner;
    const char* attribute = own ? "p1" : "pindex";
    if (!with_index.attribute(attribute)) return {};
    return group->second[index(with_index, attribute, group->second.size(), "base material")];
  }

  const ThreeMfObject& find_object(const std::string& id) const {
    const auto found = objects_.find(id);
    if (found == objects_.end())
      reject_file(path_, "the 3MF file refers to object " + core::in_quotes(id) + ", which does not exist",
                  kExportAgain);
    return found->second;
  }

  /// Twelve numbers, row by row, for points written as rows (section 3.3 of the specification).
  Eigen::Affine3d transform_of(Node node) const {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    const pugi::xml_attribute attribute = node.attribute("transform");
    if (!attribute) return transform;
    std::string_view text = attribute.value();
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 3; ++column) {
        text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || !std::isfinite(value))
          reject_file(path_, "a transform is not twelve numbers: " + core::in_quotes(attribute.value()),
                      kExportAgain);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        transform.matrix()(column, row) = value;
      }
    return transform;
  }

  void place(const std::string& id, const Eigen::Affine3d& transform, std::size_t depth) {
    if (depth > kDeepestNesting)
      reject_file(path_, "the objects of the 3MF file contain themselves, or are nested more than 500 deep");
    constexpr std::size_t kMostPlaced = 1'000'000;
    const ThreeMfObject& object = find_object(id);
    if (++placed_ > kMostPlaced || raw_.mesh.triangles.size() + object.triangles.size() > kMost3mfTriangles)
      reject_file(path_,
                  "the components of the 3MF file multiply to more than " +
                      std::to_string(kMost3mfTriangles) + " triangles or " + std::to_string(kMostPlaced) +
                      " objects",
                  "split it in several files");
    append(object, transform);
    for (const Node component : object.components.children("component")) {
      require_here(component);
      place(component.attribute("objectid").value(), transform * transform_of(component), depth + 1);
    }
  }

  void append(const ThreeMfObject& object, const Eigen::Affine3d& transform) {
    TriMesh& mesh = raw_.mesh;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const core::Vec3& vertex : object.vertices) mesh.vertices.push_back(transform * vertex);
    const bool mirrored = transform.linear().determinant() < 0.0;
    std::map<std::string, std::uint32_t> groups;
    for (const ThreeMfTriangle& triangle : object.triangles) {
      auto [a, b, c] = triangle.corners;
      if (mirrored) std::swap(b, c);
      mesh.triangles.push_back({first + a, first + b, first + c});
      const auto [group, is_new] = groups.try_emplace(triangle.material, 0);
      if (is_new) group->second = mesh.group_index(group_name(object.name, triangle.material));
      mesh.group.push_back(group->second);
    }
  }

  const std::filesystem::path& path_;
  core::ZipArchive archive_;
  pugi::xml_document document_;
  RawMesh raw_;
  std::map<std::string, std::vector<std::string>> materials_;
  std::map<std::string, ThreeMfObject> objects_;
  std::size_t placed_ = 0, lattices_ = 0;
};

}  // namespace

/// Mesh of a 3MF archive (3MF Core Specification 1.3): the model that the relationships name, its meshes and
/// components as its build items place them, in the unit of the model. Coordinates keep double precision.
/// Bodies are build items, called after their object; groups are object and base material. Colours and
/// textures are ignored, a lattice that the file does not require is left out with a note. Throws InputError
/// also for a required extension that carries geometry, when objects contain themselves, and when components
/// multiply to more than 20 million triangles.
///
/// Assimp is not used: up to 5.3 it aborts the process for archives that do not fit their checksums or whose
/// relationships lead nowhere, and frees their pictures twice.
RawMesh import_3mf(const MeshFile& file) { return ThreeMfReader(file.path, file.content).read(); }

}  // namespace scintray::mesh
