#include "scintray/cli/check.hpp"

#include <fmt/format.h>

#include <iostream>
#include <map>

#include "scintray/core/output_file.hpp"
#include "scintray/mesh/export/gltf_writer.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/report/plots/scene_picture.hpp"

namespace scintray::cli {

namespace {

std::string medium_of(const contact::PlacedMesh& part) {
  if (!part.medium.empty()) return part.medium.name;
  return part.sensor.empty() ? "no medium" : "sensor " + part.sensor.name;
}

std::vector<report::PictureMark> marks_of(const std::vector<core::Problem>& problems) {
  std::vector<report::PictureMark> marks;
  for (const core::Problem& problem : problems) {
    report::PictureMark mark{problem.what, {}};
    for (const auto& [x, y, z] : problem.places_mm) mark.places.emplace_back(x, y, z);
    if (!mark.places.empty()) marks.push_back(std::move(mark));
  }
  return marks;
}

void write_scene_glb(const std::filesystem::path& path, const std::vector<contact::PlacedMesh>& parts,
                     const std::vector<report::PictureMark>& marks) {
  constexpr double kOpacity = 0.35;
  constexpr double kMarkShare = 0.012;  // of the scene's diagonal
  std::map<std::string, std::size_t> media;
  std::vector<mesh::GltfObject> objects;
  Eigen::AlignedBox3d box;
  for (const contact::PlacedMesh& part : parts) {
    const auto colour =
        report::picture_colour(media.try_emplace(medium_of(part), media.size()).first->second);
    objects.push_back(
        {part.name, &part.mesh,
         std::array<double, 4>{colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, kOpacity}});
    box.extend(part.diagnosis.bounds);
  }
  std::vector<mesh::TriMesh> balls;
  std::vector<std::string> names;
  for (std::size_t m = 0; m < marks.size(); ++m)
    for (const core::Vec3& place : marks[m].places) {
      mesh::TriMesh ball =
          mesh::make_sphere(kMarkShare * std::max(box.isEmpty() ? 1.0 : box.diagonal().norm(), 1e-6), 3);
      for (core::Vec3& v : ball.vertices) v += place;
      balls.push_back(std::move(ball));
      names.push_back(fmt::format("{}: {}", m + 1, marks[m].text));
    }
  for (std::size_t i = 0; i < balls.size(); ++i)
    objects.push_back({names[i], &balls[i], std::array<double, 4>{0.85, 0.05, 0.05, 1.0}});
  mesh::write_glb(path, objects, mesh::GltfAxes::z_up);
}

}  // namespace

std::vector<contact::PlacedMesh> placed_for_picture(const scene_file::SceneSpec& spec) {
  core::Problems reported_elsewhere;
  return scene::place_parts(spec, reported_elsewhere);
}

void expect_picture_name(const std::filesystem::path& path) {
  const std::string ending = mesh::lower_extension(path);
  if (ending != ".glb" && ending != ".svg")
    throw core::InputError({{},
                            "a picture cannot be written as \"" + path.string() + "\"",
                            "choose a name that ends in .glb or .svg"});
}

void draw_scene(const std::filesystem::path& path, const std::vector<contact::PlacedMesh>& parts,
                const std::vector<core::Problem>& problems) {
  expect_picture_name(path);
  const auto marks = marks_of(problems);
  if (mesh::lower_extension(path) == ".glb") {
    write_scene_glb(path, parts, marks);
  } else {
    std::vector<report::PicturePart> shown;
    for (const contact::PlacedMesh& part : parts) shown.push_back({part.name, medium_of(part), &part.mesh});
    core::write_whole_file(path, report::scene_svg(shown, marks));
  }
  std::cout << fmt::format("picture: {} (parts: {}, marked problems: {})\n", path.string(), parts.size(),
                           marks.size());
}

}  // namespace scintray::cli
