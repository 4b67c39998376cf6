#include "scintray/cli/repair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <set>
#include <tuple>

#include "scintray/cli/scene_text.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/repair/repair.hpp"

namespace scintray::cli {

namespace {

using Kind = config::TomlNode::Kind;

/// A table that names the mesh of a part, or of the elements of an array.
struct MeshUse {
  const config::TomlNode* table = nullptr;
  std::string path;                            ///< path in sweeps; empty where there is none
  std::vector<const config::TomlNode*> swept;  ///< meshes that replace its own
  std::string why_not;                         ///< reason why it cannot be repaired; empty: it can

  const config::TomlNode* find(const char* key, Kind kind) const {
    const config::TomlNode* node = table->find(key);
    return node != nullptr && node->kind == kind ? node : nullptr;
  }
};

const std::vector<config::TomlNode>& items_of(const config::TomlNode& table, const char* key) {
  static const std::vector<config::TomlNode> none;
  const config::TomlNode* list = table.find(key);
  return list != nullptr && list->kind == Kind::array ? list->items : none;
}

std::string text_of(const config::TomlNode& table, const char* key) {
  const config::TomlNode* node = table.find(key);
  return node != nullptr ? node->text : "";
}

/// Records the values of a sweep that replace a mesh, or its options.
void apply_sweep(const config::TomlNode& sweep, MeshUse& use) {
  if (use.path.empty()) return;
  std::vector<std::string> keys{text_of(sweep, "key")};
  for (const config::TomlNode& key : items_of(sweep, "also")) keys.push_back(key.text);
  for (const std::string& key : keys) {
    if (key == use.path + ".mesh")
      for (const config::TomlNode& value : items_of(sweep, "values"))
        if (value.kind == Kind::string) use.swept.push_back(&value);
    for (const char* other : {"unit", "body", "tessellation"})
      if (key == use.path + "." + other || key.starts_with(use.path + "." + other + "."))
        use.why_not = fmt::format("its {} is swept", other);
  }
}

/// Every mesh of the scene, in parts and in the elements of arrays.
std::vector<MeshUse> meshes_of(const config::TomlNode& scene) {
  std::vector<MeshUse> uses;
  const auto add = [&](const config::TomlNode* table, const std::string& path) {
    if (table == nullptr || table->find("mesh") == nullptr) return;
    MeshUse use{table, path, {}, {}};
    if (use.find("mesh", Kind::string) == nullptr) return;
    for (const config::TomlNode& sweep : items_of(scene, "sweep")) apply_sweep(sweep, use);
    uses.push_back(std::move(use));
  };
  for (const config::TomlNode& part : items_of(scene, "part")) add(&part, "part." + text_of(part, "name"));
  for (const config::TomlNode& array : items_of(scene, "array")) {
    add(array.find("element"), "array." + text_of(array, "name") + ".element");
    for (const config::TomlNode& layer : items_of(array, "layer")) add(layer.find("element"), "");
  }
  return uses;
}

/// Options with which a use reads its file; their errors are reported where the scene is read.
mesh::ImportOptions options_of(const MeshUse& use) {
  mesh::ImportOptions options;
  if (const config::TomlNode* unit = use.find("unit", Kind::string))
    options.mm_per_unit = core::unit_factor(unit->text, core::Dimension::length);
  if (const config::TomlNode* body = use.table->find("body")) options.body = body->text;
  if (const config::TomlNode* tessellation = use.find("tessellation", Kind::table)) {
    if (const config::TomlNode* deviation = tessellation->find("deviation"))
      options.tessellation.deviation_mm = core::parse_quantity(deviation->text, core::Dimension::length);
    if (const config::TomlNode* angle = tessellation->find("angle"))
      options.tessellation.angle_rad = core::parse_quantity(angle->text, core::Dimension::angle);
  }
  // The scene's scale applies to the repaired mesh; the deviation counts after it.
  if (const config::TomlNode* scale = use.table->find("scale"); scale != nullptr && scale->number > 0.0)
    options.tessellation.deviation_mm /= scale->number;
  return options;
}

class SceneRepairer {
 public:
  SceneRepairer(const std::filesystem::path& scene, const std::filesystem::path& out,
                const mesh::RepairSettings& settings, RepairReport report)
      : scene_(scene),
        out_(out),
        settings_(settings),
        report_(std::move(report)),
        folder_(scene.parent_path()) {}

  bool run() {
    const config::TomlNodePtr document = config::parse_toml_file(scene_);
    std::filesystem::create_directories(out_);
    if (std::filesystem::exists(out_ / scene_.filename()) &&
        std::filesystem::equivalent(out_ / scene_.filename(), scene_))
      throw core::InputError({{}, "the output folder is that of the scene itself", "name another folder"});
    SceneText text(config::read_text_file(scene_));
    for (const MeshUse& use : meshes_of(*document)) mend(use, text);
    move_paths(*document, text);
    core::write_whole_file(out_ / scene_.filename(), text.whole());
    std::cout << (out_ / scene_.filename()).string() << ": names " << mended_.size() << " mended "
              << (mended_.size() == 1 ? "mesh" : "meshes") << "\n";
    for (const core::Problem& left : left_)
      std::cout << "  left as it was: " << left.where.text() << ": " << left.what
                << "\n        hint: " << left.hint << "\n";
    return sound_ && left_.empty();
  }

 private:
  /// A file as it was read: its name, unit (mm), body, tessellation, and the new extension.
  using Reading = std::tuple<std::string, double, std::string, double, double, std::string>;

  /// Repairs the meshes of one table and names them in the text; leaves all of them where one cannot be
  /// repaired.
  void mend(const MeshUse& use, SceneText& text) {
    std::vector<const config::TomlNode*> files{use.find("mesh", Kind::string)};
    files.insert(files.end(), use.swept.begin(), use.swept.end());
    const config::TomlNode* tessellation = use.table->find("tessellation");
    std::string why = use.why_not;
    if (why.empty() && tessellation != nullptr && !text.on_lines_of_its_own(*tessellation))
      why = "its tessellation, which a mended mesh no longer has, stands on one line with other keys";
    if (!why.empty()) {
      for (const config::TomlNode* file : files) leave(*file, why);
      return;
    }
    std::vector<std::string> names;
    try {
      const mesh::ImportOptions options = options_of(use);
      // Meshes that share one unit and one body in the scene share a format.
      const bool one_format = files.size() > 1 || !options.body.empty();
      for (const config::TomlNode* file : files)
        names.push_back(mended_name(file->text, options, one_format));
    } catch (const core::InputError& error) {
      for (const config::TomlNode* file : files) leave(*file, error.problems().front().what);
      return;
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
      text.replace(*files[i], names[i]);
      handled_.insert(files[i]);
    }
    if (const config::TomlNode* unit = use.find("unit", Kind::string))
      text.replace(*unit, names.front().ends_with(".glb") ? "m" : "mm");
    if (tessellation != nullptr) text.comment_out(*tessellation);
  }

  /// Repairs a file once for each set of options; returns the name of the written file.
  std::string mended_name(const std::string& file, const mesh::ImportOptions& options, bool as_gltf) {
    const std::filesystem::path in = folder_ / file;
    const std::string ending = as_gltf ? ".glb" : lossless_ending(in, options);
    const auto [known, is_new] = mended_.try_emplace(
        Reading{file, options.mm_per_unit, options.body, options.tessellation.deviation_mm,
                options.tessellation.angle_rad, ending},
        "");
    if (!is_new) return known->second;
    std::string name = in.stem().string() + "_mended" + ending;
    for (int copy = 2; !names_.insert(name).second; ++copy)
      name = in.stem().string() + "_mended" + std::to_string(copy) + ending;
    try {
      sound_ = repair_file(in, options, out_ / name, settings_, report_) && sound_;
    } catch (const core::InputError&) {
      mended_.erase(known);
      throw;
    }
    return known->second = name;
  }

  void leave(const config::TomlNode& file, const std::string& why) {
    left_.push_back({file.where, "\"" + file.text + "\" is not mended: " + why,
                     "mend it by hand: scintray repair " + file.text +
                         " -o MENDED.glb (--unit for STL, OBJ, PLY and OFF; --body NAME for one of several "
                         "bodies), and name MENDED.glb here"});
  }

  /// Rewrites relative paths of other files, so that they are found from the new folder, too; meshes among
  /// them were not repaired.
  void move_paths(const config::TomlNode& node, SceneText& text) {
    for (const config::TomlNode& item : node.items) move_paths(item, text);
    if (node.kind != Kind::string || handled_.contains(&node)) return;
    const std::filesystem::path path(node.text);
    std::error_code error;
    if (node.text.empty() || !std::filesystem::is_regular_file(folder_ / path, error)) return;
    const auto& endings = mesh::mesh_extensions();
    const bool reported = std::any_of(left_.begin(), left_.end(), [&](const core::Problem& left) {
      return left.where.text() == node.where.text();
    });
    if (!reported && std::find(endings.begin(), endings.end(), mesh::lower_extension(path)) != endings.end())
      leave(node, "no part and no element of an array takes it as its mesh");
    if (path.is_absolute()) return;
    text.replace(node, std::filesystem::proximate(folder_ / path, out_).generic_string());
  }

  std::filesystem::path scene_, out_;
  mesh::RepairSettings settings_;
  RepairReport report_;
  std::filesystem::path folder_;
  std::map<Reading, std::string> mended_;  ///< with the names of the written files
  std::set<std::string> names_;
  std::set<const config::TomlNode*> handled_;
  std::vector<core::Problem> left_;
  bool sound_ = true;
};

}  // namespace

bool repair_scene(const std::filesystem::path& scene, const std::filesystem::path& out,
                  const mesh::RepairSettings& settings, const RepairReport& report) {
  return SceneRepairer(scene, out, settings, report).run();
}

}  // namespace scintray::cli
