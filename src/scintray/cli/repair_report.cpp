#include "scintray/cli/repair.hpp"

#include <fmt/format.h>

#include <iostream>
#include <set>

#include "scintray/cli/progress.hpp"
#include "scintray/mesh/export/gltf_writer.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/repair/repair.hpp"

namespace scintray::cli {

namespace {

std::string places(const mesh::Defects& defects) {
  std::string text;
  for (const core::Vec3& p : defects.examples)
    text += fmt::format("{}({:.5g}, {:.5g}, {:.5g})", text.empty() ? "" : ", ", p.x(), p.y(), p.z());
  if (text.empty()) return text;
  return fmt::format(", at {}{} mm", text, defects.count > defects.examples.size() ? ", ..." : "");
}

void print_state(const std::string& when, const mesh::MeshDiagnosis& d) {
  std::cout << fmt::format("  {}: {} triangles, {} {}, {:.6g} mm2, {:.6g} mm3; ", when, d.triangles, d.bodies,
                           d.bodies == 1 ? "body" : "bodies", d.area_mm2, d.volume_mm3);
  const std::pair<const char*, const mesh::Defects*> kinds[] = {
      {"open edges", &d.open_edges},
      {"non-manifold edges", &d.nonmanifold_edges},
      {"flipped edges", &d.flipped_edges},
      {"triangles without area", &d.degenerate_triangles},
      {"duplicate triangles", &d.duplicate_triangles},
      {"crossing pairs of triangles", &d.self_intersections},
      {"bodies inside out", &d.inverted_bodies}};
  std::string found;
  for (const auto& [name, defects] : kinds)
    if (defects->count > 0) found += fmt::format("{}{} {}", found.empty() ? "" : ", ", defects->count, name);
  std::cout << (found.empty() ? (d.sound() ? "sound" : "no volume") : found) << "\n";
}

void write(const std::filesystem::path& out, const std::string& name, const mesh::TriMesh& mesh) {
  const std::string ending = mesh::lower_extension(out);
  if (ending == ".glb") {
    mesh::write_glb(out, {{name, &mesh, std::nullopt}}, mesh::GltfAxes::as_they_are);
    return;
  }
  const std::set<std::uint32_t> used(mesh.group.begin(), mesh.group.end());
  if (used.size() > 1)
    std::cout << fmt::format("  note: {} has no groups, {} are lost; write .glb to keep them\n",
                             ending == ".ply" ? "PLY" : "STL", used.size());
  ending == ".ply" ? mesh::write_ply(out, mesh) : mesh::write_stl(out, mesh);
}

}  // namespace

const char* lossless_ending(const std::filesystem::path& in, const mesh::ImportOptions& options) {
  const std::string ending = mesh::lower_extension(in);
  if (ending == ".ply") return ".ply";
  return ending == ".stl" && mesh::import_mesh(in, options).mesh.groups.size() <= 1 ? ".stl" : ".glb";
}

bool repair_file(const std::filesystem::path& in, const mesh::ImportOptions& options,
                 const std::filesystem::path& out, const mesh::RepairSettings& settings,
                 const RepairReport& report) {
  const std::string ending = mesh::lower_extension(out);
  if (ending != ".stl" && ending != ".ply" && ending != ".glb")
    throw core::InputError({{},
                            "a repaired mesh cannot be written as \"" + out.string() + "\"",
                            "choose a name that ends in .stl or .ply or, to keep groups, in .glb"});
  mesh::MeshImport imported =
      with_progress("reading " + in.string(), [&] { return mesh::import_mesh(in, options); });
  std::cout << in.string() << (options.body.empty() ? "" : ", body \"" + options.body + "\"") << "\n";
  for (const std::string& note : imported.notes) std::cout << "  on reading: " << note << "\n";
  const mesh::RepairedMesh repaired = with_progress(
      "repairing " + in.string(), [&] { return mesh::repair_mesh(std::move(imported.mesh), settings); });
  print_state("found", repaired.before);
  for (const mesh::RepairStep& step : repaired.steps)
    std::cout << fmt::format("  done: {}: {}{}\n", step.what, step.where.count, places(step.where));
  if (repaired.steps.empty()) std::cout << "  done: nothing\n";
  for (const std::string& reason : repaired.refused) std::cout << "  not done: " << reason << "\n";

  write(out, options.body.empty() ? out.stem().string() : options.body, repaired.mesh);
  const mesh::MeshDiagnosis written = with_progress("examining what was written", [&] {
    return mesh::diagnose(mesh::import_mesh(out, ending == ".glb" ? 0.0 : 1.0).mesh);
  });
  print_state("written to " + out.string(), written);
  if (written.bodies > 1)
    std::cout << fmt::format(
        "  note: {} bodies in one file make one part; save them separately to assign different media\n",
        written.bodies);
  for (const core::Problem& problem : mesh::mesh_problems(written, in.filename().string()))
    std::cout << "  left: " << problem.what << "\n        hint: " << problem.hint << "\n";
  if (report) report(in, repaired.before, written);
  return written.sound();
}

}  // namespace scintray::cli
