#include "scintray/mesh/export/gltf_writer.hpp"

#include <doctest/doctest.h>

#include "scintray/core/error.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

TEST_CASE("A mesh is read back from glTF with its groups, in millimetres") {
  const auto path = test::scratch_folder("gltf_writer") / "box.glb";
  const TriMesh box = make_box({-1, 0, 2}, {3, 4, 10});
  write_glb(path, {{"box", &box, std::nullopt}}, GltfAxes::as_they_are);
  const MeshImport read = import_mesh(path, 0.0);
  CHECK(read.mesh.triangles.size() == 12);
  CHECK(read.mesh.vertices.size() == 8);
  CHECK(read.mesh.groups == box.groups);
  CHECK(read.mesh.volume() == doctest::Approx(128.0).epsilon(1e-6));
  for (std::size_t t = 0; t < 12; ++t) {
    const Vec3 normal = read.mesh.area_vector(t).normalized();
    const std::string& side = read.mesh.groups[read.mesh.group[t]];
    const int axis = side[1] - 'x';
    CHECK(normal[axis] == doctest::Approx(side[0] == '+' ? 1.0 : -1.0));
  }
}

TEST_CASE("Face tags are read back from glTF as they were, also where only the tags differ") {
  const auto path = test::scratch_folder("gltf_tags") / "tagged.glb";
  TriMesh box = make_box({-1, 0, 2}, {3, 4, 10});
  const std::vector<FaceTags> tags{{{"finish", "rough"}, {"layer", "3"}},
                                   {{"finish", "rough"}, {"layer", "4"}},
                                   {{"color", "#ff8000"}, {"glued", "true"}},
                                   {},
                                   {{"größe", "\"10\" µm"}},
                                   {{"", ""}}};
  box.groups = {"one", "one", "two", "two", "default", "\"quoted\""};
  box.group_tags = tags;
  for (const auto& colour : {std::optional<std::array<double, 4>>(), {{0.1, 0.2, 0.3, 0.5}}}) {
    write_glb(path, {{"box", &box, colour}}, GltfAxes::as_they_are);
    const MeshImport read = import_mesh(path, 0.0);
    REQUIRE(read.mesh.triangles.size() == box.triangles.size());
    CHECK(read.mesh.groups.size() == 6);
    for (std::size_t t = 0; t < read.mesh.triangles.size(); ++t) {
      const std::uint32_t group = read.mesh.group[t];
      // Triangles come back group by group, so they are found by their place.
      const auto same = [&](std::size_t own) {
        return (centre_of(box, own) - centre_of(read.mesh, t)).norm() < 1e-4;
      };
      std::size_t own = 0;
      while (own < box.triangles.size() && !same(own)) ++own;
      REQUIRE(own < box.triangles.size());
      CHECK(read.mesh.groups[group] == box.groups[box.group[own]]);
      CHECK(read.mesh.tags_of(group) == box.tags_of(box.group[own]));
    }
  }
}

TEST_CASE("A picture's parts and marks are turned so that z points up in viewers") {
  const auto path = test::scratch_folder("gltf_picture") / "two.glb";
  const TriMesh tall = make_box({0, 0, 0}, {1, 1, 5}), ball = make_sphere(0.5, 2);
  write_glb(path,
            {{"tall", &tall, std::array<double, 4>{0, 0, 1, 0.3}},
             {"mark", &ball, std::array<double, 4>{1, 0, 0, 1}}},
            GltfAxes::z_up);
  const MeshImport read = import_mesh(path, 0.0);
  Eigen::AlignedBox3d box;
  for (const Vec3& v : read.mesh.vertices) box.extend(v);
  CHECK(box.max().y() == doctest::Approx(5.0));
  CHECK(box.min().z() == doctest::Approx(-1.0));
  // The box's sides and the ball keep their names, in the colours of their objects.
  CHECK(read.mesh.groups.size() == 7);
  CHECK_THROWS_AS(write_glb("/no/such/folder/x.glb", {{"tall", &tall, std::nullopt}}, GltfAxes::z_up),
                  SystemError);
}
