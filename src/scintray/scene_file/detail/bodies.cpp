#include "scintray/scene_file/detail/bodies.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "scintray/scene_file/detail/array.hpp"
#include "scintray/scene_file/detail/light_guide.hpp"

namespace scintray::scene_file {

namespace {

enum class BodyKind { part, array, light_guide };

struct BodyTable {
  BodyKind kind;
  config::TomlTable table;
};

/// The tables of all bodies in the order of the file.
std::vector<BodyTable> body_tables(const config::TomlTable& scene) {
  std::vector<BodyTable> bodies;
  for (const auto& [key, kind] : {std::pair{"part", BodyKind::part}, std::pair{"array", BodyKind::array},
                                  std::pair{"light_guide", BodyKind::light_guide}})
    for (const config::TomlTable& table : scene.tables(key)) bodies.push_back({kind, table});
  std::stable_sort(bodies.begin(), bodies.end(), [](const BodyTable& a, const BodyTable& b) {
    return std::tie(a.table.where().line, a.table.where().column) <
           std::tie(b.table.where().line, b.table.where().column);
  });
  return bodies;
}

bool has_fill(const PlacementSpec& placement) { return placement.touch && !placement.touch->fill.empty(); }

/// Reader of all bodies; every name is unique.
class BodyReader {
 public:
  explicit BodyReader(const mesh::MeshFormats& formats) : formats_(formats) {}

  void read(const BodyTable& body) {
    if (body.kind == BodyKind::part) return add_part(body.table);
    const std::size_t problems = body.table.problem_count();
    if (body.kind == BodyKind::array) {
      const ArraySpec array = read_array(body.table, touchable_, bodies_.surfaces, formats_);
      add_group(body.table, array.name, array.placement, expand(array));
    } else {
      const LightGuideSpec guide = read_light_guide(body.table, touchable_, bodies_.surfaces);
      add_group(body.table, guide.name, guide.placement, expand(guide));
    }
    bodies_.names_known &= body.table.problem_count() == problems;
  }

  Bodies take() { return std::move(bodies_); }

 private:
  void take_name(const config::TomlTable& table, const std::string& name, const std::string& hint) {
    if (name.empty()) return;
    if (!names_.insert(name).second)
      table.report("name", "the name \"" + name + "\" is already taken by another part", hint);
  }

  void take_names_of_body(const config::TomlTable& table, const std::string& name,
                          const PlacementSpec& placement) {
    take_name(table, name, "give each [[part]], [[array]] and [[light_guide]] a name of its own");
    touchable_.push_back(name);
    if (has_fill(placement)) {
      take_name(table, name + kFillSuffix, "the fill of a gap is a part of this name: rename one of the two");
      touchable_.push_back(name + kFillSuffix);
    }
  }

  void add_part(const config::TomlTable& table) {
    PartSpec part = read_part(table, touchable_);
    take_names_of_body(table, part.name.name, part.placement);
    bodies_.parts.push_back(std::move(part));
  }

  void add_group(const config::TomlTable& table, const config::NameRef& name, const PlacementSpec& placement,
                 BuiltBody built) {
    take_names_of_body(table, name.name, placement);
    for (const PartSpec& part : built.parts) {
      take_name(table, part.name.name, "a builder names its parts after itself: rename one of the two");
      touchable_.push_back(part.name.name);
    }
    if (built.parts.empty())
      table.report("name", "every element of \"" + name.name + "\" is removed", "keep one at least");
    bodies_.groups.push_back({name, bodies_.parts.size(), built.parts.size(), placement});
    std::move(built.parts.begin(), built.parts.end(), std::back_inserter(bodies_.parts));
    std::move(built.contacts.begin(), built.contacts.end(), std::back_inserter(bodies_.contacts));
  }

  Bodies bodies_;
  std::set<std::string> names_;
  std::vector<std::string> touchable_;  ///< names of parts and builders so far
  const mesh::MeshFormats& formats_;
};

}  // namespace

Bodies read_bodies(const config::TomlTable& scene, const mesh::MeshFormats& formats) {
  BodyReader reader(formats);
  const std::vector<BodyTable> tables = body_tables(scene);
  for (const BodyTable& table : tables) reader.read(table);
  if (tables.empty())
    scene.report("part", "the scene has no parts", "add a [[part]] with a name, a shape and a medium");
  return reader.take();
}

std::vector<std::string> part_names(const std::vector<PartSpec>& parts,
                                    const std::vector<GroupSpec>& groups) {
  std::vector<std::string> names;
  for (const PartSpec& part : parts) {
    names.push_back(part.name.name);
    if (has_fill(part.placement)) names.push_back(part.name.name + kFillSuffix);
  }
  for (const GroupSpec& group : groups)
    if (has_fill(group.placement)) names.push_back(group.name.name + kFillSuffix);
  return names;
}

}  // namespace scintray::scene_file
