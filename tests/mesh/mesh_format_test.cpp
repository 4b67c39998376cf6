// A mesh format from outside: nothing of ScintRay knows it but the list that the caller passes.
#include "scintray/mesh/import/mesh_format.hpp"

#include "mesh/toy_format.hpp"
#include "scintray/mesh/import/import.hpp"

using namespace scintray;
using namespace scintray::mesh;
using namespace scintray::test;

TEST_CASE("A mesh format from outside is read as the built-in ones are") {
  const MeshFormats formats = with_toy();
  ImportOptions options;
  options.formats = &formats;
  const MeshImport box = import_mesh(mesh_file("box.toy", kToyBox), options);
  check_box(box, 10.0);
  CHECK(box.unit_from_file == "cm");
  CHECK(box.bodies == std::vector<std::string>{"crystal"});

  const auto obj = mesh_file("beside.obj", corner_lines("v ") + quad_lines("f ", 1));
  options.mm_per_unit = 1.0;
  check_box(import_mesh(obj, options), 1.0);
  check_contains(complaint_of([&] { import_mesh(mesh_file("box.toy", kToyBox), options); }),
                 {"the file states the unit cm"});
}

TEST_CASE("Body and scale of the options hold for a mesh format from outside") {
  const MeshFormats formats = with_toy();
  ImportOptions options;
  options.formats = &formats;
  options.body = "lid";
  options.scale = 0.5;
  const auto two = mesh_file("two.toy", kToyBox + "solid lid\nf 0 2 1\nf 0 1 4\nf 0 4 2\nf 1 2 4\n");
  const MeshImport lid = import_mesh(two, options);
  CHECK(lid.mesh.triangles.size() == 4);
  CHECK(lid.mesh.volume() == doctest::Approx(125.0));  // a sixth of 1 x 2 x 3 cm^3, halved in length
  CHECK(lid.bodies == std::vector<std::string>{"crystal", "lid"});
}

TEST_CASE("A file of several bodies is read once for all announced imports of it") {
  static int reads = 0;
  reads = 0;
  MeshFormats formats;
  formats.add({.extension = ".toy", .states_unit = true, .read = [](const MeshFile& file) {
                 ++reads;
                 return read_lines_of_toy(file);
               }});
  ImportOptions options;
  options.formats = &formats;
  const auto two = mesh_file("two.toy", kToyBox + "solid lid\nf 0 2 1\nf 0 1 4\nf 0 4 2\nf 1 2 4\n");
  MeshFiles files;
  for (int i = 0; i < 4; ++i) files.announce(two);
  for (const char* body : {"lid", "crystal", "2", ""}) {
    CAPTURE(body);
    options.body = body;
    const MeshImport alone = import_mesh(two, options);
    reads = 0;
    const MeshImport shared = files.import(two, options);
    CHECK(reads == (options.body == "lid" ? 1 : 0));
    CHECK(shared.mesh.vertices == alone.mesh.vertices);
    CHECK(shared.mesh.triangles == alone.mesh.triangles);
    CHECK(shared.mesh.group == alone.mesh.group);
    CHECK(shared.mesh.groups == alone.mesh.groups);
    CHECK(shared.bodies == alone.bodies);
    CHECK(shared.notes == alone.notes);
  }
  // Nothing is kept for imports that nobody announced, nor for another tessellation or scale.
  options.body = "lid";
  reads = 0;
  (void)files.import(two, options);
  files.announce(two);
  files.announce(two);
  (void)files.import(two, options);
  options.scale = 2.0;
  CHECK(files.import(two, options).mesh.volume() == doctest::Approx(8000.0));
  CHECK(reads == 3);
  options.body = "roof";
  files.announce(two);
  files.announce(two);
  check_contains(complaint_of([&] { files.import(two, options); }), {"no body \"roof\""});
}

TEST_CASE("A mesh format is known only where it was added") {
  const auto path = mesh_file("box.toy", kToyBox);
  check_refused(path, 0.0, {"\".toy\" is not a mesh format"});
  const MeshFormats formats = with_toy();
  CHECK(formats.extensions().back() == ".toy");
  CHECK(formats.extensions().size() == mesh_extensions().size() + 1);
  CHECK(MeshFormats::built_in().find(".toy") == nullptr);

  ImportOptions options;
  options.formats = &formats;
  check_contains(complaint_of([&] { import_mesh(mesh_file("box.unknown", kToyBox), options); }),
                 {"\".unknown\" is not a mesh format", ".stp", ".toy"});
}

TEST_CASE("What a reader from outside throws reaches the caller with the file's name") {
  const MeshFormats formats = with_toy();
  ImportOptions options;
  options.formats = &formats;
  check_contains(complaint_of([&] { import_mesh(mesh_file("odd.toy", "edge 1 2\n"), options); }),
                 {"odd.toy", "begins with \"edge\""});
}

TEST_CASE("An extension has one mesh format, and a mesh format a reader") {
  MeshFormats formats = with_toy();
  CHECK_THROWS_AS(formats.add({.extension = ".toy", .read = read_lines_of_toy}), core::InternalError);
  CHECK_THROWS_AS(formats.add({.extension = ".stl", .read = read_lines_of_toy}), core::InternalError);
  CHECK_THROWS_AS(formats.add({.extension = "toy2", .read = read_lines_of_toy}), core::InternalError);
  CHECK_THROWS_AS(formats.add({.extension = ".toy2", .read = nullptr}), core::InternalError);
}
