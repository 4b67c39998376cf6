#include "scintray/mesh/gltf_writer.hpp"

#include <doctest/doctest.h>

#include "scintray/core/error.hpp"
#include "scintray/mesh/import.hpp"
#include "scintray/mesh/primitives.hpp"
#include "support/shared.hpp"

using namespace scintray;

TEST_CASE("A mesh comes back from glTF with its groups, in millimetres") {
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
  CHECK(read.mesh.groups.size() == 2);
  CHECK_THROWS_AS(write_glb("/no/such/folder/x.glb", {{"tall", &tall, std::nullopt}}, GltfAxes::z_up),
                  SystemError);
}
