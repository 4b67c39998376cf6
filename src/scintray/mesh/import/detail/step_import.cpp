#include <algorithm>
#include <new>
#include <string>
#include <string_view>

#include "scintray/core/child_process.hpp"
#include "scintray/core/error.hpp"
#include "scintray/mesh/import/detail/step_isolation.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/mesh_format.hpp"

namespace scintray::mesh {
namespace {

/// Result of the child process: a mesh, or the error of the file with its hint.
constexpr char kMesh = 'm', kProblem = 'p';

std::string step_answer(const std::filesystem::path& path, const std::string& content,
                        const Tessellation& tessellation) {
  std::string what = "Open CASCADE failed", hint;
  try {
    return kMesh + to_bytes(read_step(path, content, tessellation));
  } catch (const core::InputError& error) {
    what = error.problems().front().what;
    hint = error.problems().front().hint;
  } catch (const std::bad_alloc&) {
    what = "it takes more memory than a file of this size can need";
  } catch (const std::exception& error) {
    what = error.what();
  }
  return kProblem + what + '\0' + hint;
}

}  // namespace

/// Mesh of a STEP file (ISO 10303-21; AP203, AP214, AP242), by Open CASCADE, with its faces tessellated.
/// Coordinates are in mm; RawMesh::unit is the file's own unit.
///
/// Bodies are solids, each instance of an assembly one of its own, called after its product; a product
/// without solids is one body of its shells. Every CAD face is a group, called after its name, else its
/// colour ("#rrggbb", sRGB), else its number in the file ("face12"); its tags are "face", the number, and
/// "color", its own colour or that of its solid or product.
///
/// Throws InputError also for content that has no faces, or that Open CASCADE cannot read or tessellate; for
/// a deviation below a millionth of the size of the shape; and when ScintRay was built without Open CASCADE.
RawMesh import_step(const MeshFile& file) {
  constexpr std::size_t kAlways = std::size_t{2} << 30, kPerByte = 2000;
  constexpr unsigned kMostSeconds = 3600;
  check_step_references(file.path, file.content);
  const core::ChildAnswer answer =
      core::run_in_child([&] { return step_answer(file.path, file.content, file.tessellation); },
                         kAlways + kPerByte * file.content.size(), kMostSeconds);
  if (!answer.trouble.empty() || answer.bytes.empty())
    reject_file(
        file.path, "cannot read the STEP file: Open CASCADE failed: " + answer.trouble,
        "give the tessellation a larger deviation or angle, or export the file again (AP203, AP214 or "
        "AP242)");
  const std::string_view payload = std::string_view(answer.bytes).substr(1);
  if (answer.bytes.front() == kMesh) return from_bytes(payload);
  const std::size_t end = std::min(payload.find('\0'), payload.size() - 1);
  reject_file(file.path, std::string(payload.substr(0, end)), std::string(payload.substr(end + 1)));
}

}  // namespace scintray::mesh
