#include "scintray/cli/repair_scene.hpp"

#include <iostream>
#include <map>
#include <set>

#include "scintray/cli/repair_report.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/scene/toml_reader.hpp"

namespace scintray::cli {

namespace {

/// A string value of the scene file that gets another content.
struct Edit {
  const TomlNode* node;
  std::string content;
};

/// The scene file's text with strings replaced where they stand.
class Text {
 public:
  explicit Text(const std::string& text) {
    std::size_t begin = 0;
    for (std::size_t end = 0; end < text.size(); begin = end) {
      end = std::min(text.find('\n', begin), text.size() - 1) + 1;
      lines_.push_back(text.substr(begin, end - begin));
    }
  }

  void replace(const Edit& edit) {
    std::string& line = lines_.at(static_cast<std::size_t>(edit.node->where.line - 1));
    for (const char quote : {'"', '\''}) {
      const std::string old = quote + edit.node->text + quote;
      // Columns count characters, never more than bytes; an edit before this one may have moved it.
      const std::size_t at = line.find(old);
      if (at == std::string::npos) continue;
      line.replace(at, old.size(), "\"" + edit.content + "\"");
      return;
    }
    throw InputError({edit.node->where, "the string \"" + edit.node->text + "\" has escapes in it",
                      "write the path plainly, with / between folders"});
  }

  std::string whole() const {
    std::string text;
    for (const std::string& line : lines_) text += line;
    return text;
  }

 private:
  std::vector<std::string> lines_;
};

class SceneRepairer {
 public:
  SceneRepairer(const std::filesystem::path& scene, const std::filesystem::path& out,
                const RepairSettings& settings)
      : scene_(scene), out_(out), settings_(settings), folder_(scene.parent_path()) {}

  bool run() {
    const TomlNodePtr document = parse_toml_file(scene_);
    std::filesystem::create_directories(out_);
    if (std::filesystem::exists(out_ / scene_.filename()) &&
        std::filesystem::equivalent(out_ / scene_.filename(), scene_))
      throw InputError({{}, "the output folder is that of the scene itself", "name another folder"});
    if (const TomlNode* parts = document->find("part"))
      for (const TomlNode& part : parts->items) mend(part);
    move_paths(*document);
    Text text(read_text_file(scene_));
    for (const Edit& edit : edits_) text.replace(edit);
    write_whole_file(out_ / scene_.filename(), text.whole());
    std::cout << (out_ / scene_.filename()).string() << ": names " << mended_.size() << " mended "
              << (mended_.size() == 1 ? "mesh" : "meshes") << "\n";
    return sound_;
  }

 private:
  struct Mended {
    std::string name;
    std::string unit;
  };

  void mend(const TomlNode& part) {
    const TomlNode *mesh = part.find("mesh"), *unit = part.find("unit");
    if (mesh == nullptr || mesh->kind != TomlNode::Kind::string) return;
    const double mm_per_unit = unit == nullptr ? 0.0 : unit_factor(unit->text, Dimension::length);
    const std::filesystem::path in = folder_ / mesh->text;
    const auto [known, is_new] = mended_.try_emplace({mesh->text, mm_per_unit});
    if (is_new) {
      const std::string ending = lossless_ending(in, mm_per_unit);
      std::string name = in.stem().string() + "_mended" + ending;
      for (int copy = 2; !names_.insert(name).second; ++copy)
        name = in.stem().string() + "_mended" + std::to_string(copy) + ending;
      sound_ = repair_file(in, mm_per_unit, out_ / name, settings_) && sound_;
      known->second = {name, ending == ".glb" ? "m" : "mm"};
    }
    edits_.push_back({mesh, known->second.name});
    if (unit != nullptr) edits_.push_back({unit, known->second.unit});
    handled_.insert(mesh);
  }

  /// Other files that the scene names by relative paths are found from the new folder too.
  void move_paths(const TomlNode& node) {
    for (const TomlNode& item : node.items) move_paths(item);
    if (node.kind != TomlNode::Kind::string || handled_.count(&node) > 0) return;
    const std::filesystem::path path(node.text);
    std::error_code error;
    if (path.is_absolute() || node.text.empty() || !std::filesystem::is_regular_file(folder_ / path, error))
      return;
    edits_.push_back({&node, std::filesystem::proximate(folder_ / path, out_).generic_string()});
  }

  std::filesystem::path scene_, out_;
  RepairSettings settings_;
  std::filesystem::path folder_;
  std::map<std::pair<std::string, double>, Mended> mended_;
  std::set<std::string> names_;
  std::set<const TomlNode*> handled_;
  std::vector<Edit> edits_;
  bool sound_ = true;
};

}  // namespace

bool repair_scene(const std::filesystem::path& scene, const std::filesystem::path& out,
                  const RepairSettings& settings) {
  return SceneRepairer(scene, out, settings).run();
}

}  // namespace scintray::cli
