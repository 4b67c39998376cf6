#include "scintray/cli/scene_view.hpp"

#include <algorithm>

#include "scintray/core/error.hpp"
#include "scintray/report/view/view_page.hpp"
#include "scintray/results/results.hpp"
#include "scintray/scene/place_parts.hpp"
#include "scintray/scene_file/read_scene.hpp"

namespace scintray::cli {

namespace {

/// "scene.toml:12", of the place of a name; empty without one.
std::string place_of(const core::FileLocation& where) {
  if (where.line <= 0) return "";
  return std::filesystem::path(where.file).filename().string() + ":" + std::to_string(where.line);
}

/// Problem of a mesh or of the scene in one line, without the folders of this machine.
std::string reason_of(const core::Problem& problem) {
  const std::string file = std::filesystem::path(problem.where.file).filename().string();
  std::string what = problem.what.substr(0, problem.what.find('\n'));
  while (!what.empty() && what.back() == '.') what.pop_back();
  return (file.empty() ? "" : file + ": ") + what;
}

std::vector<contact::PlacedMesh> placed_parts(const scene_file::SceneSpec& spec) {
  core::Problems problems;
  std::vector<contact::PlacedMesh> placed = scene::place_parts(spec, problems);
  problems.throw_if_any();
  return placed;
}

/// Why parts may be others than those of the run; empty when they are the same.
std::string other_parts(const std::vector<contact::PlacedMesh>& placed, const tally::RunHeader& header) {
  for (const contact::PlacedMesh& part : placed)
    if (std::find(header.parts.begin(), header.parts.end(), part.name) == header.parts.end())
      return "its files have changed since the run, which has no part " + part.name;
  return "";
}

}  // namespace

std::vector<report::ViewPart> view_parts(const std::vector<contact::PlacedMesh>& placed) {
  std::vector<report::ViewPart> parts;
  for (const contact::PlacedMesh& part : placed) {
    report::ViewPart shown{part.name,
                           part.medium.empty() ? "sensor " + part.sensor.name : part.medium.name,
                           &part.mesh,
                           {},
                           part.face_of};
    for (const contact::PlacedFace& face : part.faces)
      shown.faces.push_back({face.name, face.surface.name,
                             (face.sensor.empty() ? part.sensor : face.sensor).name,
                             place_of(face.surface.where)});
    parts.push_back(std::move(shown));
  }
  return parts;
}

SceneOfResults scene_of_results(const std::filesystem::path& results, const tally::RunResult& run) {
  SceneOfResults scene;
  std::vector<scene_file::TallySpec> tallies;
  try {
    const scene_file::SceneFile file =
        scene_file::SceneFile::from_text(run.header.scene_text, run.header.scene_file);
    const scene_file::SceneSpec spec = file.spec(0);
    tallies = spec.tallies;
    scene.placed = placed_parts(spec);
    scene.view.missing = other_parts(scene.placed, run.header);
  } catch (const core::InputError& error) {
    scene.view.missing = reason_of(error.problems().front());
  } catch (const core::Error& error) {
    scene.view.missing = reason_of({{}, error.what(), ""});
  }
  if (!scene.view.missing.empty()) return scene;
  report::SceneView& view = scene.view.view.emplace();
  view.title = run.header.title;
  view.parts = view_parts(scene.placed);
  view.paths = results::read_paths(results, 0);
  if (!run.points.empty())
    view.tallies = report::view_tallies(run.header, run.points.front(), tallies, view.parts);
  return scene;
}

}  // namespace scintray::cli
